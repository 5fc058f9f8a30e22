// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/near/fragments.h"

#include <algorithm>

#include "core/bits.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/near/fragments.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "core/near/returns_box-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lisco {
namespace HWY_NAMESPACE {

/// The box around some returns.
void boundReturns(const NearReturn* returns, std::size_t count, Box& box) {
  ReturnsBox around;
  around.add(returns, count);
  const BoxLanes lanes = around.box();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.lo[axis] = lanes.lo(axis);
    box.hi[axis] = lanes.hi(axis);
  }
}

constexpr std::size_t kBatch = 64;  // returns

/// The returns of a batch, by coordinates. \param size those behind count as the corner, so that their numbers fit
void loadBatch(const NearReturn* returns, std::size_t size, const VoxelNumbering& numbering,
               float (&coordinates)[3][kBatch], std::uint32_t* elements) {
  NearReturn padded[kBatch];
  if (size < kBatch) {
    std::copy_n(returns, size, padded);
    std::fill(padded + size, padded + kBatch,
              NearReturn{static_cast<float>(numbering.corner[0]), static_cast<float>(numbering.corner[1]),
                         static_cast<float>(numbering.corner[2]), 0});
    returns = padded;
  }
  static_assert(kBatch % kLanes == 0, "a batch is whole vectors");
  for (std::size_t i = 0; i < kBatch; i += kLanes) {
    FloatVector x;
    FloatVector y;
    FloatVector z;
    FloatVector element;
    hn::LoadInterleaved4(kFloats, &returns[i].x, x, y, z, element);
    hn::StoreU(x, kFloats, &coordinates[0][i]);
    hn::StoreU(y, kFloats, &coordinates[1][i]);
    hn::StoreU(z, kFloats, &coordinates[2][i]);
    hn::StoreU(hn::BitCast(kWords, element), kWords, &elements[i]);
  }
}

/// The keys of a batch.
void keysOf(const VoxelNumbering& numbering, const float (&coordinates)[3][kBatch], std::uint64_t* keys) {
  constexpr hn::CappedTag<double, 8> kDoubles;
  const hn::Rebind<float, decltype(kDoubles)> half_floats;
  const hn::Rebind<std::int32_t, decltype(kDoubles)> half_integers;
  const hn::Rebind<std::uint32_t, decltype(kDoubles)> half_words;
  const hn::Rebind<std::uint64_t, decltype(kDoubles)> words;
  const unsigned voxel_shifts[3] = {0, numbering.voxel_bits[0], numbering.voxel_bits[0] + numbering.voxel_bits[1]};
  const unsigned brick_shifts[3] = {6, 6 + numbering.minor_bits, 6 + numbering.minor_bits + numbering.middle_bits};
  for (std::size_t i = 0; i < kBatch; i += hn::MaxLanes(kDoubles)) {
    auto key = hn::Zero(words);
    for (int along = 0; along < 3; ++along) {
      const std::size_t axis = numbering.axis[along];
      const auto coordinate = hn::PromoteTo(kDoubles, hn::LoadU(half_floats, &coordinates[axis][i]));
      const auto scaled = hn::Mul(hn::Sub(coordinate, hn::Set(kDoubles, numbering.corner[axis])),
                                  hn::Set(kDoubles, numbering.per_metre[axis]));
      const auto number = hn::BitCast(half_words, hn::DemoteTo(half_integers, scaled));
      const auto voxel = hn::And(number, hn::Set(half_words, (1U << numbering.voxel_bits[along]) - 1));
      // Bricks begin with 1, so that those before and after one have keys too.
      const auto brick =
          hn::Add(hn::ShiftRightSame(number, static_cast<int>(numbering.voxel_bits[along])), hn::Set(half_words, 1));
      const auto shifted = [&](auto bits, unsigned shift) {
        return hn::ShiftLeftSame(hn::PromoteTo(words, bits), static_cast<int>(shift));
      };
      key = hn::Or(key, hn::Or(shifted(brick, brick_shifts[along]), shifted(voxel, voxel_shifts[along])));
    }
    hn::StoreU(key, words, keys + i);
  }
}

