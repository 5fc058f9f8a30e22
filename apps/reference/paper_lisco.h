// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <list>
#include <unordered_map>
#include <vector>

#include "lisco/return.h"
#include "core/neighbour.h"

namespace lisco_reference {

/// What Algorithm 2 knows of a sensor: the smallest angles between two steps and between two lasers, radians.
struct NominalSensor {
  double delta_alpha, delta_theta;
};

/// Algorithm 2's neighbour mask: how many lasers above and below, and how many steps before.
struct NeighborMask {
  std::size_t lambda, sigma;
};

/// Algorithm 2, literally. It misses neighbours on real scans (see doc/algorithm.md).
/// \param distance p_d, metres
/// \return 2^31 lasers and steps, that is all of them, for a point nearer than eps, where the paper's arcsine is not
///         defined
NeighborMask getNeighborMask(double distance, double eps, const NominalSensor& sensor);

/// The paper's Lisco as it is printed: Algorithms 2 to 4 and section V's data structures. A reference implementation,
/// to show what the paper's own method costs and where its mask misses neighbours; it is not part of the library.
/// (Algorithm 1 is PCL's EuclideanClusterExtraction, which is at hand.)
///
/// What the paper leaves open, or what cannot be meant as printed:
/// - two returns are neighbours by PCL's comparison (d2 < r2 in float) instead of "distance <= eps", so that what
///   differs from PCL is what the mask misses, and nothing else; for the same reason "|p_d - p'_d| <= eps", which goes
///   before it, leaves room for rounding;
/// - line 5 of Algorithm 4 compares heads with H1 != H2; two returns without a head are to pass it, or no subcluster
///   would ever start;
/// - arcsin (eps / p_d) is not defined for p_d < eps: the mask is everything then (see getNeighborMask);
/// - a return without neighbours has no head. It is a cluster of its own here, which matters for minPts = 1 only.
class PaperLisco {
 public:
  /// Clusters one rotation, step by step.
  /// \param matrix M, step by step: cell (laser l, step s) at s * lasers + l; cells without a return fail isReturn
  /// \return a number per cell: the same for two returns if and only if they are in one cluster, kNoCluster where there
  ///         is no return; valid until the next call
  const std::vector<std::uint32_t>& cluster(const std::vector<lisco::Return>& matrix, std::size_t lasers,
                                            const NominalSensor& sensor, float tolerance);

  static constexpr std::uint32_t kNoCluster = ~std::uint32_t{0};

 private:
  using Point = std::uint32_t;  ///< number of a cell
  using Head = std::uint32_t;   ///< the point that names a subcluster

  /// A linked list of arrays: grows without moving, and is appended to another in O(1).
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
};

}  // namespace lisco_reference
