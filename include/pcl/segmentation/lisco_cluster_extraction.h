// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/export.h"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <pcl/PointIndices.h>
#include <pcl/pcl_base.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <pcl/search/search.h>
#include <pcl/segmentation/extract_clusters.h>  // kept for programs that call comparePointClusters ()
#include <pcl/segmentation/lisco_cloud_clusterer.h>
#include <pcl/segmentation/lisco_search_method.h>

namespace pcl {

/** \brief Euclidean clusters of a rotating LiDAR's scan: the clusters of pcl::EuclideanClusterExtraction,
 * without a kd-tree.
 *
 * \code
 * pcl::LiscoClusterExtraction<pcl::PointXYZI> ec;   // was: pcl::EuclideanClusterExtraction<pcl::PointXYZI>
 * ec.setClusterTolerance (0.4);                     // metres
 * ec.setMinClusterSize (10);
 * ec.setInputCloud (cloud);
 * std::vector<pcl::PointIndices> clusters;
 * ec.extract (clusters);
 * \endcode
 *
 * extract () gives, byte for byte, the vector that EuclideanClusterExtraction with
 * pcl::search::KdTree<PointT> (false) gives: the same clusters, in the same order, with the same indices and
 * headers. Clusters are the connected components of d2 < r2 in float; PCL's are parts of them only where the rounding
 * of its tree misses a pair of neighbours (planted cases, tolerances over 1e19): doc/contract.md. Points with a NaN or
 * infinite coordinate are skipped, as are those that are exactly (0, 0, 0), which many drivers write for "no return":
 * they are in no cluster, whether or not the cloud is_dense.
 *
 * Any cloud is accepted. It is fastest on organized scans (height = lasers, width = steps of the rotation), and faster
 * on unorganized clouds in the sensor's order than on shuffled ones. Using one object for many scans saves allocations.
 * An object is for one thread at a time; copies are independent.
 *
 * After H. Najdataei, Y. Nikolakopoulos, V. Gulisano, M. Papatriantafilou: "Lisco: A Continuous Approach in
 * LiDAR Point-cloud Clustering", 2018. \ingroup segmentation
 */
template <typename PointT>
class LiscoClusterExtraction : public PCLBase<PointT> {
  using BasePCLBase = PCLBase<PointT>;

 public:
  using PointCloud = pcl::PointCloud<PointT>;                ///< as in EuclideanClusterExtraction
  using PointCloudPtr = typename PointCloud::Ptr;            ///< the same
  using PointCloudConstPtr = typename PointCloud::ConstPtr;  ///< the same
  using KdTree = pcl::search::Search<PointT>;                ///< the same
  using KdTreePtr = typename KdTree::Ptr;                    ///< the same
  using PointIndicesPtr = PointIndices::Ptr;                 ///< the same
  using PointIndicesConstPtr = PointIndices::ConstPtr;       ///< the same
  using Labels = pcl::PointCloud<pcl::Label>;                ///< a label image

  /** \brief Empty constructor: tolerance 0, clusters of any size. */
  LiscoClusterExtraction() = default;

  /** \brief Extract the clusters of the cloud given by setInputCloud () and setIndices ().
   * \param[in,out] clusters receives the clusters after those it already holds; then all are sorted by size,
   * largest first, as EuclideanClusterExtraction does it. Indices within a cluster ascend. Cleared if there
   * is no input, or the cloud or the indices are empty; a cloud of no-returns adds nothing. Cleared, with a
   * PCL_ERROR, if an index is not within the cloud or the cloud is too large for pcl::index_t.
   */
  void extract(std::vector<PointIndices>& clusters);

  /** \brief The same, and the clusters as an image as well.
   * \param[in,out] clusters as above
   * \param[out] labels one label per point of the input, organized as the input is: 0 = in no cluster,
   * otherwise 1 + the place of the point's cluster in \a clusters. Clusters that were there before give no
   * labels.
   */
  inline void extract(std::vector<PointIndices>& clusters, Labels& labels) {
    // In the header, as the image's memory is the caller's: see LiscoColumnStream::allocate ().
    labels = Labels();
    if (input_) {
      const bool organized = static_cast<std::size_t>(input_->width) * input_->height == input_->size();
      labels.header = input_->header;
      labels.points.resize(input_->size());
      labels.width = organized ? input_->width : static_cast<std::uint32_t>(input_->size());
      labels.height = organized ? input_->height : 1;
      labels.is_dense = true;
      for (auto& label : labels) label.label = 0;
    }
    extractWithLabels(clusters, labels.points.data());
  }

  /** \brief Accepted for compatibility: kept, never searched, and not given the input cloud. The clusters are those of
   * an exact kd-tree over (x, y, z). If \a tree is a pcl::search::KdTree with other clusters, since its epsilon is
   * above 0 or its point representation is not (x, y, z), there is a PCL_WARN, once per process and kind.
   */
  inline void setSearchMethod(const KdTreePtr& tree) {
    detail::checkLiscoSearchMethod<PointT>(tree.get(), "pcl::LiscoClusterExtraction::setSearchMethod");
    tree_ = tree;
  }

  /** \brief The search method given to setSearchMethod (); nullptr if there was none, also after extract (). */
  inline KdTreePtr getSearchMethod() const { return (tree_); }

