// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/export.h"

#include <array>
#include <vector>

#include <Eigen/Core>

#include <pcl/PointIndices.h>
#include <pcl/pcl_base.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/segmentation/lisco_pcl_version.h>

#include "lisco/cluster_features.h"

namespace pcl {

/** \brief Clusters as objects: size, centroid, axis-aligned and oriented box, nearest range, density.
 *
 * \code
 * pcl::LiscoClusterFeatures<pcl::PointXYZI> estimation;
 * estimation.setInputCloud (cloud);
 * std::vector<lisco::ClusterFeatures> features;
 * estimation.compute (clusters, features);            // of pcl::LiscoClusterExtraction, or of any PCL class
 * features[0].box.yaw, features[0].box.length ...     // radians, metres
 * \endcode
 *
 * Or, for the points given by setIndices () as one cluster, in the way of pcl::MomentOfInertiaEstimation: compute (),
 * then getAABB (), getOBB () and getMassCenter (). Unlike there, the oriented box is upright (it turns about the z axis
 * only) and fits the visible sides of the cluster instead of its main axes, which a half-seen car does not follow.
 * Degenerate clusters and precision: lisco::clusterFeatures. Points with a NaN or infinite coordinate are left out.
 * The nearest range is counted from the cloud's sensor_origin_, which must be finite.
 * \ingroup features
 */
template <typename PointT>
class LiscoClusterFeatures : public PCLBase<PointT> {
  using BasePCLBase = PCLBase<PointT>;

 public:
  /** \brief Set the input, as in PCLBase. The getters return false until the next compute (). */
  void setInputCloud(const typename BasePCLBase::PointCloudConstPtr& cloud) override {
    is_valid_ = false;
    BasePCLBase::setInputCloud(cloud);
  }
  /** \brief Set the points that compute () takes for one cluster, as in PCLBase; the getters as above. */
  void setIndices(const IndicesPtr& indices) override { select(indices); }
  /** \copydoc setIndices(const IndicesPtr&) */
  void setIndices(const IndicesConstPtr& indices) override { select(indices); }
  /** \copydoc setIndices(const IndicesPtr&) */
  void setIndices(const typename BasePCLBase::PointIndicesConstPtr& indices) override { select(indices); }
  /** \copydoc setIndices(const IndicesPtr&) */
  void setIndices(std::size_t row_start, std::size_t col_start, std::size_t nb_rows, std::size_t nb_cols) override {
    select(row_start, col_start, nb_rows, nb_cols);
  }

  /** \brief Features of each cluster.
   * \param[in] clusters indices of points of the input cloud; setIndices () has no effect
   * \param[out] features as many as clusters, in their order. Cleared, with a PCL_ERROR, if there is no input, its
   * sensor_origin_ is not finite, or an index is not within it
   */
  void compute(const std::vector<PointIndices>& clusters, std::vector<lisco::ClusterFeatures>& features);

  /** \brief Computes the features of the input (setInputCloud (), setIndices ()) as one cluster.
   * Without input, with an index beyond it, or if its sensor_origin_ is not finite: a PCL_ERROR, and the getters return
   * false.
   */
  void compute();

  /** \brief The features of compute ().
   * \return false before compute (), or if it failed
   */
  bool getFeatures(lisco::ClusterFeatures& features) const;

  /** \brief The axis-aligned box of compute (). \return as getFeatures () */
  bool getAABB(PointT& min_point, PointT& max_point) const;

  /** \brief The oriented box of compute (), as pcl::MomentOfInertiaEstimation gives it.
   * \param[out] min_point, max_point corners relative to \a position, before the rotation
   * \param[out] position centre of the box
   * \param[out] rotational_matrix rotation about the z axis; x is along the length
   * \return as getFeatures ()
   */
  bool getOBB(PointT& min_point, PointT& max_point, PointT& position, Eigen::Matrix3f& rotational_matrix) const;

  /** \brief The centroid of compute (). \return as getFeatures () */
  bool getMassCenter(Eigen::Vector3f& mass_center) const;

 protected:
  using BasePCLBase::deinitCompute;
  using BasePCLBase::indices_;
  using BasePCLBase::initCompute;
  using BasePCLBase::input_;

 private:
  template <typename... Selected>
  void select(const Selected&... selected) {
    is_valid_ = false;
    BasePCLBase::setIndices(selected...);
  }
  /** \return false, with a PCL_ERROR, if an index is not within the input, or its sensor_origin_ is not finite */
  bool computeOf(const Indices& indices, lisco::ClusterFeatures& features);

  std::vector<std::array<float, 3>> points_;  ///< of the cluster at hand
  lisco::ClusterFeatures features_;
  bool is_valid_ = false;
};

}  // namespace pcl

#ifdef PCL_NO_PRECOMPILE
#include <pcl/features/impl/lisco_cluster_features.hpp>
#endif
