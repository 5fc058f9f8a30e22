// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/near/voxel_sorter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/bits.h"
#include "core/near/constants.h"
#include "core/near/neighbourhood.h"
#include "core/parallel.h"
#include "core/radix_sort.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/near/voxel_sorter.cpp"
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

/// Bit i: item i differs from the one before.
HWY_INLINE std::uint64_t changes(const std::uint64_t* keys, const std::uint32_t* elements) {
  using Keys = hn::CappedTag<std::uint64_t, 8>;
  constexpr Keys kKeys{};
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < kBatch; i += hn::Lanes(kKeys)) {
    std::uint8_t mask[8] = {};
    hn::StoreMaskBits(kKeys, hn::Ne(hn::LoadU(kKeys, keys + i), hn::LoadU(kKeys, keys + i - 1)), mask);
    bits |= std::uint64_t{mask[0]} << i;
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

/// The least difference of unlike floats of which all are at least lo and at most hi, and of one sign; else 0.
float leastStep(float lo, float hi) {
  if (lo <= 0 && hi >= 0) return 0;
  const float least = std::min(std::fabs(lo), std::fabs(hi));
  return std::nextafter(least, std::numeric_limits<float>::infinity()) - least;
}

constexpr std::size_t kAxes = 3;

/// The axis with most slices; kAxes if there are few.
std::size_t axisOfSlices(const Box& box, const Tolerance& tolerance) {
  std::size_t found = kAxes;
  double most = kMinSlices;
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    const float step = leastStep(box.lo[axis], box.hi[axis]);
    if (squaredDistance(step, 0, 0) < tolerance.squared()) continue;
    const double slices =
        (static_cast<double>(box.hi[axis]) - static_cast<double>(box.lo[axis])) / static_cast<double>(step);
    if (slices < most) continue;
    found = axis;
    most = slices;
  }
  return found;
}

/// How far the boxes of some parts overlap along an axis: 0 if they lie side by side, 1 for each but one if all span
/// the whole.
double overlapAlong(std::size_t axis, const std::vector<Box>& parts, const Box& all) {
  const auto lengthOf = [axis](const Box& box) {
    return static_cast<double>(box.hi[axis]) - static_cast<double>(box.lo[axis]);
  };
  double sum = 0;
  for (const Box& box : parts) sum += lengthOf(box);
  return sum / lengthOf(all) - 1;
}

unsigned bitsFor(std::uint64_t values) {
  unsigned bits = 1;
  while (values >> bits != 0) ++bits;
  return bits;
}

}  // namespace

bool VoxelSorter::link(const std::vector<const NearReturns*>& parts, const Tolerance& tolerance,
                       DisjointSets& subclusters) {
  fragments_.begin(false);
  for (const NearReturns* part : parts) fragments_.add(*part);
  if (fragments_.parts.empty() || !tolerance.joinsAnything()) return true;
  if (!sortFragments(tolerance)) return false;
  linkSlabs(tolerance, subclusters);
  return true;
}

bool VoxelSorter::number(std::vector<SingleReturns>& parts, const Tolerance& tolerance,
                         std::vector<std::uint32_t>& sizes) {
  sizes.clear();
  fragments_.begin(true);
  for (SingleReturns& part : parts) part.first = fragments_.add(*part.near);
  if (fragments_.parts.empty()) return true;
  if (!sortFragments(tolerance)) return false;
  const std::size_t most = slabs_.back().end;
  voxels_.grow(most);
  voxels_.create(0, static_cast<std::uint32_t>(most));
  begins_voxel_.grow(most + 1);
  begins_voxel_[most] = 0;
  linkSlabs(tolerance, voxels_);
  numberSets(sizes);
  forEachSlab([&](std::size_t slab) { numberReturns(slabs_[slab]); });
  return true;
}

/// Sorts all fragments by voxel, in slabs. \return false if the voxels cannot be numbered
bool VoxelSorter::sortFragments(const Tolerance& tolerance) {
  is_shared_ = fragments_.parts.size() > 1 && fragments_.end >= min_shared_;
  if (!chooseNumbering(tolerance)) return false;
  cutFragments();
  if (is_shared_)
    divide();
  else
    joinParts();
  if (planes_.size() < 2 * slabs_.size()) planes_.resize(2 * slabs_.size());
  forEachSlab([&](std::size_t slab) { sort(slabs_[slab]); });
  std::fill_n(&items_[slabs_.back().end], kPrefetch, 0);
  return true;
}

void VoxelSorter::linkSlabs(const Tolerance& tolerance, DisjointSets& subclusters) {
  subclusters.share(slabs_.size() > 1);
  forEachSlab([&](std::size_t slab) { linkSlab(slab, tolerance, subclusters); });
  subclusters.share(false);
}

