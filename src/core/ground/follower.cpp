// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/ground/follower.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace lisco::ground {
namespace {

constexpr float kStartLimit = 0.2F;  // metres above the ground beneath the sensor

/// The first rows are followed by the column that measures the block, the others by the next one, so that neither has
/// more work than the other (benchmarks/suite.sh ground_latency).
std::size_t firstRows(const RowOrder& order) {
  return order.rows().size() / 4;
}

/// A byte for each of eight bits, 0 or 1, the lowest one first.
std::array<std::uint8_t, 8> bytesOf(std::uint8_t bits) {
  constexpr std::uint64_t kEach = 0x0101010101010101, kBits = 0x8040201008040201, kBelow = 0x7F7F7F7F7F7F7F7F;
  const std::uint64_t apart = bits * kEach & kBits;  // bit i in byte i
  const std::uint64_t ones = (apart + kBelow) >> 7 & kEach;
  std::array<std::uint8_t, 8> bytes;
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(ones >> 8 * i);
  return bytes;
}

/// Ground as far as it is known before the first row of a chain.
void setStart(const Plane& plane, float slope, GroundReached& start) {
  for (Lanes* lanes : {&start.rho, &start.back_rho, &start.next_rho}) lanes->fill(0.0F);
  for (Lanes* lanes : {&start.height, &start.back_height, &start.next_height}) lanes->fill(plane.height);
  start.slope.fill(slope);
}

}  // namespace

void Follower::begin(std::size_t lasers, float max_slope) {
  const auto grow = [](auto& elements, std::size_t size) { elements.resize(std::max(elements.size(), size)); };
  grow(starts_, lasers);
  grow(followed_, 2 * lasers);
  grow(passed_, lasers);
  grow(sectors_, lasers);
  grow(with_ground_, lasers);
  grow(scattered_, lasers);
  grow(found_, lasers + 1);
  reports_.begin(lasers);
  max_slope_ = max_slope;
}

void Follower::followFirstRows(const Block& block, const RowOrder& order, const Plane& plane, GroundMap& map,
                               std::uint32_t number) {
  prepare(order, plane, map, number);
  followRows(settingOf(block, order, map), 0, firstRows(order), result());
}

void Follower::followOtherRows(const Block& block, const RowOrder& order, const GroundMap& map, std::uint8_t* ground,
                               std::size_t columns, std::size_t stride) {
  const auto& rows = order.rows();
  followRows(settingOf(block, order, map), firstRows(order), rows.size(), result());
  // Written always, counted if there is ground.
  std::size_t count = 0;
  Found* const found = result().found;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    with_ground_[count] = static_cast<std::int32_t>(i);
    count += static_cast<std::size_t>(found[i].ground != 0);
  }
  with_ground_count_ = count;
  dropScattered(rows.data(), found, with_ground_, count, reports_.unevenness.value(), scattered_);
  write(rows.data(), ground, columns, stride);
}

void Follower::write(const RowOrder::Row* rows, std::uint8_t* ground, std::size_t columns, std::size_t stride) const {
  const std::int32_t* const with_ground = with_ground_.data();
  const Found* const found = found_.data() + 1;
  for (std::size_t k = 0; k < with_ground_count_; ++k) {
    const std::int32_t i = with_ground[k];
    const std::array<std::uint8_t, 8> decisions = bytesOf(found[i].ground);
    std::uint8_t* const to = ground + static_cast<std::size_t>(rows[i].row) * stride;
    if (columns == Block::kColumns)
      std::memcpy(to, decisions.data(), Block::kColumns);
    else
      std::copy_n(decisions.data(), columns, to);
  }
}

void Follower::enterIntoMap(const Block& block, const RowOrder& order, const Plane& plane, GroundMap& map) {
  reports_.enter({settingOf(block, order, map), result(), plane.height, order.turnsLeft(), with_ground_.data(),
                  with_ground_count_},
                 map.sectors());
}

void Follower::prepare(const RowOrder& order, const Plane& plane, GroundMap& map, std::uint32_t number) {
  const RowOrder::Row* const rows = order.rows().data();
  const std::int32_t* const sector_of = order.sectors();
  std::uint32_t* const sectors = sectors_.data();
  const std::size_t size = order.rows().size();
  std::int32_t prepared = -1;
  for (std::size_t i = 0; i < size; ++i) {
    if (rows[i].down == RowOrder::kNone) {
      starts_[i] = {{}, followed_.size() / 2 + i, 0};
      starts_[i].limit.fill(plane.height + kStartLimit);
      setStart(plane, plane.slopeTowards(order.directionOf(rows[i].row)), followed_[starts_[i].followed]);
    }
    const std::int32_t sector = sector_of[rows[i].row];
    if (sector != prepared) map.prepare(static_cast<std::size_t>(sector), number, plane);
    prepared = sector;
    sectors[i] = static_cast<std::uint32_t>(sector);
  }
}

FollowSetting Follower::settingOf(const Block& block, const RowOrder& order, const GroundMap& map) const {
  return {&block,        order.rows().data(), order.rows().size(), max_slope_,
          map.sectors(), sectors_.data(),     starts_.data(),      reports_.unevenness.value()};
}

}  // namespace lisco::ground
