// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "reference/voxel_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace lisco_reference {
namespace {

constexpr std::uint32_t kReach = 2;  ///< cells per axis between two neighbours, at most
/// Of cells along an axis. A cell's number is computed in double, with an error below a 20,000th of a cell, for which
/// kSideFactor makes up.
constexpr double kMaxCells = 0x1p37;
constexpr double kSideFactor = 0.9999;
// Metres: between these, squares in float neither vanish nor overflow, and the points of a cell are neighbours.
constexpr double kMinTolerance = 1e-18;
constexpr double kMaxTolerance = 1e18;

/// Above all numbers of rows and cells.
constexpr std::uint64_t kNone = std::uint64_t{1} << 63;

/// To number so many things.
int bitsFor(double count) {
  return std::max(0, static_cast<int>(std::ceil(std::log2(count))));
}

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
  if (returns.empty()) return component_of_;
  side_ = kSideFactor * eps / std::sqrt(3.0);
  numberCells(returns);
  sortItems();
  gatherCells(returns);
  linkRows();
  const Item number_mask = (Item{1} << number_bits_) - 1;
  for (std::uint32_t c = 0; c + 1 < cells_.size(); ++c) {
    const std::uint32_t root = components_.find(c);
    for (std::size_t i = cells_[c].first; i < cells_[c + 1].first; ++i) component_of_[items_[i] & number_mask] = root;
  }
  return component_of_;
}

void VoxelGrid::numberCells(const std::vector<lisco::Return>& returns) {
  auto box = lisco::Box::around(returns[0].x, returns[0].y, returns[0].z);
  for (const lisco::Return& p : returns) box.add(lisco::Box::around(p.x, p.y, p.z));
  double cells[3];
  for (int axis = 0; axis < 3; ++axis) {
    cells[axis] = std::floor((static_cast<double>(box.hi[axis]) - static_cast<double>(box.lo[axis])) / side_) + 2;
    if (!(cells[axis] < kMaxCells)) throw std::runtime_error("the scan has too many cells for a voxel grid");
  }
  // A margin after each row, and empty rows after each z, keep others out of reach.
  const double rows_per_z = cells[1] + kReach;
  rows_per_z_ = static_cast<std::uint64_t>(rows_per_z);
  number_bits_ = bitsFor(static_cast<double>(returns.size()));
  x_bits_ = bitsFor(cells[0] + kReach);
  all_bits_ = number_bits_ + x_bits_ + bitsFor(rows_per_z * cells[2]);
  if (all_bits_ > 63) throw std::runtime_error("the scan has too many cells and returns for a voxel grid");

  const double origin[3] = {static_cast<double>(box.lo[0]), static_cast<double>(box.lo[1]),
                            static_cast<double>(box.lo[2])};
  const double per_metre = 1 / side_;
  const auto number = [&](float value, int axis) {
    return static_cast<std::uint64_t>(
        static_cast<std::int64_t>((static_cast<double>(value) - origin[axis]) * per_metre));
  };
  items_.resize(returns.size());
  for (std::size_t i = 0; i < returns.size(); ++i) {
    const lisco::Return& p = returns[i];
    const std::uint64_t row = number(p.z, 2) * rows_per_z_ + number(p.y, 1);
    items_[i] = (row << x_bits_ | number(p.x, 0)) << number_bits_ | i;
  }
}

void VoxelGrid::sortItems() {
  constexpr int kMaxDigitBits = 11;
  constexpr int kMaxDigits = (64 + kMaxDigitBits - 1) / kMaxDigitBits;
  const int bits = all_bits_ - number_bits_;
  const int digits = (bits + kMaxDigitBits - 1) / kMaxDigitBits;
  if (digits == 0) return;
  const int digit_bits = (bits + digits - 1) / digits;
  const Item mask = (Item{1} << digit_bits) - 1;
  std::array<std::array<std::uint32_t, std::size_t{1} << kMaxDigitBits>, kMaxDigits> places;
  for (int digit = 0; digit < digits; ++digit)
    std::fill_n(places[static_cast<std::size_t>(digit)].begin(), mask + 1, 0);
  for (const Item item : items_) {
    Item rest = item >> number_bits_;
    for (int digit = 0; digit < digits; ++digit, rest >>= digit_bits)
      ++places[static_cast<std::size_t>(digit)][rest & mask];
  }
  sorted_.resize(items_.size());
  for (int digit = 0; digit < digits; ++digit) {
    auto& place = places[static_cast<std::size_t>(digit)];
    std::uint32_t sum = 0;
    for (Item value = 0; value <= mask; ++value) {
      const std::uint32_t count = place[value];
      place[value] = sum;
      sum += count;
    }
    const int shift = number_bits_ + digit * digit_bits;
    for (const Item item : items_) sorted_[place[item >> shift & mask]++] = item;
    items_.swap(sorted_);
  }
}

