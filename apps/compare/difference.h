// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "compare/rivals.h"

namespace lisco_apps {

/// How the clusters of a rival differ from those of the reference.
struct Difference {
  bool identical = true;        ///< the vectors are equal: clusters, their order, indices, headers
  bool same_sets = true;        ///< the clusters are equal as sets of points; only order or headers differ
  std::size_t clusters = 0;     ///< clusters of the reference that the rival does not have
  std::size_t mislabelled = 0;  ///< points that bear another label under the best naming (see differenceOf)
  std::string details;          ///< lines that say where, for people; empty if identical
};

/// Compares a rival's clusters with the reference's.
///
/// Clusters of the two are paired one to one, those that share most points first, and noise with noise; a point is
/// mislabelled if its clusters are not paired. The details name the first such point with its coordinates, its
/// neighbours within the tolerance, and the pair that decides: neighbours that the rival keeps apart, or the nearest
/// two points that it joins although they are not connected. For these both are run once more with clusters of any
/// size.
Difference differenceOf(const Problem& problem, const Rival& reference, const Clusters& expected, const Rival& rival,
                        const Clusters& found);

/// How clusters cover the true objects of a simulated scan. Objects count if they have at least min_size of the
/// clustered returns.
struct ObjectScore {
  std::size_t objects = 0;
  std::size_t whole = 0;   ///< in one cluster, in which nothing else is
  std::size_t split = 0;   ///< over-segmented: in two or more clusters
  std::size_t merged = 0;  ///< under-segmented: in a cluster with returns of another object (may be split as well)
  std::size_t missed = 0;  ///< in no cluster
};

/// \param object_of the true object per point of the cloud, 0 = none
ObjectScore scoreObjects(const Problem& problem, const Clusters& clusters, const std::vector<std::uint32_t>& object_of);

}  // namespace lisco_apps
