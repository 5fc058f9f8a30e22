// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lisco/box.h"
#include "lisco/disjoint_sets.h"
#include "lisco/export.h"
#include "lisco/row.h"
#include "lisco/tolerance.h"

namespace lisco {

/// Cubes of space for returns that have no place in a view: those near the sensor, seen under so wide a mask that
/// angles tell nothing, and all those of a cloud that no single place has seen.
///
/// A cube is so small (eps / sqrt (3)) that what lies in it belongs together, so a thousand near returns are a handful of
/// cubes. 4 x 4 x 4 cubes are a block: one bit of a word for each cube in use, so that the cubes around one come from a
/// few words. What a run has in a cube is a *piece*.
class LISCO_EXPORT Voxels {
 public:
  /// Starts a rotation. Keeps its memory.
  void prepare(const Tolerance& tolerance);

  /// Takes some returns of a row.
  /// \param which bit i: return i
  void add(const Row& row, const MeasuredRow& measured, std::uint64_t which, DisjointSets& subclusters);

  /// Compares what is new with everything.
  void link(DisjointSets& subclusters);
  /// From now on, only what comes is new.
  void settle();

  /// What is to be done with neighbours in different voxels.
  class Joiner {
   public:
    virtual ~Joiner() = default;
    /// Whether anything in a box of one's own may have neighbours among the others.
    virtual bool reaches(const Box& /*own*/) const { return true; }
    /// Whether anybody wants to know if two elements are neighbours. They are those of add () or others of their sets.
    virtual bool areApart(std::uint32_t own, std::uint32_t others) = 0;
    /// They are.
    virtual void join(std::uint32_t own, std::uint32_t others) = 0;
  };
  enum class Part { kAll, kNew };
  /// Compares a part of these, which are linked, with all of another one's, both of the same tolerance.
  void linkTo(Voxels& other, Part part, Joiner& joiner);

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  using Key = std::array<std::uint32_t, 3>;

  /// Where there may be blocks, seen from above: a bit for four of them side by side. Others may have the same bit.
  class Footprint {
   public:
    void clear() { bits_.fill(0); }
    void add(const Key& block) { bits_[wordOf(block[0] / 2, block[1] / 2)] |= bitOf(block[0] / 2, block[1] / 2); }
    /// Whether there may be a block around this place, or there.
    bool isNear(const Key& block) const;

   private:
    static constexpr std::size_t kWords = 256;
    static std::uint32_t hashOf(std::uint32_t x, std::uint32_t y) { return x * 73856093U ^ y * 19349663U; }
    static std::size_t wordOf(std::uint32_t x, std::uint32_t y) { return hashOf(x, y) >> 6 & (kWords - 1); }
    static std::uint64_t bitOf(std::uint32_t x, std::uint32_t y) { return std::uint64_t{1} << (hashOf(x, y) & 63U); }

    std::array<std::uint64_t, kWords> bits_{};
  };

  struct Piece {
    std::uint32_t first_point;
    std::uint32_t count;
    std::uint32_t next_in_unit;
  };
  /// Pieces of one cube that are neighbours all of them; nearly always all of the cube.
  struct Unit {
    Box box;
    std::uint32_t head;         ///< of its subcluster, perhaps not the newest
    std::uint32_t first_piece;  ///< the newest
    std::uint32_t next_in_cube;
    bool is_new;  ///< something in it has not been compared yet
  };
  struct Block {
    Key key;
    std::uint32_t units;  ///< where the list of its cubes' first units begins
    std::uint32_t room;   ///< of that list
    std::uint32_t
        head;  ///< that all its units had when they were last linked, perhaps not the newest; or kNone: several
    std::uint64_t occupied;  ///< bit i: cube i
    bool is_new;
  };
  /// Where a cube's latest piece went.
  struct RecentUnit {
    Key cube;
    std::uint32_t unit;
  };
  static constexpr std::size_t kRecentUnits = 1024;
  /// A block next to another, or that one.
  struct NearBlock {
    std::size_t mask;  ///< which of the 27
    std::uint64_t occupied;
    std::uint32_t units;
  };
  struct Ordered {
    std::uint64_t number;  ///< by z, y and x
    std::uint32_t block;
  };

  std::uint32_t findBlock(const Key& key) const;
  std::uint32_t makeBlock(const Key& key);
  void rehash(std::size_t slots);
  void takeSlot(std::uint32_t block);
  std::uint32_t& firstUnit(Block& block, std::uint32_t cube);
  void addPiece(const Key& cube, const Box& box, std::uint32_t piece, std::uint32_t element, DisjointSets& subclusters);
  void addTo(Unit& unit, const Box& box, std::uint32_t piece, std::uint32_t element, DisjointSets& subclusters);
  void linkInOrder(DisjointSets& subclusters);
  void linkNew(const Block& block, DisjointSets& subclusters);
  template <typename Visit>
  void forEachUnit(const Block& block, Visit&& visit) const;
  std::uint32_t commonHead(const Block& block, DisjointSets& subclusters);
  void linkBlockTo(const Block& block, Voxels& other, Part part, Joiner& joiner);
  template <typename Wanted>
  std::size_t findNear(const Key& key, NearBlock* near, Wanted&& wanted) const;
  void linkBlock(const Block& block, const NearBlock* near, std::size_t count, DisjointSets& subclusters);
  template <typename Visit>
  void forEachAround(std::size_t cube, const NearBlock* near, std::size_t count, std::uint64_t of_own,
                     Visit&& visit) const;
  void compare(std::uint32_t a_number, std::uint32_t b_number, DisjointSets& subclusters);
  std::size_t newPoints(std::size_t count);
  void unite(Unit& unit);
  bool haveNeighbours(Unit& own, Voxels& other, Unit& others);

  Tolerance tolerance_;
  double cubes_per_metre_ = 1;
  bool safe_ = false;             ///< cubes may be numbered in float
  std::vector<float> x_, y_, z_;  ///< of all points, and some room
  std::size_t points_ = 0;
  std::vector<Piece> pieces_;
  std::vector<Unit> units_;
  std::vector<Block> blocks_;
  std::vector<std::uint32_t> first_units_;
  std::vector<std::uint32_t> slots_;  ///< hash table of blocks
  Footprint footprint_;
  std::array<RecentUnit, kRecentUnits> recent_units_{};  ///< by the hash of the cube
  std::vector<Ordered> ordered_;                         ///< blocks
  bool all_safe_ = true;                                 ///< all cubes were numbered in float
  std::vector<std::uint32_t> new_blocks_;                ///< that hold new units
  bool anything_linked_ = false;
};

}  // namespace lisco
