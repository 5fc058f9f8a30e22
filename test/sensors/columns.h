// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cmath>
#include <vector>

#include "packets.h"
#include "sensors/decoder.h"

namespace lisco_test {

/// A copy of a column.
struct SavedColumn {
  std::vector<lisco_apps::Cell> cells;
  double azimuth, time_us;
  bool after_break;
};

/// A visitor that copies columns.
inline lisco_apps::Decoder::Visitor saveIn(std::vector<SavedColumn>& columns) {
  return [&columns](const lisco_apps::Column& column) {
    columns.push_back({column.cells, column.azimuth, column.time_us, column.after_break});
  };
}
inline lisco_apps::Decoder::Kind decode(lisco_apps::Decoder& decoder, const Bytes& payload,
                                        std::vector<SavedColumn>& columns) {
  return decoder.decode(asPacket(payload), saveIn(columns));
}

inline bool isReturn(const lisco_apps::Cell& cell) {
  return std::isfinite(cell.x) && std::isfinite(cell.y) && std::isfinite(cell.z) && std::isfinite(cell.intensity);
}
inline bool isNoReturn(const lisco_apps::Cell& cell) {
  return std::isnan(cell.x) && std::isnan(cell.y) && std::isnan(cell.z) && std::isnan(cell.intensity);
}
inline double rangeOf(const lisco_apps::Cell& cell) {
  return std::hypot(cell.x, cell.y, cell.z);
}

}  // namespace lisco_test
