// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "view/scan_encoder.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/sorted_element.h"
#include "lisco/return.h"

namespace lisco_apps {
namespace {

using Json = nlohmann::ordered_json;
using Steps = std::array<std::int32_t, 3>;  ///< a position in multiples of kViewStep from the scan's origin

/// Points of a scan that are shown.
struct Shown {
  std::vector<std::uint32_t> points;  ///< indices in the scan
  std::vector<Steps> positions;       ///< of the same
  std::array<double, 3> origin{};     ///< metres
  std::size_t too_far = 0;            ///< returns beyond kViewReach
};

Shown shownOf(const std::vector<std::array<float, 3>>& points) {
  Shown shown;
  std::vector<std::uint32_t> returns;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (lisco::isReturn(points[i][0], points[i][1], points[i][2])) returns.push_back(static_cast<std::uint32_t>(i));
  if (returns.empty()) return shown;
  std::vector<float> values(returns.size());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::transform(returns.begin(), returns.end(), values.begin(), [&](std::uint32_t i) { return points[i][axis]; });
    shown.origin[axis] = static_cast<double>(lisco::sortedElement(values, values.size() / 2));
  }
  for (const std::uint32_t i : returns) {
    Steps steps{};
    bool is_near = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double offset = static_cast<double>(points[i][axis]) - shown.origin[axis];
      is_near = is_near && std::abs(offset) < kViewReach;
      if (is_near) steps[axis] = static_cast<std::int32_t>(std::lround(offset / kViewStep));
    }
    if (is_near) {
      shown.points.push_back(i);
      shown.positions.push_back(steps);
    } else {
      ++shown.too_far;
    }
  }
  return shown;
}

/// Appends numbers as differences: small ones of either sign take one byte, larger ones seven bits a byte.
class DifferenceWriter {
 public:
  explicit DifferenceWriter(std::string& bytes) : bytes_(bytes) {}

  void add(std::int32_t value) {
    const std::int32_t difference = value - std::exchange(last_, value);
    auto rest = (static_cast<std::uint32_t>(difference) << 1U) ^ static_cast<std::uint32_t>(difference >> 31);
    for (; rest >= 0x80U; rest >>= 7U) bytes_.push_back(static_cast<char>(rest | 0x80U));
    bytes_.push_back(static_cast<char>(rest));
  }

 private:
  std::string& bytes_;
  std::int32_t last_ = 0;
};

std::string encodedPositions(const std::vector<Steps>& positions) {
  std::string bytes;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    DifferenceWriter writer(bytes);
    for (const Steps& position : positions) writer.add(position[axis]);
  }
  return bytes;
}

/// The bits of a number, two zeros after each.
std::uint64_t spread(std::uint64_t bits) {
  bits &= 0x1FFFFFU;
  bits = (bits | bits << 32U) & 0x1F00000000FFFFU;
  bits = (bits | bits << 16U) & 0x1F0000FF0000FFU;
  bits = (bits | bits << 8U) & 0x100F00F00F00F00FU;
  bits = (bits | bits << 4U) & 0x10C30C30C30C30C3U;
  return (bits | bits << 2U) & 0x1249249249249249U;
}

/// Sorts points along a Z-order curve, in cubes of 16 steps.
void sortByZOrder(Shown& shown) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(shown.points.size());
  for (std::size_t i = 0; i < keys.size(); ++i) {
    std::uint64_t key = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      key |= spread(static_cast<std::uint64_t>(shown.positions[i][axis] + (1 << 24)) >> 4U) << axis;
    keys[i] = {key, static_cast<std::uint32_t>(i)};
  }
  std::sort(keys.begin(), keys.end());
  Shown sorted = shown;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    sorted.points[i] = shown.points[keys[i].second];
    sorted.positions[i] = shown.positions[keys[i].second];
  }
  shown = std::move(sorted);
}

