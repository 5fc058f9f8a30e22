// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "compare/baselines.h"

namespace lisco_apps {

/// The difference between the clusters of a baseline and of the reference.
struct Difference {
  bool identical = true;             ///< equal vectors: clusters, their order, indices, headers
  bool same_sets = true;             ///< equal sets of points; only order or headers may differ
  std::size_t clusters = 0;          ///< clusters of the reference that the baseline lacks
  std::size_t mislabelled = 0;       ///< points with another label under the best naming, see differenceOf ()
  bool missed_by_reference = false;  ///< the deciding pair are neighbours that the search of PCL's tree misses
  std::string details;               ///< lines that locate it; empty if identical
};

/// Compares a baseline's clusters with the reference's.
///
/// Clusters are paired one to one, those that share most points first, and noise with noise; a point is mislabelled if
/// its clusters are not paired. The details name the first such point with its coordinates, its neighbours within the
/// tolerance, and the pair that decides: neighbours that the baseline keeps apart, neighbours that it joins and PCL's
/// tree misses by rounding (doc/contract.md), or the nearest two unconnected points that it joins. To find the pair,
/// both are run again with clusters of any size.
/// \param locate false: only how much differs, not where
Difference differenceOf(const Problem& problem, const Baseline& reference, const Clusters& expected,
                        const Baseline& baseline, const Clusters& found, bool locate = true);

/// How clusters cover the true objects of a scan. Objects with fewer than min_size clustered returns do not count.
struct ObjectScore {
  std::size_t objects = 0;
  std::size_t whole = 0;   ///< in one cluster without returns of other objects
  std::size_t split = 0;   ///< in two or more clusters (over-segmented)
  std::size_t merged = 0;  ///< in a cluster with returns of another object (under-segmented); may be split as well
  std::size_t missed = 0;  ///< in no cluster
};

/// \param object_of true object per point of the cloud, 0 = none
ObjectScore scoreObjects(const Problem& problem, const Clusters& clusters, const std::vector<std::uint32_t>& object_of);

}  // namespace lisco_apps
