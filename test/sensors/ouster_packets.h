// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Packets and metadata of an Ouster sensor, by its manual.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "packets.h"

namespace lisco_test {

/// A sensor whose beams are 1 degree apart, and 2 degrees to either side in turns.
struct OusterSensor {
  std::string profile = "LEGACY";
  std::size_t pixels = 32, columns = 1024, columns_per_packet = 16;
  std::pair<std::size_t, std::size_t> window{0, 1023};
  double beam_origin_mm = 15.806;
  std::string header_type = "";  ///< "STANDARD" or "FUSA"; "": that of the profile, and not in the metadata

  double altitude(std::size_t pixel) const { return static_cast<double>(pixels) / 2 - static_cast<double>(pixel); }
  double azimuth(std::size_t pixel) const { return pixel % 2 == 0 ? 2. : -2.; }
  std::size_t returns() const;
  bool hasSafetyHeader() const { return header_type.empty() ? profile.rfind("FUSA", 0) == 0 : header_type == "FUSA"; }
  /// \param in_sections as since firmware 3.0
  std::string metadata(bool in_sections = true) const;
};

/// Ranges in millimetres by frame, column, pixel and return.
using OusterWorld = std::function<std::uint32_t(std::size_t, std::size_t, std::size_t, std::size_t)>;

/// The packets of a frame that its window lets through. The signal and the reflectivity of a pixel are its number
/// modulo 256, and more by one for the second return.
std::vector<Bytes> ousterFrame(const OusterSensor& sensor, std::size_t frame, const OusterWorld& world,
                               std::uint32_t initialization = 7);

}  // namespace lisco_test
