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

#include <Eigen/Geometry>

#include <pcl/filters/voxel_grid.h>

#include "captured_rotations.h"
#include "compare/comparison.h"
#include "io/point_geometry.h"
#include "io/scan_file.h"
#include "io/text.h"
#include "simulation/cases.h"
#include "simulation/drive.h"
#include "simulation/random.h"
#include "simulation/scanner.h"
#include "simulation/scenes.h"
#include "simulation/sensor.h"

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
  const Cloud::Ptr cloud = readScan(file).cloud;
  return prepareScan(*cloud, {}, returnsAbove(*cloud, groundOf(file.stem().string())), unorganized).cloud;
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

/// An organized cloud of the points that at(row, column) returns.
template <typename At>
CloudPtr organized(std::size_t columns, std::size_t rows, At&& at) {
  auto cloud = std::make_shared<ComparedCloud>();
  cloud->reserve(columns * rows);
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < columns; ++column) cloud->push_back(at(row, column));
  cloud->width = static_cast<std::uint32_t>(columns);
  cloud->height = static_cast<std::uint32_t>(rows);
  cloud->is_dense = false;
  return cloud;
}

CloudPtr columnPerLaser(const ComparedCloud& cloud) {
  return organized(cloud.height, cloud.width,
                   [&cloud](std::size_t row, std::size_t column) { return cloud[column * cloud.width + row]; });
}

CloudPtr sector(const ComparedCloud& cloud) {
  return organized(cloud.width / 12, cloud.height,
                   [&cloud](std::size_t row, std::size_t column) { return cloud[row * cloud.width + column]; });
}

/// Rows in the order in which Velodyne's sensors fire: the lasers of the upper half between those of the lower one.
CloudPtr unsortedLasers(const ComparedCloud& cloud) {
  return organized(cloud.width, cloud.height, [&cloud](std::size_t row, std::size_t column) {
    return cloud[(row % 2 * ((cloud.height + 1) / 2) + row / 2) * cloud.width + column];
  });
}

CloudPtr halfMissing(const ComparedCloud& cloud) {
  auto result = std::make_shared<ComparedCloud>(cloud);
  result->is_dense = false;
  lisco_simulation::Random random(1);
  for (ComparedPoint& point : *result)
    if (random.chance(0.5)) point.x = point.y = point.z = std::numeric_limits<float>::quiet_NaN();
  return result;
}

/// Turns of the same scene, with noise in the ranges.
/// \param below as more rows, otherwise as more columns
CloudPtr severalTurns(const ComparedCloud& cloud, std::size_t turns, bool below) {
  constexpr float kNoise = 0.02F;  // metres
  lisco_simulation::Random random(1);
  const std::size_t columns = cloud.width, rows = cloud.height;
  return organized(below ? columns : turns * columns, below ? turns * rows : rows,
                   [&](std::size_t row, std::size_t column) {
                     ComparedPoint point = cloud[row % rows * columns + column % columns];
                     if (isReturn(point)) {
                       const float range = point.getVector3fMap().norm();
                       point.getVector3fMap() *= 1.0F + kNoise * static_cast<float>(2.0 * random.unit() - 1.0) / range;
                     }
                     return point;
                   });
}

/// A sensor's place in another frame.
struct Mount {
  const char* name;
  double roll, pitch, yaw;  ///< degrees
  double x, y, z;           ///< metres

  Eigen::Affine3d transform() const {
    constexpr double kDegree = kPi / 180;
    return Eigen::Translation3d(x, y, z) * Eigen::AngleAxisd(yaw * kDegree, Eigen::Vector3d::UnitZ()) *
           Eigen::AngleAxisd(pitch * kDegree, Eigen::Vector3d::UnitY()) *
           Eigen::AngleAxisd(roll * kDegree, Eigen::Vector3d::UnitX());
  }
};

/// The resolution of floats is 3 cm in UTM's x and in both of the British National Grid's, half a metre in UTM's y.
constexpr Mount kMounts[] = {{"vehicle", 2, 4, 30, 1.2, -0.4, 1.9},
                             {"UTM", 1, -2, 140, 512345.6, 5403210.4, 312.7},
                             {"OSGB", 1, -2, 140, 512345.6, 403210.4, 312.7}};

/// A sensor that looks down.
constexpr Mount kTilted{"tilted", 0, 15, 0, 1.2, 0.3, 1.8};

