// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cmath>
#include <cstdint>

#include "bodies.h"
#include "sensors/decoder.h"

namespace lisco_test {

/// Checks a column of any decoder.
inline void holdColumn(const lisco_apps::Column& column) {
  hold(column.azimuth >= 0 && column.azimuth < 360, "an invalid azimuth");
  hold(std::isfinite(column.time_us) && column.time_us >= 0, "an invalid time");
  for (const lisco_apps::Cell& cell : column.cells) {
    const bool all = std::isfinite(cell.x) && std::isfinite(cell.y) && std::isfinite(cell.z) && cell.intensity >= 0 &&
                     cell.intensity <= 65535;
    const bool none = std::isnan(cell.x) && std::isnan(cell.y) && std::isnan(cell.z) && std::isnan(cell.intensity);
    hold(all || none, "half a return");
    hold(none || std::hypot(cell.x, cell.y, cell.z) < 10000, "an implausible return");
  }
}

/// Checks a decoder after so many packets and columns.
inline void holdCounts(const lisco_apps::Decoder& decoder, std::uint64_t packets, std::uint64_t columns) {
  const lisco_apps::Decoder::Counts& counts = decoder.counts();
  hold(counts.data + counts.late + counts.position + counts.foreign == packets, "the number of packets");
  hold(counts.columns == columns, "the number of columns");
  hold(std::isfinite(decoder.turnUs()) && std::isfinite(decoder.gapUs()), "an invalid number");
  hold(decoder.packetPeriodUs() > 0, "the period of packets");
}

}  // namespace lisco_test
