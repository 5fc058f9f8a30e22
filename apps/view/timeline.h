// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <map>
#include <string>

#include "io/text.h"

namespace lisco_apps {

/// Collects the scans of a run for one page, where they are frames of a timeline.
class ViewTimeline {
 public:
  /// Of encoded scans: more make a page that browsers load slowly. A VLP-16's scans fill it in 700 rotations, a
  /// VLS-128's in 60.
  static constexpr std::size_t kMaxBytes = std::size_t{64} << 20;

  /// \param file the page; one of an earlier run is removed
  /// \throws std::runtime_error with one line if the file exists and is no such page
  explicit ViewTimeline(fs::path file);

  /// Adds a scan, if there is space.
  /// \param number the scan's place among the others; any order
  /// \param scan as encodeViewScan () gives it
  void add(std::size_t number, std::string scan);

  /// Writes the page, unless it has no scan. \return one line to print; empty if nothing is written
  /// \throws std::runtime_error with one line if it cannot be written
  std::string write() const;

 private:
  fs::path file_;
  std::map<std::size_t, std::string> scans_;
  std::size_t bytes_ = 0, left_out_ = 0;
};

}  // namespace lisco_apps