CloudPtr moved(const ComparedCloud& cloud, const Mount& mount, bool origin_known) {
  auto result = std::make_shared<ComparedCloud>(cloud);
  const Eigen::Affine3d transform = mount.transform();
  for (ComparedPoint& point : *result)
    if (isReturn(point)) point.getVector3fMap() = (transform * point.getVector3fMap().cast<double>()).cast<float>();
  if (origin_known) result->sensor_origin_ << transform.translation().cast<float>(), 0;
  return result;
}

/// The motion of the sensors of set 5.
constexpr lisco_simulation::Motion kMotion{30, kPi / 4};

/// A scan of a sensor at rest as one in motion: each column moves with the sensor. Surfaces are bent, what one ring has
/// next to each other stays so.
CloudPtr inMotion(const ComparedCloud& cloud) {
  auto result = std::make_shared<ComparedCloud>(cloud);
  for (std::size_t i = 0; i < result->size(); ++i) {
    ComparedPoint& point = (*result)[i];
    if (!isReturn(point)) continue;
    const double turns = static_cast<double>(i % cloud.width) / cloud.width;
    const lisco_simulation::Vector at{static_cast<double>(point.x), static_cast<double>(point.y),
                                      static_cast<double>(point.z)};
    const auto place = rotated(at, kMotion.headingAfter(turns)) + kMotion.placeAfter(turns);
    point.x = static_cast<float>(place.x);
    point.y = static_cast<float>(place.y);
  }
  return result;
}

/// Each ring's returns in their azimuth bins as seen from the origin; a taken bin pushes on to the next free one.
CloudPtr byRing(const ComparedCloud& cloud) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  ComparedPoint none;
  none.x = none.y = none.z = kNan;
  auto result = std::make_shared<ComparedCloud>(cloud.width, cloud.height, none);
  result->is_dense = false;
  std::vector<bool> is_taken(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!isReturn(cloud[i])) continue;
    const std::size_t row = i - i % cloud.width;
    auto bin = static_cast<std::size_t>((kPi - azimuthOf(cloud[i])) / (2 * kPi) * cloud.width) % cloud.width;
    while (is_taken[row + bin]) bin = (bin + 1) % cloud.width;
    is_taken[row + bin] = true;
    (*result)[row + bin] = cloud[i];
  }
  return result;
}

/// Two returns per firing in successive columns: a fifth have a second one farther along the ray, the others have the
/// first one twice, as Velodyne's sensors send them. \param repeats false: these are left out
CloudPtr dual(const ComparedCloud& cloud, bool repeats) {
  constexpr double kSecond = 0.2;
  auto result = std::make_shared<ComparedCloud>(2 * cloud.width, cloud.height);
  result->is_dense = false;
  lisco_simulation::Random random(1);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    ComparedPoint first = cloud[i];
    ComparedPoint second = first;
    if (isReturn(first) && random.chance(kSecond)) {
      const auto factor = static_cast<float>(1 + random.between(0.3, 4) / rangeOf(first));
      second.getVector3fMap() *= factor;
    } else if (!repeats) {
      second.x = second.y = second.z = std::numeric_limits<float>::quiet_NaN();
    }
    (*result)[2 * i] = first;
    (*result)[2 * i + 1] = second;
  }
  return result;
}

CloudPtr fromSimulation(const lisco_simulation::SimulatedScan& scan, float ground_z) {
  Cloud cloud(static_cast<std::uint32_t>(scan.steps), static_cast<std::uint32_t>(scan.lasers));
  for (std::size_t i = 0; i < scan.cells.size(); ++i) cloud[i] = {scan.cells[i].x, scan.cells[i].y, scan.cells[i].z};
  return prepareScan(cloud, {}, returnsAbove(cloud, ground_z), false).cloud;
}

/// A function that makes an organized scan.
using Source = std::function<CloudPtr()>;

/// Keeps the latest scan, which is usually the next one, too.
Source remembering(const std::string& name, Source make) {
  return [name, make = std::move(make)] {
    static std::pair<std::string, CloudPtr> latest;
    if (latest.first != name) latest = {name, make()};
    return latest.second;
  };
}

/// Makes recordings of one scan.
class Adder {
 public:
  Adder(std::vector<Recording>& recordings, std::string scan, Source source)
      : recordings_(recordings), scan_(std::move(scan)), source_(remembering(scan_, std::move(source))) {}

  template <typename Make>
  void add(int set, const std::string& form, Make make, const std::vector<double>& tolerances = kTolerances) {
    recordings_.push_back({set, scan_, form, tolerances, [source = source_, make] { return make(*source()); }});
  }
  void asItIs(int set, const std::string& form, const std::vector<double>& tolerances = kTolerances) {
    recordings_.push_back({set, scan_, form, tolerances, source_});
  }

