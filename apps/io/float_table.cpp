// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "io/float_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "io/point_geometry.h"

namespace lisco_apps {
namespace {

constexpr std::size_t kFewPoints = 16;  ///< too few to compare numbers of fields
// Points that are looked at: runs of consecutive ones, spread over the file.
constexpr std::size_t kRuns = 16, kRunPoints = 1024;
constexpr float kMaxCoordinate = 1e7F, kMinCoordinate = 1e-5F;  ///< of a cloud, metres; smaller ones are zero
constexpr double kMinPlausible = 0.95;                          ///< share of the points of a cloud
constexpr double kMinScore = 0.3;   ///< of 2: wrong numbers of fields have about 0.1, right ones 0.5 and more
constexpr double kTieScore = 0.15;  ///< a multiple of the right number comes this near

/// Whether numbers are those of a point: coordinates in metres, and other values that sensors give.
bool isPlausible(const float* point, std::size_t fields) {
  if (std::isnan(point[0]) && std::isnan(point[1]) && std::isnan(point[2])) return true;  // no return
  for (std::size_t i = 0; i < fields; ++i) {
    const float size = std::fabs(point[i]);
    if (i < 3 && !(size == 0 || (size >= kMinCoordinate && size <= kMaxCoordinate))) return false;
    // Intensities, rings, times: neither infinite nor denormal.
    if (i >= 3 && !std::isnan(size) && !(size == 0 || (std::isnormal(size) && size < 1e20F))) return false;
  }
  return true;
}

/// How much values look like points of so many fields, 0 to 2; negative: not at all.
double scoreOf(const std::vector<float>& values, std::size_t fields) {
  const std::size_t points = values.size() / fields;
  const std::size_t run = std::min(points, kRunPoints);
  const std::size_t runs = std::clamp<std::size_t>(points / run, 1, kRuns);
  std::size_t seen = 0;
  std::size_t plausible = 0;
  std::size_t pairs = 0;
  std::size_t near_pairs = 0;
  std::vector<std::size_t> negative(fields, 0);
  std::size_t nonzero = 0;
  constexpr double kNear = 5 * kPi / 180;  // radians of azimuth, from point to point
  for (std::size_t i = 0; i < runs; ++i) {
    const std::size_t first = runs == 1 ? 0 : (points - run) / (runs - 1) * i;
    double last = std::numeric_limits<double>::quiet_NaN();
    for (std::size_t at = first; at < first + run; ++at) {
      const float* const point = values.data() + at * fields;
      ++seen;
      if (!isPlausible(point, fields)) continue;
      ++plausible;
      if (point[0] == 0 && point[1] == 0 && point[2] == 0) continue;
      ++nonzero;
      for (std::size_t field = 0; field < fields; ++field) negative[field] += point[field] < 0 ? 1 : 0;
      const double azimuth = std::atan2(static_cast<double>(point[1]), static_cast<double>(point[0]));
      if (!std::isnan(last) && !std::isnan(azimuth)) {
        ++pairs;
        near_pairs += std::fabs(std::remainder(azimuth - last, 2 * kPi)) < kNear ? 1 : 0;
      }
      last = azimuth;
    }
  }
  if (static_cast<double>(plausible) < kMinPlausible * static_cast<double>(seen) || nonzero == 0 || pairs == 0)
    return -1;
  const auto [fewest, most] = std::minmax_element(negative.begin(), negative.end());
  return static_cast<double>(*most - *fewest) / static_cast<double>(nonzero) +
         static_cast<double>(near_pairs) / static_cast<double>(pairs);
}

}  // namespace

std::size_t plausibleFields(const std::vector<float>& values, const std::vector<std::size_t>& candidates) {
  if (values.size() < kFewPoints * kMinFields) {
    const auto of_few = std::find(candidates.begin(), candidates.end(), std::size_t{4});
    const std::size_t fields = of_few != candidates.end() ? *of_few : candidates.front();
    for (std::size_t at = 0; at < values.size(); at += fields)
      if (!isPlausible(values.data() + at, fields)) return 0;
    return fields;
  }
  std::vector<double> scores;
  for (const std::size_t fields : candidates) scores.push_back(scoreOf(values, fields));
  const double best = *std::max_element(scores.begin(), scores.end());
  if (best < kMinScore) return 0;
  for (std::size_t i = 0; i < scores.size(); ++i)
    if (scores[i] >= best - kTieScore) return candidates[i];
  return 0;
}

std::optional<std::size_t> ringField(const FloatTable& table) {
  for (std::size_t field = 4; field < table.fields; ++field) {
    bool are_rings = true;
    std::array<bool, 256> seen{};
    for (std::size_t point = 0; point < table.points() && are_rings; ++point) {
      const float value = table.at(point, field);
      are_rings = value >= 0 && value < 256 && value == std::floor(value);
      if (are_rings) seen[static_cast<std::size_t>(value)] = true;
    }
    if (are_rings && std::count(seen.begin(), seen.end(), true) > 1) return field;
  }
  return std::nullopt;
}

std::vector<std::uint16_t> ringsByAzimuth(const FloatTable& table) {
  constexpr std::size_t kMinRings = 8, kMaxRings = 256;
  constexpr double kMinSteady = 0.98;  ///< share of steps that go the way of the sensor
  constexpr double kMinTurn = 0.5;     ///< of a full one: the mean of the rings
  constexpr double kMaxStep = 30 * kPi / 180;
  std::vector<std::uint16_t> rings(table.points());
  std::size_t ring = 0;
  std::size_t rising = 0;
  std::size_t falling = 0;
  std::size_t back = 0;  // passes of +x against the way of the others
  int way = 0;
  double turned = 0;
  double last = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < rings.size(); ++i) {
    const double x = static_cast<double>(table.at(i, 0));
    const double y = static_cast<double>(table.at(i, 1));
    const bool is_return = std::isfinite(x) && std::isfinite(y) && (x != 0 || y != 0);
    if (is_return) {
      double azimuth = std::atan2(y, x);
      if (azimuth < 0) azimuth += 2 * kPi;  // 0 is +x
      if (!std::isnan(last)) {
        const double step = azimuth - last;
        if (std::fabs(step) > kPi) {
          const int this_way = step < 0 ? 1 : -1;
          if (way == 0) way = this_way;
          if (way == this_way)
            ++ring;
          else
            ++back;
        } else {
          (step >= 0 ? rising : falling) += 1;
          if (std::fabs(step) < kMaxStep) turned += std::fabs(step);
        }
      }
      last = azimuth;
    }
    if (ring >= kMaxRings) return {};
    rings[i] = static_cast<std::uint16_t>(ring);
  }
  const auto steady = static_cast<double>(way > 0 ? rising : falling);
  const auto steps = static_cast<double>(rising + falling);
  const bool are_rings = ring + 1 >= kMinRings && back * 50 < ring && steady >= kMinSteady * steps &&
                         turned >= kMinTurn * 2 * kPi * static_cast<double>(ring + 1);
  return are_rings ? rings : std::vector<std::uint16_t>{};
}

