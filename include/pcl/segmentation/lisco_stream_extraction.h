// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/cxx17.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include <pcl/PointIndices.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/segmentation/lisco_cluster_writer.h>
#include <pcl/segmentation/lisco_column_store.h>
#include <Eigen/Core>
#include <Eigen/Geometry>

#include "lisco/column_clusterer.h"
#include "lisco/endless_clusterer.h"
#include "lisco/export.h"
#include "lisco/sensor_hints.h"
#include "lisco/window_clusterer.h"

namespace pcl {

namespace detail {

/** \brief What the classes that are given one column after the other have in common. Their errors are told by PCL_ERROR;
 * what was wrong has no effect. An exception (memory was refused, or a callback threw) ends the rotation or stream, unless
 * it comes from writing clusters out: no column is taken and nothing is delivered until the next one begins.
 */
template <typename PointT>
class LiscoColumnStream {
 public:
  using PointCloud = pcl::PointCloud<PointT>;

  /** \brief Set the cluster tolerance: points nearer to each other than this belong together. Takes effect when the next
   * rotation or stream begins.
   * \param[in] tolerance metres (default 0). A negative one acts as its absolute value; with 0 or NaN every point is a cluster
   * of its own.
   */
  inline void setClusterTolerance(double tolerance) { cluster_tolerance_ = tolerance; }

  /** \brief Get the cluster tolerance in metres. */
  inline double getClusterTolerance() const { return (cluster_tolerance_); }

  /** \brief Set the least number of points of a cluster (default 1). */
  inline void setMinClusterSize(pcl::uindex_t min_cluster_size) { min_pts_per_cluster_ = min_cluster_size; }

  /** \brief Get the least number of points of a cluster. */
  inline pcl::uindex_t getMinClusterSize() const { return (min_pts_per_cluster_); }

  /** \brief Set the largest number of points of a cluster (default: no limit). */
  inline void setMaxClusterSize(pcl::uindex_t max_cluster_size) { max_pts_per_cluster_ = max_cluster_size; }

  /** \brief Get the largest number of points of a cluster. */
  inline pcl::uindex_t getMaxClusterSize() const { return (max_pts_per_cluster_); }

  /** \brief Declare the number of lasers: a column with more rows is an error (default 0: any number). Columns may always
   * have fewer.
   */
  inline void setNumberOfLasers(std::size_t lasers) { lasers_ = lasers; }

  /** \brief Get the number of lasers, as it was set. */
  inline std::size_t getNumberOfLasers() const { return (lasers_); }

  /** \brief Set the header that clusters and clouds are given from now on. */
  inline void setHeader(const PCLHeader& header) { header_ = header; }

  /** \brief Get the header of clusters and clouds. */
  inline const PCLHeader& getHeader() const { return (header_); }

 protected:
  /** \brief Whether a column can be taken; if not, after a PCL_ERROR.
   * \param[in] columns number of columns kept, with this one
   * \param[in] caller named in front of the PCL_ERROR
   */
  bool accepts(const PointT* points, std::size_t count, std::size_t columns, const char* caller);

  /** \brief A column with its cells' names, as the engine takes it. Valid until the next call. */
  const lisco::Return* namedColumn(const PointT* points, std::size_t count, std::uint32_t first_name);

  /** \brief Appends the clusters of some columns as LiscoClusterExtraction does it for their organized cloud.
   * \param[in] clusterer holds the subclusters of just these columns
   */
  template <typename Clusterer>
  void appendClusters(Clusterer& clusterer, std::uint64_t first_column, std::uint64_t end_column,
                      std::vector<PointIndices>& clusters);

  double cluster_tolerance_ = 0;
  pcl::uindex_t min_pts_per_cluster_ = 1;
  pcl::uindex_t max_pts_per_cluster_ = std::numeric_limits<pcl::uindex_t>::max();
  std::size_t lasers_ = 0;
  PCLHeader header_;

  bool begun_ = false;         ///< and left by no exception since
  std::size_t most_rows_ = 0;  ///< of any column since the beginning
  LiscoColumnStore<PointT> store_;

