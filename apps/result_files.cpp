// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "result_files.h"

#include <unistd.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string>

#include <pcl/common/io.h>
#include <pcl/io/pcd_io.h>

#include "pictures.h"

namespace lisco_apps {
namespace {

namespace fs = std::filesystem;

constexpr std::array<const char*, 5> kResults{"labels.pcd", "clusters.csv", "range_image.png", "top_view.png",
                                              "clusters"};

/// A folder that disappears again unless it is kept.
class TemporaryFolder {
 public:
  explicit TemporaryFolder(fs::path path) : path_(std::move(path)) { fs::create_directory(path_); }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// Makes a folder and those above it; unless kept, removes the ones it made.
class MadeFolder {
 public:
  explicit MadeFolder(const fs::path& path) {
    for (fs::path p = fs::absolute(path).lexically_normal(); !p.empty() && !fs::exists(p); p = p.parent_path())
      made_.push_back(p);
    fs::create_directories(path);
  }
  ~MadeFolder() {
    std::error_code ignored;
    if (!kept_)
      for (const fs::path& p : made_) fs::remove(p, ignored);  // innermost first, only if empty
  }
  MadeFolder(const MadeFolder&) = delete;
  MadeFolder& operator=(const MadeFolder&) = delete;
  void keep() { kept_ = true; }

 private:
  std::vector<fs::path> made_;
  bool kept_ = false;
};

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

bool isResultFolder(const fs::path& folder) {
  return fs::exists(folder / kResultMarker);
}

void writeResults(const ClusteredScan& scan, const fs::path& folder, bool cloud_per_cluster) {
  try {
    MadeFolder made(folder);
    if (!isResultFolder(folder))
      for (const char* name : kResults)
        if (fs::exists(folder / name))
          throw std::runtime_error((folder / name).string() +
                                   ": exists and was not written by this program; choose another folder");

    const TemporaryFolder aside(folder / (".lisco_partial_" + std::to_string(getpid())));
    writeLabels(scan, aside.path() / "labels.pcd");
    writeTable(scan, aside.path() / "clusters.csv");
    drawRangeImage(scan, aside.path() / "range_image.png");
    drawTopView(scan, aside.path() / "top_view.png");
    if (cloud_per_cluster) writeClusterClouds(scan, aside.path() / "clusters");

    std::ofstream(folder / kResultMarker)
        << "The results in this folder were written by lisco and may be replaced by it.\n";
    removeClusterClouds(folder / "clusters");
    for (const char* name : kResults) {
      if (!fs::is_directory(aside.path() / name)) {
        if (fs::exists(aside.path() / name)) fs::rename(aside.path() / name, folder / name);
        continue;
      }
      fs::create_directory(folder / name);  // it may be there, with things of somebody else
      for (const auto& entry : fs::directory_iterator(aside.path() / name))
        fs::rename(entry.path(), folder / name / entry.path().filename());
    }
    made.keep();
  } catch (const fs::filesystem_error& error) {
    const fs::path& path = error.path2().empty() ? error.path1() : error.path2();
    throw std::runtime_error(path.string() + ": cannot be written: " + error.code().message());
  } catch (const pcl::IOException&) {
    throw std::runtime_error(folder.string() + ": cannot be written");
  }
}

}  // namespace lisco_apps
