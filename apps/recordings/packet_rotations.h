// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "recordings/packet_input.h"
#include "sensors/decoder.h"
#include "sensors/rotation_cutter.h"

namespace lisco_apps {

/// The columns of one rotation.
struct PacketRotation {
  /// What Column states beside its cells.
  struct ColumnState {
    double azimuth, time_us;
    bool after_break;
  };

  std::size_t rows = 0;     ///< of each column
  std::vector<Cell> cells;  ///< column by column
  std::vector<ColumnState> columns;
  std::int64_t first_packet_us = 0;  ///< microseconds since 1970: of the packet of the first column
  std::int64_t last_packet_us = 0;   ///< of the packet of the last column
};

/// Cuts the columns of packets on file into rotations, as lisco_stream does it. A rotation also ends where the number
/// of rows changes. Holds one or two rotations at a time.
class PacketRotations {
 public:
  explicit PacketRotations(PacketInput input);

  /// \return nothing at the end; see error ()
  std::optional<PacketRotation> next();
  /// Why the recording broke off, one line; empty if it did not.
  std::string error() const { return input_.source->error(); }
  double share() const { return input_.source->share(); }
  const Decoder& decoder() const { return *input_.decoder; }

 private:
  void add(const Column& column);
  void end();

  PacketInput input_;
  RotationCutter cutter_;
  bool is_over_ = false;
  std::int64_t packet_us_ = 0;  ///< of the last packet
  PacketRotation rotation_;     ///< that has begun
  std::deque<PacketRotation> ended_;
};

}  // namespace lisco_apps