 private:
  LiscoClusterWriter writer_;
  std::vector<lisco::Return> named_column_;
};

}  // namespace detail

/** \brief Euclidean clusters of a rotating LiDAR's scan, while the sensor turns: the work is done as the columns arrive, the
 * subclusters so far can be had at any moment, and the clusters are there right after the last column.
 *
 * \code
 * pcl::LiscoStreamExtraction<pcl::PointXYZI> stream;
 * stream.setClusterTolerance (0.4);                        // metres
 * stream.setMinClusterSize (10);
 * stream.beginRotation ();
 * while (...)
 *   stream.addColumn (points, 64);                         // what the lasers measured in this step
 * std::vector<pcl::PointIndices> clusters;
 * pcl::PointCloud<pcl::PointXYZI> cloud;                   // organized: a row for each laser, a column for each step
 * stream.endRotation (clusters, cloud);
 * \endcode
 *
 * endRotation () gives, byte for byte, the vector that LiscoClusterExtraction::extract (), and so EuclideanClusterExtraction
 * with pcl::search::KdTree<PointT> (false), gives for the organized cloud of these columns (the exception is that of extract ()). In that cloud a point has the index
 * row * width + column; its width is the number of columns, its height the most rows of any column.
 *
 * The rows of a column are its lasers, always in the same order; a laser without a return is NaN or (0, 0, 0), columns
 * may have fewer rows than others or none. Points of each column are copied.
 *
 * Use one object for all rotations: it keeps its memory, and it learns from the last rotation where to look in the next one. That
 * decides the speed, never the result. One object is for one thread at a time; any number of objects may work side by side.
 * \ingroup segmentation
 */
template <typename PointT>
class LiscoStreamExtraction : public detail::LiscoColumnStream<PointT> {
  using Base = detail::LiscoColumnStream<PointT>;

 public:
  using PointCloud = typename Base::PointCloud;  ///< of its points

  /** \brief Where the sensor stands in the coordinates of the points (default: the origin). Helps the speed if it is not
   * there, and is the sensor_origin_ of the cloud.
   */
  inline void setSensorOrigin(const Eigen::Vector4f& origin) { sensor_origin_ = {origin[0], origin[1], origin[2]}; }

  /** \brief Get where the sensor stands. */
  inline Eigen::Vector4f getSensorOrigin() const {
    return (Eigen::Vector4f(sensor_origin_[0], sensor_origin_[1], sensor_origin_[2], 0.0F));
  }

  /** \brief Set how many columns are worked on together, 1..64 (default 64, which is the least work). The fewer, the
   * less is left to do for a look or at the end. Takes effect when the next rotation begins; it changes no result.
   */
  inline void setBlockColumns(std::size_t columns) { block_columns_ = columns; }

  /** \brief Get how many columns are worked on together. */
  inline std::size_t getBlockColumns() const { return (block_columns_); }

  /** \brief Begin a rotation. One that has not been ended is forgotten. */
  void beginRotation();

  /** \brief Add the next column of the rotation.
   * \param[in] points what the lasers measured; copied
   * \param[in] count number of rows, may be 0
   * \return false, after a PCL_ERROR and without effect: outside a rotation; if there are more rows than lasers
   * declared; if the organized cloud would have more points than pcl::index_t can number
   */
  bool addColumn(const PointT* points, std::size_t count);

  /** \brief The same; the points of the cloud are the rows. */
  bool addColumn(const PointCloud& column);

  /** \brief Number of columns added, which is the width of the cloud so far. */
  inline std::size_t getNumberOfColumns() const { return (store_.size()); }

  // The looks: at the columns so far of this rotation, or at the last rotation until the next one begins.

  /** \brief Number of subclusters, of any size. */
  std::size_t getNumberOfSubclusters();

  /** \brief Number of points of each subcluster.
   * \param[out] sizes one for each subcluster, by its number
   */
  void getSubclusterSizes(std::vector<pcl::uindex_t>& sizes);

  /** \brief The number of the subcluster that a point is in; -1 if there is no return, or no such row or column. Numbers hold
   * until the next column is added.
   */
  pcl::index_t getSubcluster(std::size_t row, std::size_t column);

  /** \brief The subclusters of at least the least and at most the largest size: the clusters, if the rotation were over. The width
   * of the cloud is the number of columns so far, and changes the points' indices with every column.
   * \param[out] clusters as of endRotation (); what it held is forgotten
   */
  void getSubclusters(std::vector<PointIndices>& clusters);

