// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/ground/plane_estimator.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/bits.h"
#include "core/ground/column_profile.h"
#include "core/ground/distance_bins.h"

namespace lisco::ground {
namespace {

// Least loss of objects and of ground in the tables of benchmarks/suite.sh ground ground_real.
constexpr float kNear = 25.0F;          // metres; beyond, the ground may be higher or lower
constexpr std::size_t kMaxCells = 48;   // of a column
constexpr float kMinReach = 1.12F;      // of a cell's distance by that of the one before
constexpr float kSameSlope = 0.08F;     // metres per metre
constexpr float kLevel = 0.1F;          // metres per metre
constexpr float kEnough = 0.5F;         // of the most weight
constexpr float kWindow = 0.15F;        // metres, of heights that agree
constexpr float kRefinedWindow = 0.4F;  // metres, of heights that agree with the plane's slope
constexpr float kRefinedEnough = 0.7F;  // of the most weight
constexpr float kLowSensor = 0.3F;      // metres; a line less deep beneath the sensor may be on the table it stands on
constexpr float kBeyondTable = 2.2F;    // metres; such a line counts if its second cell is further out than a table is
constexpr float kTableGap = 1.75F;      // and less than this many times as far as its first
constexpr float kTable = 0.5F;          // metres; most height of the sensor above a table, or a low floor
constexpr float kBelowTable = 0.1F;     // metres, by which the floor beside a table is lower at least
constexpr float kRoom = 10.0F;          // metres, distance up to which that floor is looked for
constexpr float kSureReach = 9.0F;      // metres; lines that begin further out agree with less weight
constexpr float kTrust = 0.5F;          // of the plane's slope, the rest of a line's own
constexpr double kPointReach = 6.0;     // metres; where lines begin further out, they count less as points
constexpr double kSlopeReach = 2.0;     // metres, over which a line's slope counts
constexpr double kLevelWeight = 20.0;   // square metres, of the horizon
constexpr float kMinWeight = 6.0F;      // of the lines that show a plane
constexpr float kMinRefining = 1.5F;    // of the lines that refine it: few are near where a stream begins
constexpr float kOnPlane = 0.2F;        // metres; lines that begin this near to a plane begin on it
constexpr float kClearlyMore = 1.5F;    // times the weight of lines that begin on another plane
// Updates per one that shows ground, at most: 1 to 2 on streets, 9 and more where objects alone are around. Where a
// plane may be a table's, most updates show it, or it is none.
constexpr std::uint32_t kUpdatesPerGround = 8, kUpdatesPerLowGround = 3;

}  // namespace

void PlaneEstimator::begin(const GroundParameters& parameters, float max_slope, std::size_t lasers) {
  for (auto* values : {&rho_, &height_, &x_, &y_}) values->resize(std::max(values->size(), lasers));
  for (auto* values : {&bins_, &levels_}) values->resize(std::max(values->size(), lasers));
  lowest_.resize(std::max(lowest_.size(), lasers));
  const SensorHints& sensor = parameters.sensor;
  const bool origin_known = sensor.steps_per_turn != 0 || sensor.origin != std::array<float, 3>{};
  highest_ = origin_known ? -0.2F : 0.5F;  // otherwise the ground may be as high as the cloud's origin
  max_slope_ = max_slope;
  origin_ = sensor.origin;
  height_state_ = std::isnan(parameters.sensor_height) ? Height::kUnknown : Height::kGiven;
  plane_ = {hasHeight() ? -parameters.sensor_height : 0.0F, parameters.slope[0] - sensor.tilt[0],
            parameters.slope[1] - sensor.tilt[1]};
  count_ = seen_ = 0;
  updates_ = 0;
  showed_ = 0;
}

bool PlaneEstimator::isKnown() const {
  if (height_state_ == Height::kGiven) return true;
  const std::uint32_t updates_per_one = plane_.height > -kTable ? kUpdatesPerLowGround : kUpdatesPerGround;
  return height_state_ == Height::kFound && updates_per_one * countBits(showed_) >= updates_;
}

void PlaneEstimator::add(const Block& block, const Columns& columns, std::size_t first, std::size_t column) {
  struct Low {
    float rho, height;
  };
  // Written always, counted if near.
  std::size_t count = 0;
  for (std::size_t i = column, from = first + column; i < block.size; i += Block::kColumns, from += columns.stride) {
    const float rho = block.rho[i];
    rho_[count] = rho;
    height_[count] = block.height[i];
    x_[count] = columns.x[from] - origin_[0];
    y_[count] = columns.y[from] - origin_[1];
    count += static_cast<std::size_t>((rho > Block::kMinRho) & (rho < kNear));
  }
  for (std::size_t i = 0; i < count; ++i) {
    x_[i] /= rho_[i];
    y_[i] /= rho_[i];
  }
  for (std::size_t i = 0; i < count; ++i) {
    bins_[i] = static_cast<std::uint32_t>(distanceBin(rho_[i], static_cast<std::int32_t>(kBins)));
    levels_[i] = levelOf(height_[i]);
  }
  for (std::size_t i = 0; i < count; ++i) lowest_[i] = ground::lowestOf(rho_[i], height_[i]);
  ColumnProfile profile;  // of all azimuths: lasers of a column may be staggered
  Direction sum{0.0F, 0.0F};
  for (std::size_t i = 0; i < count; ++i) {
    profile.add(bins_[i], lowest_[i], levels_[i]);
    sum.x += x_[i];
    sum.y += y_[i];
  }
  const float length = std::max(std::sqrt(sum.x * sum.x + sum.y * sum.y), 1e-3F);
  const Direction direction{sum.x / length, sum.y / length};

  std::array<Low, kMaxCells + 1> lows;
  std::size_t size = 0;
  forEachBin(profile, [&](std::size_t bin) {
    const Cell& cell = profile.cells[bin];
    lows[size] = {cell.lowRho(), cell.low()};
    size += static_cast<std::size_t>((size < kMaxCells) & isBare(cell.low(), cell.levels));
  });
  // For each of these, the first clearly beyond it, and the slope to there.
  std::array<std::size_t, kMaxCells + 1> beyond;
  std::array<float, kMaxCells> slopes;
  beyond[size] = size;
  for (std::size_t i = 0, j = 0; i < size; ++i) {
    j = std::max(j, i + 1);
    while (j < size && lows[j].rho < kMinReach * lows[i].rho) ++j;
    beyond[i] = j;
  }
  const auto slopeOf = [&](std::size_t i, std::size_t j) {
    return (lows[j].height - lows[i].height) / (lows[j].rho - lows[i].rho);
  };
  for (std::size_t i = 0; i < size && beyond[i] < size; ++i) slopes[i] = slopeOf(i, beyond[i]);
  // Whether the column has returns below a line, as those of the floor are beyond a table.
  const auto isPassedBelow = [&](float height, float slope) {
    bool is_below = false;
    forEachBin(profile, [&](std::size_t bin) {
      const float rho = profile.cells[bin].lowRho(), below = height + slope * rho - profile.cells[bin].low();
      is_below = is_below || (rho < kRoom && below > kBelowTable);
    });
    return is_below;
  };
  // Lines through three cells, or through two that are nearly level.
  std::array<Line, kMaxCells> lines{};
  std::size_t line_count = 0;
  for (std::size_t i = 0; i < size; ++i) {
    const std::size_t j = beyond[i];
    if (j == size) break;
    float slope = slopes[i];
    float weight = 0.5F;
    const std::size_t k = beyond[j];
    if (k < size && std::fabs(slopes[j] - slope) < kSameSlope && std::fabs(slope) < max_slope_) {
      slope = slopeOf(i, k);
      weight = 1.0F;
    } else if (std::fabs(slope) > kLevel) {
      continue;
    }
    const float height = lows[i].height - slope * lows[i].rho;
    const bool is_far = lows[j].rho > kBeyondTable && lows[j].rho < kTableGap * lows[i].rho;
    if ((height > -kLowSensor && !is_far) || (height > -kTable && isPassedBelow(height, slope))) continue;
    if (height < highest_) lines[line_count++] = {height, slope, weight, lows[i].rho, direction};
  }
  const Agreed agreed = lowestOf(lines.data(), line_count, 0.1F, kEnough);
  if (agreed.weight == 0.0F) return;
  Line line{agreed.height, 0.0F, agreed.weight, 0.0F, direction};
  float weight = 0.0F;
  for (std::size_t i = 0; i < line_count; ++i)
    if (std::fabs(lines[i].height - agreed.height) < 0.2F) {
      line.slope += lines[i].weight * lines[i].slope;
      weight += lines[i].weight;
      if (line.rho == 0.0F) line.rho = lines[i].rho;
    }
  line.slope = weight > 0.0F ? line.slope / weight : 0.0F;
  lines_[count_++ % kMemory] = line;
}

/// Weight of a line's height beneath the sensor.
float PlaneEstimator::sureWeight(const Line& line) {
  const float reach = line.rho / kSureReach, squared = reach * reach;
  return line.weight * std::min(1.0F, 2.0F / (1.0F + squared * squared));
}

/// Of the heights that at least `enough` of the most weight agrees with, the lowest: the mean of those near it, and
/// their weight.
PlaneEstimator::Agreed PlaneEstimator::lowestOf(const Line* lines, std::size_t size, float window, float enough) {
  std::array<float, kMemory> heights, support{};
  for (std::size_t i = 0; i < size; ++i) heights[i] = lines[i].height;
  for (std::size_t j = 0; j < size; ++j) {
    const float height = lines[j].height, weight = sureWeight(lines[j]);
    for (std::size_t i = 0; i < size; ++i) support[i] += std::fabs(heights[i] - height) < window ? weight : 0.0F;
  }
  float most = 0.0F;
  for (std::size_t i = 0; i < size; ++i) most = std::max(most, support[i]);
  float lowest = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < size; ++i)
    if (support[i] >= enough * most) lowest = std::min(lowest, heights[i]);
  float sum = 0.0F, weight = 0.0F;
  for (std::size_t i = 0; i < size; ++i)
    if (std::fabs(heights[i] - (lowest + window)) < 2.0F * window) {
      sum += lines[i].weight * heights[i];
      weight += lines[i].weight;
    }
  return {weight > 0.0F ? sum / weight : 0.0F, weight};
}

