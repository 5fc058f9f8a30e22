// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "lisco/ground_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "core/finite.h"
#include "core/ground/block.h"
#include "core/ground/follower.h"
#include "core/ground/ground_map.h"
#include "core/ground/plane_estimator.h"
#include "core/ground/row_order.h"
#include "core/pi.h"
#include "core/simd.h"

namespace lisco {

using ground::Block;
using ground::Columns;
using ground::Follower;
using ground::GroundMap;
using ground::PlaneEstimator;
using ground::RowOrder;

namespace {

/// Metres per metre.
float maxSlope(const GroundParameters& parameters) {
  return static_cast<float>(std::tan(static_cast<double>(parameters.max_slope) * kPi / 180.0));
}

void check(const GroundParameters& parameters) {
  if (std::isinf(parameters.sensor_height))
    throw std::invalid_argument("lisco::GroundFilter: the sensor height is infinite");
  if (!(parameters.max_slope >= 1.0F && parameters.max_slope <= 60.0F))
    throw std::invalid_argument("lisco::GroundFilter: max_slope is not within 1 to 60 degrees");
  if (!areFinite(parameters.sensor.origin))
    throw std::invalid_argument("lisco::GroundFilter: the sensor's origin must be finite");
  constexpr float kMaxSlope = 10.0F;
  for (const float slope :
       {parameters.slope[0], parameters.slope[1], parameters.sensor.tilt[0], parameters.sensor.tilt[1]})
    if (!(std::fabs(slope) <= kMaxSlope))
      throw std::invalid_argument("lisco::GroundFilter: the slope or the sensor's tilt is not within -10 to 10");
}

}  // namespace

/// The columns of a block, and the ground found in the blocks before.
class GroundFilter::State {
 public:
  /// A copy with room for as many lasers.
  static std::unique_ptr<State> copyOf(const State& other);

  void begin(const GroundParameters& parameters, std::size_t lasers);
  /// add () needs another begin ().
  void end() { begun_ = false; }
  void add(const Return* cells, std::size_t lasers, const Visitor& visit);
  void finish(const Visitor& visit);
  void addAll(std::size_t columns, const CellSource& cells, std::uint8_t* ground);

 private:
  void measureWaiting();
  void decideMeasured();
  void visitNext(const Visitor& visit);
  void measure(std::size_t first);
  void decide(std::size_t count, std::uint8_t* ground, std::size_t stride);
  void enterIntoMap();
  void estimatePlane(std::size_t first);

