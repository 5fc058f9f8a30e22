// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <string>

namespace lisco_apps {

/// A line on the terminal (stderr) that shows how many of several things are done. Silent in a pipe, and for one
/// thing.
class ProgressBar {
 public:
  explicit ProgressBar(std::size_t total) : total_(total), shown_(total > 1 && isatty(STDERR_FILENO) != 0) {}
  ~ProgressBar() { clear(); }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  /// Shows that `done` things are done and what is being worked on.
  void show(std::size_t done, const std::string& what) {
    if (!shown_) return;
    constexpr std::size_t kWidth = 30;
    const std::size_t filled = kWidth * done / std::max<std::size_t>(1, total_);
    std::fprintf(stderr, "\r\033[K[%s%s] %zu/%zu %s", std::string(filled, '=').c_str(),
                 std::string(kWidth - filled, ' ').c_str(), done, total_, what.c_str());
    std::fflush(stderr);
  }

  /// Empties the line, before something else is printed.
  void clear() {
    if (shown_) std::fputs("\r\033[K", stderr);
  }

 private:
  std::size_t total_;
  bool shown_;
};

}  // namespace lisco_apps
