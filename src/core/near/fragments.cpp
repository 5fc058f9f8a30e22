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

/// The numbers of the voxels of some coordinates along an axis.
HWY_INLINE hn::Vec<Words> numbersAlong(const VoxelNumbering& numbering, std::size_t axis, FloatVector coordinates) {
  const hn::RebindToSigned<Floats> integers;
  if (numbering.in_float) {
    const FloatVector corner = hn::Set(kFloats, static_cast<float>(numbering.corner[axis]));
    const FloatVector per_metre = hn::Set(kFloats, static_cast<float>(numbering.per_metre[axis]));
    return hn::BitCast(kWords, hn::ConvertTo(integers, hn::Mul(hn::Sub(coordinates, corner), per_metre)));
  }
  constexpr hn::CappedTag<double, 8> kDoubles;
  const hn::Rebind<float, decltype(kDoubles)> some_floats;
  const hn::Rebind<std::int32_t, decltype(kDoubles)> some_integers;
  const auto corner = hn::Set(kDoubles, numbering.corner[axis]);
  const auto per_metre = hn::Set(kDoubles, numbering.per_metre[axis]);
  const auto numbersOf = [&](hn::Vec<decltype(some_floats)> some) {
    return hn::DemoteTo(some_integers, hn::Mul(hn::Sub(hn::PromoteTo(kDoubles, some), corner), per_metre));
  };
#if HWY_TARGET == HWY_SCALAR
  return hn::BitCast(kWords, numbersOf(coordinates));
#else
  return hn::BitCast(kWords, hn::Combine(integers, numbersOf(hn::UpperHalf(some_floats, coordinates)),
                                         numbersOf(hn::LowerHalf(some_floats, coordinates))));
#endif
}

/// What keys are composed of: numbers of voxels in their bricks, and of these along the minor, middle and major axis.
struct KeyParts {
  hn::Vec<Words> voxel, brick[3];
};

HWY_INLINE KeyParts keyPartsOf(const VoxelNumbering& numbering, FloatVector x, FloatVector y, FloatVector z) {
  const FloatVector coordinates[3] = {x, y, z};
  KeyParts parts{hn::Zero(kWords), {}};
  int shift = 0;
  for (std::size_t along = 0; along < 3; ++along) {
    const std::size_t axis = numbering.axis[along];
    const auto bits = static_cast<int>(numbering.voxel_bits[along]);
    const auto number = numbersAlong(numbering, axis, coordinates[axis]);
    const auto in_brick = hn::And(number, hn::Set(kWords, (1U << bits) - 1));
    parts.voxel = hn::Or(parts.voxel, hn::ShiftLeftSame(in_brick, shift));
    // Bricks begin with 1, so that those before and after one have keys too.
    parts.brick[along] = hn::Add(hn::ShiftRightSame(number, bits), hn::Set(kWords, 1));
    shift += bits;
  }
  return parts;
}

/// Where the numbers of a brick along the axes begin in a key: see VoxelNumbering.
struct BrickShifts {
  explicit BrickShifts(const VoxelNumbering& numbering)
      : along{6, static_cast<int>(6 + numbering.minor_bits), static_cast<int>(numbering.planeBits())} {}
  int along[3];
};

HWY_INLINE void storeKeys(const KeyParts& parts, const BrickShifts& shifts, std::uint32_t* keys) {
  auto key = parts.voxel;
  for (int i = 0; i < 3; ++i) key = hn::Or(key, hn::ShiftLeftSame(parts.brick[i], shifts.along[i]));
  hn::StoreU(key, kWords, keys);
}

HWY_INLINE void storeKeys(const KeyParts& parts, const BrickShifts& shifts, std::uint64_t* keys) {
  constexpr hn::CappedTag<std::uint64_t, 8> kKeys;
  const hn::Rebind<std::uint32_t, decltype(kKeys)> some_words;
  std::uint32_t words[4][kLanes];
  hn::StoreU(parts.voxel, kWords, words[0]);
  for (int i = 0; i < 3; ++i) hn::StoreU(parts.brick[i], kWords, words[1 + i]);
  for (std::size_t k = 0; k < kLanes; k += hn::MaxLanes(kKeys)) {
    const auto part = [&](int i) { return hn::PromoteTo(kKeys, hn::LoadU(some_words, words[i] + k)); };
    auto key = part(0);
    for (int i = 0; i < 3; ++i) key = hn::Or(key, hn::ShiftLeftSame(part(1 + i), shifts.along[i]));
    hn::StoreU(key, kKeys, keys + k);
  }
}