  GroundParameters parameters_;
  std::size_t lasers_ = 0;
  bool begun_ = false;
  Columns received_;
  std::size_t waiting_ = 0;                                 // columns received and not measured
  std::array<std::size_t, Block::kColumns> cell_counts_{};  // of these columns
  // The latest block measured:
  std::array<std::size_t, Block::kColumns> block_counts_{};  // cells of its columns
  std::size_t block_columns_ = 0;                            // number of its columns
  std::size_t next_visited_ = 0;                             // of them
  enum class Stage { kMeasured, kDecided, kInMap } stage_ = Stage::kInMap;
  std::vector<std::uint8_t> block_ground_, column_ground_;
  std::size_t visited_ = 0;  // columns, from begin () on
  Block block_;
  std::uint64_t block_number_ = 0;
  RowOrder order_;
  GroundMap map_;
  Follower follower_;
  PlaneEstimator plane_estimator_;
};

std::unique_ptr<GroundFilter::State> GroundFilter::State::copyOf(const State& other) {
  auto copy = std::make_unique<State>(other);
  copy->order_.reserve();
  return copy;
}

void GroundFilter::State::begin(const GroundParameters& parameters, std::size_t lasers) {
  check(parameters);
  begun_ = false;  // until all memory is there
  parameters_ = parameters;
  const float max_slope = maxSlope(parameters);
  lasers_ = lasers;
  block_.resize(lasers);
  received_.resize(lasers, Block::kColumns);
  block_ground_.resize(std::max(block_ground_.size(), lasers * Block::kColumns));
  column_ground_.resize(std::max(column_ground_.size(), lasers));
  order_.begin(lasers);
  map_.begin();
  follower_.begin(lasers, max_slope);
  waiting_ = next_visited_ = block_columns_ = visited_ = 0;
  stage_ = Stage::kInMap;
  block_number_ = 0;
  plane_estimator_.begin(parameters, max_slope, lasers);
  begun_ = true;
}

/// Spreads the work of a block over columns: its last one measures it, the next one decides, and the one after that
/// enters it into the map. Each of them visits a column of the block before.
void GroundFilter::State::add(const Return* cells, std::size_t lasers, const Visitor& visit) {
  if (!begun_) throw std::logic_error("lisco::GroundFilter: addColumn before begin");
  if (lasers > lasers_) throw std::invalid_argument("lisco::GroundFilter: more cells than lasers");
  if (waiting_ == Block::kColumns) measureWaiting();  // an exception of `visit` has prevented it
  for (std::size_t laser = 0; laser < lasers_; ++laser)
    received_.set(laser, waiting_, laser < lasers ? cells[laser] : kNoReturn);
  cell_counts_[waiting_++] = lasers;
  if (stage_ == Stage::kMeasured)
    decideMeasured();
  else
    enterIntoMap();
  if (next_visited_ < block_columns_) visitNext(visit);
  if (waiting_ == Block::kColumns) measureWaiting();
}

void GroundFilter::State::finish(const Visitor& visit) {
  if (!begun_) return;
  if (stage_ == Stage::kMeasured) decideMeasured();
  while (next_visited_ < block_columns_) visitNext(visit);
  if (waiting_ == 0) return;
  for (std::size_t column = waiting_; column < Block::kColumns; ++column) received_.clear(column, lasers_);
  measureWaiting();
  decideMeasured();
  while (next_visited_ < block_columns_) visitNext(visit);
}

void GroundFilter::State::measureWaiting() {
  block_counts_ = cell_counts_;
  block_columns_ = waiting_;
  next_visited_ = waiting_ = 0;
  measure(0);
}

void GroundFilter::State::decideMeasured() {
  std::fill(block_ground_.begin(), block_ground_.end(), std::uint8_t{0});
  decide(block_columns_, block_ground_.data(), Block::kColumns);
}

void GroundFilter::State::visitNext(const Visitor& visit) {
  const std::size_t column = next_visited_++, cells = block_counts_[column];
  for (std::size_t laser = 0; laser < cells; ++laser)
    column_ground_[laser] = block_ground_[laser * Block::kColumns + column];
  visit(visited_++, column_ground_.data(), cells);
}

/// Reads more columns at a time than are decided together: the returns of a laser lie side by side in a cloud's memory.
void GroundFilter::State::addAll(std::size_t columns, const CellSource& cells, std::uint8_t* ground) {
  constexpr std::size_t kRead = 128;
  static_assert(kRead % Block::kColumns == 0, "blocks are read as a whole");
  std::array<std::uint32_t, kRead> source_indices;
  begun_ = false;
  received_.resize(lasers_, kRead);
  std::fill_n(ground, columns * lasers_, std::uint8_t{0});
  for (std::size_t first = 0; first < columns; first += kRead) {
    const std::size_t count = std::min(kRead, columns - first);
    for (std::size_t laser = 0; laser < lasers_; ++laser) {
      const std::size_t i = laser * kRead;
      cells.read(laser, first, count, {&received_.x[i], &received_.y[i], &received_.z[i], source_indices.data()});
    }
    for (std::size_t column = count; column % Block::kColumns != 0; ++column) received_.clear(column, lasers_);
    for (std::size_t column = 0; column < count; column += Block::kColumns) {
      measure(column);
      decide(std::min(Block::kColumns, count - column), ground + first + column, columns);
    }
  }
}

/// Measures a block of the columns received, and follows the ground along its first rows.
void GroundFilter::State::measure(std::size_t first) {
  enterIntoMap();
  stage_ = Stage::kMeasured;
  ++block_number_;
  block_.measure(received_, first, parameters_.sensor);
  order_.update(block_);
  estimatePlane(first);
  if (plane_estimator_.isKnown())
    follower_.followFirstRows(block_, order_, plane_estimator_.plane(), map_,
                              static_cast<std::uint32_t>(block_number_));
}

/// Decides on the first `count` columns of the block measured.
/// \param ground zeros, in rows of `stride`; receives 1 for each cell on the ground
void GroundFilter::State::decide(std::size_t count, std::uint8_t* ground, std::size_t stride) {
  stage_ = plane_estimator_.isKnown() ? Stage::kDecided : Stage::kInMap;
  if (plane_estimator_.isKnown()) follower_.followOtherRows(block_, order_, map_, ground, count, stride);
}

/// Enters what the latest block has shown into the map, for the next one.
void GroundFilter::State::enterIntoMap() {
  if (stage_ == Stage::kDecided) follower_.enterIntoMap(block_, order_, plane_estimator_.plane(), map_);
  stage_ = Stage::kInMap;
}

/// \param first of the columns received that the block has
void GroundFilter::State::estimatePlane(std::size_t first) {
  constexpr std::uint64_t kEstimatePeriod = 4;  // blocks
  if (plane_estimator_.hasHeight() && block_number_ % kEstimatePeriod != 0) return;
  const std::size_t count = plane_estimator_.hasHeight() ? 1 : Block::kColumns;
  for (std::size_t column = 0; column < count; ++column) plane_estimator_.add(block_, received_, first, column);
  plane_estimator_.update();
}

GroundParameters estimateGround(std::size_t columns, std::size_t lasers, const std::array<float, 3>& declared_origin,
                                const CellSource& cells) {
  GroundParameters parameters;
  parameters.sensor = estimateSensor(columns, lasers, declared_origin, cells);
  return estimateGroundPlane(columns, lasers, parameters, cells);
}

GroundParameters estimateGroundPlane(std::size_t columns, std::size_t lasers, GroundParameters parameters,
                                     const CellSource& cells) {
  check(parameters);
  Columns sampled;
  sampled.resize(lasers, Block::kColumns);
  Block block;
  block.resize(lasers);
  PlaneEstimator estimator;
  estimator.begin(parameters, maxSlope(parameters), lasers);
  const std::size_t samples = std::min(columns, PlaneEstimator::kMemory);
  for (std::size_t sample = 0; sample < samples; ++sample) {
    const std::size_t to = sample % Block::kColumns;
    const std::size_t column = (2 * sample + 1) * columns / (2 * samples);
    for (std::size_t laser = 0; laser < lasers; ++laser) sampled.set(laser, to, cells.at(laser, column));
    if (to + 1 < Block::kColumns && sample + 1 < samples) continue;
    block.measure(sampled, 0, parameters.sensor);
    for (std::size_t i = 0; i <= to; ++i) estimator.add(block, sampled, 0, i);
  }
  estimator.estimate();
  if (!estimator.isKnown()) return parameters;
  if (std::isnan(parameters.sensor_height)) parameters.sensor_height = -estimator.plane().height;
  parameters.slope = {estimator.plane().slope_x + parameters.sensor.tilt[0],
                      estimator.plane().slope_y + parameters.sensor.tilt[1]};
  return parameters;
}

static_assert(GroundFilter::kMaxDelay == Block::kColumns,
              "a column waits for its block, and is visited during the next");

GroundFilter::GroundFilter() : state_(std::make_unique<State>()) {
  chooseSimdLevel();
}
GroundFilter::~GroundFilter() = default;
GroundFilter::GroundFilter(const GroundFilter& other) : state_(State::copyOf(*other.state_)) {}
GroundFilter& GroundFilter::operator=(const GroundFilter& other) {
  if (this != &other) state_ = State::copyOf(*other.state_);
  return *this;
}

void GroundFilter::begin(const GroundParameters& parameters, std::size_t lasers) {
  state_->begin(parameters, lasers);
}

void GroundFilter::receive(const Return* cells, std::size_t lasers, const Visitor& visit) {
  state_->add(cells, lasers, visit);
}

void GroundFilter::decideRest(const Visitor& visit) {
  state_->finish(visit);
}

void GroundFilter::filterAll(const GroundParameters& parameters, std::size_t columns, std::size_t lasers,
                             const CellSource& cells, std::uint8_t* ground) {
  state_->begin(parameters, lasers);
  state_->addAll(columns, cells, ground);
}

GroundParameters GroundFilter::estimateAndFilter(const GroundParameters& parameters, std::size_t columns,
                                                 std::size_t lasers, const CellSource& cells, std::uint8_t* ground) {
  state_->end();
  const GroundParameters estimated = estimateGroundPlane(columns, lasers, parameters, cells);
  // A scan that shows no ground as a whole has none, though some of its columns may seem to.
  if (std::isnan(estimated.sensor_height))
    std::fill_n(ground, columns * lasers, std::uint8_t{0});
  else
    filterAll(estimated, columns, lasers, cells, ground);
  return estimated;
}

}  // namespace lisco
