// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/export.h"

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include <pcl/filters/filter_indices.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/segmentation/lisco_pcl_version.h>

#include "lisco/label_ground.h"

namespace pcl {

/** \brief Removes the ground from a rotating LiDAR's scan.
 *
 * \code
 * pcl::LiscoGroundFilter<pcl::PointXYZI> filter;
 * filter.setInputCloud (cloud);
 * filter.filter (*objects);                         // all but the ground
 * filter.setNegative (true);
 * filter.filter (*ground);                          // the ground
 * \endcode
 *
 * Points that are no measurements are always removed: those with a NaN or infinite coordinate, as by
 * pcl::PassThrough, and those at exactly (0, 0, 0). setIndices (), getRemovedIndices (), setKeepOrganized () and
 * setUserFilterValue () act as in all filters; only the indexed points are read. Indices stay in the order given.
 *
 * The cloud's z axis points up, to within about 10 degrees. Organized scans (height = lasers, width = steps of the
 * rotation) are filtered column by column, as lisco::GroundFilter does it; the sensor's position and tilt are
 * estimated. Unorganized clouds, in any order, are sorted by azimuth about sensor_origin_ first; a height that is set
 * counts from there. If no height is set, the ground is less than 0.5 m below sensor_origin_, and hardly any return
 * straight below it, as in a vehicle's frame, they are sorted about a point 1.5 m above it instead. If no height is
 * set, and the cloud as a whole shows no ground clearly, none is removed.
 *
 * An infinite height, a slope out of range, a sensor_origin_ that is not finite, or an index that is not within the
 * cloud: a PCL_ERROR, and no indices. With setKeepOrganized (true), the output then is the whole input, as after an
 * error of pcl::PassThrough.
 * \ingroup filters
 */
template <typename PointT>
class LiscoGroundFilter : public FilterIndices<PointT> {
 public:
  using PointCloud = typename FilterIndices<PointT>::PointCloud;  ///< as in all filters
  using Ptr = shared_ptr<LiscoGroundFilter<PointT>>;              ///< the same
  using ConstPtr = shared_ptr<const LiscoGroundFilter<PointT>>;   ///< the same

  /** \brief Constructor.
   * \param[in] extract_removed_indices whether getRemovedIndices () is to be filled
   */
  explicit LiscoGroundFilter(bool extract_removed_indices = false) : FilterIndices<PointT>(extract_removed_indices) {
    this->filter_name_ = "LiscoGroundFilter";
  }

  /** \brief Set the height of the sensor above the ground beneath it.
   * \param[in] height metres, any finite value; NaN (the default): estimated from the cloud
   */
  inline void setSensorHeight(float height) { sensor_height_ = height; }
  /** \brief Get the height of the sensor in metres, as it was set. */
  inline float getSensorHeight() const { return (sensor_height_); }

  /** \brief Set the steepest ground.
   * \param[in] degrees against the sensor's horizon, 1 to 60 (default 17); see lisco::GroundParameters
   */
  inline void setMaxSlope(float degrees) { max_slope_ = degrees; }
  /** \brief Get the steepest ground in degrees. */
  inline float getMaxSlope() const { return (max_slope_); }

 protected:
  /** \brief Filter, by indices.
   * \param[out] indices the points that remain, in the order of the input's indices
   */
  void applyFilter(Indices& indices) override;
  using FilterIndices<PointT>::applyFilter;

 private:
  float sensor_height_ = std::numeric_limits<float>::quiet_NaN();  // metres
  float max_slope_ = 17.0F;                                        // degrees
  // Memory, kept from cloud to cloud:
  lisco::GroundLabeller labeller_;
  std::vector<std::array<float, 3>> copy_;  // of the points
  std::vector<std::uint8_t> ground_;        // their labels
};

}  // namespace pcl

#ifdef PCL_NO_PRECOMPILE
#include <pcl/filters/impl/lisco_ground_filter.hpp>
#endif
