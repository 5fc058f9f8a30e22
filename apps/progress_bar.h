// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <string>

namespace lisco_apps {

/// A line on the terminal (stderr) that shows which part of the work is done. Silent in a pipe.
class ProgressBar {
 public:
  /// \param worthwhile false: silent on a terminal too
  explicit ProgressBar(bool worthwhile = true) : shown_(worthwhile && isatty(STDERR_FILENO) != 0) {}
  ~ProgressBar() { clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Shows which share of the work is done, 0 to 1, and what is being worked on; cut to the terminal's width.
  void show(double share, const std::string& what) {
    if (!shown_) return;
    constexpr std::size_t kWidth = 20;
    const auto filled = static_cast<std::size_t>(kWidth * std::clamp(share, 0.0, 1.0));
    std::string line = "[" + std::string(filled, '=') + std::string(kWidth - filled, ' ') + "] " +
                       std::to_string(static_cast<int>(100 * share)) + "% " + what;
    winsize size{};
    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0)
      line.resize(std::min<std::size_t>(line.size(), size.ws_col - 1U));  // a longer one could not be cleared
    std::fprintf(stderr, "\r\033[K%s", line.c_str());
    std::fflush(stderr);
  }

  /// Empties the line, before something else is printed.
  void clear() {
    if (shown_) std::fputs("\r\033[K", stderr);
  }

 private:
  bool shown_;
};

}  // namespace lisco_apps