/// Bit i: element i differs from the one before, of which there is one before the first.
HWY_INLINE std::uint64_t changes(const std::uint32_t* elements) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < kBatch; i += kLanes)
    bits |= std::uint64_t{bitsOf(differ(elements + i, hn::LoadU(kWords, elements + i - 1)))} << i;
  return bits;
}

HWY_INLINE std::uint64_t changes(const std::uint64_t* elements) {
  constexpr hn::CappedTag<std::uint64_t, 8> kKeys;
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < kBatch; i += hn::MaxLanes(kKeys)) {
    std::uint8_t mask[8] = {};
    hn::StoreMaskBits(kKeys, hn::Ne(hn::LoadU(kKeys, elements + i), hn::LoadU(kKeys, elements + i - 1)), mask);
    bits |= std::uint64_t{wordOf(mask[0])} << i;
  }
  return bits;
}

/// Cuts a part's returns into fragments. \return the number of fragments
/// \tparam Key std::uint32_t, or std::uint64_t for keys of more than 32 bits
/// \param starts nullptr: each return is a fragment
template <typename Key>
std::size_t cutPartBy(const VoxelNumbering& numbering, unsigned number_bits, const FragmentList::Part& part,
                      std::uint64_t* starts, std::uint64_t* items) {
  static_assert(kBatch % kLanes == 0, "a batch is whole vectors");
  const BrickShifts shifts(numbering);
  const NearReturn corner{static_cast<float>(numbering.corner[0]), static_cast<float>(numbering.corner[1]),
                          static_cast<float>(numbering.corner[2]), 0};
  Key keys[1 + kBatch];  // the first: of the return before
  std::uint32_t elements[1 + kBatch];
  keys[kBatch] = static_cast<Key>(~Key{0});
  elements[kBatch] = 0;
  std::size_t count = 0;
  for (std::size_t batch = 0; batch < part.near->count; batch += kBatch) {
    const std::size_t size = std::min(kBatch, part.near->count - batch);
    const NearReturn* returns = part.near->returns.data() + batch;
    NearReturn padded[kBatch];
    if (size < kBatch) {  // those behind count as the corner, so that their numbers fit
      std::copy_n(returns, size, padded);
      std::fill(padded + size, padded + kBatch, corner);
      returns = padded;
    }
    keys[0] = keys[kBatch];
    elements[0] = elements[kBatch];
    for (std::size_t i = 0; i < kBatch; i += kLanes) {
      FloatVector x;
      FloatVector y;
      FloatVector z;
      FloatVector element;
      hn::LoadInterleaved4(kFloats, &returns[i].x, x, y, z, element);
      hn::StoreU(hn::BitCast(kWords, element), kWords, &elements[1 + i]);
      storeKeys(keyPartsOf(numbering, x, y, z), shifts, &keys[1 + i]);
    }
    const auto itemOf = [&](std::size_t i) {
      return std::uint64_t{keys[1 + i]} << number_bits | (part.first + batch + i);
    };
    if (starts == nullptr) {
      for (std::size_t i = 0; i < kBatch; ++i) items[batch + i] = itemOf(i);
      continue;
    }
    const std::uint64_t starts_here = (changes(keys + 1) | changes(elements + 1)) & ~bitsFrom(size);
    forEachBit(starts_here, [&](std::size_t i) { items[count++] = itemOf(i); });
    starts[batch / kBatch] = starts_here;
  }
  if (starts == nullptr) return part.near->count;
  const std::size_t end = part.near->count;
  if (end % kBatch == 0) starts[end / kBatch] = 0;  // a word that no batch has written
  starts[end / kBatch] |= std::uint64_t{1} << end % kBatch;
  return count;
}

std::size_t cutPart(const VoxelNumbering& numbering, unsigned number_bits, const FragmentList::Part& part,
                    std::uint64_t* starts, std::uint64_t* items) {
  return numbering.bits <= 32 ? cutPartBy<std::uint32_t>(numbering, number_bits, part, starts, items)
                              : cutPartBy<std::uint64_t>(numbering, number_bits, part, starts, items);
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
