// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/near/voxel_sorter.h"

#include <algorithm>
#include <numeric>

#include "core/bits.h"
#include "core/near/constants.h"
#include "core/near/neighbourhood.h"
#include "core/parallel.h"
#include "core/radix_sort.h"

namespace lisco {

namespace {

/// The number of no plane, nor of one beside a plane.
constexpr std::uint64_t kNoPlane = ~std::uint64_t{0} / 2;

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
  const std::size_t most = division_.slabs.back().end;
  voxels_.grow(most);
  voxels_.create(0, static_cast<std::uint32_t>(most));
  begins_voxel_.grow(most + 1);
  begins_voxel_[most] = 0;
  linkSlabs(tolerance, voxels_);
  numberSets(sizes);
  division_.forEach([&](std::size_t slab) { numberReturns(slab); });
  return true;
}

/// Sorts all fragments by voxel, in slabs. \return false if the voxels cannot be numbered
bool VoxelSorter::sortFragments(const Tolerance& tolerance) {
  is_shared_ = fragments_.parts.size() > 1 && fragments_.end >= min_shared_;
  if (!chooseNumbering(tolerance)) return false;
  cutFragments();
  if (is_shared_) {
    forEachPart([&](std::size_t i) { sort(fragments_.parts[i].first, items_.part_sizes[i]); });
    division_.divide(fragments_, boxes_, numbering_, items_);
  } else {
    division_.join(fragments_, items_);
    sort(0, division_.slabs.front().end);
  }
  if (planes_.size() < division_.slabs.size()) planes_.resize(division_.slabs.size());
  std::fill_n(&items_.all[division_.slabs.back().end], kPrefetch, 0);
  return true;
}

void VoxelSorter::linkSlabs(const Tolerance& tolerance, DisjointSets& subclusters) {
  const PlaneLayout layout{items_.number_bits, numbering_.minor_bits, numbering_.minor_bits + numbering_.middle_bits,
                           tolerance.squared(), numbering_.has_slices ? kSliceNeighbourhood.of : kNeighbourhood.of};
  const std::size_t slabs = division_.slabs.size();
  division_.beginLinking(items_);
  subclusters.share(slabs > 1);
  division_.forEach([&](std::size_t slab) { linkSlab(slab, layout, subclusters); });
  subclusters.share(false);
  if (slabs == 1) return;
  // Next time, any thread may take the largest plane.
  VoxelPlane& largest = planes_.front().latestPlane();
  const auto forEachPlane = [&](auto&& visit) {
    for (std::size_t slab = 0; slab < slabs; ++slab)
      for (VoxelPlane& plane : planes_[slab].planes) visit(plane);
  };
  forEachPlane([&](const VoxelPlane& plane) { largest.reserveAs(plane); });
  forEachPlane([&](VoxelPlane& plane) { plane.reserveAs(largest); });
}

/// Calls work(part) for each part, by a thread of its own if they share the work.
template <typename Work>
void VoxelSorter::forEachPart(Work&& work) {
  const std::size_t parts = fragments_.parts.size();
  if (is_shared_) return inParallel(parts, work);
  for (std::size_t part = 0; part < parts; ++part) work(part);
}

/// Chooses how voxels are numbered and items composed. \return false if that cannot be
bool VoxelSorter::chooseNumbering(const Tolerance& tolerance) {
  if (fragments_.end > VoxelPlane::kInItems) return false;
  boxes_.resize(fragments_.parts.size());
  forEachPart([&](std::size_t i) { boxes_[i] = boxAround(fragments_.parts[i]); });
  if (!numbering_.choose(boxes_, is_shared_, tolerance)) return false;
  items_.number_bits = bitsFor(fragments_.end);
  items_.plane_shift = items_.number_bits + numbering_.planeBits();
  return numbering_.bits + items_.number_bits <= 64;
}

/// The first element of the voxels that a slab's thread has linked.
std::size_t VoxelSorter::firstVoxel(std::size_t slab) const {
  const Slab& own = division_.slabs[slab];
  return SlabDivision::descends(slab) ? own.end - own.voxels : own.begin;
}

/// Numbers the sets of voxels by their first ones.
void VoxelSorter::numberSets(std::vector<std::uint32_t>& sizes) {
  Sets* const all = sets();
  SetNumbering numbering(voxels_, sizes);
  for (std::size_t slab = 0; slab < division_.slabs.size(); ++slab) {
    const std::size_t first = firstVoxel(slab);
    for (std::size_t voxel = first; voxel < first + division_.slabs[slab].voxels; ++voxel)
      all[voxel].of_voxel = numbering.numberOf(static_cast<std::uint32_t>(voxel), all[voxel].of_voxel,
                                               [all](std::uint32_t parent) { return all[parent].of_voxel; });
  }
  numbering.finish();
}

/// Hands the numbers of sets to the returns that a slab's thread has linked.
void VoxelSorter::numberReturns(std::size_t slab) {
  Sets* const all = sets();
  const std::uint64_t number_mask = items_.numberMask();
  const std::uint64_t* const items = items_.all.data();
  const std::uint8_t* const begins_voxel = begins_voxel_.data();
  std::size_t voxel = firstVoxel(slab);
  const auto [begin, end] = division_.linkedBy(slab);
  for (std::size_t i = begin; i < end; ++i) {
    all[items[i] & number_mask].of_return = all[voxel].of_voxel;
    voxel += begins_voxel[i + 1];
  }
}

/// Cuts all returns into fragments with their keys.
void VoxelSorter::cutFragments() {
  const std::size_t size = fragments_.end;
  std::vector<std::size_t>& part_sizes = items_.part_sizes;
  items_.all.grow(size + kPrefetch);
  if (!fragments_.are_single && fragments_.starts.size() < size / 64) fragments_.starts.resize(size / 64);
  part_sizes.resize(fragments_.parts.size());
  forEachPart(
      [&](std::size_t i) { part_sizes[i] = cutIntoFragments(numbering_, fragments_.parts[i], fragments_, items_); });
  // Threads exchange both arrays; the sets of single returns need an entry for each.
  if (part_sizes.size() == 1 && !fragments_.are_single)
    items_.scratch.growInSteps(part_sizes[0] + kPrefetch);
  else
    items_.scratch.grow(size + kPrefetch);
}

/// Sorts fragments by key.
void VoxelSorter::sort(std::size_t begin, std::size_t count) {
  radixSort(items_.all.data() + begin, items_.scratch.data() + begin, count, items_.number_bits, numbering_.bits);
}

/// Links planes from the outer one of a slab on, until its thread meets that of the other slab of the pair.
void VoxelSorter::linkSlab(std::size_t slab, const PlaneLayout& layout, DisjointSets& subclusters) {
  division_.slabs[slab].voxels = 0;
  planes_[slab].number = kNoPlane;
  planes_[slab].latest = 0;  // a scan like the last one fills each of the two as much as that one did
  const bool descends = SlabDivision::descends(slab);
  if (slab > 0 && !descends && linksPlanes()) fillPlaneBefore(slab, layout, subclusters);
  SlabPair& pair = division_.pairOf(slab);
  Planes taken = division_.outerPlane(slab, items_);
  do linkPlanesOf(slab, taken, layout, subclusters);
  while (pair.take(descends, items_, taken));
  if (!pair.end() || !linksPlanes()) return;
  TwoPlanes& lower = planes_[slab / 2 * 2];
  TwoPlanes& upper = planes_[slab / 2 * 2 + 1];
  if (lower.number + 1 == upper.number) linkPlanes(lower.latestPlane(), upper.latestPlane(), layout, subclusters);
}

/// Fills a slab's latest plane with the last one of the slab before, of another pair, whose thread links it within.
void VoxelSorter::fillPlaneBefore(std::size_t slab, const PlaneLayout& layout, DisjointSets& subclusters) {
  TwoPlanes& own = planes_[slab];
  const Planes before = division_.outerPlane(slab - 1, items_);
  const std::size_t voxels = fillPlane(own.latestPlane(), before, layout, subclusters);
  own.number = items_.planeOf(items_.all[before.begin]);
  // That slab's thread links this plane first: its voxels are the last elements of the slab.
  if (fragments_.are_single)
    std::iota(own.latestPlane().root.data(), own.latestPlane().root.data() + voxels,
              static_cast<std::uint32_t>(before.end - voxels));
}

/// Links the planes that a slab's thread has taken within and, unless they are slices, with those before, in the
/// thread's direction.
void VoxelSorter::linkPlanesOf(std::size_t slab, Planes planes, const PlaneLayout& layout, DisjointSets& subclusters) {
  TwoPlanes& own = planes_[slab];
  const bool descends = SlabDivision::descends(slab);
  while (planes.begin < planes.end) {
    const Planes one = planes.outerOne(descends, items_);
    planes = descends ? Planes{planes.begin, one.begin} : Planes{one.end, planes.end};
    VoxelPlane& plane = own.otherPlane();
    VoxelPlane& last = own.latestPlane();
    const std::size_t voxels = fillPlane(plane, one, layout, subclusters);
    if (fragments_.are_single) addVoxels(slab, plane, voxels, one);
    linkPlane(plane, layout, subclusters);
    const std::uint64_t number = items_.planeOf(items_.all[one.begin]);
    if (linksPlanes() && own.number == (descends ? number + 1 : number - 1))
      linkPlanes(descends ? plane : last, descends ? last : plane, layout, subclusters);
    own.latest = 1 - own.latest;
    own.number = number;
  }
}

/// \return number of voxels
std::size_t VoxelSorter::fillPlane(VoxelPlane& plane, const Planes& one, const PlaneLayout& layout,
                                   DisjointSets& subclusters) {
  const std::uint64_t* const items = &items_.all[one.begin];
  const std::size_t count = one.end - one.begin;
  if (fragments_.are_single) return fillPlaneFromSingle(plane, items, count, layout, fragments_);
  return fillPlaneFromRuns(plane, items, count, layout, fragments_, subclusters);
}

/// Enters the voxels of a plane of single returns, which are elements behind or before those of its slab.
void VoxelSorter::addVoxels(std::size_t slab, VoxelPlane& plane, std::size_t voxels, const Planes& one) {
  Slab& own = division_.slabs[slab];
  const std::size_t first = SlabDivision::descends(slab) ? own.end - own.voxels - voxels : own.begin + own.voxels;
  own.voxels += voxels;
  std::iota(plane.root.data(), plane.root.data() + voxels, static_cast<std::uint32_t>(first));
  Sets* const all = sets() + first;
  for (std::size_t voxel = 0; voxel < voxels; ++voxel) all[voxel].of_voxel = plane.return_count[voxel];
  std::copy_n(plane.begins_voxel.data(), one.end - one.begin, &begins_voxel_[one.begin]);
}

}  // namespace lisco
