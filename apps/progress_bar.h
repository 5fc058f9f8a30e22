// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>

#include "terminal_line.h"

namespace lisco_apps {

/// A line on the terminal (stderr) that shows which part of the work is done. Silent in a pipe.
class ProgressBar {
 public:
  /// \param worthwhile false: silent on a terminal too
  explicit ProgressBar(bool worthwhile = true) : line_(worthwhile) {}

  /// Shows which share of the work is done, 0 to 1, and what is being worked on; cut to the terminal's width.
  void show(double share, const std::string& what) {
    constexpr std::size_t kWidth = 20;
    const auto filled = static_cast<std::size_t>(kWidth * std::clamp(share, 0.0, 1.0));
    line_.show("[" + std::string(filled, '=') + std::string(kWidth - filled, ' ') + "] " +
               std::to_string(static_cast<int>(100 * share)) + "% " + what);
  }

  /// Empties the line, before something else is printed.
  void clear() { line_.clear(); }

 private:
  TerminalLine line_;
};

}  // namespace lisco_apps
