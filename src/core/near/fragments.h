// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/growing_array.h"
#include "core/near/near_returns.h"
#include "core/near/voxel_numbering.h"
#include "core/neighbour.h"

namespace lisco {

/// Near returns of several parts, numbered one part after the other, and their fragments. A fragment has the number of
/// its first return.
struct FragmentList {
  struct Part {
    const NearReturns* near;
    std::size_t first;  ///< number of its first return, a multiple of kBlock
  };
  /// Returns of a block, which are of one part and lie side by side in memory; a multiple of 64.
  static constexpr std::size_t kBlock = 1024;

  std::vector<Part> parts;                ///< those with returns
  std::vector<const NearReturn*> blocks;  ///< the first return of each: finds one by its number alone
  std::size_t end = 0;                    ///< above all numbers, a multiple of 64
  std::vector<std::uint64_t> starts;      ///< bit i: return i begins a fragment, or is the end of a part
  bool are_single = false;                ///< each return is a fragment, as in unordered clouds; starts are not in use

  void begin(bool single) {
    parts.clear();
    blocks.clear();
    end = 0;
    are_single = single;
  }
  /// \return the number of the part's first return
  std::size_t add(const NearReturns& near) {
    const std::size_t first = blocks.size() * kBlock;
    if (near.count == 0) return first;
    parts.push_back({&near, first});
    end = first + (near.count / 64 + 1) * 64;  // and one more behind the last
    reserveInSteps(blocks, blocks.size() + near.count / kBlock + 1);
    for (std::size_t i = 0; i <= near.count; i += kBlock) blocks.push_back(near.returns.data() + i);
    return first;
  }
  /// The first return of a fragment. Up to kReadBehind may be read behind its last.
  const NearReturn* returnsOf(std::size_t number) const { return blocks[number / kBlock] + number % kBlock; }
  /// The number of returns of the fragment that begins with a return; not of single ones.
  std::size_t sizeOf(std::size_t number) const { return endOf(number) - number; }
  /// The end of that fragment.
  std::size_t endOf(std::size_t number) const {
    std::size_t word = ++number / 64;
    std::uint64_t left = starts[word] >> number % 64;
    if (left != 0) return number + static_cast<std::size_t>(__builtin_ctzll(left));
    do left = starts[++word];
    while (left == 0);
    return 64 * word + static_cast<std::size_t>(__builtin_ctzll(left));
  }
};

/// Fragments for sorting: an item is the key of the fragment's voxel, and below it, in `number_bits`, its number.
struct FragmentItems {
  unsigned number_bits = 0;  ///< of an item: the lowest
  unsigned plane_shift = 0;  ///< of an item: the bits from this one on are the number of its plane of bricks
  GrowingArray<std::uint64_t> all;
  GrowingArray<std::uint64_t> scratch;  ///< for sorting
  std::vector<std::size_t> part_sizes;  ///< in fragments; those of a part begin at its first return's number

  std::uint64_t planeOf(std::uint64_t item) const { return item >> plane_shift; }
  /// Where the plane of bricks that holds sorted fragment i begins, and where it ends. The search stays behind `begin`
  /// and before `end`, which are between planes.
  std::size_t beginOfPlane(std::size_t i, std::size_t begin) const;
  std::size_t endOfPlane(std::size_t i, std::size_t end) const;
  std::uint64_t numberMask() const { return (std::uint64_t{1} << number_bits) - 1; }
};

/// The box around the returns of a part.
Box boxAround(const FragmentList::Part& part);

/// Cuts the returns of a part into fragments, whose items follow each other.
/// \param fragments receives the starts, unless they are single
/// \return number of fragments
std::size_t cutIntoFragments(const VoxelNumbering& numbering, const FragmentList::Part& part, FragmentList& fragments,
                             FragmentItems& items);

}  // namespace lisco