  /** \brief The organized cloud of the columns so far. Cells that were not given are NaN. */
  inline void getCloud(PointCloud& cloud) const {
    store_.organize(0, store_.endColumn(), cloud);
    cloud.header = header_;
    cloud.sensor_origin_ = getSensorOrigin();
    cloud.sensor_orientation_ = Eigen::Quaternionf::Identity();
  }

  /** \brief End the rotation.
   * \param[in,out] clusters receives the clusters after those it already holds; then all are sorted by size, largest first,
   * as LiscoClusterExtraction::extract () does it. Cleared if there was not one cell.
   * \return false, after a PCL_ERROR and with \a clusters cleared, if no rotation has begun
   */
  bool endRotation(std::vector<PointIndices>& clusters);

  /** \brief The same, and the organized cloud.
   * \param[out] cloud the one the indices are of; empty if no rotation has begun
   */
  inline bool endRotation(std::vector<PointIndices>& clusters, PointCloud& cloud) {
    const bool ended = endRotation(clusters);
    if (ended)
      getCloud(cloud);
    else
      cloud.clear();
    return (ended);
  }

 private:
  using Base::begun_;
  using Base::cluster_tolerance_;
  using Base::header_;
  using Base::most_rows_;
  using Base::store_;

  void update();
  void learn();

  std::array<float, 3> sensor_origin_{};
  std::size_t block_columns_ = 64;
  lisco::ColumnClusterer clusterer_;
  lisco::SensorHints hints_;  ///< from the last rotation that was ended
  bool has_ended_ = false;  ///< the rotation in the store
  bool is_up_to_date_ = false;
};

/** \brief Euclidean clusters of the last W columns, every H columns, without clustering from scratch.
 *
 * \code
 * pcl::LiscoWindowExtraction<pcl::PointXYZI> windows;
 * windows.setClusterTolerance (0.4);
 * windows.setWindowSize (1800);
 * windows.setHop (100);
 * windows.beginStream ();
 * while (...)
 *   if (windows.addColumn (points, 64)) {                  // a window ends with this column
 *     std::vector<pcl::PointIndices> clusters;
 *     windows.extract (clusters);
 *     ...
 *   }
 * \endcode
 *
 * extract () gives, byte for byte, the vector that LiscoClusterExtraction::extract () gives for the organized cloud of the
 * window's columns: row * width + column is the index of a point, the width the number of columns, the height the most rows of
 * any of them. Columns are as for LiscoStreamExtraction. \ingroup segmentation
 */
template <typename PointT>
class LiscoWindowExtraction : public detail::LiscoColumnStream<PointT> {
  using Base = detail::LiscoColumnStream<PointT>;

 public:
  using PointCloud = typename Base::PointCloud;  ///< of its points

  /** \brief Set W, the number of columns of a window: a multiple of the hop. Takes effect when the next stream begins. */
  inline void setWindowSize(std::size_t columns) { window_size_ = columns; }

  /** \brief Get the number of columns of a window. */
  inline std::size_t getWindowSize() const { return (window_size_); }

  /** \brief Set H, after how many columns the next window ends. Takes effect when the next stream begins. */
  inline void setHop(std::size_t columns) { hop_ = columns; }

  /** \brief Get after how many columns the next window ends. */
  inline std::size_t getHop() const { return (hop_); }

  /** \brief Begin a stream. The last one is forgotten.
   * \return false, after a PCL_ERROR and without effect, if the window is no multiple, 1 or more, of the hop
   */
  bool beginStream();

  /** \brief Add the next column.
   * \param[in] points what the lasers measured; copied
   * \param[in] count number of rows, may be 0
   * \return whether a window ends with this column. The first windows are shorter: all columns so far. Also false, after a PCL_ERROR
   * and without effect: before beginStream (); if there are more rows than lasers declared; if the window would have more points
   * than pcl::index_t can number
   */
  bool addColumn(const PointT* points, std::size_t count);

  /** \brief The same; the points of the cloud are the rows. */
  bool addColumn(const PointCloud& column);

  /** \brief Number of columns of the last window that ended, 0 before the first. */
  inline std::size_t getNumberOfColumns() const { return (static_cast<std::size_t>(window_end_ - window_first_)); }

  /** \brief Extract the clusters of the last window that ended, until the next one ends.
   * \param[in,out] clusters receives the clusters after those it already holds; then all are sorted by size, largest first,
   * as LiscoClusterExtraction::extract () does it. Cleared if the window has not one cell.
   * \return false, after a PCL_ERROR and with \a clusters cleared, if no window has ended
   */
  bool extract(std::vector<PointIndices>& clusters);

