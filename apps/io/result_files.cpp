// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "io/result_files.h"

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <pcl/common/io.h>
#include <boost/algorithm/string/join.hpp>

#include "drawing/scan_pictures.h"
#include "io/cluster_json.h"
#include "io/input_fields.h"
#include "io/label_files.h"
#include "io/options.h"
#include "io/output_file.h"
#include "io/text.h"
#include "view/clustered_view.h"
#include "view/page.h"
#include "view/scan_encoder.h"

namespace lisco_apps {
namespace {

constexpr const char* kClouds = "clusters";  ///< a folder
constexpr const char* kSemanticKitti = "labels.label";

struct Kind {
  const char* name;
  bool ResultKinds::*is_wanted;
  std::vector<std::string> files;
};

const std::vector<Kind>& allKinds() {
  static const std::vector<Kind> kKinds{{"labels", &ResultKinds::labels, {"labels.pcd"}},
                                        {"table", &ResultKinds::table, {"clusters.csv"}},
                                        {"pictures", &ResultKinds::pictures, {"range_image.png", "top_view.png"}},
                                        {"view", &ResultKinds::view, {"view.html"}},
                                        {"clouds", &ResultKinds::clouds, {kClouds}},
                                        {"json", &ResultKinds::json, {"clusters.json"}},
                                        {"semantickitti", &ResultKinds::semantickitti, {kSemanticKitti, "labels.npy"}}};
  return kKinds;
}

void writeText(const fs::path& file, const std::string& text) {
  errno = 0;
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) failToWrite(file);
}

std::string tableOf(const ClusteredScan& scan) {
  std::string table =
      "id,size,centroid_x,centroid_y,centroid_z,min_x,min_y,min_z,max_x,max_y,max_z,nearest_range,"
      "box_x,box_y,box_z,yaw,length,width,height,density\n";
  std::size_t id = 0;
  for (const lisco::ClusterFeatures& features : scan.features) {
    table += formatted("%zu,%zu", ++id, features.size);
    const auto add = [&table](double value) { table += formatted(",%.4f", value); };
    for (const double value : features.centroid) add(value);
    for (const float value : features.min) add(static_cast<double>(value));
    for (const float value : features.max) add(static_cast<double>(value));
    add(features.nearest_range);
    for (const double value : features.box.center) add(value);
    add(yawDegrees(features.box));
    for (const double value : {features.box.length, features.box.width, features.box.height}) add(value);
    add(features.density);
    table += '\n';
  }
  return table;
}

void writeClusterClouds(const ClusteredScan& scan, const fs::path& folder) {
  fs::create_directory(folder);
  const pcl::PCLPointCloud2 points = inputFieldsOf(scan);
  for (std::size_t i = 0; i < scan.clusters.size(); ++i) {
    pcl::PCLPointCloud2 cluster;
    pcl::copyPointCloud(points, scan.clusters[i].indices, cluster);
    writePcd(cluster, scan, folder / formatted("cluster_%04zu.pcd", i + 1));
  }
}

}  // namespace

ResultKinds resultKindsOf(const std::string& text) {
  ResultKinds kinds;
  std::vector<std::string> known;
  for (const Kind& kind : allKinds()) {
    kinds.*kind.is_wanted = false;
    known.emplace_back(kind.name);
  }
  for (const std::string& item : itemsOf(text)) {
    const auto kind =
        std::find_if(allKinds().begin(), allKinds().end(), [&](const Kind& each) { return each.name == item; });
    if (kind == allKinds().end())
      throw std::runtime_error("--write: '" + item + "' is none of " + boost::join(known, ", "));
    kinds.*kind->is_wanted = true;
  }
  return kinds;
}

std::string writeResults(const ClusteredScan& scan, const fs::path& folder, const ResultKinds& kinds) {
  const bool are_too_many = kinds.semantickitti && scan.clusters.size() > kMaxSemanticKittiClusters;
  std::vector<std::string> wanted;
  for (const Kind& kind : allKinds())
    for (const std::string& file : kind.files)
      if (kinds.*kind.is_wanted && !(are_too_many && file == kSemanticKitti)) wanted.push_back(file);
  writeOwnFolder(folder, kClusterProgram, wanted, [&](const fs::path& aside) {
    if (kinds.labels) writeLabelledPcd(scan, aside / "labels.pcd");
    if (kinds.table) writeText(aside / "clusters.csv", tableOf(scan));
    if (kinds.pictures) drawPictures(scan, aside / "range_image.png", aside / "top_view.png");
    if (kinds.view) writeText(aside / "view.html", viewPage(scan.name, {encodeViewScan(viewScanOf(scan))}));
    if (kinds.clouds) writeClusterClouds(scan, aside / kClouds);
    if (kinds.json) writeText(aside / "clusters.json", lineOf(jsonOf(scan)) + "\n");
    if (kinds.semantickitti && !are_too_many) writeSemanticKitti(scan, aside / kSemanticKitti);
    if (kinds.semantickitti) writeNpy(scan, aside / "labels.npy");
  });
  if (!are_too_many) return "";
  return (folder / kSemanticKitti).string() +
         formatted(
             " is not written: SemanticKITTI's format has 16 bits for an instance, %zu clusters at most; there are "
             "%zu (a larger --min-size gives fewer)",
             kMaxSemanticKittiClusters, scan.clusters.size());
}

nlohmann::ordered_json jsonOf(const ClusteredScan& scan) {
  std::size_t in_clusters = 0;
  Json clusters = Json::array();
  for (const lisco::ClusterFeatures& features : scan.features) {
    in_clusters += features.size;
    Json one{{"id", clusters.size() + 1}};
    addFeatures(one, features);
    clusters.push_back(std::move(one));
  }
  Json json{{"scan", scan.name},
            {"rows", scan.cloud->height},
            {"columns", scan.cloud->width},
            {"returns", scan.returns.returns},
            {"ignored", scan.returns.ignored},
            {"ground", scan.returns.ground.size()},
            {"clustered", scan.returns.clustered.size()},
            {"noise", scan.returns.clustered.size() - in_clusters},
            {"tolerance", scan.tolerance},
            {"min_size", scan.min_size}};
  if (scan.max_size) json["max_size"] = *scan.max_size;
  json["clusters"] = std::move(clusters);
  return json;
}

}  // namespace lisco_apps
