// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "result_files.h"

#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <pcl/common/io.h>
#include <pcl/io/pcd_io.h>

#include "output_file.h"
#include "pictures.h"

namespace lisco_apps {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kResults{"labels.pcd", "clusters.csv", "range_image.png", "top_view.png", "clusters"};

void writeLabels(const ClusteredScan& scan, const fs::path& file) {
  pcl::PointCloud<pcl::PointXYZL> labelled;
  pcl::copyPointCloud(*scan.cloud, labelled);
  const std::vector<std::uint32_t> labels = scan.labels();
  for (std::size_t i = 0; i < labels.size(); ++i) labelled[i].label = labels[i];
  if (pcl::PCDWriter().writeBinary(file.string(), labelled) != 0)
    throw std::runtime_error(file.string() + ": cannot be written");
}

void writeTable(const ClusteredScan& scan, const fs::path& file) {
  std::ofstream table(file);
  table << "id,size,centroid_x,centroid_y,centroid_z,min_x,min_y,min_z,max_x,max_y,max_z,nearest_range\n";
  for (std::size_t number = 0; number < scan.clusters.size(); ++number) {
    const ClusterShape s = shapeOf(*scan.cloud, scan.clusters[number]);
    char line[1024];  // twelve numbers of up to 46 characters
    const auto wide = [](float value) { return static_cast<double>(value); };
    std::snprintf(line, sizeof line, "%zu,%zu,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f\n", number + 1, s.size,
                  s.centroid[0], s.centroid[1], s.centroid[2], wide(s.lo[0]), wide(s.lo[1]), wide(s.lo[2]),
                  wide(s.hi[0]), wide(s.hi[1]), wide(s.hi[2]), s.nearest_range);
    table << line;
  }
  table.close();
  if (!table) throw std::runtime_error(file.string() + ": cannot be written");
}

void writeClusterClouds(const ClusteredScan& scan, const fs::path& folder) {
  fs::create_directory(folder);
  for (std::size_t number = 0; number < scan.clusters.size(); ++number) {
    char name[48];
    std::snprintf(name, sizeof name, "cluster_%04zu.pcd", number + 1);
    Cloud cluster;
    pcl::copyPointCloud(*scan.cloud, scan.clusters[number].indices, cluster);
    if (pcl::PCDWriter().writeBinary((folder / name).string(), cluster) != 0)
      throw std::runtime_error((folder / name).string() + ": cannot be written");
  }
}

/// Removes what an earlier run has written there, and nothing else.
void removeClusterClouds(const fs::path& folder) {
  if (!fs::is_directory(folder)) return;
  std::vector<fs::path> ours;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.rfind("cluster_", 0) == 0 && entry.path().extension() == ".pcd") ours.push_back(entry.path());
  }
  for (const fs::path& file : ours) fs::remove(file);
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
          drawRangeImage(scan, aside / "range_image.png");
          drawTopView(scan, aside / "top_view.png");
          if (cloud_per_cluster) writeClusterClouds(scan, aside / "clusters");
        } catch (const pcl::IOException&) {
          throw std::runtime_error(folder.string() + ": cannot be written");
        }
      },
      [&] { removeClusterClouds(folder / "clusters"); });
}

}  // namespace lisco_apps