  /** \brief The organized cloud of the last window that ended, until the next one ends: what the indices are of. Empty if no
   * window has ended.
   */
  inline void getWindow(PointCloud& cloud) const {
    store_.organize(window_first_, window_end_, cloud);
    cloud.header = header_;
  }

 private:
  using Base::begun_;
  using Base::cluster_tolerance_;
  using Base::header_;
  using Base::most_rows_;
  using Base::store_;

  std::size_t window_size_ = 0;
  std::size_t hop_ = 1;
  std::size_t columns_kept_ = 0;  ///< at the most
  std::uint64_t window_first_ = 0, window_end_ = 0;
  lisco::WindowClusterer clusterer_;
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
  bool is_cut;                    ///< it was delivered for having lasted a whole turn, perhaps before its end
  bool is_continued;              ///< it goes on from a cut one
};

/** \brief Euclidean clusters of a rotating LiDAR whose columns never end: each is delivered once, as soon as no later column can
 * reach it, whole across the borders of rotations.
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
 * Returns are compared only within less than half a turn of each other, so the next rotation's view of the same wall is a new
 * cluster; a cluster that lasts a whole turn is delivered in pieces. lisco::EndlessClusterer says precisely which returns are
 * neighbours. The azimuth of a return must be near that of its column, as setStartAzimuth () and setClockwise () tell it:
 * see setStagger (). Columns are as for LiscoStreamExtraction. \ingroup segmentation
 */
template <typename PointT>
class LiscoEndlessExtraction : public detail::LiscoColumnStream<PointT> {
  using Base = detail::LiscoColumnStream<PointT>;

 public:
  using PointCloud = typename Base::PointCloud;                 ///< of its points
  using Cluster = LiscoEndlessCluster<PointT>;                  ///< what is delivered
  using ClusterCallback = std::function<void(const Cluster&)>;  ///< who gets it

  LiscoEndlessExtraction() = default;
  LiscoEndlessExtraction(const LiscoEndlessExtraction&) = delete;
  LiscoEndlessExtraction& operator=(const LiscoEndlessExtraction&) = delete;
  ~LiscoEndlessExtraction() = default;

  // All of these take effect when the next stream begins, sizes as well; the callback at once.

  /** \brief Set who receives the clusters. The cluster is valid during the call: copy what is to last. It must neither throw
   * nor call this object.
   */
  inline void setClusterCallback(ClusterCallback callback) {
    callback_ = nullptr;
    if (!callback) return;
    // The cluster is made here, not in the library: see LiscoColumnStore.
    callback_ = [callback = std::move(callback), cluster = Cluster()](const LiscoEndlessExtraction& from,
                                                                      const lisco::EndlessCluster& delivered) mutable {
      cluster.cloud.points.assign(from.delivered_points_.begin(), from.delivered_points_.end());
      cluster.cloud.header = from.header_;
      cluster.cloud.width = static_cast<std::uint32_t>(cluster.cloud.points.size());
      cluster.cloud.height = 1;
      cluster.cloud.is_dense = true;
      cluster.cells = from.delivered_cells_;
      cluster.first_position = delivered.firstPosition();
      cluster.last_position = delivered.lastPosition();
      cluster.is_cut = delivered.isCut();
      cluster.is_continued = delivered.isContinued();
      callback(cluster);
    };
  }

  /** \brief Where the sensor stands in the coordinates of the points (default: the origin). Azimuths are seen from there. */
  inline void setSensorOrigin(const Eigen::Vector4f& origin) { parameters_.origin = {origin[0], origin[1], origin[2]}; }

  /** \brief Get where the sensor stands. */
  inline Eigen::Vector4f getSensorOrigin() const {
    return (Eigen::Vector4f(parameters_.origin[0], parameters_.origin[1], parameters_.origin[2], 0.0F));
  }

  /** \brief Set whether the sensor turns clockwise, seen from above (default false). */
  inline void setClockwise(bool clockwise) { parameters_.clockwise = clockwise; }

  /** \brief Get whether the sensor turns clockwise. */
  inline bool getClockwise() const { return (parameters_.clockwise); }

  /** \brief Set the azimuth of position 0, radians, counter-clockwise from the x axis (default 0). */
  inline void setStartAzimuth(double azimuth) { parameters_.start_azimuth = azimuth; }

