// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/bits.h"
#include "core/disjoint_sets.h"
#include "core/growing_array.h"
#include "core/neighbour.h"
#include "core/ring_block.h"

namespace lisco {

/// Voxels for near returns, which are seen under so wide a mask that angles do not narrow the search, and for clouds
/// that were not seen from one place.
///
/// A voxel is so small (eps / sqrt (3)) that its returns belong together: a thousand near returns are a handful of
/// voxels. 4 x 4 x 4 voxels are a *brick*: one bit of a word for each voxel in use, so that the voxels around one come
/// from a few words. The returns of a run in a voxel are a *fragment*; fragments of a voxel that are all neighbours are
/// a *clique*, nearly always all of the voxel.
struct VoxelGrid {
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  static constexpr std::uint32_t kBrickMask = (std::uint32_t{1} << 30) - 1;
  using Key = std::array<std::uint32_t, 3>;  ///< numbers of a voxel or brick along the axes

  struct Fragment {
    std::uint32_t first_point;
    std::uint32_t count;
    std::uint32_t next_in_clique;
  };
  enum class State : std::uint8_t {
    kNew,     ///< part of it is not linked yet
    kLinked,  ///< linked with the cliques of the grid
    kOld      ///< linked with those of other grids, too
  };
  struct Clique {
    Box box;
    std::uint32_t root;            ///< of its subcluster, perhaps outdated
    std::uint32_t first_fragment;  ///< the newest
    std::uint32_t next_in_voxel;
    State state;
  };
  struct Brick {
    Key key;
    std::uint32_t cliques;   ///< where the list of its voxels' first cliques begins
    std::uint32_t capacity;  ///< of that list
    std::uint32_t root;      ///< common to all its cliques when they were last linked, perhaps outdated; kNone: several
    std::uint64_t occupied;  ///< bit i: voxel i
    bool is_new;             ///< holds new cliques
    bool is_linked;          ///< some of its cliques were linked
  };
  /// A brick among the 27 around one.
  struct NearBrick {
    std::size_t mask;  ///< which of the 27
    std::uint64_t occupied;
    std::uint32_t cliques;
  };

  /// Which bricks there are, seen from above: a bit for two by two of them, shared by others of the same hash.
  class BloomFilter {
   public:
    void clear() { bits_.fill(0); }
    void add(const Key& brick) { bits_[wordOf(brick[0] / 2, brick[1] / 2)] |= bitOf(brick[0] / 2, brick[1] / 2); }
    /// False if there is no brick at this place or around it.
    bool mayHaveNear(const Key& brick) const;

   private:
    static constexpr std::size_t kWords = 256;
    static std::uint32_t hashOf(std::uint32_t x, std::uint32_t y) { return x * 73856093U ^ y * 19349663U; }
    static std::size_t wordOf(std::uint32_t x, std::uint32_t y) { return hashOf(x, y) >> 6 & (kWords - 1); }
    static std::uint64_t bitOf(std::uint32_t x, std::uint32_t y) { return std::uint64_t{1} << (hashOf(x, y) & 63U); }

    std::array<std::uint64_t, kWords> bits_{};
  };

  /// Starts a rotation. Keeps its memory.
  void prepare(const Tolerance& new_tolerance);

  /// Adds some returns of a ring block, after Runs::add.
  /// \param which bit i: return i
  void add(const RingBlock& block, const RingBlockInfo& info, ColumnBits which, DisjointSets& subclusters);

  /// The number of a brick, kNone if there is none.
  std::uint32_t findBrick(const Key& key) const;

  /// Calls visit(voxel, clique) for all cliques of a brick.
  template <typename Visit>
  void forEachClique(const Brick& brick, Visit&& visit) const {
    std::uint32_t rank = 0;
    for (std::uint64_t left = brick.occupied; left != 0; left &= left - 1, ++rank)
      for (std::uint32_t clique = first_cliques[brick.cliques + rank]; clique != kNone;
           clique = cliques[clique].next_in_voxel)
        visit(static_cast<std::size_t>(__builtin_ctzll(left)), clique);
  }

  /// Makes few fragments of the many that a clique may have, so that points lie side by side: the newest is joined with
  /// those that are not more than twice as large. Each of the others is then more than twice as large as the one
  /// before, and no point moves often.
  void compactFragments(Clique& clique);

  Tolerance tolerance;
  GrowingArray<float> x, y, z;  ///< of all points, longer than what is in use
  std::vector<Fragment> fragments;
  std::vector<Clique> cliques;
  std::vector<Brick> bricks;
  std::vector<std::uint32_t> first_cliques;
  std::vector<std::uint32_t> new_bricks;  ///< in the order in which they became new, some perhaps again
  std::size_t linked_bricks = 0;          ///< how many of these, the first ones, are linked
  BloomFilter filter;
  bool all_in_float_range = true;  ///< all voxels were numbered in float: their numbers do not wrap

 private:
  /// The clique of a voxel that the latest fragment went to.
  struct RecentClique {
    Key voxel;
    std::uint32_t clique;
  };
  static constexpr std::size_t kRecentCliques = 1024;
  /// Of the hash table of bricks. The hash rules out nearly all other bricks without reading them.
  struct Slot {
    std::uint32_t hash = 0;
    std::uint32_t brick = kNone;
  };

  std::uint32_t makeBrick(const Key& key);
  void rehash(std::size_t count);
  void takeSlot(std::uint32_t brick);
  std::uint32_t& firstClique(Brick& brick, std::uint32_t voxel);
  void addFragment(const Key& voxel, const Box& box, std::uint32_t fragment, std::uint32_t element,
                   DisjointSets& subclusters);
  void addTo(Clique& clique, const Box& box, std::uint32_t fragment, std::uint32_t element, DisjointSets& subclusters);
  std::size_t newPoints(std::size_t count);

  double voxels_per_metre_ = 1;
  bool in_float_range_ = false;  ///< voxels may be numbered in float
  std::size_t points_ = 0;
  std::vector<Slot> slots_;
  std::array<RecentClique, kRecentCliques> recent_cliques_{};  ///< by the hash of the voxel
};

}  // namespace lisco
