// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// Subclusters while a scan comes in (the paper's figure 3): their number over the columns, and pictures midway.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <pcl/features/lisco_cluster_features.h>
#include <pcl/segmentation/extract_clusters.h>  // comparePointClusters

#include "drawing/chart.h"
#include "drawing/scan_pictures.h"
#include "io/text.h"
#include "lisco/column_clusterer.h"
#include "lisco/sensor_hints.h"
#include "organized_scans.h"

namespace {

namespace fs = std::filesystem;
using namespace lisco_apps;

constexpr unsigned kMinSize = 10;
constexpr unsigned kColors[] = {0xD55E00, 0x0072B2, 0x009E73, 0xCC79A7, 0xE69F00};

struct Sizes {
  std::size_t subclusters = 0;  ///< of two returns or more, as the paper's
  std::size_t clusters = 0;     ///< of kMinSize or more
};

Sizes sizesIn(const lisco::ColumnClusterer& clusterer) {
  Sizes sizes;
  for (std::uint32_t i = 0; i < clusterer.subclusterCount(); ++i) {
    sizes.subclusters += clusterer.sizeOf(i) > 1 ? 1 : 0;
    sizes.clusters += clusterer.sizeOf(i) >= kMinSize ? 1 : 0;
  }
  return sizes;
}

/// Draws the scan from above, as far as it has come, in the colours of its subclusters.
void draw(const std::string& name, const ComparedScan& scan, double tolerance, std::size_t columns,
          lisco::ColumnClusterer& clusterer, const fs::path& png) {
  ClusteredScan picture;
  picture.name = formatted("%s, %zu of %u columns", name.c_str(), columns, scan.cloud->width);
  picture.tolerance = tolerance;
  picture.min_size = 2;
  auto cloud = std::make_shared<Cloud>(scan.cloud->width, scan.cloud->height, pcl::PointXYZ(NAN, NAN, NAN));
  std::vector<pcl::PointIndices> subclusters(clusterer.subclusterCount());
  clusterer.forEachRun([&](const std::uint32_t* cells, std::size_t count, std::uint32_t subcluster) {
    for (std::size_t i = 0; i < count; ++i) {
      subclusters[subcluster].indices.push_back(static_cast<pcl::index_t>(cells[i]));
      const ComparedPoint& point = (*scan.cloud)[cells[i]];
      cloud->points[cells[i]] = {point.x, point.y, point.z};
    }
  });
  for (auto& subcluster : subclusters) {
    if (subcluster.indices.size() < picture.min_size) continue;
    std::sort(subcluster.indices.begin(), subcluster.indices.end());
    picture.clusters.push_back(std::move(subcluster));
  }
  std::sort(picture.clusters.rbegin(), picture.clusters.rend(), pcl::comparePointClusters);
  for (const auto index : *scan.returns)
    if (static_cast<std::size_t>(index) % scan.cloud->width < columns) picture.returns.clustered.push_back(index);
  picture.returns.returns = picture.returns.clustered.size();
  picture.cloud = cloud;
  pcl::LiscoClusterFeatures<pcl::PointXYZ> estimation;
  estimation.setInputCloud(cloud);
  estimation.compute(picture.clusters, picture.features);
  const fs::path range_image = png.string() + ".range.png";
  drawPictures(picture, range_image, png);
  fs::remove(range_image);
}

}  // namespace

int main(int argc, char** argv) {
  return runProgram("growing_subclusters", [&] {
    boost::program_options::options_description shown(
        "Usage: growing_subclusters SCAN-OR-FOLDER... -o FOLDER [options]\n\n"
        "Feeds scans column by column and counts subclusters of two returns or more, and clusters of ten or more, "
        "each\n"
        "64th of the columns. Writes into the folder subclusters.png and .svg, and NAME_half.png and NAME_whole.png "
        "of\n"
        "each scan; prints CSV.\n\n"
        "Options");
    lisco_benchmarks::OrganizedScans scans;
    fs::path folder;
    scans.addTo(shown, "0.4");
    shown.add_options()("output,o", pathOption("FOLDER", "--output", folder), "for the pictures; must exist");
    boost::program_options::variables_map given;
    if (!readCommandLine(argc, argv, "growing_subclusters", shown, &scans.inputs, given)) return 0;
    scans.check();
    if (folder.empty()) throw std::runtime_error("--output is missing; see --help");
    const double tolerance = scans.tolerances.front();
    Chart chart{formatted("tolerance %g m", tolerance), "columns received, percent",
                "subclusters of 2 returns or more"};
    std::printf("scan,returns,tolerance,columns,received,returns_received,subclusters,clusters\n");
    scans.forEach([&](const std::string& name, const ComparedScan& scan) {
      constexpr std::size_t kLooks = 64;
      const std::size_t width = scan.cloud->width;
      const std::size_t height = scan.cloud->height;
      const std::vector<lisco::Return> cells = lisco_benchmarks::columnsOf(*scan.cloud);
      lisco::Parameters parameters;
      parameters.tolerance = static_cast<float>(tolerance);
      const auto cell_at = [&](std::size_t laser, std::size_t column) { return cells[column * height + laser]; };
      parameters.sensor = lisco::estimateSensor(width, height, {0, 0, 0}, lisco::CellSource(cell_at));
      lisco::ColumnClusterer clusterer;
      clusterer.begin(parameters);
      Chart::Line line{name, kColors[chart.lines.size() % std::size(kColors)], {}};
      for (std::size_t column = 0; column < width; ++column) {
        clusterer.addColumn(&cells[column * height], height);
        const std::size_t received = column + 1;
        if (received * kLooks / width == column * kLooks / width) continue;
        clusterer.update();
        const Sizes sizes = sizesIn(clusterer);
        std::printf("%s,%zu,%g,%zu,%zu,%zu,%zu,%zu\n", name.c_str(), scan.returns->size(), tolerance, width, received,
                    clusterer.returnCount(), sizes.subclusters, sizes.clusters);
        if (sizes.subclusters > 0)
          line.points.push_back({100 * static_cast<double>(received) / static_cast<double>(width),
                                 static_cast<double>(sizes.subclusters), 0});
        if (received * kLooks / width == kLooks / 2)
          draw(name, scan, tolerance, received, clusterer, folder / (name + "_half.png"));
        if (received == width) draw(name, scan, tolerance, received, clusterer, folder / (name + "_whole.png"));
      }
      chart.lines.push_back(std::move(line));
    });
    drawChart(chart, (folder / "subclusters").string());
    return 0;
  });
}