/// Calls work(part) for each part, by a thread of its own if they share the work.
template <typename Work>
void VoxelSorter::forEachPart(Work&& work) {
  const std::size_t parts = fragments_.parts.size();
  if (is_shared_) return inParallel(parts, work);
  for (std::size_t part = 0; part < parts; ++part) work(part);
}

/// Calls work(slab) for each slab, by the thread that it is assigned to.
template <typename Work>
void VoxelSorter::forEachSlab(Work&& work) {
  if (slabs_.size() == 1) return work(std::size_t{0});
  inParallel(slab_of_.size(), [&](std::size_t thread) {
    const std::size_t slab = slab_of_[thread];
    if (slab < slabs_.size()) shares_.time(thread, [&] { work(slab); });
  });
}

/// Numbers the sets of voxels by their first ones.
void VoxelSorter::numberSets(std::vector<std::uint32_t>& sizes) {
  Sets* const all = sets();
  SetNumbering numbering(voxels_, sizes);
  for (const Slab& slab : slabs_) numbering.addRoots(static_cast<std::uint32_t>(slab.begin), slab.voxels);
  for (const Slab& slab : slabs_)
    for (std::size_t voxel = slab.begin; voxel < slab.begin + slab.voxels; ++voxel)
      all[voxel].of_voxel = numbering.numberOf(static_cast<std::uint32_t>(voxel), all[voxel].of_voxel,
                                               [all](std::uint32_t parent) { return all[parent].of_voxel; });
}

/// Hands the numbers of sets to the returns.
void VoxelSorter::numberReturns(const Slab& slab) {
  Sets* const all = sets();
  const std::uint64_t number_mask = (std::uint64_t{1} << number_bits_) - 1;
  const std::uint64_t* const items = items_.data();
  const std::uint8_t* const begins_voxel = begins_voxel_.data();
  std::size_t voxel = slab.begin;
  for (std::size_t i = slab.begin; i < slab.end; ++i) {
    all[items[i] & number_mask].of_return = all[voxel].of_voxel;
    voxel += begins_voxel[i + 1];
  }
}

/// The box around all returns.
Box VoxelSorter::boxOfAll() {
  part_boxes_.resize(fragments_.parts.size());
  forEachPart([&](std::size_t i) {
    const NearReturns& near = *fragments_.parts[i].near;
    HWY_DYNAMIC_DISPATCH(boundReturns)(near.returns.data(), near.count, part_boxes_[i]);
  });
  Box all = part_boxes_.front();
  for (const Box& box : part_boxes_) all.add(box);
  return all;
}

/// Puts the axes into the order of the sides of the box, with a sliced axis last. Several threads take the middle axis
/// as the major one if their parts overlap less along it: what others have read comes from other caches.
/// \param sides of the box, in voxels
void VoxelSorter::orderAxes(const Box& all, const double (&sides)[kAxes], std::size_t sliced) {
  std::size_t* const axes = numbering_.axis;
  std::iota(axes, axes + kAxes, std::size_t{0});
  if (sliced < kAxes) std::swap(axes[sliced], axes[kAxes - 1]);
  std::sort(axes, axes + (sliced < kAxes ? kAxes - 1 : kAxes),
            [&](std::size_t a, std::size_t b) { return sides[a] < sides[b]; });
  const std::size_t parts = part_boxes_.size();
  if (sliced < kAxes || !is_shared_ || sides[axes[1]] < kMinSharedSide * static_cast<double>(parts)) return;
  const double gain = overlapAlong(axes[2], part_boxes_, all) - overlapAlong(axes[1], part_boxes_, all);
  if (gain > kMinOverlapGain * static_cast<double>(parts - 1)) std::swap(axes[1], axes[2]);
}