Cloud::Ptr cloudOf(const FloatTable& table, bool is_guessed, ReadExtras& extras) {
  auto cloud = std::make_shared<Cloud>();
  cloud->resize(table.points());
  for (std::size_t i = 0; i < cloud->size(); ++i)
    std::memcpy((*cloud)[i].data, table.values.data() + i * table.fields, 3 * sizeof(float));
  cloud->is_dense = std::all_of(cloud->begin(), cloud->end(), [](const pcl::PointXYZ& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
  });

  // The fields after the fourth have no usual names.
  for (std::size_t i = 0; i < table.fields; ++i) {
    constexpr const char* kNames[] = {"x", "y", "z", "intensity"};
    addField(extras.fields, i < 4 ? kNames[i] : "field_" + std::to_string(i + 1), pcl::PCLPointField::FLOAT32);
  }
  allocate(extras.fields, cloud->width, 1);
  std::memcpy(extras.fields.data.data(), table.values.data(), extras.fields.data.size());

  extras.note = std::to_string(table.fields) + " floats a point" + (is_guessed ? " (by their looks)" : "");
  if (const std::optional<std::size_t> field = ringField(table)) {
    std::vector<std::uint16_t> rings;
    for (std::size_t i = 0; i < table.points(); ++i) rings.push_back(static_cast<std::uint16_t>(table.at(i, *field)));
    extras.message = messageOf(*cloud, rings);
    extras.note += ", rings in field " + std::to_string(*field + 1);
  } else {
    extras.rings = ringsByAzimuth(table);
  }
  return cloud;
}

}  // namespace lisco_apps
