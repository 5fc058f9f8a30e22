// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "lisco/ground_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "core/ground/block.h"
#include "core/ground/polar_grid.h"
#include "core/ground/profile.h"
#include "core/ground/start.h"
#include "core/pi.h"

namespace lisco {

using ground::Block;
using ground::Cell;
using ground::kSectors;
using ground::PlaneEstimator;
using ground::Profile;
using ground::Sector;


namespace {

/// Metres per metre.
float maxSlope(const GroundParameters& parameters) {
  return static_cast<float>(std::tan(static_cast<double>(parameters.max_slope) * kPi / 180.0));
}

}  // namespace

/// Blocks of columns, the polar grid that they fill, and the ground found in it.
class GroundFilter::State {
 public:
  void begin(const GroundParameters& parameters, std::size_t lasers);
  void add(const Return* cells, std::size_t lasers, const GroundVisitor& visit);
  void addColumns(std::size_t first, std::size_t count, const CellSource& cells);
  void finish(const GroundVisitor& visit);
  const std::uint8_t* ground() const { return block_.ground.data(); }
  void decide();
  void clear() { begun_ = false; }

 private:
  void visitColumns(const GroundVisitor& visit);
  void insert();
  void findGround();
  void classify();

  GroundParameters parameters_;
  float max_slope_ = 0.0F;
  std::size_t lasers_ = 0;
  bool begun_ = false;
  Block block_;
  std::size_t columns_ = 0;                                 // in the block
  std::array<std::size_t, Block::kColumns> cell_counts_{};  // of its columns
  std::size_t first_column_ = 0;                            // of the block, from begin () on
  std::vector<std::uint8_t> column_ground_;                 // of one column
  std::uint64_t block_number_ = 0;
  std::vector<Sector> sectors_;
  PlaneEstimator plane_estimator_;
};

void GroundFilter::State::begin(const GroundParameters& parameters, std::size_t lasers) {
  if (std::isinf(parameters.sensor_height))
    throw std::invalid_argument("lisco::GroundFilter: the sensor height is infinite");
  if (!(parameters.max_slope >= 1.0F && parameters.max_slope <= 60.0F))
    throw std::invalid_argument("lisco::GroundFilter: max_slope is not within 1 to 60 degrees");
  parameters_ = parameters;
  max_slope_ = maxSlope(parameters);
  lasers_ = lasers;
  block_.resize(lasers);
  column_ground_.resize(std::max(column_ground_.size(), lasers));
  sectors_.resize(kSectors);
  for (Sector& sector : sectors_) {
    sector.occupied = {};
    sector.block = 0;
  }
  columns_ = first_column_ = 0;
  block_number_ = 0;
  plane_estimator_.begin(parameters, max_slope_);
  begun_ = true;
}

void GroundFilter::State::add(const Return* cells, std::size_t lasers, const GroundVisitor& visit) {
  if (!begun_) throw std::logic_error("lisco::GroundFilter: addColumn before begin");
  if (lasers > lasers_) throw std::invalid_argument("lisco::GroundFilter: more cells than lasers");
  for (std::size_t laser = 0; laser < lasers_; ++laser) {
    const Return cell = laser < lasers ? cells[laser] : kNoReturn;
    const std::size_t i = laser * Block::kColumns + columns_;
    block_.x[i] = cell.x;
    block_.y[i] = cell.y;
    block_.z[i] = cell.z;
  }
  cell_counts_[columns_++] = lasers;
  if (columns_ < Block::kColumns) return;
  decide();
  visitColumns(visit);
}

void GroundFilter::State::addColumns(std::size_t first, std::size_t count, const CellSource& cells) {
  std::array<std::uint32_t, Block::kColumns> source_indices;
  for (std::size_t laser = 0; laser < lasers_; ++laser) {
    const std::size_t i = laser * Block::kColumns;
    cells.read(laser, first, count, {&block_.x[i], &block_.y[i], &block_.z[i], source_indices.data()});
  }
  columns_ = count;
}

void GroundFilter::State::finish(const GroundVisitor& visit) {
  if (!begun_ || columns_ == 0) return;
  decide();
  visitColumns(visit);
}

void GroundFilter::State::visitColumns(const GroundVisitor& visit) {
  const std::size_t count = columns_;
  columns_ = 0;
  for (std::size_t column = 0; column < count; ++column) {
    for (std::size_t laser = 0; laser < cell_counts_[column]; ++laser)
      column_ground_[laser] = block_.ground[laser * Block::kColumns + column];
    visit(first_column_++, column_ground_.data(), cell_counts_[column]);
  }
}

/// Decides on the columns of the block.
void GroundFilter::State::decide() {
  for (std::size_t column = columns_; column < Block::kColumns; ++column)
    for (std::size_t laser = 0; laser < lasers_; ++laser) {
      const std::size_t i = laser * Block::kColumns + column;
      block_.x[i] = block_.y[i] = block_.z[i] = 0.0F;
    }
  ++block_number_;
  block_.measure(parameters_.sensor);
  insert();
  findGround();
  classify();
}

void GroundFilter::State::insert() {
  constexpr std::uint64_t kFresh = 16;  // blocks after which a sector shows the rotation before
  for (std::size_t i = 0; i < block_.size; ++i) {
    if (block_.cell[i] == Block::kNoCell) continue;
    Sector& sector = sectors_[Block::sectorOf(block_.cell[i])];
    if (sector.block != block_number_) {
      if (block_number_ - sector.block > kFresh) sector.occupied = {};
      sector.block = block_number_;
    }
    sector.add(Block::binOf(block_.cell[i]), block_.rho[i], block_.height[i]);
  }
}

void GroundFilter::State::findGround() {
  constexpr std::uint64_t kEstimatePeriod = 4;  // blocks
  if (!plane_estimator_.isKnown() || block_number_ % kEstimatePeriod == 0) {
    const std::size_t count = plane_estimator_.isKnown() ? 1 : Block::kColumns;
    for (std::size_t column = 0; column < count; ++column) plane_estimator_.add(block_, column);
    plane_estimator_.update();
  }
  if (!plane_estimator_.isKnown()) return;
  const Profile profile(plane_estimator_.plane(), max_slope_);
  for (std::size_t s = 0; s < kSectors; ++s) {
    if (sectors_[s].block != block_number_) continue;
    const Sector* beside = nullptr;
    for (const std::size_t other : {(s + 1) % kSectors, (s + kSectors - 1) % kSectors})
      if (sectors_[other].block != 0 && block_number_ - sectors_[other].block < 8) beside = &sectors_[other];
    profile.follow(sectors_[s], ground::directionOf(s), beside);
  }
}

void GroundFilter::State::classify() {
  for (std::size_t i = 0; i < block_.size; ++i) {
    block_.ground[i] = 0;
    if (block_.cell[i] == Block::kNoCell || !plane_estimator_.isKnown()) continue;
    const Cell& cell = sectors_[Block::sectorOf(block_.cell[i])].cells[Block::binOf(block_.cell[i])];
    const float above = block_.height[i] - (cell.ground + cell.slope * (block_.rho[i] - cell.low_rho));
    block_.ground[i] = above < cell.tolerance && above > -0.5F;
  }
}

GroundParameters estimateGround(std::size_t columns, std::size_t lasers, const std::array<float, 3>& declared_origin,
                                const CellSource& cells) {
  GroundParameters parameters;
  parameters.sensor = estimateSensor(columns, lasers, declared_origin, cells);
  Block block;
  block.resize(lasers);
  PlaneEstimator estimator;
  estimator.begin(parameters, maxSlope(parameters));
  const std::size_t samples = std::min(columns, PlaneEstimator::kMemory);
  for (std::size_t sample = 0; sample < samples; sample += Block::kColumns) {
    const std::size_t count = std::min(Block::kColumns, samples - sample);
    std::fill(block.z.begin(), block.z.end(), std::numeric_limits<float>::quiet_NaN());
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t column = (2 * (sample + i) + 1) * columns / (2 * samples);
      for (std::size_t laser = 0; laser < lasers; ++laser) {
        const Return cell = cells.at(laser, column);
        const std::size_t to = laser * Block::kColumns + i;
        block.x[to] = cell.x;
        block.y[to] = cell.y;
        block.z[to] = cell.z;
      }
    }
    block.measure(parameters.sensor);
    for (std::size_t i = 0; i < count; ++i) estimator.add(block, i);
  }
  estimator.update();
  if (!estimator.isKnown()) return parameters;
  parameters.sensor_height = -estimator.plane().height;
  parameters.slope = {estimator.plane().slope_x + parameters.sensor.tilt[0],
                      estimator.plane().slope_y + parameters.sensor.tilt[1]};
  return parameters;
}