 private:
  std::vector<Recording>& recordings_;
  std::string scan_;
  Source source_;
};

bool startsWith(const std::string& text, const char* begin) {
  return text.rfind(begin, 0) == 0;
}

/// Of these, columns are no firings at rest.
bool isDeskewed(const std::string& scan) {
  return startsWith(scan, "hdl64e_kitti") || startsWith(scan, "vls128_deskewed");
}

void addMoved(Adder& adder, const std::string& scan) {
  const std::pair<const char*, CloudPtr (*)(const ComparedCloud&)> kForms[] = {
      {" organized", [](const ComparedCloud& c) { return std::make_shared<ComparedCloud>(c); }},
      {" ring order", inRingOrder},
      {" firing order", inFiringOrder}};
  for (const Mount& mount : kMounts)
    for (const auto& [form, make] : kForms)
      for (const bool origin_known : {false, true}) {
        if (origin_known && startsWith(scan, "vls128_deskewed")) continue;  // where it stood is unknown
        adder.add(4, mount.name + std::string(form) + (origin_known ? ", origin" : ""),
                  [&mount, make = make, origin_known](const ComparedCloud& c) {
                    return moved(*make(c), mount, origin_known);
                  });
      }
}

/// \param move gives a scan its motion
template <typename Move>
void addDeskewed(Adder& adder, Move move) {
  adder.add(5, "by firing", [move](const ComparedCloud& c) { return move(c); });
  adder.add(5, "by ring", [move](const ComparedCloud& c) { return byRing(*move(c)); });
  adder.add(5, "unorganized", [move](const ComparedCloud& c) { return inFiringOrder(*move(c)); });
  adder.add(5, "dual, organized", [move](const ComparedCloud& c) { return move(*dual(c, true)); });
  adder.add(5, "dual, unorganized", [move](const ComparedCloud& c) { return inFiringOrder(*move(*dual(c, false))); });
}

void addRotatingScan(std::vector<Recording>& recordings, const fs::path& file) {
  const std::string name = file.stem().string();
  Adder adder(recordings, name, [file] { return load(file, false); });
  adder.asItIs(1, "organized");
  adder.add(2, "ring order", inRingOrder);
  adder.add(2, "firing order", inFiringOrder);
  adder.add(3, "shuffled", shuffled);
  adder.add(3, "filtered", filtered);
  addMoved(adder, name);
  if (isDeskewed(name))
    adder.asItIs(5, "by ring");
  else
    addDeskewed(adder, inMotion);
  adder.add(7, "a column per laser", columnPerLaser);
  adder.add(7, "unsorted lasers", unsortedLasers);
  adder.add(7, "half missing", halfMissing);
  adder.add(7, "tilted", [](const ComparedCloud& c) { return moved(c, kTilted, false); });
  adder.add(7, "sector", sector);
  adder.add(7, "two turns", [](const ComparedCloud& c) { return severalTurns(c, 2, false); });
  adder.add(7, "four turns in rows", [](const ComparedCloud& c) { return severalTurns(c, 4, true); });
}

constexpr double kOverTurn = 0.08;  ///< of a turn, beyond a whole one

void addCaptures(std::vector<Recording>& recordings, const fs::path& folder) {
  struct Capture {
    const char *file, *model, *scan;
  };
  constexpr Capture kCaptures[] = {{"hdl32e_outdoor", "hdl32e", "hdl32e_outdoor_0"},
                                   {"vlp16_close", "vlp16", "vlp16_close_0"},
                                   {"vlp16_street", "vlp16", "vlp16_street_0"},
                                   {"vls128_street", "vls128", "vls128_street_0"}};
  for (const Capture& capture : kCaptures) {
    const fs::path file = folder / (capture.file + std::string(".pcap"));
    if (!fs::exists(file)) continue;
    Adder adder(recordings, capture.file + std::string(".pcap"), [file, capture] {
      const Cloud::Ptr cloud = readRotations(file, capture.model, 1, kOverTurn).front();
      return prepareScan(*cloud, {}, returnsAbove(*cloud, groundOf(capture.scan)), false).cloud;
    });
    adder.asItIs(5, "over a turn");
    adder.add(5, "over a turn, unorganized", inFiringOrder);
  }
}