void VoxelGrid::gatherCells(const std::vector<lisco::Return>& returns) {
  const std::size_t count = items_.size();
  const Item number_mask = (Item{1} << number_bits_) - 1;
  points_.resize(count);
  keys_.resize(count + 1);
  cells_.resize(count + 1);
  rows_.clear();
  components_.reserve(count);
  std::uint32_t cells = 0;
  for (std::size_t i = 0; i < count;) {
    const std::uint64_t key = items_[i] >> number_bits_;
    if (rows_.empty() || key >> x_bits_ != rows_.back().number) rows_.push_back({key >> x_bits_, cells});
    const lisco::Return& head = returns[items_[i] & number_mask];
    const auto first = static_cast<std::uint32_t>(i);
    auto box = lisco::Box::around(head.x, head.y, head.z);
    points_[i] = {head.x, head.y, head.z};
    while (++i < count && items_[i] >> number_bits_ == key) {
      const lisco::Return& p = returns[items_[i] & number_mask];
      points_[i] = {p.x, p.y, p.z};
      box.add(lisco::Box::around(p.x, p.y, p.z));
    }
    keys_[cells] = key;
    cells_[cells] = {first, box};
    components_.create(cells++);
  }
  rows_.push_back({kNone, cells});
  keys_[cells] = kNone;
  cells_[cells] = {static_cast<std::uint32_t>(count), {}};
  cells_.resize(cells + 1);
}

void VoxelGrid::linkRows() {
  const Row* const rows = rows_.data();
  std::array<std::size_t, kReach> cursor{};
  for (std::size_t r = 0; r + 1 < rows_.size(); ++r) {
    linkWithin(rows[r]);
    for (std::size_t n = r + 1; rows[n].number <= rows[r].number + kReach; ++n) linkAcross(rows[r], rows[n]);
    for (std::size_t z = 0; z < kReach; ++z) {
      const std::uint64_t number = rows[r].number + (z + 1) * rows_per_z_;
      std::size_t n = cursor[z];
      while (rows[n].number + kReach < number) ++n;
      cursor[z] = n;
      for (; rows[n].number <= number + kReach; ++n) linkAcross(rows[r], rows[n]);
    }
  }
}

void VoxelGrid::linkWithin(const Row& row) {
  const std::uint64_t* const keys = keys_.data();
  const std::uint32_t end = (&row)[1].first;
  for (std::uint32_t c = row.first; c < end; ++c) {
    std::uint32_t root = components_.find(c);
    for (std::uint32_t n = c + 1; keys[n] <= keys[c] + kReach; ++n) root = link(c, root, n);
  }
}

void VoxelGrid::linkAcross(const Row& row, const Row& later) {
  const std::uint64_t* const keys = keys_.data();
  const std::uint32_t end = (&row)[1].first;
  const std::uint64_t ahead = (later.number - row.number) << x_bits_;
  std::uint32_t from = later.first;
  for (std::uint32_t c = row.first; c < end; ++c) {
    const std::uint64_t key = keys[c] + ahead;
    while (keys[from] + kReach < key) ++from;
    if (keys[from] > key + kReach) continue;
    std::uint32_t root = components_.find(c);
    std::uint32_t n = from;
    do root = link(c, root, n);
    while (keys[++n] <= key + kReach);
  }
}

std::uint32_t VoxelGrid::link(std::uint32_t a, std::uint32_t root_a, std::uint32_t b) {
  const std::uint32_t root_b = components_.find(b);
  if (root_a == root_b || !touch(a, b)) return root_a;
  return components_.merge(root_a, root_b);
}

bool VoxelGrid::touch(std::uint32_t a, std::uint32_t b) const {
  const float r2 = tolerance_.squared();
  const lisco::Box& box = cells_[b].box;
  if (!(lisco::Box::squaredGap(cells_[a].box, box) < r2)) return false;
  const std::uint32_t a_end = cells_[a + 1].first;
  const std::uint32_t b_end = cells_[b + 1].first;
  if (a_end - cells_[a].first == 1 && b_end - cells_[b].first == 1) return true;  // the boxes are the points
  for (std::uint32_t i = cells_[a].first; i < a_end; ++i) {
    const Point& p = points_[i];
    if (!(lisco::Box::squaredGap(lisco::Box::around(p.x, p.y, p.z), box) < r2)) continue;
    for (std::uint32_t j = cells_[b].first; j < b_end; ++j)
      if (lisco::squaredDistance(p.x - points_[j].x, p.y - points_[j].y, p.z - points_[j].z) < r2) return true;
  }
  return false;
}

}  // namespace lisco_reference
