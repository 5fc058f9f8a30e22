// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/ground/plane_estimator.h"

#include <algorithm>
#include <cmath>

#include "core/bits.h"

namespace lisco::ground {
namespace {

// Least loss of objects and of ground in the tables of benchmarks/suite.sh ground ground_real.
constexpr float kEnough = 0.5F;         // of the most weight
constexpr float kWindow = 0.15F;        // metres, of heights that agree
constexpr float kRefinedWindow = 0.4F;  // metres, of heights that agree with the plane's slope
constexpr float kRefinedEnough = 0.7F;  // of the most weight
constexpr float kTrust = 0.5F;          // of the plane's slope, the rest of a line's own
constexpr double kPointReach = 6.0;     // metres; where lines begin further out, they count less as points
constexpr double kSlopeReach = 2.0;     // metres, over which a line's slope counts
constexpr double kLevelWeight = 20.0;   // square metres, of the horizon
constexpr float kMinWeight = 6.0F;      // of the lines that show a plane
constexpr float kMinRefining = 1.5F;    // of the lines that refine it: few are near where a stream begins
constexpr float kOnPlane = 0.2F;        // metres; lines that begin this near to a plane begin on it
constexpr float kClearlyMore = 1.5F;    // times the weight of lines that begin on another plane
// Updates per one that shows ground, at most: 1 to 2 on streets, 9 and more where objects alone are around. A plane as
// near to the sensor as a table is taken for the ground only if more of the updates show it.
constexpr std::uint32_t kUpdatesPerGround = 8, kUpdatesPerLowGround = 3;

}  // namespace

void PlaneEstimator::begin(const GroundParameters& parameters, float max_slope, std::size_t lasers) {
  const SensorHints& sensor = parameters.sensor;
  const bool origin_known = sensor.steps_per_turn != 0 || sensor.origin != std::array<float, 3>{};
  const float highest = origin_known ? -0.2F : 0.5F;  // otherwise the ground may be as high as the cloud's origin
  finder_.begin({highest, max_slope, sensor.origin}, lasers);
  max_slope_ = max_slope;
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
  ColumnLine line;
  if (finder_.find(block, columns, first, column, line)) lines_[count_++ % kMemory] = line;
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
  const AgreedHeight agreed = lowestAgreed(lines_.data(), size, kWindow, kEnough);
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
    const ColumnLine& line = lines_[i];
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
    const ColumnLine& line = lines_[i];
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
  std::array<ColumnLine, kMemory> lines = lines_;
  for (std::size_t i = 0; i < size; ++i)
    lines[i].height += kTrust * (lines[i].slope - plane_.slopeTowards(lines[i].direction)) * lines[i].rho;
  const AgreedHeight agreed = lowestAgreed(lines.data(), size, kRefinedWindow, kRefinedEnough);
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
    const ColumnLine& line = lines_[i];
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