  /** \brief Get the azimuth of position 0. */
  inline double getStartAzimuth() const { return (parameters_.start_azimuth); }

  /** \brief Set by how much, in radians, a return's azimuth may differ from that of its column, 0..pi/8 (default pi/8). Clusters
   * are delivered the later, the larger it is. A return that differs by more is a cluster of its own.
   */
  inline void setStagger(double stagger) { parameters_.stagger = stagger; }

  /** \brief Get by how much a return's azimuth may differ from that of its column. */
  inline double getStagger() const { return (parameters_.stagger); }

  /** \brief Set the number of columns of a turn (default 0: unknown), so that columns can be added without a position. */
  inline void setColumnsPerTurn(double columns) { parameters_.columns_per_turn = columns; }

  /** \brief Get the number of columns of a turn. */
  inline double getColumnsPerTurn() const { return (parameters_.columns_per_turn); }

  /** \brief Set how many columns are worked on together, 1..64 (default 16). The fewer, the sooner clusters are delivered. */
  inline void setBlockColumns(std::size_t columns) { parameters_.block_columns = columns; }

  /** \brief Get how many columns are worked on together. */
  inline std::size_t getBlockColumns() const { return (parameters_.block_columns); }

  /** \brief Begin a stream. Of the last one nothing more is delivered.
   * \return false, after a PCL_ERROR and without effect, if the stagger is not within 0..pi/8, the sensor origin is not finite, or
   * the start azimuth is not within -1e6..1e6 radians
   */
  bool beginStream();

  /** \brief Add the next column; delivers what it cannot reach.
   * \param[in] points what the lasers measured; copied
   * \param[in] count number of rows, may be 0
   * \param[in] position turns of the sensor since any moment, never less than that of the column before
   * \return false, after a PCL_ERROR and without effect: before beginStream (); if there are more rows than lasers declared; if the
   * position is less than the one before, not finite, or beyond 1e12 turns
   */
  bool addColumn(const PointT* points, std::size_t count, double position);

  /** \brief The same, 1 / getColumnsPerTurn () turns after the column before, at 0 for the first one. False, after a PCL_ERROR
   * and without effect, if the number of columns of a turn is not known.
   */
  bool addColumn(const PointT* points, std::size_t count);

  /** \brief The same; the points of the cloud are the rows. */
  bool addColumn(const PointCloud& column, double position);
  /** \brief The same without a position. */
  bool addColumn(const PointCloud& column);

  /** \brief Deliver what can be delivered with the columns so far, without waiting for a block of them. */
  void update();

  /** \brief The stream has ended: deliver all. More columns may follow; they have nothing to do with those before. */
  void finish();

  /** \brief Number of returns since beginStream () of the columns that have been worked on. */
  inline std::uint64_t getNumberOfReturns() const { return (clusterer_.returnCount()); }

  /** \brief How many of these are outliers: their azimuth differs from that of their column by more than the stagger. Many of them
   * are the sign of a wrong start azimuth, sense of rotation, position or stagger.
   */
  inline std::uint64_t getNumberOfOutliers() const { return (clusterer_.outlierCount()); }

  /** \brief Number of columns in memory, of about a turn and a half at the most. */
  inline std::size_t getNumberOfColumnsHeld() const { return (store_.size()); }

 private:
  using Base::begun_;
  using Base::cluster_tolerance_;
  using Base::header_;
  using Base::max_pts_per_cluster_;
  using Base::min_pts_per_cluster_;
  using Base::most_rows_;
  using Base::store_;

  /** \brief Adds a column at the position given, or at the engine's next one (nullptr). */
  bool addColumnAt(const PointT* points, std::size_t count, const double* given_position);
  void deliver(const lisco::EndlessCluster& delivered);

  lisco::EndlessParameters parameters_;
  double columns_per_turn_ = 0;  ///< of the stream
  std::function<void(const LiscoEndlessExtraction&, const lisco::EndlessCluster&)> callback_;
  lisco::EndlessClusterer clusterer_;
  // Of the cluster that is being delivered:
  std::vector<PointT> delivered_points_;
  std::vector<typename Cluster::Cell> delivered_cells_;
};

}  // namespace pcl

#ifdef PCL_NO_PRECOMPILE
#include <pcl/segmentation/impl/lisco_stream_extraction.hpp>
#endif
