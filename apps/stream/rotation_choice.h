// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstdint>
#include <optional>

#include "sensors/decoder.h"
#include "sensors/rotation_cutter.h"

namespace lisco_apps {

/// Chooses the first of every N rotations among the columns of a sensor.
class RotationChoice {
 public:
  /// \param rotation_start Decoder::rotationStart ()
  RotationChoice(unsigned every, std::optional<double> rotation_start) : every_(every), cutter_(rotation_start) {}

  /// \return the column if it belongs to a rotation that is chosen; after a rotation left out, it has a break before it
  std::optional<Column> choose(const Column& column) {
    if (every_ == 1) return column;
    if (cutter_.startsRotation(column.azimuth, column.after_break)) ++rotations_;
    const bool is_chosen = (rotations_ - 1) % every_ == 0;
    const bool is_first = is_chosen && !was_chosen_;
    was_chosen_ = is_chosen;
    if (!is_chosen) return std::nullopt;
    return Column{column.cells, column.azimuth, column.time_us, column.after_break || is_first, column.starts_rotation};
  }

 private:
  unsigned every_;
  RotationCutter cutter_;
  std::uint64_t rotations_ = 0;  ///< begun
  bool was_chosen_ = false;
};

}  // namespace lisco_apps
