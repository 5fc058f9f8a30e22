// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>

#include "io/text.h"

namespace lisco_apps {

/// A line on the terminal (stderr) that each show () replaces. Shows nothing if stderr is no terminal.
class TerminalLine {
 public:
  /// \param enabled false: shows nothing on a terminal either
  explicit TerminalLine(bool enabled = true) : shown_(enabled && isatty(STDERR_FILENO) != 0) {}
  ~TerminalLine() { clear(); }
  TerminalLine(const TerminalLine&) = delete;
  TerminalLine& operator=(const TerminalLine&) = delete;

  bool isShown() const { return shown_; }

  /// \param line cut to the terminal's width, as clear () empties one line only
  void show(std::string line) {
    if (!shown_) return;
    winsize size{};
    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0)
      line.resize(std::min<std::size_t>(line.size(), size.ws_col - 1U));
    std::fprintf(stderr, "\r\033[K%s", line.c_str());
    std::fflush(stderr);
  }

  /// Empties the line; to be called before anything else is printed.
  void clear() {
    if (shown_) std::fputs("\r\033[K", stderr);
  }

 private:
  bool shown_;
};

/// "1:05 left, "; empty at the beginning, where it is unknown.
/// \param seconds since the beginning
/// \param share of the work that is done, 0 to 1
inline std::string timeLeft(double seconds, double share) {
  constexpr double kMinTime = 1;
  if (seconds <= kMinTime || share <= 0) return {};
  const auto left = static_cast<long>(std::ceil(seconds / share - seconds));
  return formatted("%ld:%02ld left, ", left / 60, left % 60);
}

/// A TerminalLine with the share of the work that is done.
class ProgressBar : private TerminalLine {
 public:
  using TerminalLine::clear;
  using TerminalLine::TerminalLine;

  /// \param share of the work that is done, 0 to 1
  /// \param what the current item
  void show(double share, const std::string& what) {
    constexpr std::size_t kWidth = 20;  // characters
    const auto filled = static_cast<std::size_t>(kWidth * std::clamp(share, 0.0, 1.0));
    TerminalLine::show("[" + std::string(filled, '=') + std::string(kWidth - filled, ' ') + "] " +
                       std::to_string(static_cast<int>(100 * share)) + "% " + what);
  }
};

}  // namespace lisco_apps