/// Chooses the voxels, the axes and the bits of the keys.
bool VoxelSorter::chooseNumbering(const Tolerance& tolerance) {
  if (tolerance.reach() < kMinSortedTolerance || tolerance.reach() > kMaxSortedTolerance) return false;
  if (fragments_.end > VoxelPlane::kInItems) return false;
  const Box all = boxOfAll();
  const std::size_t sliced = axisOfSlices(all, tolerance);
  numbering_.has_slices = sliced < kAxes;
  constexpr unsigned kVoxelBits[2][kAxes] = {{2, 2, 2}, {3, 2, 0}};
  std::copy_n(kVoxelBits[numbering_.has_slices ? 1 : 0], kAxes, numbering_.voxel_bits);
  const double voxel = (numbering_.has_slices ? kSliceVoxelSide : kVoxelSide) * tolerance.reach();
  double sides[kAxes];  // of the box, in voxels
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    const auto lo = static_cast<double>(all.lo[axis]);
    const auto hi = static_cast<double>(all.hi[axis]);
    numbering_.corner[axis] = lo;
    numbering_.per_metre[axis] =
        1 / (axis == sliced ? static_cast<double>(leastStep(all.lo[axis], all.hi[axis])) : voxel);
    sides[axis] = (hi - lo) * numbering_.per_metre[axis];
    if (!(sides[axis] < kMaxVoxelNumber)) return false;
  }
  orderAxes(all, sides, sliced);
  const auto bitsAlong = [&](std::size_t i) {
    const auto last = static_cast<std::uint64_t>(sides[numbering_.axis[i]]);
    return bitsFor((last >> numbering_.voxel_bits[i]) + 3);
  };
  numbering_.minor_bits = bitsAlong(0);
  numbering_.middle_bits = bitsAlong(1);
  numbering_.bits = numbering_.minor_bits + numbering_.middle_bits + bitsAlong(2) + 6;
  number_bits_ = bitsFor(fragments_.end);
  plane_shift_ = number_bits_ + 6 + numbering_.minor_bits + numbering_.middle_bits;
  return numbering_.bits + number_bits_ <= 64;
}

/// Cuts all returns into fragments with their keys.
void VoxelSorter::cutFragments() {
  const std::size_t size = fragments_.end;
  items_.grow(size + kPrefetch);
  if (!fragments_.are_single && fragments_.starts.size() < size / 64) fragments_.starts.resize(size / 64);
  part_sizes_.resize(fragments_.parts.size());
  forEachPart([&](std::size_t i) {
    const FragmentList::Part& part = fragments_.parts[i];
    std::uint64_t* const starts = fragments_.are_single ? nullptr : &fragments_.starts[part.first / 64];
    part_sizes_[i] = HWY_DYNAMIC_DISPATCH(cutPart)(numbering_, number_bits_, part, starts, &items_[part.first]);
  });
  // Threads exchange both arrays; the sets of single returns need an entry for each.
  if (part_sizes_.size() == 1 && !fragments_.are_single)
    scratch_.growInSteps(part_sizes_[0] + kPrefetch);
  else
    scratch_.grow(size + kPrefetch);
}

/// Assigns each slab to the thread that has read most of it, about: both are in order along the major axis.
void VoxelSorter::assignSlabs() {
  thread_of_.resize(part_boxes_.size());
  slab_of_.resize(part_boxes_.size());
  std::iota(thread_of_.begin(), thread_of_.end(), std::size_t{0});
  const auto centreOf = [&](std::size_t part) {
    return part_boxes_[part].lo[numbering_.axis[2]] + part_boxes_[part].hi[numbering_.axis[2]];
  };
  std::sort(thread_of_.begin(), thread_of_.end(),
            [&](std::size_t a, std::size_t b) { return centreOf(a) < centreOf(b); });
  for (std::size_t slab = 0; slab < thread_of_.size(); ++slab) slab_of_[thread_of_[slab]] = slab;
}

/// Makes the fragments of all parts one slab.
void VoxelSorter::joinParts() {
  std::size_t end = 0;
  for (std::size_t part = 0; part < part_sizes_.size(); ++part) {
    const std::size_t size = part_sizes_[part];
    std::copy_n(items_.data() + fragments_.parts[part].first, size, items_.data() + end);  // to the front
    end += size;
  }
  slabs_.assign(1, {0, end, 0});
}

/// Moves the fragments of each slab of planes together: slabs of about equal work, one for each part.
void VoxelSorter::divide() {
  const std::size_t parts = fragments_.parts.size();
  assignSlabs();
  shares_.begin(parts);
  constexpr unsigned kGroupBits = 10;
  constexpr std::size_t kGroups = std::size_t{1} << kGroupBits;  // of planes
  const unsigned plane_bits = numbering_.bits + number_bits_ - plane_shift_;
  const unsigned shift = plane_shift_ + (plane_bits > kGroupBits ? plane_bits - kGroupBits : 0);
  histogram_.assign(parts * kGroups, {0, 0});
  const std::uint64_t number_mask = (std::uint64_t{1} << number_bits_) - 1;
  inParallel(parts, [&](std::size_t part) {
    const FragmentList::Part& own = fragments_.parts[part];
    const std::uint64_t* const items = &items_[own.first];
    std::size_t end = own.first + own.near->count;
    for (std::size_t i = part_sizes_[part]; i-- > 0;) {
      Planes& planes = histogram_[part * kGroups + (items[i] >> shift)];
      const std::size_t number = items[i] & number_mask;
      ++planes.fragments;
      planes.work += static_cast<std::uint32_t>(kWorkOfFragment + end - number);
      end = number;
    }
  });
  // Where each part's fragments of each group of planes go.
  double all = 0;
  for (const Planes& planes : histogram_) all += planes.work;
  slabs_.clear();
  std::uint32_t sum = 0;
  std::size_t begin = 0;
  double work = 0;
  double share = all * shares_.of(thread_of_[0]);
  for (std::size_t group = 0; group < kGroups; ++group) {
    const std::uint32_t end = sum;
    const double before = work;
    for (std::size_t part = 0; part < parts; ++part) {
      Planes& planes = histogram_[part * kGroups + group];
      work += planes.work;
      sum += std::exchange(planes.fragments, sum);
    }
    // A slab ends at the planes nearest to its share.
    if (end > begin && slabs_.size() + 1 < parts && work > share && work - share > share - before) {
      slabs_.push_back({begin, end, 0});
      share += all * shares_.of(thread_of_[slabs_.size()]);
      begin = end;
    }
  }
  slabs_.push_back({begin, sum, 0});
  inParallel(parts, [&](std::size_t part) {
    const std::uint64_t* const items = &items_[fragments_.parts[part].first];
    for (std::size_t i = 0; i < part_sizes_[part]; ++i)
      scratch_[histogram_[part * kGroups + (items[i] >> shift)].fragments++] = items[i];
  });
  std::swap(items_, scratch_);
}

