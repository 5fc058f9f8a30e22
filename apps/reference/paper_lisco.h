// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <unordered_map>
#include <vector>

#include "core/neighbour.h"
#include "lisco/return.h"

namespace lisco_reference {

/// The sensor of Algorithm 2: the smallest angles between two steps and between two lasers, radians.
struct NominalSensor {
  double delta_alpha, delta_theta;
};

/// Algorithm 2's neighbour mask: lasers above and below, and steps before.
struct NeighborMask {
  std::size_t lambda, sigma;
};

/// Algorithm 2, literally, which misses neighbours on real scans (see doc/algorithm.md).
/// \param distance p_d, metres
/// \return 2^31 lasers and steps, that is all, for a point nearer than eps, where the paper's arcsine is undefined
NeighborMask getNeighborMask(double distance, double eps, const NominalSensor& sensor);

/// The paper's Lisco as printed, for comparison only: Algorithms 2 to 4 and section IV's data structures. (Algorithm 1
/// is PCL's EuclideanClusterExtraction.)
///
/// Choices where the paper is open or cannot be meant as printed:
/// - two returns are neighbours by PCL's comparison (d2 < r2 in float) instead of "distance <= eps", so that all
///   differences from PCL come from the mask; "|p_d - p'_d| <= eps" before it allows for rounding for the same reason;
/// - line 5 of Algorithm 4 compares heads with H1 != H2; two returns without a head pass it, to start a subcluster;
/// - a return without neighbours has no head; it is a cluster of its own here, which matters for minPts = 1 only.
class PaperLisco {
 public:
  /// Clusters one rotation, step by step.
  /// \param matrix M, step by step: cell (laser l, step s) at s * lasers + l; cells without a return fail isReturn
  /// \return cluster number per cell, kNoCluster without a return; valid until the next call
  const std::vector<std::uint32_t>& cluster(const std::vector<lisco::Return>& matrix, std::size_t lasers,
                                            const NominalSensor& sensor, float tolerance);

  static constexpr std::uint32_t kNoCluster = ~std::uint32_t{0};

  /// What a call has done: section IV's trade-off between getH and merge.
  struct Work {
    std::size_t pairs = 0;       ///< pairs of points whose heads were compared: two calls of getH each
    std::size_t merges = 0;      ///< calls of merge
    std::size_t relabelled = 0;  ///< points that were given another head by these
  };
  /// Counting takes 1.5 % of the instructions.
  const Work& work() const { return work_; }

 private:
  using Point = std::uint32_t;  ///< number of a cell
  using Head = std::uint32_t;   ///< the point that names a subcluster

  /// A linked list of arrays, which grows without moving and is spliced in O(1).
  struct Members {
    std::list<std::vector<Point>> arrays;
    std::size_t size = 0;
  };

  void receiveStep(std::size_t step);
  void cluster(Point p, const NeighborMask& mask);
  void compare(Point p, Point other);

  Head getH(Point p) const { return head_[p]; }
  void setH(Point p, Head head);
  Head createH(Point p, Point other);
  void merge(Head a, Head b);

  const lisco::Return* matrix_ = nullptr;
  std::size_t lasers_ = 0;
  std::size_t steps_ = 0;
  NominalSensor sensor_{};
  lisco::Tolerance tolerance_;
  float eps_ = 0;
  std::vector<float> distance_;  ///< p_d per cell; 0: no return
  std::vector<Head> head_;       ///< per cell
  std::unordered_map<Head, Members> subclusters_;
  Work work_;
};

}  // namespace lisco_reference