/// Bit i: return i is in another voxel or of another run than the one before. Both arrays have one before the first.
HWY_INLINE std::uint64_t changes(const std::uint64_t* keys, const std::uint32_t* elements) {
  using Keys = hn::CappedTag<std::uint64_t, 8>;
  constexpr Keys kKeys{};
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < kBatch; i += hn::MaxLanes(kKeys)) {
    std::uint8_t mask[8] = {};
    hn::StoreMaskBits(kKeys, hn::Ne(hn::LoadU(kKeys, keys + i), hn::LoadU(kKeys, keys + i - 1)), mask);
    bits |= std::uint64_t{wordOf(mask[0])} << i;
  }
  for (std::size_t i = 0; i < kBatch; i += kLanes)
    bits |= std::uint64_t{bitsOf(differ(elements + i, hn::LoadU(kWords, elements + i - 1)))} << i;
  return bits;
}

/// Cuts a part's returns into fragments. \return the number of fragments
/// \param starts nullptr: each return is a fragment
std::size_t cutPart(const VoxelNumbering& numbering, unsigned number_bits, const FragmentList::Part& part,
                    std::uint64_t* starts, std::uint64_t* items) {
  float coordinates[3][kBatch];
  std::uint64_t keys[1 + kBatch];  // the first: of the return before
  std::uint32_t elements[1 + kBatch];
  keys[kBatch] = ~std::uint64_t{0};
  elements[kBatch] = 0;
  const NearReturn* const returns = part.near->returns.data();
  std::size_t count = 0;
  for (std::size_t batch = 0; batch < part.near->count; batch += kBatch) {
    const std::size_t size = std::min(kBatch, part.near->count - batch);
    keys[0] = keys[kBatch];
    elements[0] = elements[kBatch];
    loadBatch(returns + batch, size, numbering, coordinates, elements + 1);
    keysOf(numbering, coordinates, keys + 1);
    std::uint64_t items_here[kBatch];
    std::uint64_t* const all = starts == nullptr ? items + batch : items_here;
    for (std::size_t i = 0; i < kBatch; ++i) all[i] = keys[1 + i] << number_bits | (part.first + batch + i);
    if (starts == nullptr) continue;
    const std::uint64_t starts_here = changes(keys + 1, elements + 1) & ~bitsFrom(size);
    forEachBit(starts_here, [&](std::size_t i) { items[count++] = items_here[i]; });
    starts[batch / kBatch] = starts_here;
  }
  if (starts == nullptr) return part.near->count;
  const std::size_t end = part.near->count;
  if (end % kBatch == 0) starts[end / kBatch] = 0;  // a word that no batch has written
  starts[end / kBatch] |= std::uint64_t{1} << end % kBatch;
  return count;
}

}  // namespace HWY_NAMESPACE
}  // namespace lisco
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lisco {
namespace {

HWY_EXPORT(boundReturns);
HWY_EXPORT(cutPart);

/// Fragments of a plane from which on the search for its end doubles its steps: planes are short compared with all.
constexpr std::size_t kFirstStep = 32;

}  // namespace

std::size_t FragmentItems::beginOfPlane(std::size_t i, std::size_t begin) const {
  const std::uint64_t plane = planeOf(all[i]);
  std::size_t step = kFirstStep;
  for (; i >= begin + step && planeOf(all[i - step]) == plane; step *= 2) i -= step;
  const std::uint64_t* const items = all.data();
  const auto is_before = [&](std::uint64_t item) { return planeOf(item) < plane; };
  const std::uint64_t* const first = items + (i >= begin + step ? i - step : begin);
  return static_cast<std::size_t>(std::partition_point(first, items + i, is_before) - items);
}

std::size_t FragmentItems::endOfPlane(std::size_t i, std::size_t end) const {
  const std::uint64_t plane = planeOf(all[i]);
  std::size_t step = kFirstStep;
  for (; i + step < end && planeOf(all[i + step]) == plane; step *= 2) i += step;
  const std::uint64_t* const items = all.data();
  const auto is_within = [&](std::uint64_t item) { return planeOf(item) == plane; };
  return static_cast<std::size_t>(std::partition_point(items + i, items + std::min(i + step, end), is_within) - items);
}

Box boxAround(const FragmentList::Part& part) {
  Box box{};
  HWY_DYNAMIC_DISPATCH(boundReturns)(part.near->returns.data(), part.near->count, box);
  return box;
}

std::size_t cutIntoFragments(const VoxelNumbering& numbering, const FragmentList::Part& part, FragmentList& fragments,
                             FragmentItems& items) {
  std::uint64_t* const starts = fragments.are_single ? nullptr : &fragments.starts[part.first / 64];
  return HWY_DYNAMIC_DISPATCH(cutPart)(numbering, items.number_bits, part, starts, &items.all[part.first]);
}

}  // namespace lisco
#endif
