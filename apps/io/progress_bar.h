// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>

#include "io/terminal_line.h"

namespace lisco_apps {

/// A TerminalLine with the share of the work that is done.
class ProgressBar {
 public:
  /// \param enabled false: shows nothing
  explicit ProgressBar(bool enabled = true) : line_(enabled) {}

  /// \param share of the work that is done, 0 to 1
  /// \param what is being worked on
  void show(double share, const std::string& what) {
    constexpr std::size_t kWidth = 20;  // characters
    const auto filled = static_cast<std::size_t>(kWidth * std::clamp(share, 0.0, 1.0));
    line_.show("[" + std::string(filled, '=') + std::string(kWidth - filled, ' ') + "] " +
               std::to_string(static_cast<int>(100 * share)) + "% " + what);
  }

  void clear() { line_.clear(); }

 private:
  TerminalLine line_;
};

}  // namespace lisco_apps
