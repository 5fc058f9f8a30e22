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
#include "core/near/neighbourhood.h"
#include "core/neighbour.h"
#include "core/ring_block.h"

namespace lisco {

/// Voxels for near returns, which are seen under so wide a mask that angles do not narrow the search, and for clouds
/// that were not seen from one place.
///
/// A voxel is so small (eps / sqrt (3)) that its returns belong together: a thousand near returns are a handful of
/// voxels. 4 x 4 x 4 voxels are a *brick*: one bit of a word for each voxel in use, so that the voxels around one come
/// from a few words. So do the bricks around one: 4 x 4 x 4 of them are a *group*, found by a hash table. The returns
/// of a run in a voxel are a *fragment*; fragments of a voxel that are all neighbours are a *clique*, nearly always all
/// of the voxel.
struct VoxelGrid {
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};
  static constexpr std::uint32_t kBrickMask = (std::uint32_t{1} << 30) - 1;
  static constexpr std::uint32_t kGroupMask = (std::uint32_t{1} << 28) - 1;
  using Key = std::array<std::uint32_t, 3>;  ///< numbers of a voxel, brick or group along the axes

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
  /// A value for each of 64 places in use, side by side in an array of many lists, in the order of the places.
  struct SparseList {
    std::uint64_t used = 0;      ///< bit i: place i
    std::uint32_t begin = 0;     ///< of the list
    std::uint32_t capacity = 0;  ///< of the list

    bool has(std::uint32_t place) const { return (used >> place & 1U) != 0; }
    std::size_t indexOf(std::uint32_t place) const { return begin + countBits(used & ~bitsFrom(place)); }
    /// Adds a place that is not in use. The list moves to the end of the array when it outgrows its capacity.
    /// \return its index
    std::size_t add(std::uint32_t place, std::uint32_t value, std::vector<std::uint32_t>& lists);
  };
  struct Brick {
    Key key;
    std::uint32_t root;  ///< common to all its cliques when they were last linked, perhaps outdated; kNone: several
    SparseList voxels;   ///< of their first cliques
    bool is_new;         ///< holds new cliques
    bool is_linked;      ///< some of its cliques were linked
  };
  struct Group {
    Key key;
    SparseList bricks;  ///< of their numbers
  };
  /// A brick among the 27 around one.
  struct NearBrick {
    std::size_t mask;  ///< which of the 27
    SparseList voxels;
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

  /// Calls visit(i, number) for each brick around one, itself included; i says which of the 27.
  template <typename Visit>
  void forEachBrickAround(const Key& key, Visit&& visit) const;