void PlaneEstimator::update() {
  updates_ = std::min(updates_ + 1, kUpdates);
  showed_ = showed_ << 1 | static_cast<std::uint64_t>(count_ != seen_);
  seen_ = count_;
  if (height_state_ == Height::kFound) return refine();
  if (height_state_ == Height::kGiven) return fitSlopes();
  if (!find()) return;
  // The lines so far come from all kColumns columns of a block, which have one direction. From now on one column of a
  // block adds a line, and each of these lines counts as much less.
  for (std::size_t i = 0; i < std::min(count_, kMemory); ++i) lines_[i].weight /= static_cast<float>(Block::kColumns);
}

/// On uneven ground, lines are far off beneath the sensor: a plane refined by where they begin is taken if it clearly
/// holds more of these places.
void PlaneEstimator::estimate() {
  if (height_state_ == Height::kGiven) return fitSlopes();
  if (!find()) return;
  const Plane found = plane_;
  refine();
  refine();  // by other lines, as the slope has changed
  if (!(weightOn(plane_) > kClearlyMore * weightOn(found))) plane_ = found;
}

/// Finds the plane's height from those of the lines beneath the sensor. \return false if they show none
bool PlaneEstimator::find() {
  const std::size_t size = std::min(count_, kMemory);
  const Agreed agreed = lowestOf(lines_.data(), size, kWindow, kEnough);
  float sure = 0.0F;
  for (std::size_t i = 0; i < size; ++i)
    if (std::fabs(lines_[i].height - agreed.height) < 2.0F * kWindow) sure += sureWeight(lines_[i]);
  if (sure < kMinWeight) return false;
  plane_.height = agreed.height;
  height_state_ = Height::kFound;
  fitSlopes();
  return true;
}