void addSimulatedMotion(std::vector<Recording>& recordings) {
  using namespace lisco_simulation;
  for (const char* const sensor_name : {"hdl64e", "hdl32e", "vlp16", "vls128", "os1-128"})
    for (const int number : {1, 3}) {
      const auto make = [sensor_name, number](double turns) {
        const Scene scene = makeScene(number, 1);
        const Sensor sensor = makeSensor(sensor_name);
        const auto columns = static_cast<std::size_t>(turns * static_cast<double>(sensor.steps));
        return fromSimulation(scanInMotion(scene, sensor, {}, kMotion, columns), scene.ground_z);
      };
      const std::string name = formatted("scene%d_%s", number, sensor_name);
      Adder adder(recordings, name, [make] { return make(1); });
      adder.asItIs(5, "by firing");
      adder.add(5, "by ring", byRing);
      adder.add(5, "unorganized", inFiringOrder);
      recordings.push_back({5, name, "over a turn", kTolerances, [make] { return make(1 + kOverTurn); }});
    }
}

/// A crowded room as seen from four places, one scan after the other.
CloudPtr roomFromStations() {
  using namespace lisco_simulation;
  constexpr Vector kStations[] = {{0, 0, 0}, {2, 1.5, 0}, {-2, 1.5, 0.2}, {0.5, -2, -0.3}};
  const Scene scene = makeScene(5, 1);
  const Sensor sensor = makeSensor("hdl64e");
  auto room = std::make_shared<ComparedCloud>();
  Disturbance disturbance;
  for (const Vector& station : kStations) {
    const Scene seen = seenFrom(scene, station, 0);
    CloudPtr cloud = inRingOrder(*fromSimulation(scan(seen, sensor, disturbance), seen.ground_z));
    for (ComparedPoint& point : *cloud) {
      point.x += static_cast<float>(station.x);
      point.y += static_cast<float>(station.y);
      point.z += static_cast<float>(station.z);
    }
    *room += *cloud;
    ++disturbance.seed;
  }
  return room;
}

void addWorstCases(std::vector<Recording>& recordings) {
  const auto add = [&](const std::string& name, std::size_t steps, double gap) {
    const std::string scan = lisco_simulation::caseHasGap(name) ? formatted("%s_%g", name.c_str(), gap) : name;
    recordings.push_back({6, scan, "worst case", {0.1, 0.4, 1.0}, [name, steps, gap] {
                            const auto sensor = lisco_simulation::makeSensor("hdl64e", 0, steps);
                            return fromSimulation(lisco_simulation::scanCase(name, sensor, {}, gap), kNoGround);
                          }});
  };
  for (const char* const name : {"room", "random", "poles"}) add(name, 0, 0.41);
  add("singletons", 0, 0.41);
  for (const double gap : {0.11, 0.41, 1.01}) add("sheets", 0, gap);  // just over each of the tolerances
  // Most returns are neighbours of each other, and PCL's time grows with their square: fewer steps.
  add("wall", 450, 0.41);
  add("blocked", 225, 0.41);
}

void addCamera(std::vector<Recording>& recordings, const fs::path& file) {
  Adder(recordings, file.stem().string(), [file] {
    return load(file, false);
  }).asItIs(6, "RGB-D", {0.01, 0.02, 0.05, 0.1});
}

void addAirborne(std::vector<Recording>& recordings, const fs::path& file) {
  Adder(recordings, file.stem().string(), [file] { return load(file, false); }).asItIs(6, "airborne", {0.1, 0.3, 1});
}

std::vector<fs::path> filesOf(const fs::path& folder) {
  if (!fs::is_directory(folder)) throw std::runtime_error("no real scans in " + folder.string());
  return cloudFilesIn(folder);
}

}  // namespace

const char* titleOf(int set) {
  static const char* const kTitles[kSets] = {
      "organized", "ring and firing order", "shuffled, filtered", "moved", "deskewed and dual",
      "other",     "laid out otherwise"};
  return kTitles[set - 1];
}

std::vector<Recording> allRecordings(const fs::path& data) {
  std::vector<Recording> recordings;
  for (const fs::path& file : filesOf(data / "scans")) {
    const std::string name = file.stem().string();
    if (startsWith(name, "rgbd"))
      addCamera(recordings, file);
    else if (startsWith(name, "airborne"))
      addAirborne(recordings, file);
    else
      addRotatingScan(recordings, file);
  }
  for (const fs::path& file : filesOf(data / "kitti"))
    recordings.push_back(
        {2, "kitti_" + file.stem().string(), "ring order", kTolerances, [file] { return load(file, true); }});
  addCaptures(recordings, data / "captures");
  addSimulatedMotion(recordings);
  recordings.push_back({6, "room_stations", "merged", kTolerances, roomFromStations});
  addWorstCases(recordings);
  std::stable_sort(recordings.begin(), recordings.end(),
                   [](const Recording& a, const Recording& b) { return a.set < b.set; });
  return recordings;
}

}  // namespace lisco_benchmarks
