// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/far/range_image.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/far/constants.h"
#include "core/far/far_range.h"
#include "core/pi.h"

namespace lisco {

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::size_t kSpare = 4 * RangeImage::kMargin;  ///< bins that may hold returns, beyond a turn or the columns
constexpr std::size_t kEmpty = 2 * RangeImage::kMargin;  ///< bins at the ends of a row that hold none

/// RangeImage::stride for some columns.
std::size_t strideFor(std::size_t columns, std::size_t steps) {
  constexpr std::size_t kSector = RangeImage::kSector;
  return (std::min(columns, steps) + kSector - 1) / kSector * kSector + kSpare + kEmpty;
}

constexpr RangeImage::Row kNewRow{false, kInfinity, -kInfinity, RangeImage::kNoBin, 0};

}  // namespace

void RangeImage::prepare(const Tolerance& new_tolerance, const SensorHints& hints, std::size_t columns,
                         std::size_t capacity) {
  tolerance = new_tolerance;
  started = false;
  linked = scheduled = 0;
  unplaced.clear();
  late.clear();
  placed = realigned = end = placed_when_sorted = 0;
  full = elevations_changed = may_be_unsorted = false;

  range = farRangeFor(tolerance, hints);
  if (std::isinf(range.min_range)) {
    steps = 0;
    return;
  }
  const auto new_steps = static_cast<std::size_t>(hints.steps_per_turn);
  deviation = deviationFor(hints);
  reach = paddedReach(tolerance);
  // Measuring heights from a tilted plane is a shear, by whose norm distances may grow.
  const float tilt = std::hypot(range.tilt[0], range.tilt[1]);
  slope_reach = reach * (0.5F * (tilt + std::sqrt(tilt * tilt + 4.0F)) * 1.00001F);
  direction = hints.clockwise ? -1.0F : 1.0F;
  if (new_steps != steps_of_tables) {
    steps_of_tables = new_steps;
    cosine.clear();
    sine.clear();
    rows.clear();
    ranks.clear();
    known_when_sorted = 0;
  }
  steps = new_steps;
  radians_per_bin = static_cast<float>(2 * kPi / static_cast<double>(steps));
  deviation_sine = std::sin(deviation * radians_per_bin);
  setBins(columns);
  begin = std::numeric_limits<std::size_t>::max();
  const std::size_t lasers_before = laserCount();
  rows.clear();
  layers = 1;
  cells.clear(std::max(stride, strideFor(capacity, steps)));
  addLasers(lasers_before);
}

void RangeImage::setBins(std::size_t columns) {
  stride = strideFor(columns, steps);
  bins = stride - kEmpty;
  const std::size_t directions = stride + 2 * kMargin;
  const double step = 2 * kPi / static_cast<double>(steps);
  cosine.reserve(directions);
  sine.reserve(directions);
  for (std::size_t i = cosine.size(); i < directions; ++i) {
    const double angle = step * (static_cast<double>(i) - static_cast<double>(kMargin));
    cosine.push_back(static_cast<float>(std::cos(angle)));
    sine.push_back(static_cast<float>(std::sin(angle)));
  }
}

void RangeImage::expectColumns(std::size_t columns) {
  if (!inUse()) return;
  const std::size_t former = stride;
  if (strideFor(columns, steps) <= former) return;
  setBins(columns);
  if (stride > cells.rowSize()) {
    cells.widenRows(stride, kMargin + end);
    return;
  }
  for (std::size_t row = 0; row < rows.size(); ++row)
    if (rows[row].is_open) std::fill_n(cells.at(row, former).x(), stride - former, kNan);
}

bool RangeImage::hasMemoryFor(std::size_t lasers, std::size_t columns, const SensorHints& hints) const {
  const std::size_t row_size = strideFor(columns, static_cast<std::size_t>(hints.steps_per_turn));
  return cells.capacityFor(row_size) >= std::max({lasers, laserCount(), cells.rowsWithMemory()});
}

void RangeImage::addLasers(std::size_t count) {
  const std::size_t before = laserCount();
  if (count <= before) return;
  ranks.addUpTo(count);
  rows.resize(count * layers, kNewRow);
  cells.addRows(rows.size() - before * layers);
  elevations_changed = true;
  // Side by side in the order of the lasers, though some see far returns later.
  for (std::size_t laser = before; laser < count; ++laser) addMemory(firstRowOf(laser));
}

void RangeImage::addMemory(std::size_t row) {
  // Most lasers need a second row where some do; few need more.
  cells.giveMemory(row, layers <= 2 ? rows.size() - cells.rowsWithMemory() : 1);
}

void RangeImage::openRow(std::size_t row) {
  if (!cells.hasMemory(row)) addMemory(row);
  cells.populate(row);
  rows[row].is_open = true;
  std::fill_n(cells.at(row, 0).x(), stride, kNan);
}

bool RangeImage::isLayerWorthwhile() const {
  return layers < kMaxLayers && unplaced.size() >= layers * (kFewTaken + placed / kPlacedPerTaken);
}

void RangeImage::addLayer() {
  insertLayer(rows, layers, [](const Row& first) { return Row{false, first.lowest, first.highest, kNoBin, 0}; });
  cells.addLayer(layers);
  ++layers;
  elevations_changed = true;
}

void RangeImage::start(const RingBlock& block, const RingBlockInfo& info, std::uint32_t column) {
  started = true;
  const auto first = static_cast<std::uint32_t>(__builtin_ctzll(info.far));
  const double azimuth = std::atan2(static_cast<double>(block.y[RingBlock::kMargin + first] - range.origin[1]),
                                    static_cast<double>(block.x[RingBlock::kMargin + first] - range.origin[0]));
  start_azimuth = azimuth - static_cast<double>(direction * static_cast<float>(kMargin) * radians_per_bin);
  start_cosine = static_cast<float>(std::cos(start_azimuth));
  start_sine = static_cast<float>(std::sin(start_azimuth));
  first_column = column + first;
}