/// Weight of the lines that begin on a plane.
float PlaneEstimator::weightOn(const Plane& plane) const {
  float weight = 0.0F;
  for (std::size_t i = 0; i < std::min(count_, kMemory); ++i) {
    const Line& line = lines_[i];
    const float slope = line.slope - plane.slopeTowards(line.direction);
    if (std::fabs(line.height - plane.height + slope * line.rho) < kOnPlane) weight += line.weight;
  }
  return weight;
}

/// Fits the slopes of a plane to those of the lines at its height.
void PlaneEstimator::fitSlopes() {
  const std::size_t size = std::min(count_, kMemory);
  // Least squares of slope_x x + slope_y y = slope, drawn to the horizon where directions are few.
  float xx = 1.0F, xy = 0.0F, yy = 1.0F, xs = 0.0F, ys = 0.0F, all = 0.0F;
  for (std::size_t i = 0; i < size; ++i) {
    const Line& line = lines_[i];
    if (std::fabs(line.height - plane_.height) > 2.0F * kWindow) continue;
    const auto [x, y] = line.direction;
    all += line.weight;
    xx += line.weight * x * x;
    xy += line.weight * x * y;
    yy += line.weight * y * y;
    xs += line.weight * x * line.slope;
    ys += line.weight * y * line.slope;
  }
  if (all < kMinWeight) return;
  const float determinant = xx * yy - xy * xy;
  plane_.slope_x = std::clamp((xs * yy - ys * xy) / determinant, -max_slope_, max_slope_);
  plane_.slope_y = std::clamp((ys * xx - xs * xy) / determinant, -max_slope_, max_slope_);
}

