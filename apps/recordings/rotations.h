// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "io/cloud_file.h"
#include "recordings/packet_input.h"
#include "sensors/rotation_cutter.h"

namespace lisco_apps {

/// A turn of a sensor as an organized cloud: a row per laser, from top to bottom, a column per firing.
struct Rotation {
  std::uint64_t number = 0;  ///< from 1
  Cloud::Ptr cloud;
  std::int64_t time_us = 0;  ///< of the packet of its last column, microseconds since 1970
};

/// Cuts packets into rotations as lisco_stream does. Holds one or two rotations at a time.
class Rotations {
 public:
  explicit Rotations(PacketInput input) : input_(std::move(input)), cutter_(input_.decoder->rotationStart()) {}

  /// \return nothing at the end
  std::optional<Rotation> next();

  const PacketInput& input() const { return input_; }

 private:
  void add(const Column& column);
  void end();

  static constexpr std::size_t kMaxColumns = 36000;  ///< as of lisco_stream: bounds a rotation of a sensor at rest

  PacketInput input_;
  RotationCutter cutter_;
  bool is_over_ = false;
  std::uint64_t rotations_ = 0;
  std::vector<Cell> cells_;  ///< of the rotation that has begun, column by column
  std::size_t rows_ = 0;
  std::int64_t time_us_ = 0, packet_time_us_ = 0;
  std::deque<Rotation> ended_;
};

}  // namespace lisco_apps
