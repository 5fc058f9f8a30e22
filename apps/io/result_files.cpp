// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "io/clusters.h"

#include <fstream>
#include <string>
#include <vector>

#include <pcl/common/io.h>
#include <pcl/io/pcd_io.h>

#include "drawing/scan_pictures.h"
#include "io/output_file.h"
#include "io/text.h"
#include "view/clustered_view.h"

namespace lisco_apps {
namespace {

const std::vector<std::string> kResults{"labels.pcd",   "clusters.csv", "range_image.png",
                                        "top_view.png", "view.html",    "clusters"};

template <typename AnyCloud>
void writePcd(const AnyCloud& cloud, const fs::path& file) {
  if (pcl::PCDWriter().writeBinary(file.string(), cloud) != 0) fail(file, "cannot be written");
}

void writeLabels(const ClusteredScan& scan, const fs::path& file) {
  pcl::PointCloud<pcl::PointXYZL> labelled;
  pcl::copyPointCloud(*scan.cloud, labelled);
  const std::vector<std::uint32_t> labels = labelsOf(scan.clusters, labelled.size());
  for (std::size_t i = 0; i < labels.size(); ++i) labelled[i].label = labels[i];
  writePcd(labelled, file);
}

void writeTable(const ClusteredScan& scan, const fs::path& file) {
  std::ofstream table(file);
  table << "id,size,centroid_x,centroid_y,centroid_z,min_x,min_y,min_z,max_x,max_y,max_z,nearest_range\n";
  for (std::size_t i = 0; i < scan.clusters.size(); ++i) {
    const ClusterShape shape = shapeOf(*scan.cloud, scan.clusters[i]);
    table << i + 1 << ',' << shape.size();
    for (const double value : shape.centroid()) table << formatted(",%.4f", value);
    for (const float value : shape.lo()) table << formatted(",%.4f", static_cast<double>(value));
    for (const float value : shape.hi()) table << formatted(",%.4f", static_cast<double>(value));
    table << formatted(",%.4f\n", shape.nearestRange());
  }
  table.close();
  if (!table) fail(file, "cannot be written");
}

void writeClusterClouds(const ClusteredScan& scan, const fs::path& folder) {
  fs::create_directory(folder);
  for (std::size_t i = 0; i < scan.clusters.size(); ++i) {
    Cloud cluster;
    pcl::copyPointCloud(*scan.cloud, scan.clusters[i].indices, cluster);
    writePcd(cluster, folder / formatted("cluster_%04zu.pcd", i + 1));
  }
}

/// Removes the clouds of an earlier run, and the folder if nothing else is in it.
void removeClusterClouds(const fs::path& folder) {
  if (!fs::is_directory(folder)) return;
  for (const fs::path& file : filesIn(folder, "cluster_", ".pcd")) fs::remove(file);
  if (fs::is_empty(folder)) fs::remove(folder);
}

}  // namespace

void writeResults(const ClusteredScan& scan, const fs::path& folder, bool cloud_per_cluster) {
  writeOwnFolder(
      folder, kResults,
      [&](const fs::path& aside) {
        try {
          writeLabels(scan, aside / "labels.pcd");
          writeTable(scan, aside / "clusters.csv");
          drawRangeImage(scan.arranged ? *scan.arranged : scan, aside / "range_image.png");
          drawTopView(scan, aside / "top_view.png");
          writeView(scan, scan.clustered, aside / "view.html");
          if (cloud_per_cluster) writeClusterClouds(scan, aside / "clusters");
        } catch (const pcl::IOException&) {
          fail(folder, "cannot be written");
        }
      },
      [&] { removeClusterClouds(folder / "clusters"); });
}

}  // namespace lisco_apps
