// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "lisco/column_clusterer.h"

#include <array>

namespace lisco {

ColumnClusterer::ColumnClusterer() {
  Parameters lightest;
  lightest.mask = Parameters::Mask::kGrid;
  lightest.expected_returns = 0;
  begin(lightest);
}

void ColumnClusterer::begin(const Parameters& parameters) {
  parameters_ = parameters;
  parameters_.block_columns = std::clamp<std::size_t>(parameters.block_columns, 1, kMostBlockColumns);
  tolerance_ = Tolerance(parameters.tolerance);
  if (parameters.mask == Parameters::Mask::kView) {
    if (!std::holds_alternative<ViewMask>(mask_)) mask_.emplace<ViewMask>();
    std::get<ViewMask>(mask_).prepare(tolerance_, parameters.view, parameters.expected_returns);
  } else {
    if (!std::holds_alternative<GridMask>(mask_)) mask_.emplace<GridMask>();
    std::get<GridMask>(mask_).prepare(tolerance_, parameters.expected_returns);
  }
  const std::size_t tiles = std::visit([](const auto& mask) { return mask.tileCount(); }, mask_);
  // Every number of the last rotation lies below stamp + returns + 1, and no rotation has 2^31 returns.
  stamp_ += static_cast<std::uint32_t>(returnCount()) + 1;
  if (stamp_ >= std::uint32_t{1} << 31) {
    tiles_.clear();
    stamp_ = 1;
  }
  if (tiles_.size() < tiles) tiles_.resize(tiles);

  for (StagedRow& row : staged_) row.count = 0;
  staged_columns_ = 0;
  for (auto* coordinate : {&x_, &y_, &z_}) {
    coordinate->clear();
    coordinate->reserve(parameters.expected_returns);
  }
  source_index_.clear();
  source_index_.reserve(parameters.expected_returns);
  runs_.clear();
  patches_.clear();
  shelves_.clear();
  subclusters_.clear();
  first_open_patch_ = 0;
  young_patch_ = 0;
  young_columns_ = 0;
  comparisons_ = 0;
}

void ColumnClusterer::update() {
  if (staged_columns_ > 0) clusterBlock();
  const auto end = static_cast<std::uint32_t>(patches_.size());
  std::visit([&](const auto& mask) { closePatches(mask, end); }, mask_);
  young_patch_ = end;
  young_columns_ = 0;
}

/// Reads a block of columns row by row into runs and patches, then closes the patches that are no longer young.
void ColumnClusterer::clusterBlock() {
  std::visit(
      [&](const auto& mask) {
        for (StagedRow& row : staged_) {
          if (row.count > 0) readRow(mask, row);
          row.count = 0;
        }
        young_columns_ += staged_columns_;
        if (young_columns_ >= parameters_.open_columns) {
          closePatches(mask, young_patch_);
          young_patch_ = static_cast<std::uint32_t>(patches_.size());
          young_columns_ = 0;
        }
      },
      mask_);
  staged_columns_ = 0;
}

/// Cuts the returns of one laser into runs: neighbours in turn, all in the same tile.
template <typename Mask>
void ColumnClusterer::readRow(const Mask& mask, const StagedRow& row) {
  const auto first_return = static_cast<std::uint32_t>(returnCount());
  x_.insert(x_.end(), row.x, row.x + row.count);
  y_.insert(y_.end(), row.y, row.y + row.count);
  z_.insert(z_.end(), row.z, row.z + row.count);
  source_index_.insert(source_index_.end(), row.source_index, row.source_index + row.count);

  std::array<std::uint32_t, kMostBlockColumns> tiles;
  mask.tilesOf(row.x, row.y, row.z, row.count, tiles.data());

  const float squared_tolerance = tolerance_.squared();
  for (std::size_t i = 0; i < row.count;) {
    const std::size_t begin = i;
    Box box = Box::around(row.x[i], row.y[i], row.z[i]);
    for (++i; i < row.count && tiles[i] == tiles[begin]; ++i) {
      const float d2 = squaredDistance(row.x[i] - row.x[i - 1], row.y[i] - row.y[i - 1], row.z[i] - row.z[i - 1]);
      if (!(d2 < squared_tolerance)) break;
      box.add(Box::around(row.x[i], row.y[i], row.z[i]));
    }
    runs_.push_back(
        {box, first_return + static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(i - begin), kNone, kNone});
    placeRun(static_cast<std::uint32_t>(runs_.size() - 1), tiles[begin]);
  }
}

/// Adds a run to an open patch of its tile that it touches, or starts a patch with it. Not every patch is
/// tried, and of a patch only its latest run: what is missed here is found when the patches close.
void ColumnClusterer::placeRun(std::uint32_t run_number, std::uint32_t tile) {
  constexpr int kMostTried = 4;
  Run& run = runs_[run_number];
  const std::uint32_t newest = unstamped(tiles_[tile].newest_open);
  std::uint32_t candidate = newest;
  for (int tried = 0; tried < kMostTried && candidate != kNone && candidate >= first_open_patch_; ++tried) {
    Patch& patch = patches_[candidate];
    if (Box::squaredSpan(patch.box, run.box) < tolerance_.squared() || neighbours(run, runs_[patch.last_run])) {
      patch.box.add(run.box);
      runs_[patch.last_run].next_in_patch = run_number;
      patch.last_run = run_number;
      run.patch = candidate;
      subclusters_.grow(candidate, run.count);
      return;
    }
    candidate = patch.next_in_tile;
  }
  run.patch = static_cast<std::uint32_t>(patches_.size());
  patches_.push_back({run.box, newest, tile, run_number, run_number});
  tiles_[tile].newest_open = run.patch + stamp_;
  subclusters_.create(run.count);
}

template <typename Mask>
void ColumnClusterer::closePatches(const Mask& mask, std::uint32_t end) {
  if (tolerance_.joinsAnything())
    for (std::uint32_t patch = first_open_patch_; patch < end; ++patch) {
      cluster(mask, patch);
      shelve(patch);
    }
  first_open_patch_ = std::max(first_open_patch_, end);
}

/// Algorithm 4 of the paper for a whole patch: merges its subcluster with that of every older patch within
/// its mask that holds a neighbour of one of its returns.
template <typename Mask>
void ColumnClusterer::cluster(const Mask& mask, std::uint32_t patch_number) {
  const Patch& patch = patches_[patch_number];
  const Box& box = patch.box;
  const float squared_tolerance = tolerance_.squared();
  std::uint32_t head = subclusters_.head(patch_number);
  mask.forEachTile(box, [&](std::uint32_t tile) {
    for (std::uint32_t s = unstamped(tiles_[tile].newest_shelf); s != kNone; s = shelves_[s].next_in_tile) {
      const Shelf& shelf = shelves_[s];
      comparisons_ += Shelf::kPlaces;
      std::uint32_t near = shelf.placesNear(box, squared_tolerance);
      for (std::uint32_t place = 0; near != 0; ++place, near >>= 1) {
        if ((near & 1U) == 0) continue;
        const std::uint32_t other_head = subclusters_.head(shelf.patch[place]);
        if (other_head != head && neighbours(patch, patches_[shelf.patch[place]]))
          head = subclusters_.merge(head, other_head);
      }
    }
  });
}

/// Puts a closed patch where later patches look for it.
void ColumnClusterer::shelve(std::uint32_t patch_number) {
  const Patch& patch = patches_[patch_number];
  const std::uint32_t newest = unstamped(tiles_[patch.tile].newest_shelf);
  if (newest != kNone && !shelves_[newest].full()) {
    shelves_[newest].add(patch_number, patch.box);
    return;
  }
  tiles_[patch.tile].newest_shelf = static_cast<std::uint32_t>(shelves_.size()) + stamp_;
  shelves_.push_back(Shelf::empty(newest));
  shelves_.back().add(patch_number, patch.box);
}

/// Whether any return of one patch is a neighbour of any return of the other.
bool ColumnClusterer::neighbours(const Patch& a, const Patch& b) const {
  const float squared_tolerance = tolerance_.squared();
  if (Box::squaredSpan(a.box, b.box) < squared_tolerance) return true;
  for (std::uint32_t i = a.first_run; i != kNone; i = runs_[i].next_in_patch) {
    if (!(Box::squaredGap(runs_[i].box, b.box) < squared_tolerance)) continue;
    for (std::uint32_t j = b.first_run; j != kNone; j = runs_[j].next_in_patch)
      if (neighbours(runs_[i], runs_[j])) return true;
  }
  return false;
}

/// Whether any return of one run is a neighbour of any return of the other.
bool ColumnClusterer::neighbours(const Run& a, const Run& b) const {
  const float squared_tolerance = tolerance_.squared();
  if (!(Box::squaredGap(a.box, b.box) < squared_tolerance)) return false;
  for (std::uint32_t i = a.first_return; i < a.first_return + a.count; ++i) {
    bool any = false;
    for (std::uint32_t j = b.first_return; j < b.first_return + b.count; ++j)
      any |= squaredDistance(x_[i] - x_[j], y_[i] - y_[j], z_[i] - z_[j]) < squared_tolerance;
    if (any) return true;
  }
  return false;
}

}  // namespace lisco
