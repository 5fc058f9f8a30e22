// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "reference/voxel_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace lisco_reference {
namespace {

constexpr std::uint64_t kReach = 2;  ///< cells per axis between two neighbours, at most
/// Of a cell's number along an axis, computed in double: its error is below a 20,000th of a cell, for which kSideFactor
/// makes up.
constexpr int kMaxBitsPerAxis = 37;
constexpr double kSideFactor = 0.9999;
// Metres: between these, squares in float neither vanish nor overflow, and the points of a cell are neighbours.
constexpr double kMinTolerance = 1e-18;
constexpr double kMaxTolerance = 1e18;

}  // namespace

const std::vector<std::uint32_t>& VoxelGrid::cluster(const std::vector<lisco::Return>& returns, float tolerance) {
  tolerance_ = lisco::Tolerance(tolerance);
  component_of_.resize(returns.size());
  if (!tolerance_.joinsAnything()) {
    for (std::size_t i = 0; i < returns.size(); ++i) component_of_[i] = static_cast<std::uint32_t>(i);
    return component_of_;
  }
  const double eps = std::fabs(static_cast<double>(tolerance));
  if (eps < kMinTolerance || eps > kMaxTolerance)
    throw std::runtime_error("the tolerance is too small or too large for a voxel grid");
  side_ = kSideFactor * eps / std::sqrt(3.0);
  numberCells(returns);
  sortItems();
  gatherCells(returns);
  linkCells();
  for (std::size_t c = 0; c + 1 < cells_.size(); ++c) {
    const std::uint32_t root = components_.find(static_cast<std::uint32_t>(c));
    for (std::size_t i = cells_[c].first; i < cells_[c + 1].first; ++i) component_of_[items_[i].number] = root;
  }
  return component_of_;
}

void VoxelGrid::numberCells(const std::vector<lisco::Return>& returns) {
  lisco::Box box{};
  for (std::size_t i = 0; i < returns.size(); ++i) {
    const auto at = lisco::Box::around(returns[i].x, returns[i].y, returns[i].z);
    if (i == 0)
      box = at;
    else
      box.add(at);
  }
  double origin[3];
  int all_bits = 0;
  bool numbers_hold = true;
  for (int axis = 0; axis < 3; ++axis) {
    origin[axis] = static_cast<double>(box.lo[axis]);
    // A margin of kReach cells on both sides keeps rows apart.
    const double cells =
        (static_cast<double>(box.hi[axis]) - origin[axis]) / side_ + 1 + 2 * static_cast<double>(kReach);
    bits_[axis] = static_cast<int>(std::ceil(std::log2(cells + 1)));
    all_bits += bits_[axis];
    numbers_hold = numbers_hold && bits_[axis] <= kMaxBitsPerAxis;
  }
  if (all_bits > 64 || !numbers_hold) throw std::runtime_error("the scan has too many cells for a voxel grid");

  const double per_metre = 1 / side_;
  const auto number = [&](float value, int axis) {
    return static_cast<std::uint64_t>((static_cast<double>(value) - origin[axis]) * per_metre) + kReach;
  };
  items_.resize(returns.size());
  for (std::size_t i = 0; i < returns.size(); ++i) {
    const lisco::Return& p = returns[i];
    items_[i] = {(number(p.z, 2) << bits_[1] | number(p.y, 1)) << bits_[0] | number(p.x, 0),
                 static_cast<std::uint32_t>(i)};
  }
}

void VoxelGrid::sortItems() {
  constexpr int kDigitBits = 11;
  constexpr std::size_t kDigits = std::size_t{1} << kDigitBits;
  sorted_.resize(items_.size());
  const int bits = bits_[0] + bits_[1] + bits_[2];
  for (int shift = 0; shift < bits; shift += kDigitBits) {
    std::array<std::uint32_t, kDigits> place{};
    for (const Item& item : items_) ++place[item.key >> shift & (kDigits - 1)];
    std::uint32_t sum = 0;
    for (std::uint32_t& p : place) {
      const std::uint32_t count = p;
      p = sum;
      sum += count;
    }
    for (const Item& item : items_) sorted_[place[item.key >> shift & (kDigits - 1)]++] = item;
    items_.swap(sorted_);
  }
}

void VoxelGrid::gatherCells(const std::vector<lisco::Return>& returns) {
  points_.resize(items_.size());
  cells_.clear();
  components_.reset(items_.size());
  for (std::size_t i = 0; i < items_.size(); ++i) {
    const lisco::Return& p = returns[items_[i].number];
    points_[i] = {p.x, p.y, p.z};
    const auto at = lisco::Box::around(p.x, p.y, p.z);
    if (i == 0 || items_[i].key != items_[i - 1].key) {
      cells_.push_back({items_[i].key, static_cast<std::uint32_t>(i), at});
      components_.create(static_cast<std::uint32_t>(cells_.size() - 1));
    } else {
      cells_.back().box.add(at);
    }
  }
  cells_.push_back({std::numeric_limits<std::uint64_t>::max(), static_cast<std::uint32_t>(items_.size()), {}});
}

void VoxelGrid::linkCells() {
  // The rows to compare after a cell's own, as differences of keys.
  constexpr std::size_t kRows = 12;
  std::array<std::uint64_t, kRows> row{};
  std::array<std::size_t, kRows> cursor{};
  const std::uint64_t next_y = std::uint64_t{1} << bits_[0];
  const std::uint64_t next_z = next_y << bits_[1];
  std::size_t rows = 0;
  for (std::uint64_t y = 1; y <= kReach; ++y) row[rows++] = y * next_y;
  for (std::uint64_t z = 1; z <= kReach; ++z)
    for (std::uint64_t y = 0; y <= 2 * kReach; ++y) row[rows++] = z * next_z + y * next_y - kReach * next_y;

  const std::size_t cells = cells_.size() - 1;
  for (std::size_t c = 0; c < cells; ++c) {
    const std::uint64_t key = cells_[c].key;
    for (std::size_t n = c + 1; n < cells && cells_[n].key <= key + kReach; ++n) link(c, n);
    for (std::size_t r = 0; r < kRows; ++r) {
      std::size_t& n = cursor[r];
      const std::uint64_t from = key + row[r] - kReach;
      while (n < cells && cells_[n].key < from) ++n;
      for (std::size_t m = n; m < cells && cells_[m].key <= from + 2 * kReach; ++m) link(c, m);
    }
  }
}

void VoxelGrid::link(std::size_t a, std::size_t b) {
  const std::uint32_t root_a = components_.find(static_cast<std::uint32_t>(a));
  const std::uint32_t root_b = components_.find(static_cast<std::uint32_t>(b));
  if (root_a != root_b && touch(cells_[a], cells_[a + 1].first, cells_[b], cells_[b + 1].first))
    components_.merge(root_a, root_b);
}

bool VoxelGrid::touch(const Cell& a, std::size_t a_end, const Cell& b, std::size_t b_end) const {
  const float r2 = tolerance_.squared();
  if (!(lisco::Box::squaredGap(a.box, b.box) < r2)) return false;
  for (std::size_t i = a.first; i < a_end; ++i) {
    const Point& p = points_[i];
    if (!(lisco::Box::squaredGap(lisco::Box::around(p.x, p.y, p.z), b.box) < r2)) continue;
    for (std::size_t j = b.first; j < b_end; ++j)
      if (lisco::squaredDistance(p.x - points_[j].x, p.y - points_[j].y, p.z - points_[j].z) < r2) return true;
  }
  return false;
}

}  // namespace lisco_reference
