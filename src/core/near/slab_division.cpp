// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/near/slab_division.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "core/merge_sorted.h"
#include "core/near/constants.h"

namespace lisco {

bool SlabPair::take(bool last, const FragmentItems& items, Planes& taken) {
  std::uint64_t left = inWord(this->left());
  while (true) {
    const Planes planes{left & kMask, left >> kBits};
    if (planes.begin == planes.end) return false;
    const std::size_t least = std::min(kLeastTaken, planes.end - planes.begin);
    taken = planes;
    Planes rest = planes;
    if (last)
      rest.end = taken.begin = items.beginOfPlane(planes.end - least, planes.begin);
    else
      rest.begin = taken.end = items.endOfPlane(planes.begin + least - 1, planes.end);
    if (__atomic_compare_exchange_n(&left_, &left, inWord(rest), false, __ATOMIC_RELAXED, __ATOMIC_RELAXED))
      return true;
  }
}

/// Assigns each slab to the thread that has read most of it, about: both are in order along an axis, the major one.
void SlabDivision::assign(std::size_t axis, const std::vector<Box>& boxes) {
  thread_of_.resize(boxes.size());
  slab_of_.resize(boxes.size());
  std::iota(thread_of_.begin(), thread_of_.end(), std::size_t{0});
  const auto centreOf = [&](std::size_t part) { return boxes[part].lo[axis] + boxes[part].hi[axis]; };
  std::sort(thread_of_.begin(), thread_of_.end(),
            [&](std::size_t a, std::size_t b) { return centreOf(a) < centreOf(b); });
  for (std::size_t slab = 0; slab < thread_of_.size(); ++slab) slab_of_[thread_of_[slab]] = slab;
}

void SlabDivision::join(const FragmentList& fragments, FragmentItems& items) {
  std::size_t end = 0;
  for (std::size_t part = 0; part < items.part_sizes.size(); ++part) {
    const std::size_t size = items.part_sizes[part];
    std::copy_n(items.all.data() + fragments.parts[part].first, size, items.all.data() + end);  // to the front
    end += size;
  }
  slabs.assign(1, {{0, end}});
}

/// Ends slabs between planes, each where the number of fragments is nearest to its share.
void SlabDivision::cut(const FragmentList& fragments, const VoxelNumbering& numbering, const FragmentItems& items) {
  const std::size_t parts = fragments.parts.size();
  const std::uint64_t planes = std::uint64_t{1} << (numbering.bits - numbering.planeBits());
  const std::uint64_t* const data = items.all.data();
  const auto placeIn = [&](std::size_t part, std::uint64_t plane) {  // where the part's fragments from a plane on begin
    const std::size_t begin = fragments.parts[part].first;
    const std::size_t end = begin + items.part_sizes[part];
    if (plane == planes) return end;
    return static_cast<std::size_t>(std::lower_bound(data + begin, data + end, plane << items.plane_shift) - data);
  };
  const auto countBefore = [&](std::uint64_t plane) {
    std::size_t count = 0;
    for (std::size_t part = 0; part < parts; ++part) count += placeIn(part, plane) - fragments.parts[part].first;
    return count;
  };
  slabs.clear();
  ranges_.clear();
  ranges_.reserve(parts * parts);
  std::uint64_t first = 0;  // plane of the slab
  const auto addSlab = [&](std::uint64_t end) {
    slabs.push_back({{countBefore(first), countBefore(end)}});
    for (std::size_t part = 0; part < parts; ++part) ranges_.push_back({placeIn(part, first), placeIn(part, end)});
    first = end;
  };
  const std::size_t all = countBefore(planes);
  double share = 0;
  while (slabs.size() + 1 < parts) {
    share += shares_.of(thread_of_[slabs.size()]) * static_cast<double>(all);
    const std::size_t begin = countBefore(first);
    const std::size_t target = std::max(begin, static_cast<std::size_t>(share));
    std::uint64_t end = first;  // the last plane with no more before it than the target
    for (std::uint64_t above = planes; end + 1 < above;) {
      const std::uint64_t middle = end + (above - end) / 2;
      (countBefore(middle) <= target ? end : above) = middle;
    }
    const std::size_t below = countBefore(end);
    if (below == begin || countBefore(end + 1) - target < target - below) ++end;
    if (countBefore(end) == all) break;
    addSlab(end);
  }
  addSlab(planes);
}

void SlabDivision::divide(const FragmentList& fragments, const std::vector<Box>& boxes, const VoxelNumbering& numbering,
                          FragmentItems& items) {
  const std::size_t parts = fragments.parts.size();
  assign(numbering.axis[2], boxes);
  shares_.begin(parts);
  cut(fragments, numbering, items);
  // Pairs of what a slab has are merged until it has one.
  for (std::size_t left = parts; left > 1; left = (left + 1) / 2) {
    forEach([&](std::size_t slab) {
      Range* const ranges = &ranges_[slab * parts];
      std::size_t to = slabs[slab].begin;
      for (std::size_t i = 0; i < left; i += 2) {
        const Range a = ranges[i];
        const Range b = i + 1 < left ? ranges[i + 1] : Range{a.end, a.end};
        mergeSorted({items.all.data() + a.begin, a.end - a.begin}, {items.all.data() + b.begin, b.end - b.begin},
                    items.scratch.data() + to);
        const std::size_t begin = std::exchange(to, to + (a.end - a.begin) + (b.end - b.begin));
        ranges[i / 2] = {begin, to};
      }
    });
    std::swap(items.all, items.scratch);
  }
}

void SlabDivision::beginLinking(const FragmentItems& items) {
  pairs_.resize((slabs.size() + 1) / 2);
  for (std::size_t slab = 0; slab < slabs.size(); slab += 2) {
    const bool is_pair = slab + 1 < slabs.size();
    pairs_[slab / 2].begin(
        {outerPlane(slab, items).end, is_pair ? outerPlane(slab + 1, items).begin : slabs[slab].end});
  }
}

}  // namespace lisco
