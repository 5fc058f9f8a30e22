// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/ground/follower.h"

#include <algorithm>
#include <cstring>

#include "core/bits.h"

namespace lisco::ground {
namespace {

constexpr float kStartLimit = 0.2F;  // metres above the ground beneath the sensor

/// The highest of the bits that are set, of at least one.
std::size_t lastOf(std::uint8_t bits) {
  return 31 - static_cast<std::size_t>(__builtin_clz(bits));
}

/// A byte for each of eight bits, 0 or 1, the lowest one first.
std::array<std::uint8_t, 8> bytesOf(std::uint8_t bits) {
  static constexpr auto table = [] {
    std::array<std::array<std::uint8_t, 8>, 256> all{};
    for (std::size_t i = 0; i < all.size(); ++i)
      for (std::size_t k = 0; k < 8; ++k) all[i][k] = i >> k & 1;
    return all;
  }();
  return table[bits];
}

/// Ground as far as it is known before the first row of a chain.
void setStart(const Plane& plane, float slope, Followed& start) {
  for (Lanes* lanes : {&start.rho, &start.back_rho, &start.next_rho}) lanes->fill(0.0F);
  for (Lanes* lanes : {&start.height, &start.back_height, &start.next_height}) lanes->fill(plane.height);
  start.slope.fill(slope);
}

}  // namespace

void Follower::begin(std::size_t lasers, float max_slope) {
  if (sectors_.size() < lasers) {
    starts_.resize(lasers);
    followed_.resize(2 * lasers);
    passed_.resize(lasers);
    sectors_.resize(lasers);
    sector_numbers_.resize(lasers);
    found_.resize(lasers);
    last_ground_.resize(lasers);
    reports_.reserve(lasers);
  }
  max_slope_ = max_slope;
}

void Follower::follow(const Block& block, const RowOrder& order, const Plane& plane, GroundMap& map,
                      std::uint32_t number, std::uint8_t* ground, std::size_t columns, std::size_t stride) {
  const auto& rows = order.rows();
  prepare(order, plane, map, number);
  followRows({&block, rows.data(), rows.size(), max_slope_, sectors_.data(), starts_.data()},
             {passed_.data(), followed_.data(), found_.data()});
  dropScattered(rows, found_);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::array<std::uint8_t, 8> decisions = bytesOf(found_[i].ground);
    std::uint8_t* const to = ground + static_cast<std::size_t>(rows[i].row) * stride;
    if (columns == Block::kColumns)
      std::memcpy(to, decisions.data(), Block::kColumns);
    else
      std::copy_n(decisions.data(), columns, to);
  }
}

void Follower::tell(const Block& block, const RowOrder& order, const Plane& plane, GroundMap& map) {
  for (std::size_t i = 0; i < order.rows().size(); ++i) sectors_[i] = map.sectors() + sector_numbers_[i];
  report(block, order, plane);
  enterReports(reports_, max_slope_, order.turnsLeft());
}

void Follower::prepare(const RowOrder& order, const Plane& plane, GroundMap& map, std::uint32_t number) {
  const auto& rows = order.rows();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i].down == RowOrder::kNone) {
      starts_[i] = {starts_.size() + i, {}, {}, 0};
      starts_[i].limit.fill(plane.height + kStartLimit);
      setStart(plane, plane.slopeTowards(order.directionOf(rows[i].row)), followed_[starts_[i].followed]);
    }
    sectors_[i] = &map.sectorAt(order.azimuthOf(rows[i].row), number, plane);
    sector_numbers_[i] = static_cast<std::size_t>(sectors_[i] - map.sectors());
  }
}

/// Reports what the latest column of each row has shown.
void Follower::report(const Block& block, const RowOrder& order, const Plane& plane) {
  const auto& rows = order.rows();
  reports_.clear();
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const RowOrder::Row& row = rows[i];
    const bool is_first = row.down == RowOrder::kNone;
    last_ground_[i] = is_first ? RowOrder::kNone : last_ground_[static_cast<std::size_t>(row.down)];
    const std::uint8_t returns = block.returns[static_cast<std::size_t>(row.row)], reached = found_[i].reached;
    if (returns == 0) continue;
    const std::size_t k = lastOf(returns), cell = static_cast<std::size_t>(row.row) * Block::kColumns + k;
    const float rho = block.rho[cell], reach = before(row, i).reach[k];
    if (rho <= reach && reached == 0) continue;
    // Filled in its place: a copy of fields just written waits for them.
    reports_.emplace_back();
    Report& report = reports_.back();
    report.sector = sectors_[i];
    report.seen_from = reach;
    report.seen_to = rho;
    report.seen_height = block.height[cell];
    report.has_ground = reached != 0;
    report.is_last = true;
    if (reached != 0) {
      const std::size_t last = lastOf(reached);
      const Followed& now = followed_[passed_[i].followed];
      const Followed& inwards = followed_[before(row, i).followed];
      Stretch& stretch = report.stretch;
      stretch.from_rho = is_first ? 0.0F : inwards.rho[last];
      stretch.from_height = is_first ? plane.height : inwards.height[last];
      stretch.rho = now.rho[last];
      stretch.height = now.height[last];
      stretch.slope = now.slope[last];
      stretch.is_doubted = (found_[i].confirmed >> last & 1) == 0;
      if (last_ground_[i] != RowOrder::kNone) reports_[static_cast<std::size_t>(last_ground_[i])].is_last = false;
      last_ground_[i] = static_cast<std::int32_t>(reports_.size()) - 1;
    }
  }
}

}  // namespace lisco::ground
