// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "io/text.h"

namespace lisco_apps {

/// An affine transform, row by row, lengths in millimetres.
using Transform = std::array<double, 16>;

/// What the metadata of an Ouster sensor says.
struct OusterMetadata {
  /// Layout of a packet's pixels.
  enum class Profile {
    kLegacy,
    kSingle,
    kSingleColour,
    kDual,
    kFiveWords,
    kLowBandwidth,
    kLowBandwidthZones,
    kLowBandwidthDual
  };

  std::string product;                      ///< for example "OS-1-128"; empty if unknown
  std::uint64_t serial_number = 0;          ///< 0 if unknown
  std::vector<double> altitudes, azimuths;  ///< degrees, of each pixel of a column; azimuths clockwise
  Transform beam_to_lidar{}, lidar_to_sensor{};
  Profile profile = Profile::kLegacy;
  bool has_safety_header = false;  ///< of packets, as functional safety (FuSa) has it; never with kLegacy
  std::size_t columns_per_frame = 0, columns_per_packet = 16;
  std::size_t first_column = 0, last_column = 0;  ///< that are sent; the last may be before the first
  double frames_per_second = 10;

  std::size_t pixels() const { return altitudes.size(); }
};

/// Reads the JSON that Ouster's sensors give of themselves: flat, as up to firmware 2.x, or in sections, as since 3.0.
/// Lacking values are those of the maker's first sensors.
/// \throws std::runtime_error with one line if the file is missing, malformed, or of another kind of sensor
OusterMetadata readOusterMetadata(const fs::path& file);

/// \param source named by errors
OusterMetadata parseOusterMetadata(const std::string& json, const fs::path& source);

}  // namespace lisco_apps
