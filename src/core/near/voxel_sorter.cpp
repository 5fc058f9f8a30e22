// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/near/voxel_sorter.h"

#include <algorithm>
#include <utility>

#include "core/bits.h"
#include "core/near/constants.h"
#include "core/near/neighbourhood.h"
#include "core/parallel.h"
#include "core/radix_sort.h"

namespace lisco {

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
  division_.forEach([&](std::size_t slab) { numberReturns(division_.slabs[slab]); });
  return true;
}

/// Sorts all fragments by voxel, in slabs. \return false if the voxels cannot be numbered
bool VoxelSorter::sortFragments(const Tolerance& tolerance) {
  is_shared_ = fragments_.parts.size() > 1 && fragments_.end >= min_shared_;
  if (!chooseNumbering(tolerance)) return false;
  cutFragments();
  if (is_shared_)
    division_.divide(fragments_, boxes_, numbering_, items_);
  else
    division_.join(fragments_, items_);
  if (planes_.size() < 2 * division_.slabs.size()) planes_.resize(2 * division_.slabs.size());
  division_.forEach([&](std::size_t slab) { sort(division_.slabs[slab]); });
  std::fill_n(&items_.all[division_.slabs.back().end], kPrefetch, 0);
  return true;
}

void VoxelSorter::linkSlabs(const Tolerance& tolerance, DisjointSets& subclusters) {
  subclusters.share(division_.slabs.size() > 1);
  division_.forEach([&](std::size_t slab) { linkSlab(slab, tolerance, subclusters); });
  subclusters.share(false);
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

/// Numbers the sets of voxels by their first ones.
void VoxelSorter::numberSets(std::vector<std::uint32_t>& sizes) {
  Sets* const all = sets();
  SetNumbering numbering(voxels_, sizes);
  for (const Slab& slab : division_.slabs)
    for (std::size_t voxel = slab.begin; voxel < slab.begin + slab.voxels; ++voxel)
      all[voxel].of_voxel = numbering.numberOf(static_cast<std::uint32_t>(voxel), all[voxel].of_voxel,
                                               [all](std::uint32_t parent) { return all[parent].of_voxel; });
  numbering.finish();
}

/// Hands the numbers of sets to the returns.
void VoxelSorter::numberReturns(const Slab& slab) {
  Sets* const all = sets();
  const std::uint64_t number_mask = items_.numberMask();
  const std::uint64_t* const items = items_.all.data();
  const std::uint8_t* const begins_voxel = begins_voxel_.data();
  std::size_t voxel = slab.begin;
  for (std::size_t i = slab.begin; i < slab.end; ++i) {
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

/// Sorts the fragments of a slab by key.
void VoxelSorter::sort(const Slab& slab) {
  radixSort(items_.all.data() + slab.begin, items_.scratch.data() + slab.begin, slab.end - slab.begin,
            items_.number_bits, numbering_.bits);
}

std::size_t VoxelSorter::endOfPlane(std::size_t begin, std::size_t end) const {
  const std::uint64_t plane = items_.planeOf(items_.all[begin]);
  // Planes are short compared with all that follows.
  std::size_t step = 32;
  while (begin + step < end && items_.planeOf(items_.all[begin + step]) == plane) {
    begin += step;
    step *= 2;
  }
  const std::uint64_t* const items = items_.all.data();
  const auto is_before = [&](std::uint64_t item) { return items_.planeOf(item) == plane; };
  return static_cast<std::size_t>(std::partition_point(items + begin, items + std::min(begin + step, end), is_before) -
                                  items);
}

/// Enters a plane's voxels, which are elements, and those of its returns [begin, end).
void VoxelSorter::addVoxels(std::size_t slab, const VoxelPlane& plane, std::size_t voxels, std::size_t begin,
                            std::size_t end) {
  Sets* const all = sets() + division_.slabs[slab].begin + division_.slabs[slab].voxels;
  for (std::size_t voxel = 0; voxel < voxels; ++voxel) all[voxel].of_voxel = plane.return_count[voxel];
  division_.slabs[slab].voxels += voxels;
  std::copy_n(plane.begins_voxel.data(), end - begin, &begins_voxel_[begin]);
}

/// Links the planes of a slab within and, unless they are slices, with the next ones, the first of the next slab
/// included.
void VoxelSorter::linkSlab(std::size_t slab, const Tolerance& tolerance, DisjointSets& subclusters) {
  const PlaneLayout layout{items_.number_bits, numbering_.minor_bits, numbering_.minor_bits + numbering_.middle_bits,
                           tolerance.squared(), numbering_.has_slices ? kSliceNeighbourhood.of : kNeighbourhood.of};
  VoxelPlane* plane = &planes_[2 * slab];
  VoxelPlane* last = plane + 1;
  std::uint64_t last_number = ~std::uint64_t{0} - 1;
  std::size_t first_voxel = division_.slabs[slab].begin;
  const bool links_planes = !numbering_.has_slices;
  const std::size_t end_of_all = links_planes ? division_.slabs.back().end : division_.slabs[slab].end;
  for (std::size_t begin = division_.slabs[slab].begin; begin < end_of_all;) {
    const std::uint64_t number = items_.planeOf(items_.all[begin]);
    const bool is_own = begin < division_.slabs[slab].end;
    if (!is_own && number != last_number + 1) return;
    const std::size_t end = endOfPlane(begin, end_of_all);
    if (!is_own) first_voxel = division_.slabs[slab + 1].begin;
    if (fragments_.are_single) {
      const std::size_t voxels = fillPlaneFromSingle(*plane, &items_.all[begin], end - begin, layout, fragments_,
                                                     static_cast<std::uint32_t>(first_voxel));
      if (is_own) addVoxels(slab, *plane, voxels, begin, end);
      first_voxel += voxels;
    } else {
      fillPlaneFromRuns(*plane, &items_.all[begin], end - begin, layout, fragments_, subclusters);
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
