// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/near/slab_division.h"

#include <algorithm>
#include <numeric>
#include <utility>

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

void SlabDivision::divide(const FragmentList& fragments, const std::vector<Box>& boxes, const VoxelNumbering& numbering,
                          FragmentItems& items) {
  const std::size_t parts = fragments.parts.size();
  assign(numbering.axis[2], boxes);
  shares_.begin(parts);
  constexpr unsigned kMaxGroupBits = 10;
  const unsigned plane_bits = numbering.bits - numbering.planeBits();
  const unsigned group_bits = std::min(plane_bits, kMaxGroupBits);
  const unsigned shift = items.plane_shift + plane_bits - group_bits;
  const std::size_t groups = std::size_t{1} << group_bits;  // of planes
  histogram_.assign(parts * groups, {0, 0});
  const std::uint64_t number_mask = items.numberMask();
  inParallel(parts, [&](std::size_t part) {
    const FragmentList::Part& own = fragments.parts[part];
    const std::uint64_t* const own_items = &items.all[own.first];
    std::size_t end = own.first + own.near->count;
    for (std::size_t i = items.part_sizes[part]; i-- > 0;) {
      PlaneGroup& planes = histogram_[part * groups + (own_items[i] >> shift)];
      const std::size_t number = own_items[i] & number_mask;
      ++planes.fragments;
      planes.work += static_cast<std::uint32_t>(kWorkOfFragment + end - number);
      end = number;
    }
  });
  // Where each part's fragments of each group of planes go.
  double all = 0;
  for (const PlaneGroup& planes : histogram_) all += planes.work;
  slabs.clear();
  std::uint32_t sum = 0;
  std::size_t begin = 0;
  double work = 0;
  double share = all * shares_.of(thread_of_[0]);
  for (std::size_t group = 0; group < groups; ++group) {
    const std::uint32_t end = sum;
    const double before = work;
    for (std::size_t part = 0; part < parts; ++part) {
      PlaneGroup& planes = histogram_[part * groups + group];
      work += planes.work;
      sum += std::exchange(planes.fragments, sum);
    }
    // A slab ends at the planes nearest to its share.
    if (end > begin && slabs.size() + 1 < parts && work > share && work - share > share - before) {
      slabs.push_back({{begin, end}});
      share += all * shares_.of(thread_of_[slabs.size()]);
      begin = end;
    }
  }
  slabs.push_back({{begin, sum}});
  inParallel(parts, [&](std::size_t part) {
    const std::uint64_t* const own_items = &items.all[fragments.parts[part].first];
    for (std::size_t i = 0; i < items.part_sizes[part]; ++i)
      items.scratch[histogram_[part * groups + (own_items[i] >> shift)].fragments++] = own_items[i];
  });
  std::swap(items.all, items.scratch);
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