  /// Calls visit(voxel, clique) for all cliques of a brick.
  template <typename Visit>
  void forEachClique(const Brick& brick, Visit&& visit) const {
    std::uint32_t rank = 0;
    for (std::uint64_t left = brick.voxels.used; left != 0; left &= left - 1, ++rank)
      for (std::uint32_t clique = first_cliques[brick.voxels.begin + rank]; clique != kNone;
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
  std::vector<std::uint32_t> first_cliques;  ///< of the voxels of each brick
  std::vector<std::uint32_t> new_bricks;     ///< in the order in which they became new, some perhaps again
  std::size_t linked_bricks = 0;             ///< how many of these, the first ones, are linked
  BloomFilter filter;
  bool all_in_float_range = true;  ///< all voxels were numbered in float: their numbers do not wrap

 private:
  /// The clique of a voxel that the latest fragment went to.
  struct RecentClique {
    Key voxel{};
    std::uint32_t clique = kNone;
  };
  static constexpr std::size_t kRecentCliques = 1024;
  /// Of the hash table of groups. The hash rules out nearly all other groups without reading them.
  struct Slot {
    std::uint32_t hash = 0;
    std::uint32_t group = kNone;
  };

  /// The brick of a voxel, or the group of a brick.
  static Key containerOf(const Key& key) { return {key[0] >> 2, key[1] >> 2, key[2] >> 2}; }
  /// Its place there, as in Neighbourhood.
  static std::uint32_t placeOf(const Key& key) { return (key[0] & 3U) | (key[1] & 3U) << 2 | (key[2] & 3U) << 4; }
  static bool areEqual(const Key& a, const Key& b) { return ((a[0] ^ b[0]) | (a[1] ^ b[1]) | (a[2] ^ b[2])) == 0; }
  static std::uint32_t hashOf(const Key& key) {
    // Teschner et al. 2003, with a final mix so that flat scenes use the whole table.
    const std::uint32_t hash = key[0] * 73856093U ^ key[1] * 19349663U ^ key[2] * 83492791U;
    return hash ^ hash >> 15;
  }
  std::uint32_t findGroup(const Key& key) const;
  Group& makeGroup(const Key& key);
  std::uint32_t makeBrick(const Key& key);
  void rehash(std::size_t count);
  void takeSlot(std::uint32_t group);
  std::uint32_t& firstClique(Brick& brick, std::uint32_t voxel);
  void addFragment(const Key& voxel, const Box& box, std::uint32_t fragment, std::uint32_t element,
                   DisjointSets& subclusters);
  void addTo(Clique& clique, const Box& box, std::uint32_t fragment, std::uint32_t element, DisjointSets& subclusters);
  std::size_t newPoints(std::size_t count);

  double voxels_per_metre_ = 1;
  bool in_float_range_ = false;  ///< voxels may be numbered in float
  std::size_t points_ = 0;
  std::vector<Slot> slots_;
  std::vector<Group> groups_;
  std::vector<std::uint32_t> group_bricks_;   ///< numbers of the bricks of each group
  std::vector<RecentClique> recent_cliques_;  ///< by the hash of the voxel; none before the first
};

/// The number of a group, kNone if there is none.
inline std::uint32_t VoxelGrid::findGroup(const Key& key) const {
  const std::size_t mask = slots_.size() - 1;
  const std::uint32_t hash = hashOf(key);
  for (std::size_t i = hash & mask;; i = (i + 1) & mask) {
    const Slot& slot = slots_[i];
    if (slot.group == kNone || (slot.hash == hash && areEqual(groups_[slot.group].key, key))) return slot.group;
  }
}

template <typename Visit>
void VoxelGrid::forEachBrickAround(const Key& key, Visit&& visit) const {
  const Key at{key[0] & 3U, key[1] & 3U, key[2] & 3U};
  const std::uint32_t place = placeOf(key);
  const Key own = containerOf(key);
  // Along each axis, the bricks around lie in the group before the own one (0), in it (1), and in the next one (2).
  const auto firstOf = [](std::uint32_t number) { return number == 0 ? 0U : 1U; };
  const auto lastOf = [](std::uint32_t number) { return number == 3 ? 2U : 1U; };
  for (std::uint32_t gz = firstOf(at[2]); gz <= lastOf(at[2]); ++gz)
    for (std::uint32_t gy = firstOf(at[1]); gy <= lastOf(at[1]); ++gy)
      for (std::uint32_t gx = firstOf(at[0]); gx <= lastOf(at[0]); ++gx) {
        const std::uint32_t number =
            findGroup({(own[0] + gx - 1) & kGroupMask, (own[1] + gy - 1) & kGroupMask, (own[2] + gz - 1) & kGroupMask});
        if (number == kNone) continue;
        const SparseList& in_group = groups_[number].bricks;
        for (std::uint64_t left = in_group.used & kBrickNeighbourhood.of[place][gz * 9 + gy * 3 + gx]; left != 0;
             left &= left - 1) {
          const auto other = static_cast<std::uint32_t>(__builtin_ctzll(left));
          // By how much numbers along an axis exceed those of the first of the 27.
          const std::uint32_t dx = 4 * gx + (other & 3U) - at[0] - 3;
          const std::uint32_t dy = 4 * gy + (other >> 2 & 3U) - at[1] - 3;
          const std::uint32_t dz = 4 * gz + (other >> 4) - at[2] - 3;
          visit(std::size_t{dz * 9 + dy * 3 + dx}, group_bricks_[in_group.indexOf(other)]);
        }
      }
}

}  // namespace lisco