GroundFilter::GroundFilter() : state_(std::make_unique<State>()) {}
GroundFilter::~GroundFilter() = default;
GroundFilter::GroundFilter(const GroundFilter& other) : state_(std::make_unique<State>(*other.state_)) {}
GroundFilter& GroundFilter::operator=(const GroundFilter& other) {
  if (this != &other) state_ = std::make_unique<State>(*other.state_);
  return *this;
}

void GroundFilter::begin(const GroundParameters& parameters, std::size_t lasers) {
  state_->begin(parameters, lasers);
}

void GroundFilter::receive(const Return* cells, std::size_t lasers, const GroundVisitor& visit) {
  state_->add(cells, lasers, visit);
}

void GroundFilter::decideRest(const GroundVisitor& visit) {
  state_->finish(visit);
}

void GroundFilter::filterAll(const GroundParameters& parameters, std::size_t columns, std::size_t lasers,
                             const CellSource& cells, std::uint8_t* ground) {
  state_->begin(parameters, lasers);
  for (std::size_t first = 0; first < columns; first += Block::kColumns) {
    const std::size_t count = std::min(Block::kColumns, columns - first);
    state_->addColumns(first, count, cells);
    state_->decide();
    for (std::size_t laser = 0; laser < lasers; ++laser)
      std::copy_n(state_->ground() + laser * Block::kColumns, count, ground + laser * columns + first);
  }
  state_->clear();
}

}  // namespace lisco
