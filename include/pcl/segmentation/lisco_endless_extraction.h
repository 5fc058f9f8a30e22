// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/export.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <pcl/point_cloud.h>
#include <pcl/segmentation/lisco_column_stream.h>

#include "lisco/endless_clusterer.h"

namespace pcl {

template <typename PointT>
struct LiscoEndlessCluster;

/** \brief Euclidean clusters of a rotating LiDAR whose columns never end: each is delivered once, as soon as no later
 * column can reach it, whole across the borders of rotations.
 *
 * \code
 * pcl::LiscoEndlessExtraction<pcl::PointXYZI> endless;
 * endless.setClusterTolerance (0.4);
 * endless.setMinClusterSize (10);
 * endless.setClockwise (true);
 * endless.setClusterCallback ([] (const pcl::LiscoEndlessCluster<pcl::PointXYZI>& cluster) { ... });
 * endless.beginStream ();
 * while (...)
 *   endless.addColumn (points, 64, turns);                 // turns of the sensor since any moment
 * endless.finish ();
 * \endcode
 *
 * Returns are compared only within less than half a turn of each other, so the next rotation's view of the same wall is
 * a new cluster; a cluster that lasts a whole turn is delivered in parts. lisco::EndlessClusterer defines which
 * returns are neighbours. The azimuth of a return must be near that of its column, as setStartAzimuth () and
 * setClockwise () define it: see setStagger (). Columns are as for LiscoStreamExtraction. \ingroup segmentation
 */
template <typename PointT>
class LiscoEndlessExtraction : public detail::LiscoColumnStream<PointT> {
  using Base = detail::LiscoColumnStream<PointT>;

 public:
  using PointCloud = typename Base::PointCloud;                 ///< of its points
  using Cluster = LiscoEndlessCluster<PointT>;                  ///< delivered by the callback
  using ClusterCallback = std::function<void(const Cluster&)>;  ///< receives it

  /** \brief Begin a stream. Discards clusters of the last one not yet delivered.
   * \return false, after a PCL_ERROR and without effect, if the stagger is not within 0..pi/8, the sensor origin is not
   * finite, or the start azimuth is not within -1e6..1e6 radians
   */
  bool beginStream();

  /** \brief Set the receiver of the clusters. A cluster is valid during the call only. The receiver must not call this
   * object; if it throws, the stream ends. Takes effect at once.
   */
  inline void setClusterCallback(ClusterCallback callback) {
    Receiver receiver;
    // Made in the header, not in the library: see LiscoColumnStream::allocate ().
    if (callback)
      receiver = [this, callback = std::move(callback), cluster = Cluster()](
                     const lisco::EndlessCluster& delivered, const PointT* points,
                     const typename Cluster::Cell* cells) mutable {
        cluster.cloud.points.assign(points, points + delivered.size());
        cluster.cloud.header = header_;
        cluster.cloud.width = static_cast<std::uint32_t>(delivered.size());
        cluster.cloud.height = 1;
        cluster.cloud.is_dense = true;
        cluster.cells.assign(cells, cells + delivered.size());
        cluster.first_position = delivered.firstPosition();
        cluster.last_position = delivered.lastPosition();
        cluster.is_cut = delivered.isCut();
        cluster.is_continued = delivered.isContinued();
        callback(cluster);
      };
    setReceiver(std::move(receiver));
  }

  /** \brief Add the next column; delivers the clusters that it cannot reach.
   * \param[in] points one of each laser; copied
   * \param[in] count number of rows, may be 0
   * \param[in] position turns of the sensor since any moment, never less than that of the column before
   * \return false, after a PCL_ERROR and without effect: before beginStream (), or after an exception; if \a points is
   * null and count is not 0; if there are more rows than lasers declared; if the columns that are held, of as many rows
   * as the largest so far, are more points than pcl::index_t can number; if the position is less than the one before,
   * not finite, or beyond 1e12 turns
   */
  inline bool addColumn(const PointT* points, std::size_t count, double position) {
    return (addColumnAt(points, count, &position));
  }

  /** \brief Add a column, 1 / getColumnsPerTurn () turns after the column before, at 0 for the first one. False, after
   * a PCL_ERROR and without effect, if the number of columns of a turn is not known.
   */
  inline bool addColumn(const PointT* points, std::size_t count) { return (addColumnAt(points, count, nullptr)); }

  /** \brief The same; the points of the cloud are the rows. */
  inline bool addColumn(const PointCloud& column, double position) {
    return (addColumn(column.points.data(), column.size(), position));
  }
  /** \brief The same without a position. */
  inline bool addColumn(const PointCloud& column) { return (addColumn(column.points.data(), column.size())); }

  /** \brief Deliver the clusters that the columns so far complete, without waiting for a block of them. */
  void update();

  /** \brief End the stream: deliver all clusters. More columns may follow; they are a new stream. */
  void finish();