ColumnBits RangeImage::place(const RingBlock& block, const RingBlockInfo& info, std::size_t laser,
                             std::uint32_t column) {
  if (!started) start(block, info, column);
  const Row& first_row = rows[firstRowOf(laser)];
  if (info.lowest < first_row.lowest || info.highest > first_row.highest) {
    for (std::size_t row = firstRowOf(laser); row < firstRowOf(laser) + layers; ++row) {
      rows[row].lowest = std::min(rows[row].lowest, info.lowest - kWidening * (1 + std::fabs(info.lowest)));
      rows[row].highest = std::max(rows[row].highest, info.highest + kWidening * (1 + std::fabs(info.highest)));
    }
    elevations_changed = may_be_unsorted = true;
  }
  const ColumnBits not_placed = full ? info.far : placeReturns(*this, block, info, laser, column);
  forEachBit(not_placed, [&](std::size_t i) {
    unplaced.push_back({block.x[RingBlock::kMargin + i], block.y[RingBlock::kMargin + i],
                        block.z[RingBlock::kMargin + i], info.run[i]});
  });
  if (unplaced.size() > kFewUnplaced + placed / kPlacedPerUnplaced) full = true;
  return not_placed;
}

void RangeImage::stopPlacing() {
  full = true;
  unplaced.clear();
}

void RangeImage::sortLasers() {
  if (!may_be_unsorted) return;
  may_be_unsorted = false;
  constexpr float kSteepest = 1e6F;
  for (std::size_t laser = 0; laser < laserCount(); ++laser) {
    const Row& row = rows[firstRowOf(laser)];
    if (row.lowest <= row.highest)
      ranks.setSlope(laser, 0.5F * (std::max(row.lowest, -kSteepest) + std::min(row.highest, kSteepest)));
  }
  if (ranks.knownCount() == known_when_sorted && placed < 2 * placed_when_sorted) return;
  if (!ranks.areUnsorted()) return;
  known_when_sorted = ranks.knownCount();
  placed_when_sorted = placed;
  orderLasers(ranks.sorted());
}

void RangeImage::orderLasers(const std::vector<std::uint32_t>& lasers) {
  for (std::size_t rank = 0; rank < lasers.size(); ++rank) swapLasers(rank, ranks.rankOf(lasers[rank]));
}

void RangeImage::swapLasers(std::size_t a, std::size_t b) {
  if (a == b) return;
  ranks.swap(a, b);
  for (std::size_t layer = 0; layer < layers; ++layer) {
    std::swap(rows[a * layers + layer], rows[b * layers + layer]);
    cells.swapRows(a * layers + layer, b * layers + layer);
  }
  ++times_reordered;
  elevations_changed = true;
}

void RangeImage::updateElevations() {
  if (!elevations_changed) return;
  elevations_changed = false;
  const std::size_t count = rows.size();
  // Envelopes are kept for rows from top to bottom; if they come the other way round, elevations are turned over.
  float first = 0;
  float last = 0;
  bool any_seen = false;
  for (const Row& row : rows) {
    if (row.lowest > row.highest) continue;
    if (!any_seen) first = row.lowest + row.highest;
    any_seen = true;
    last = row.lowest + row.highest;
  }
  upside_down = last > first;
  constexpr float kBeyond = 10.0F;  // radians, more than any elevation
  for (auto* angles : {&lowest, &highest, &lowest_above, &highest_below}) angles->resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const bool seen = rows[i].lowest <= rows[i].highest;
    const float low = seen ? std::atan(rows[i].lowest) : kBeyond;
    const float high = seen ? std::atan(rows[i].highest) : -kBeyond;
    lowest[i] = seen && upside_down ? -high : low;
    highest[i] = seen && upside_down ? -low : high;
  }
  float bound = kBeyond;
  for (std::size_t i = 0; i < count; ++i) lowest_above[i] = bound = std::min(bound, lowest[i]);
  bound = -kBeyond;
  for (std::size_t i = count; i-- > 0;) highest_below[i] = bound = std::max(bound, highest[i]);
}

void RangeImage::mergeRows(const RangeImage& other) {
  while (layers < other.layers) addLayer();
  addLasers(other.laserCount());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::size_t laser = ranks.laserAt(i / layers);
    if (laser >= other.laserCount()) continue;
    const Row& measured = other.rows[other.firstRowOf(laser)];
    if (measured.lowest >= rows[i].lowest && measured.highest <= rows[i].highest) continue;
    rows[i].lowest = std::min(rows[i].lowest, measured.lowest);
    rows[i].highest = std::max(rows[i].highest, measured.highest);
    elevations_changed = may_be_unsorted = true;
  }
}

void RangeImage::shareRows(const RangeImage& other) {
  mergeRows(other);
  orderLasers(other.ranks.lasers());
  known_when_sorted = other.known_when_sorted;
}

std::size_t RangeImage::passed() const {
  std::int64_t front = std::numeric_limits<std::int64_t>::max();
  std::uint32_t column = 0;
  for (std::size_t row = 0; row < rows.size(); row += layers)
    if (rows[row].next_bin != kNoBin) column = std::max(column, rows[row].next_column);
  for (std::size_t row = 0; row < rows.size(); row += layers)
    if (rows[row].next_bin != kNoBin) front = std::min(front, rows[row].next_bin + (column - rows[row].next_column));
  front = std::clamp<std::int64_t>(front, 0, static_cast<std::int64_t>(bins));
  return static_cast<std::size_t>(front) / kSector * kSector;
}

}  // namespace lisco
