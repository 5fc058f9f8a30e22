// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/export.h"

#include <vector>

#include <pcl/search/kdtree.h>
#include <pcl/search/search.h>
#include <pcl/segmentation/lisco_pcl_version.h>

namespace pcl::detail {

/** \brief The warning of a search method with which PCL finds other clusters than with KdTree<PointT> (false). */
struct LISCO_EXPORT LiscoSearchMethodWarning {
  enum class Reason { kEpsilon, kRepresentation };
  /** \brief Prints a PCL_WARN, once per process and reason. */
  static void print(Reason reason, const char* caller);
};

/** \brief Whether a point representation leaves x, y and z as they are, tried on one point. */
template <typename PointT>
bool isLiscoXyz(const PointRepresentation<PointT>& representation) {
  if (representation.getNumberOfDimensions() != 3) return (false);
  PointT point{};
  point.x = 1.5F;
  point.y = -2.5F;
  point.z = 3.5F;
  std::vector<float> values(3);
  representation.vectorize(point, values);
  return (values == std::vector<float>{1.5F, -2.5F, 3.5F});
}

/** \brief Warns, once per process and kind, of a pcl::search::KdTree whose epsilon is above 0, or whose point
 * representation is not (x, y, z). Any other search method passes.
 * \param[in] method may be nullptr
 * \param[in] caller named in front of the PCL_WARN
 */
template <typename PointT>
void checkLiscoSearchMethod(const search::Search<PointT>* method, const char* caller) {
  const auto* const tree = dynamic_cast<const search::KdTree<PointT>*>(method);
  if (!tree) return;
  using Reason = LiscoSearchMethodWarning::Reason;
  if (tree->getEpsilon() > 0.0F) LiscoSearchMethodWarning::print(Reason::kEpsilon, caller);
  const auto representation = tree->getPointRepresentation();
  if (representation && !isLiscoXyz(*representation)) LiscoSearchMethodWarning::print(Reason::kRepresentation, caller);
}

}  // namespace pcl::detail