/// Fits a known plane to where the lines begin and to their slopes: on uneven ground, a line's own height beneath the
/// sensor is far off.
void PlaneEstimator::refine() {
  const std::size_t size = std::min(count_, kMemory);
  std::array<Line, kMemory> lines = lines_;
  for (std::size_t i = 0; i < size; ++i)
    lines[i].height += kTrust * (lines[i].slope - plane_.slopeTowards(lines[i].direction)) * lines[i].rho;
  const Agreed agreed = lowestOf(lines.data(), size, kRefinedWindow, kRefinedEnough);
  // Least squares of height + slope_x x + slope_y y = z.
  std::array<std::array<double, 4>, 3> rows{};
  rows[1][1] = rows[2][2] = kLevelWeight;
  const auto add = [&rows](double weight, const std::array<double, 4>& terms) {
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 4; ++j) rows[i][j] += weight * terms[i] * terms[j];
  };
  double all = 0.0;
  for (std::size_t i = 0; i < size; ++i) {
    if (std::fabs(lines[i].height - agreed.height) > 2.0F * kRefinedWindow) continue;
    const Line& line = lines_[i];
    const double weight = line.weight, rho = line.rho, slope = line.slope;
    const double x = line.direction.x, y = line.direction.y, reach = rho / kPointReach;
    add(weight / (1.0 + reach * reach), {1.0, rho * x, rho * y, line.height + slope * rho});
    add(weight, {0.0, kSlopeReach * x, kSlopeReach * y, kSlopeReach * slope});
    all += weight;
  }
  if (all < kMinRefining) return;
  for (std::size_t pivot = 0; pivot < 3; ++pivot)
    for (std::size_t i = 0; i < 3; ++i) {
      if (i == pivot) continue;
      const double factor = rows[i][pivot] / rows[pivot][pivot];
      for (std::size_t j = 0; j < 4; ++j) rows[i][j] -= factor * rows[pivot][j];
    }
  const auto valueOf = [&rows](std::size_t i) { return static_cast<float>(rows[i][3] / rows[i][i]); };
  plane_.height = valueOf(0);
  plane_.slope_x = std::clamp(valueOf(1), -max_slope_, max_slope_);
  plane_.slope_y = std::clamp(valueOf(2), -max_slope_, max_slope_);
}

}  // namespace lisco::ground
