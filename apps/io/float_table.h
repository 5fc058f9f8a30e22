// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "io/formats.h"

namespace lisco_apps {

/// Numbers of fields a point that are tried.
inline constexpr std::size_t kMinFields = 3, kMaxFields = 16;

/// Unorganized points without names of their fields; the first three are x, y and z.
struct FloatTable {
  std::vector<float> values;  ///< point by point
  std::size_t fields = 4;     ///< of a point

  std::size_t points() const { return values.size() / fields; }
  float at(std::size_t point, std::size_t field) const { return values[point * fields + field]; }
};

/// The number of fields a point with which values look most like a cloud: coordinates are of sensible size, neighbours
/// in the file mostly neighbours in azimuth, and fields differ from each other. Of a few points, 4 if it is among the
/// candidates.
/// \return 0 if they look like no cloud with any of them
std::size_t plausibleFields(const std::vector<float>& values, const std::vector<std::size_t>& candidates);

/// The field after the fourth whose values are whole numbers from 0 to 255 of at least two values, as rings are.
std::optional<std::size_t> ringField(const FloatTable& table);

/// The laser of each point of a cloud that is sorted laser by laser, as KITTI's are: the next one begins where the
/// azimuth passes the direction +x.
/// \return empty if the azimuth of such parts does not rise, or fall, steadily
std::vector<std::uint16_t> ringsByAzimuth(const FloatTable& table);

/// The cloud, with its rings in extras.message or extras.rings, if they are known or found.
/// \param is_guessed whether its number of fields was
Cloud::Ptr cloudOf(const FloatTable& table, bool is_guessed, ReadExtras& extras);

}  // namespace lisco_apps
