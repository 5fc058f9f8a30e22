// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "io/text.h"
#include "stream/stream.h"

namespace lisco_apps {

/// A folder that receives a labelled cloud of each turn: rotation_000001.pcd and so on, organized (a row per laser from
/// top to bottom, a column per firing), fields x y z intensity label ground; label 0: in no cluster; ground 1: left out
/// as ground.
class LabelledClouds {
 public:
  /// Makes the folder, and those above it, and removes the files of an earlier run.
  /// \param has_ground false: without the field ground
  /// \throws std::runtime_error with one line on failure, or if the folder has foreign files of such names
  LabelledClouds(fs::path folder, bool has_ground);

  /// \throws std::runtime_error with one line if it cannot be written
  void write(const Turn& turn) const;

 private:
  fs::path folder_;
  bool has_ground_;
};

}  // namespace lisco_apps
