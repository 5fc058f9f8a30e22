// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "lisco/cluster_features.h"
#include "recordings/mcap_writer.h"

namespace lisco_apps {

/// A labelled scan, as the results of a program have it.
struct LabelledScan {
  std::int64_t time_ns = 0;  ///< nanoseconds since 1970
  std::string frame;
  std::size_t rows = 1, columns = 0;
  std::vector<std::array<float, 3>> points;  ///< row by row, metres
  std::vector<std::uint32_t> labels;         ///< of the points: id of a cluster, 0: in none
  std::vector<std::uint8_t> ground;          ///< of the points: 1 where left out as ground; empty: not looked for
  struct Box {
    std::uint32_t id;
    lisco::OrientedBox box;
  };
  std::vector<Box> boxes;
};

/// Results as a recording that ROS 2's and Foxglove's tools play: for each scan a sensor_msgs/PointCloud2 of x, y, z,
/// label and ground on /lisco/points, and a visualization_msgs/MarkerArray of oriented boxes on /lisco/boxes.
class ResultBag {
 public:
  /// \throws std::runtime_error as McapWriter ()
  ResultBag(const fs::path& file, const std::string& program);
  void write(const LabelledScan& scan);
  void finish() { writer_.finish(); }

 private:
  McapWriter writer_;
};

}  // namespace lisco_apps
