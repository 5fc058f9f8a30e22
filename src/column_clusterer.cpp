// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "lisco/column_clusterer.h"

#include <array>
#include <limits>

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
  ViewHints hints = parameters.view;
  if (parameters.mask != Parameters::Mask::kView) hints.steps_per_turn = 0;
  strip_.prepare(tolerance_, hints);
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
  column_ = 0;
  runs_.clear();
  pieces_.clear();
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
  if (strip_.inUse()) strip_.linkAll(mergeRuns, this);
  young_patch_ = end;
  young_columns_ = 0;
}

/// Reads a block of columns row by row into runs and patches, then closes the patches that are no longer young.
void ColumnClusterer::clusterBlock() {
  std::visit(
      [&](const auto& mask) {
        for (std::size_t laser = 0; laser < staged_.size(); ++laser) {
          if (staged_[laser].count > 0) readRow(mask, staged_[laser], laser);
          staged_[laser].count = 0;
        }
        if (strip_.inUse()) strip_.link(mergeRuns, this);
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

/// Chains the returns of one laser into runs: each a neighbour of the one before. Far ones go to their places in the
/// strip, all others, and some far ones that others must find, into patches.
template <typename Mask>
void ColumnClusterer::readRow(const Mask& mask, const StagedRow& row, std::size_t laser) {
  const auto first_return = static_cast<std::uint32_t>(returnCount());
  x_.insert(x_.end(), row.x, row.x + row.count);
  y_.insert(y_.end(), row.y, row.y + row.count);
  z_.insert(z_.end(), row.z, row.z + row.count);
  source_index_.insert(source_index_.end(), row.source_index, row.source_index + row.count);

  std::array<float, kMostBlockColumns> step;  // squared, from the return before
  step[0] = std::numeric_limits<float>::infinity();
  for (std::size_t i = 1; i < row.count; ++i)
    step[i] = squaredDistance(row.x[i] - row.x[i - 1], row.y[i] - row.y[i - 1], row.z[i] - row.z[i - 1]);
  std::array<std::uint32_t, kMostBlockColumns> run;
  const float squared_tolerance = tolerance_.squared();
  for (std::size_t i = 0; i < row.count;) {
    const std::size_t begin = i;
    const auto number = static_cast<std::uint32_t>(runs_.size());
    do run[i++] = number;
    while (i < row.count && step[i] < squared_tolerance);
    runs_.push_back({first_return + static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(i - begin)});
    subclusters_.create(static_cast<std::uint32_t>(i - begin));
  }

  std::uint64_t wanted = ~std::uint64_t{0};
  if (strip_.inUse()) {
    std::array<float, kMostBlockColumns> rho;
    const ViewStrip::Row far{laser, row.count, row.x, row.y, row.z, row.column, run.data()};
    strip_.horizontalDistances(far, rho.data());
    wanted = strip_.place(far, rho.data());
    for (std::size_t i = 0; i < row.count; ++i) wanted |= static_cast<std::uint64_t>(!strip_.amongFar(rho[i])) << i;
  }
  if (wanted != 0) cutIntoPieces(mask, row, first_return, run.data(), wanted);
}

/// Cuts runs where they pass from one tile to the next, and puts the pieces of wanted returns into patches.
/// \param run the number of each return's run
/// \param wanted bit i: return i
template <typename Mask>
void ColumnClusterer::cutIntoPieces(const Mask& mask, const StagedRow& row, std::uint32_t first_return,
                                    const std::uint32_t* run, std::uint64_t wanted) {
  std::array<std::uint32_t, kMostBlockColumns> tiles;
  mask.tilesOf(row.x, row.y, row.z, row.count, tiles.data());
  const auto isWanted = [wanted](std::size_t i) { return (wanted >> i & 1U) != 0; };
  for (std::size_t i = 0; i < row.count;) {
    const std::size_t begin = i++;
    if (!isWanted(begin)) continue;
    Box box = Box::around(row.x[begin], row.y[begin], row.z[begin]);
    for (; i < row.count && isWanted(i) && tiles[i] == tiles[begin] && run[i] == run[begin]; ++i)
      box.add(Box::around(row.x[i], row.y[i], row.z[i]));
    pieces_.push_back({box, first_return + static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(i - begin),
                       kNone, run[begin]});
    placePiece(static_cast<std::uint32_t>(pieces_.size() - 1), tiles[begin]);
  }
}

/// Adds a piece to an open patch of its tile that it touches, or starts a patch with it. Not every patch is
/// tried, and of a patch only its latest piece: what is missed here is found when the patches close.
void ColumnClusterer::placePiece(std::uint32_t piece_number, std::uint32_t tile) {
  constexpr int kMostTried = 4;
  Piece& piece = pieces_[piece_number];
  const std::uint32_t newest = unstamped(tiles_[tile].newest_open);
  std::uint32_t candidate = newest;
  for (int tried = 0; tried < kMostTried && candidate != kNone && candidate >= first_open_patch_; ++tried) {
    Patch& patch = patches_[candidate];
    if (Box::squaredSpan(patch.box, piece.box) < tolerance_.squared() || neighbours(piece, pieces_[patch.last_piece])) {
      patch.box.add(piece.box);
      pieces_[patch.last_piece].next_in_patch = piece_number;
      patch.last_piece = piece_number;
      mergeRuns(this, patch.run, piece.run);
      return;
    }
    candidate = patch.next_in_tile;
  }
  patches_.push_back({piece.box, newest, tile, piece_number, piece_number, piece.run});
  tiles_[tile].newest_open = static_cast<std::uint32_t>(patches_.size() - 1) + stamp_;
}

/// Joins the subclusters of two runs. \return the head that they have now
std::uint32_t ColumnClusterer::mergeRuns(void* clusterer, std::uint32_t a, std::uint32_t b) {
  DisjointSets& subclusters = static_cast<ColumnClusterer*>(clusterer)->subclusters_;
  const std::uint32_t head_a = subclusters.head(a);
  const std::uint32_t head_b = subclusters.head(b);
  return head_a == head_b ? head_a : subclusters.merge(head_a, head_b);
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
  std::uint32_t head = subclusters_.head(patch.run);
  mask.forEachTile(box, [&](std::uint32_t tile) {
    for (std::uint32_t s = unstamped(tiles_[tile].newest_shelf); s != kNone; s = shelves_[s].next_in_tile) {
      const Shelf& shelf = shelves_[s];
      comparisons_ += Shelf::kPlaces;
      std::uint32_t near = shelf.placesNear(box, squared_tolerance);
      for (std::uint32_t place = 0; near != 0; ++place, near >>= 1) {
        if ((near & 1U) == 0) continue;
        const Patch& other = patches_[shelf.patch[place]];
        const std::uint32_t other_head = subclusters_.head(other.run);
        if (other_head != head && neighbours(patch, other)) head = subclusters_.merge(head, other_head);
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
  for (std::uint32_t i = a.first_piece; i != kNone; i = pieces_[i].next_in_patch) {
    if (!(Box::squaredGap(pieces_[i].box, b.box) < squared_tolerance)) continue;
    for (std::uint32_t j = b.first_piece; j != kNone; j = pieces_[j].next_in_patch)
      if (neighbours(pieces_[i], pieces_[j])) return true;
  }
  return false;
}

/// Whether any return of one piece is a neighbour of any return of the other.
bool ColumnClusterer::neighbours(const Piece& a, const Piece& b) const {
  const float squared_tolerance = tolerance_.squared();
  if (!(Box::squaredGap(a.box, b.box) < squared_tolerance)) return false;
  for (std::uint32_t i = a.first_return; i < a.first_return + a.count; ++i) {
    if (!(Box::squaredGap(Box::around(x_[i], y_[i], z_[i]), b.box) < squared_tolerance)) continue;
    bool any = false;
    for (std::uint32_t j = b.first_return; j < b.first_return + b.count; ++j)
      any |= squaredDistance(x_[i] - x_[j], y_[i] - y_[j], z_[i] - z_[j]) < squared_tolerance;
    if (any) return true;
  }
  return false;
}

}  // namespace lisco