/// A range of intensities that is split into 256 levels: 0 to 255 for whole numbers in it, otherwise the one that holds
/// 99 % of them.
std::pair<double, double> intensityRange(const std::vector<float>& intensity, const Shown& shown) {
  std::vector<float> values;
  bool are_bytes = true;
  for (const std::uint32_t i : shown.points) {
    const float value = intensity[i];
    if (!std::isfinite(value)) continue;
    values.push_back(value);
    are_bytes = are_bytes && value >= 0 && value <= 255 && value == std::floor(value);
  }
  if (values.empty() || are_bytes) return {0, 255};
  const auto at = [&](double part) {
    const auto place = static_cast<std::size_t>(part * static_cast<double>(values.size() - 1));
    return static_cast<double>(lisco::sortedElement(values, place));
  };
  const double low = at(0.005);
  return {low, std::max(at(0.995), low + 1e-6 * std::max(1.0, std::abs(low)))};
}

void encodeIntensity(const std::vector<float>& intensity, const Shown& shown, std::pair<double, double> range,
                     std::string& bytes) {
  const double scale = 255 / (range.second - range.first);
  for (const std::uint32_t i : shown.points) {
    const auto value = static_cast<double>(intensity[i]);
    const double level =
        std::isfinite(value) ? (std::clamp(value, range.first, range.second) - range.first) * scale : 0;
    bytes.push_back(static_cast<char>(std::lround(level)));
  }
}

/// To tenths of a millimetre.
double rounded(double value) {
  return std::round(value * 1e4) / 1e4;
}

Json headerOf(const ViewLabelling& labelling) {
  Json clusters = Json::array();
  for (const ViewCluster& cluster : labelling.clusters)
    clusters.push_back({cluster.size, rounded(cluster.center[0]), rounded(cluster.center[1]),
                        rounded(cluster.center[2]), rounded(cluster.length), rounded(cluster.width),
                        rounded(cluster.height), rounded(cluster.yaw), rounded(cluster.nearest_range)});
  Json header{{"name", labelling.name}, {"tolerance", labelling.tolerance}, {"clusters", std::move(clusters)}};
  if (!labelling.clusters.empty() && labelling.clusters.front().id != 0) {
    header["ids"] = Json::array();
    for (const ViewCluster& cluster : labelling.clusters) header["ids"].push_back(cluster.id);
  }
  return header;
}

/// Appends the class of each point: 0 = ground, 1 = noise, otherwise 1 + the cluster's number.
void encodeLabels(const ViewScan& scan, const ViewLabelling& labelling, const Shown& shown, std::string& bytes) {
  DifferenceWriter writer(bytes);
  for (const std::uint32_t i : shown.points) {
    const bool is_ground = labelling.labels[i] == 0 && !scan.is_ground.empty() && scan.is_ground[i] != 0;
    writer.add(is_ground ? 0 : static_cast<std::int32_t>(labelling.labels[i] + 1));
  }
}

}  // namespace

std::string withSize(const std::string& text) {
  std::string bytes;
  for (unsigned shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<char>(text.size() >> shift));
  return bytes + text;
}

std::string encodeViewScan(const ViewScan& scan, PointOrder order) {
  Shown shown = shownOf(scan.points);
  std::string streams = encodedPositions(shown.positions);
  if (order == PointOrder::kSmallest) {
    Shown sorted = shown;
    sortByZOrder(sorted);
    std::string sorted_positions = encodedPositions(sorted.positions);
    if (sorted_positions.size() < streams.size()) {
      streams = std::move(sorted_positions);
      shown = std::move(sorted);
    }
  }

  Json header{{"name", scan.name},
              {"points", shown.points.size()},
              {"too_far", shown.too_far},
              {"step", kViewStep},
              {"error", rounded(kViewError)},
              {"origin", shown.origin},
              {"camera", scan.seen_by_camera},
              {"labellings", Json::array()}};
  for (const ViewLabelling& labelling : scan.labellings) {
    header["labellings"].push_back(headerOf(labelling));
    encodeLabels(scan, labelling, shown, streams);
  }
  if (!scan.intensity.empty()) {
    const std::pair<double, double> range = intensityRange(scan.intensity, shown);
    header["intensity"] = {range.first, range.second};
    encodeIntensity(scan.intensity, shown, range, streams);
  }
  if (!scan.ring.empty()) {
    header["ring"] = true;
    DifferenceWriter writer(streams);
    for (const std::uint32_t i : shown.points) writer.add(scan.ring[i]);
  }

  return withSize(header.dump(-1, ' ', false, Json::error_handler_t::replace)) + streams;
}

}  // namespace lisco_apps