  /** \brief Set the cluster tolerance: points nearer to each other than this belong together.
   * \param[in] tolerance metres (default 0). A negative one acts as its absolute value; with 0 or NaN every
   * point is a cluster of its own.
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

  /** \brief Set how many threads share the work of extract () (default 1). Affects the time only.
   * \param[in] nr_threads 0: one for each core. No more are used than there are cores, nor than the scan has work for
   * (one for 64 columns), nor more than 256.
   */
  inline void setNumberOfThreads(unsigned int nr_threads = 0) { threads_ = nr_threads; }
  /** \brief Get the number of threads, as it was set. */
  inline unsigned int getNumberOfThreads() const { return (threads_); }

 protected:
  using BasePCLBase::deinitCompute;
  using BasePCLBase::fake_indices_;
  using BasePCLBase::indices_;
  using BasePCLBase::initCompute;
  using BasePCLBase::input_;

  KdTreePtr tree_;                         ///< given to setSearchMethod (), not used
  double cluster_tolerance_ = 0;           ///< metres
  pcl::uindex_t min_pts_per_cluster_ = 1;  ///< least number of points of a cluster
  pcl::uindex_t max_pts_per_cluster_ = std::numeric_limits<pcl::uindex_t>::max();  ///< largest number of points

  /** \brief Class getName method. */
  virtual std::string getClassName() const { return ("LiscoClusterExtraction"); }

 private:
  /** \brief Appends the clusters, not yet sorted by size, or clears the vector as extract () does.
   * \return how many were there before
   */
  std::size_t appendClusters(std::vector<PointIndices>& clusters);

  /** \brief Extracts the clusters and numbers them.
   * \param[out] labels one for each point of the input; those of points in no cluster are left as they are
   */
  void extractWithLabels(std::vector<PointIndices>& clusters, Label* labels);

  detail::LiscoCloudClusterer clusterer_;
  unsigned int threads_ = 1;
};

/** \brief Extract Euclidean clusters as LiscoClusterExtraction does, from a whole cloud. The counterpart of
 * pcl::extractEuclideanClusters (cloud, tree, tolerance, clusters, min, max): clusters are appended, not sorted by
 * size.
 * \param[in] cloud the scan
 * \param[in] tolerance metres
 * \param[in,out] clusters receives the clusters after those it already holds, in the order of their first points;
 * unchanged if there are none to be clustered; cleared, with a PCL_ERROR, as LiscoClusterExtraction::extract ()
 * \param[in] min_pts_per_cluster least number of points of a cluster
 * \param[in] max_pts_per_cluster largest number of points of a cluster (default INT_MAX)
 * \ingroup segmentation
 */
template <typename PointT>
void extractLiscoClusters(const PointCloud<PointT>& cloud, float tolerance, std::vector<PointIndices>& clusters,
                          unsigned int min_pts_per_cluster = 1,
                          unsigned int max_pts_per_cluster = (std::numeric_limits<int>::max)());

/** \brief The same for some points of a cloud.
 * \param[in] indices which points of the cloud are clustered, in any order, duplicates allowed
 */
template <typename PointT>
void extractLiscoClusters(const PointCloud<PointT>& cloud, const Indices& indices, float tolerance,
                          std::vector<PointIndices>& clusters, unsigned int min_pts_per_cluster = 1,
                          unsigned int max_pts_per_cluster = (std::numeric_limits<int>::max)());

/** \brief The same with the parameters of pcl::extractEuclideanClusters (cloud, tree, tolerance, clusters, min, max).
 * \param[in] tree ignored, may be nullptr; a PCL_WARN as in LiscoClusterExtraction::setSearchMethod ()
 */
template <typename PointT>
inline void extractLiscoClusters(const PointCloud<PointT>& cloud, const typename search::Search<PointT>::Ptr& tree,
                                 float tolerance, std::vector<PointIndices>& clusters,
                                 unsigned int min_pts_per_cluster = 1,
                                 unsigned int max_pts_per_cluster = (std::numeric_limits<int>::max)()) {
  detail::checkLiscoSearchMethod<PointT>(tree.get(), "pcl::extractLiscoClusters");
  extractLiscoClusters(cloud, tolerance, clusters, min_pts_per_cluster, max_pts_per_cluster);
}

/** \brief The same for some points of a cloud: the parameters of
 * pcl::extractEuclideanClusters (cloud, indices, tree, tolerance, clusters, min, max).
 */
template <typename PointT>
inline void extractLiscoClusters(const PointCloud<PointT>& cloud, const Indices& indices,
                                 const typename search::Search<PointT>::Ptr& tree, float tolerance,
                                 std::vector<PointIndices>& clusters, unsigned int min_pts_per_cluster = 1,
                                 unsigned int max_pts_per_cluster = (std::numeric_limits<int>::max)()) {
  detail::checkLiscoSearchMethod<PointT>(tree.get(), "pcl::extractLiscoClusters");
  extractLiscoClusters(cloud, indices, tolerance, clusters, min_pts_per_cluster, max_pts_per_cluster);
}

}  // namespace pcl

#ifdef PCL_NO_PRECOMPILE
#include <pcl/segmentation/impl/lisco_cluster_extraction.hpp>
#endif
