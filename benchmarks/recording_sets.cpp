// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "recording_sets.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <stdexcept>
#include <utility>

#include <pcl/filters/voxel_grid.h>

#include "compare/comparison.h"
#include "io/cloud_file.h"
#include "io/point_geometry.h"
#include "simulation/random.h"

namespace lisco_benchmarks {
namespace {

namespace fs = std::filesystem;
using namespace lisco_apps;
using CloudPtr = ComparedCloud::Ptr;

const std::vector<double> kTolerances{0.1, 0.3, 0.4, 0.7, 1.0};  // metres

constexpr float kNoGround = -std::numeric_limits<float>::infinity();

/// The height below which the ground lies, metres.
float groundOf(const std::string& scan) {
  static const std::map<std::string, float> kGround{
      {"hdl32e_outdoor_0", -2.10F}, {"hdl32e_outdoor_1", -2.10F},  {"hdl64e_city_0", -1.60F},
      {"hdl64e_city_1", -1.60F},    {"vlp16_close_0", -0.57F},     {"vlp16_street_0", -1.99F},
      {"vls128_street_0", -1.74F},  {"os1_128_outdoor_0", -1.81F}, {"os1_64_sparse_0", -0.48F},
      {"hdl64e_kitti_0", -1.30F},   {"vls128_deskewed_0", 0.30F},  {"0000000000", -1.30F}};
  const auto found = kGround.find(scan);
  return found != kGround.end() ? found->second : kNoGround;
}

CloudPtr load(const fs::path& file, bool unorganized) {
  return prepareScan(*readCloudFile(file), {}, groundOf(file.stem().string()), unorganized).cloud;
}

/// An unorganized cloud of the points that `add` is called with.
template <typename Collect>
CloudPtr unorganized(Collect&& collect) {
  auto cloud = std::make_shared<ComparedCloud>();
  collect([&cloud](const ComparedPoint& point) {
    if (isReturn(point)) cloud->push_back(point);
  });
  return cloud;
}

CloudPtr inRingOrder(const ComparedCloud& cloud) {
  return unorganized([&cloud](auto&& add) {
    for (const ComparedPoint& point : cloud) add(point);
  });
}

CloudPtr inFiringOrder(const ComparedCloud& cloud) {
  return unorganized([&cloud](auto&& add) {
    for (std::size_t column = 0; column < cloud.width; ++column)
      for (std::size_t row = 0; row < cloud.height; ++row) add(cloud[row * cloud.width + column]);
  });
}

CloudPtr shuffled(const ComparedCloud& cloud) {
  CloudPtr result = inRingOrder(cloud);
  lisco_simulation::Random random(1);
  for (std::size_t i = result->size(); i > 1; --i)
    std::swap((*result)[i - 1], (*result)[static_cast<std::size_t>(random.unit() * static_cast<double>(i))]);
  return result;
}

/// Cropped first, since PCL's filter numbers voxels by 32 bits.
CloudPtr filtered(const ComparedCloud& cloud) {
  constexpr float kCrop = 40;    // metres to each side
  constexpr float kLeaf = 0.1F;  // metres
  const CloudPtr cropped = unorganized([&cloud](auto&& add) {
    for (const ComparedPoint& point : cloud)
      if (std::fabs(point.x) < kCrop && std::fabs(point.y) < kCrop) add(point);
  });
  pcl::VoxelGrid<ComparedPoint> filter;
  filter.setInputCloud(cropped);
  filter.setLeafSize(kLeaf, kLeaf, kLeaf);
  auto result = std::make_shared<ComparedCloud>();
  filter.filter(*result);
  return result;
}

/// A scan in memory as long as a recording made of it is measured.
class Source {
 public:
  explicit Source(fs::path file) : file_(std::move(file)) {}

  std::string name() const { return file_.stem().string(); }

  CloudPtr organized() const {
    static std::pair<fs::path, CloudPtr> latest;
    if (latest.first != file_) latest = {file_, load(file_, false)};
    return latest.second;
  }

 private:
  fs::path file_;
};

/// Adds a form of a scan to the recordings.
template <typename Make>
void add(std::vector<Recording>& recordings, int set, const Source& source, const char* form, Make make) {
  recordings.push_back({set, source.name(), form, kTolerances, [source, make] { return make(*source.organized()); }});
}

std::vector<fs::path> filesOf(const fs::path& folder) {
  if (!fs::is_directory(folder)) throw std::runtime_error("no real scans in " + folder.string());
  return cloudFilesIn(folder);
}

void addOther(std::vector<Recording>& recordings, const fs::path& file) {
  const bool airborne = file.stem().string().rfind("airborne", 0) == 0;
  const std::vector<double> tolerances =
      airborne ? std::vector<double>{0.1, 0.3, 1} : std::vector<double>{0.01, 0.02, 0.05, 0.1};
  recordings.push_back({6, file.stem().string(), airborne ? "unorganized" : "organized", tolerances,
                        [file] { return load(file, false); }});
}

}  // namespace

const char* titleOf(int set) {
  static const char* const kTitles[kSets] = {"organized", "ring and firing order", "shuffled, filtered",
                                             "moved",     "deskewed and dual",     "other"};
  return kTitles[set - 1];
}

std::vector<Recording> allRecordings(const fs::path& data) {
  std::vector<Recording> recordings;
  for (const fs::path& file : filesOf(data / "scans")) {
    const Source source(file);
    const std::string name = source.name();
    if (name.rfind("rgbd", 0) == 0 || name.rfind("airborne", 0) == 0) {
      addOther(recordings, file);
      continue;
    }
    add(recordings, 1, source, "organized", [](const ComparedCloud& c) { return std::make_shared<ComparedCloud>(c); });
    add(recordings, 2, source, "ring order", inRingOrder);
    add(recordings, 2, source, "firing order", inFiringOrder);
    add(recordings, 3, source, "shuffled", shuffled);
    add(recordings, 3, source, "filtered", filtered);
  }
  for (const fs::path& file : filesOf(data / "kitti"))
    recordings.push_back(
        {2, "kitti_" + file.stem().string(), "ring order", kTolerances, [file] { return load(file, true); }});
  std::stable_sort(recordings.begin(), recordings.end(),
                   [](const Recording& a, const Recording& b) { return a.set < b.set; });
  return recordings;
}

}  // namespace lisco_benchmarks
