// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/export.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "lisco/return.h"

namespace lisco {

/// How points are clustered and labelled.
struct LabelParameters {
  float tolerance = 0.0F;                  ///< eps, metres; see Parameters::tolerance for 0, negative and NaN values
  std::size_t min_size = 1;                ///< clusters of fewer points get no label
  std::size_t max_size = ~std::size_t{0};  ///< nor do clusters of more points
  std::size_t lasers = 1;  ///< rows of an organized cloud, stored row by row; 1: unorganized. Decides the speed only
  std::array<float, 3> origin{};  ///< position of the sensor, metres, if not (0, 0, 0). Decides the speed only
  std::size_t threads = 1;        ///< 0: one for each core; no more are used than there are cores
};

/// Labels points by their Euclidean clusters, which are those of pcl::EuclideanClusterExtraction:
///
///   std::vector<float> points = ...;                        // x, y, z, x, y, z, ...
///   std::vector<std::int32_t> labels(points.size() / 3);
///   lisco::LabelParameters parameters;
///   parameters.tolerance = 0.4F;
///   parameters.min_size = 10;
///   lisco::labelClusters(points.data(), labels.size(), 3 * sizeof(float), parameters, labels.data());
///
/// \param points the first point: x, y and z as floats, metres; NaN, infinite or all 0 where there is no return
/// \param count number of points, below 2^31
/// \param stride bytes from one point to the next, at least 12; points need not be aligned
/// \param labels receives `count` labels: 0 for the largest cluster and so on, in the order of PCL's vector of
///        clusters; -1 for points in no cluster
/// \return number of clusters
/// \throws std::invalid_argument if the stride is below 12, count is 2^31 or more, lasers do not divide count, or a
///         pointer is null while count is not 0
LISCO_EXPORT std::size_t labelClusters(const void* points, std::size_t count, std::size_t stride,
                                       const LabelParameters& parameters, std::int32_t* labels);

/// labelClusters () for points in memory of any layout, scan after scan:
///
///   lisco::ClusterLabeller labeller;
///   const auto cell_at = [&](std::size_t laser, std::size_t column) { return lisco::Return{...}; };
///   while (...) clusters = labeller.label(count, cell_at, parameters, labels);
///
/// Nothing is allocated once the buffers have grown to the largest scan seen (see ColumnClusterer). Not thread safe;
/// any number of instances may work side by side.
class LISCO_EXPORT ClusterLabeller {
 public:
  ClusterLabeller();
  ~ClusterLabeller();
  ClusterLabeller(const ClusterLabeller&) = delete;
  ClusterLabeller& operator=(const ClusterLabeller&) = delete;

  /// \param count number of points, below 2^31: LabelParameters::lasers rows of as many columns each
  /// \param cells callable as Return (std::size_t laser, std::size_t column), or block by block as CellSource has it;
  ///        source indices are ignored. May be called several times for a cell, and by several threads at once if
  ///        LabelParameters::threads allows it
  /// \param labels receives `count` labels, laser by laser; see labelClusters
  /// \return number of clusters
  /// \throws as labelClusters
  template <typename Cells>
  std::size_t label(std::size_t count, Cells&& cells, const LabelParameters& parameters, std::int32_t* labels) {
    return labelAll(count, CellSource(cells), parameters, labels);
  }

 private:
  std::size_t labelAll(std::size_t count, const CellSource& cells, const LabelParameters& parameters,
                       std::int32_t* labels);

  class LISCO_HIDDEN State;
  std::unique_ptr<State> state_;
};

}  // namespace lisco