  LiscoEndlessExtraction();
  ~LiscoEndlessExtraction();
  LiscoEndlessExtraction(const LiscoEndlessExtraction&) = delete;
  LiscoEndlessExtraction& operator=(const LiscoEndlessExtraction&) = delete;

  /** \brief Number of returns since beginStream (), of the columns clustered so far. */
  std::uint64_t getNumberOfReturns() const;

  /** \brief Number of outliers among them: returns whose azimuth differs from that of their column by more than the
   * stagger. Many outliers indicate a wrong start azimuth, sense of rotation, position or stagger.
   */
  std::uint64_t getNumberOfOutliers() const;

  /** \brief Number of columns in memory, about a turn and a half at most. */
  std::size_t getNumberOfColumnsHeld() const;

  // The setters below and those of the sizes take effect when the next stream begins.

  /** \brief Position of the sensor, metres, in the coordinates of the points (default: the origin): the centre of the
   * azimuths.
   */
  inline void setSensorOrigin(const Eigen::Vector4f& origin) { sensor_origin_ = {origin[0], origin[1], origin[2]}; }
  /** \brief Get the position of the sensor. */
  inline Eigen::Vector4f getSensorOrigin() const {
    return (Eigen::Vector4f(sensor_origin_[0], sensor_origin_[1], sensor_origin_[2], 0.0F));
  }

  /** \brief Set whether the sensor turns clockwise, seen from above (default false). */
  inline void setClockwise(bool clockwise) { clockwise_ = clockwise; }
  /** \brief Get whether the sensor turns clockwise. */
  inline bool getClockwise() const { return (clockwise_); }

  /** \brief Set the azimuth of position 0, radians, counter-clockwise from the x axis (default 0). */
  inline void setStartAzimuth(double azimuth) { start_azimuth_ = azimuth; }
  /** \brief Get the azimuth of position 0. */
  inline double getStartAzimuth() const { return (start_azimuth_); }

  /** \brief Set by how much, in radians, a return's azimuth may differ from that of its column, 0..pi/8 (default pi/8).
   * Clusters are delivered the later, the larger it is. A return that differs by more is a cluster of its own.
   */
  inline void setStagger(double stagger) { stagger_ = stagger; }
  /** \brief Get by how much a return's azimuth may differ from that of its column. */
  inline double getStagger() const { return (stagger_); }

  /** \brief Set the number of columns of a turn, more than 0, so that columns can be added without a position (default
   * 0: each column has one).
   */
  inline void setColumnsPerTurn(double columns) { columns_per_turn_ = columns; }
  /** \brief Get the number of columns of a turn. */
  inline double getColumnsPerTurn() const { return (columns_per_turn_); }

  /** \brief Set how many columns are clustered together, 1..64 (default 16); other values are clamped. The fewer, the
   * sooner clusters are delivered. Takes effect when the next stream begins.
   */
  inline void setBlockColumns(std::size_t columns) { block_columns_ = columns; }
  /** \brief Get how many columns are clustered together. */
  inline std::size_t getBlockColumns() const { return (block_columns_); }

 private:
  using Base::cluster_tolerance_;
  using Base::header_;
  using Base::lasers_;
  using Base::max_pts_per_cluster_;
  using Base::min_pts_per_cluster_;

  /** \brief Converts a cluster of the engine, its points and their cells to the user's. */
  using Receiver =
      std::function<void(const lisco::EndlessCluster&, const PointT* points, const typename Cluster::Cell* cells)>;

  void setReceiver(Receiver receiver);
  /** \brief Adds a column at the position given, or at the engine's next one (nullptr). */
  bool addColumnAt(const PointT* points, std::size_t count, const double* given_position);

  std::array<float, 3> sensor_origin_{};
  bool clockwise_ = false;
  double start_azimuth_ = 0;
  double stagger_ = lisco::EndlessParameters::kMaxStagger;
  double columns_per_turn_ = 0;
  std::size_t block_columns_ = 16;

  class State;
  std::unique_ptr<State> state_;
};

/** \brief A cluster of an endless stream, with its points.
 * \ingroup segmentation
 */
template <typename PointT>
struct LiscoEndlessCluster {
  /** \brief Where a point was measured. */
  struct Cell {
    std::uint64_t column;  ///< counted from beginStream () or finish ()
    std::uint32_t row;     ///< its place in the column
  };

  pcl::PointCloud<PointT> cloud;  ///< the points, in one row
  std::vector<Cell> cells;        ///< of each of them
  double first_position;          ///< of its first column, turns
  double last_position;           ///< of its last column, less than a turn after the first
  bool is_cut;                    ///< delivered after a whole turn, possibly before its end
  bool is_continued;              ///< the continuation of a cut cluster
};

}  // namespace pcl

#ifdef PCL_NO_PRECOMPILE
#include <pcl/segmentation/impl/lisco_endless_extraction.hpp>
#endif