/// Sorts the fragments of a slab by key.
void VoxelSorter::sort(const Slab& slab) {
  radixSort(items_.data() + slab.begin, scratch_.data() + slab.begin, slab.end - slab.begin, number_bits_,
            numbering_.bits);
}

std::size_t VoxelSorter::endOfPlane(std::size_t begin, std::size_t end) const {
  const std::uint64_t plane = planeOf(items_[begin]);
  // Planes are short compared with all that follows.
  std::size_t step = 32;
  while (begin + step < end && planeOf(items_[begin + step]) == plane) {
    begin += step;
    step *= 2;
  }
  const std::uint64_t* const items = items_.data();
  const auto is_before = [&](std::uint64_t item) { return planeOf(item) == plane; };
  return static_cast<std::size_t>(std::partition_point(items + begin, items + std::min(begin + step, end), is_before) -
                                  items);
}

/// Enters a plane's voxels, which are elements, and those of its returns [begin, end).
void VoxelSorter::addVoxels(std::size_t slab, const VoxelPlane& plane, std::size_t voxels, std::size_t begin,
                            std::size_t end) {
  Sets* const all = sets() + slabs_[slab].begin + slabs_[slab].voxels;
  for (std::size_t voxel = 0; voxel < voxels; ++voxel) all[voxel].of_voxel = plane.return_count[voxel];
  slabs_[slab].voxels += voxels;
  std::copy_n(plane.begins_voxel.data(), end - begin, &begins_voxel_[begin]);
}

/// Links the planes of a slab within and, unless they are slices, with the next ones, the first of the next slab
/// included.
void VoxelSorter::linkSlab(std::size_t slab, const Tolerance& tolerance, DisjointSets& subclusters) {
  const PlaneLayout layout{number_bits_, numbering_.minor_bits, numbering_.minor_bits + numbering_.middle_bits,
                           tolerance.squared(), numbering_.has_slices ? kSliceNeighbourhood.of : kNeighbourhood.of};
  VoxelPlane* plane = &planes_[2 * slab];
  VoxelPlane* last = plane + 1;
  std::uint64_t last_number = ~std::uint64_t{0} - 1;
  std::size_t first_voxel = slabs_[slab].begin;
  const bool links_planes = !numbering_.has_slices;
  const std::size_t end_of_all = links_planes ? slabs_.back().end : slabs_[slab].end;
  for (std::size_t begin = slabs_[slab].begin; begin < end_of_all;) {
    const std::uint64_t number = planeOf(items_[begin]);
    const bool is_own = begin < slabs_[slab].end;
    if (!is_own && number != last_number + 1) return;
    const std::size_t end = endOfPlane(begin, end_of_all);
    if (!is_own) first_voxel = slabs_[slab + 1].begin;
    if (fragments_.are_single) {
      const std::size_t voxels = fillPlaneFromSingle(*plane, &items_[begin], end - begin, layout, fragments_,
                                                     static_cast<std::uint32_t>(first_voxel));
      if (is_own) addVoxels(slab, *plane, voxels, begin, end);
      first_voxel += voxels;
    } else {
      fillPlaneFromRuns(*plane, &items_[begin], end - begin, layout, fragments_, subclusters);
    }
    if (is_own) linkPlane(*plane, layout, subclusters);
    if (links_planes && number == last_number + 1) linkPlanes(*last, *plane, layout, subclusters);
    if (!is_own) return;
    std::swap(plane, last);
    last_number = number;
    begin = end;
  }
}

}  // namespace lisco
#endif
