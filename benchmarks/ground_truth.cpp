// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// Ground filters against the truth of simulated drives: precision, recall and F1 of the ground, and the part of the
// objects' returns that is lost, per terrain, sensor and filter. Prints Markdown.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <pcl/ModelCoefficients.h>
#include <pcl/common/io.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/segmentation/approximate_progressive_morphological_filter.h>
#include <pcl/segmentation/sac_segmentation.h>

#include "io/options.h"
#include "lisco/ground_filter.h"
#include "simulation/drive.h"
#include "simulation/motion.h"
#include "simulation/sensor.h"
#include "simulation/street.h"
#include "simulation/terrain.h"

namespace {

using namespace lisco_apps;
using namespace lisco_simulation;
using Cloud = pcl::PointCloud<pcl::PointXYZ>;

constexpr double kDegree = kPi / 180;

struct Settings {
  std::vector<std::string> terrains = terrainNames();
  std::vector<std::string> sensors = lisco_simulation::simulatedSensors();
  std::vector<std::string> seeds = {"1", "2", "3"};
  std::size_t rotations = 2;
  double slope = 10;    ///< degrees
  double height = 1.8;  ///< metres
  double speed = 8;     ///< metres per second
  double sway = 2;      ///< amplitude of roll and pitch, degrees
};

/// A simulated drive, and what its returns lie on.
struct Simulated {
  std::vector<SimulatedScan> rotations;
  std::vector<std::string> kinds;          ///< of the objects, by their numbers less 1
  std::vector<std::vector<double>> above;  ///< the ground, metres, per rotation and cell; NaN: no return
};

/// Decisions on the returns of a rotation, laser by laser: 1 on the ground.
using Decisions = std::vector<std::uint8_t>;

struct Counts {
  double true_ground = 0, false_ground = 0, missed_ground = 0, objects = 0;

  void add(const SimulatedScan& scan, const Decisions& decided) {
    for (std::size_t i = 0; i < scan.cells.size(); ++i) {
      const SimulatedCell& cell = scan.cells[i];
      if (std::isnan(cell.x)) continue;
      const bool ground = cell.object == 0;
      if (!ground) ++objects;
      if (decided[i] != 0)
        ++(ground ? true_ground : false_ground);
      else if (ground)
        ++missed_ground;
    }
  }
  double precision() const { return true_ground > 0 ? true_ground / (true_ground + false_ground) : 0; }
  double recall() const { return true_ground > 0 ? true_ground / (true_ground + missed_ground) : 0; }
  double f1() const { return 2 * true_ground / std::max(1.0, 2 * true_ground + false_ground + missed_ground); }
  double lost() const { return objects > 0 ? false_ground / objects : 0; }
};

/// The returns of a scan, and the cells they come from.
struct Returns {
  Cloud::Ptr cloud = std::make_shared<Cloud>();
  std::vector<std::size_t> cells;

  explicit Returns(const SimulatedScan& scan) {
    for (std::size_t i = 0; i < scan.cells.size(); ++i) {
      const SimulatedCell& cell = scan.cells[i];
      if (std::isnan(cell.x)) continue;
      cloud->emplace_back(cell.x, cell.y, cell.z);
      cells.push_back(i);
    }
  }
  Decisions decisions(const SimulatedScan& scan, const pcl::Indices& ground) const {
    Decisions decided(scan.cells.size(), 0);
    for (const auto index : ground) decided[cells[static_cast<std::size_t>(index)]] = 1;
    return decided;
  }
};

/// A filter that decides on one rotation by itself.
struct Filter {
  const char* name;
  std::function<Decisions(const SimulatedScan& scan, double height)> decide;
};

constexpr std::size_t kBetweenDrives = 5;  // rotations

constexpr double kThickness = 0.2;  // metres: how far ground may be from the height or the plane

Decisions byHeight(const SimulatedScan& scan, double height) {
  Decisions decided;
  for (const SimulatedCell& cell : scan.cells)
    decided.push_back(static_cast<double>(cell.z) < kThickness - height ? 1 : 0);
  return decided;
}

Decisions byPlane(const SimulatedScan& scan, double /*height*/) {
  const Returns returns(scan);
  pcl::SACSegmentation<pcl::PointXYZ> segmentation;
  segmentation.setModelType(pcl::SACMODEL_PERPENDICULAR_PLANE);  // not the largest wall
  segmentation.setAxis({0, 0, 1});
  segmentation.setEpsAngle(20 * kDegree);
  segmentation.setMethodType(pcl::SAC_RANSAC);
  segmentation.setMaxIterations(1000);
  segmentation.setOptimizeCoefficients(true);
  segmentation.setDistanceThreshold(kThickness);
  segmentation.setInputCloud(returns.cloud);
  pcl::PointIndices ground;
  pcl::ModelCoefficients plane;
  segmentation.segment(ground, plane);
  return returns.decisions(scan, ground.indices);
}

Decisions byMorphology(const SimulatedScan& scan, double /*height*/) {
  const Returns returns(scan);
  pcl::ApproximateProgressiveMorphologicalFilter<pcl::PointXYZ> filter;  // with its defaults
  filter.setInputCloud(returns.cloud);
  pcl::Indices ground;
  filter.extract(ground);
  return returns.decisions(scan, ground);
}

/// Runs the filter over a whole drive, column by column.
std::vector<Decisions> byLisco(const std::vector<SimulatedScan>& rotations) {
  lisco::GroundFilter filter;
  filter.begin({}, rotations.front().lasers);
  std::vector<Decisions> decided;
  for (const SimulatedScan& scan : rotations) decided.emplace_back(scan.cells.size(), std::uint8_t{0});
  const std::size_t steps = rotations.front().steps;
  const auto visit = [&](std::size_t column, const std::uint8_t* ground, std::size_t lasers) {
    for (std::size_t laser = 0; laser < lasers; ++laser)
      decided[column / steps][laser * steps + column % steps] = ground[laser];
  };
  std::vector<lisco::Return> cells(rotations.front().lasers);
  for (const SimulatedScan& scan : rotations)
    for (std::size_t step = 0; step < steps; ++step) {
      for (std::size_t laser = 0; laser < scan.lasers; ++laser) {
        const SimulatedCell& cell = scan.at(laser, step);
        cells[laser] = {cell.x, cell.y, cell.z, 0};
      }
      filter.addColumn(cells.data(), scan.lasers, visit);
    }
  filter.finish(visit);
  return decided;
}

/// Where a filter goes wrong.
class Details {
 public:
  void add(const Simulated& drive, const std::vector<Decisions>& decided) {
    for (std::size_t i = 0; i < decided.size(); ++i)
      for (std::size_t at = 0; at < decided[i].size(); ++at) {
        const SimulatedCell& cell = drive.rotations[i].cells[at];
        if (std::isnan(cell.x)) continue;
        const bool is_right = (decided[i][at] != 0) == (cell.object == 0);
        if (cell.object != 0)
          count(drive.kinds[cell.object - 1], bandOf(drive.above[i][at], {0.1, 0.2, 0.5, 1}), is_right);
        else
          count("ground", bandOf(std::hypot(static_cast<double>(cell.x), static_cast<double>(cell.y)), {5, 10, 20, 40}),
                is_right);
      }
  }
  void print() const {
    std::printf("\n%-12s %s\n", "", "wrong of all returns, up to 0.1, 0.2, 0.5, 1 m and higher above the ground");
    for (const auto& [kind, bands] : of_)
      if (kind != "ground") printBands(kind, bands);
    std::printf("%-12s %s\n", "", "up to 5, 10, 20, 40 m and farther from the sensor");
    const auto ground = of_.find("ground");
    if (ground != of_.end()) printBands("ground", ground->second);
    std::printf("\n");
  }

 private:
  static constexpr std::size_t kBands = 5;
  struct Band {
    long wrong = 0, all = 0;
  };
  using Bands = std::array<Band, kBands>;

  static std::size_t bandOf(double value, const std::array<double, kBands - 1>& limits) {
    return static_cast<std::size_t>(std::upper_bound(limits.begin(), limits.end(), value) - limits.begin());
  }
  void count(const std::string& kind, std::size_t band, bool is_right) {
    Band& in = of_[kind][band];
    ++in.all;
    if (!is_right) ++in.wrong;
  }
  static void printBands(const std::string& kind, const Bands& bands) {
    std::printf("%-12s", kind.c_str());
    for (const Band& band : bands) std::printf(" %7ld/%-8ld", band.wrong, band.all);
    std::printf("\n");
  }

  std::map<std::string, Bands> of_;
};

Simulated simulated(const Settings& settings, const std::string& terrain, const std::string& sensor_name,
                    unsigned seed) {
  Motion motion;
  motion.speed = settings.speed;
  motion.roll = settings.sway * kDegree;
  motion.pitch = settings.sway * kDegree;
  Disturbance disturbance;
  disturbance.seed = seed;
  const std::size_t begin = kBetweenDrives * (seed % 20);  // another phase of the swaying
  const double seconds = static_cast<double>(begin + settings.rotations) * motion.turn_seconds;
  const Terrain ground = makeTerrain(terrain, settings.slope * kDegree, seed);
  const Sensor sensor = makeSensor(sensor_name);
  Drive drive(makeStreet(ground, motion, seconds, settings.height, seed), sensor, disturbance, motion, settings.height);
  Simulated result;
  for (const Body& body : drive.world().bodies) result.kinds.push_back(body.kind);
  result.kinds.emplace_back("sensor car");
  for (std::size_t rotation = 0; rotation < settings.rotations; ++rotation) {
    const std::size_t first = (begin + rotation) * sensor.steps;
    result.rotations.push_back(drive.columns(first, sensor.steps));
    const SimulatedScan& scan = result.rotations.back();
    std::vector<double>& above = result.above.emplace_back();
    for (std::size_t i = 0; i < scan.cells.size(); ++i) {
      const SimulatedCell& cell = scan.cells[i];
      const Pose pose = drive.poseOf(first + i % sensor.steps);
      const Vector place =
          Rotation(pose)({static_cast<double>(cell.x), static_cast<double>(cell.y), static_cast<double>(cell.z)}) +
          pose.place;
      above.push_back(place.z - ground.height(place.x, place.y));
    }
  }
  return result;
}

std::string cellsOf(const Counts& counts) {
  return formatted("%.1f / %.1f / **%.1f** / %.1f", 100 * counts.precision(), 100 * counts.recall(), 100 * counts.f1(),
                   100 * counts.lost());
}

/// The least, the most and the mean of a column of the table.
struct Summary {
  double sum_f1 = 0, least_f1 = 2, sum_lost = 0, most_lost = -1;
  std::string least_at, most_at;
  int count = 0;

  void add(const Counts& counts, const std::string& at) {
    sum_f1 += counts.f1();
    sum_lost += counts.lost();
    ++count;
    if (counts.f1() < least_f1) {
      least_f1 = counts.f1();
      least_at = at;
    }
    if (counts.lost() > most_lost) {
      most_lost = counts.lost();
      most_at = at;
    }
  }
  void print(const std::string& name) const {
    std::printf("| %s | %.1f | %.1f (%s) | %.1f | %.1f (%s) |\n", name.c_str(), 100 * sum_f1 / count, 100 * least_f1,
                least_at.c_str(), 100 * sum_lost / count, 100 * most_lost, most_at.c_str());
  }
};

int run(const Settings& settings, bool only_lisco, bool with_details) {
  const std::vector<Filter> rivals =
      only_lisco ? std::vector<Filter>{}
                 : std::vector<Filter>{{"height", byHeight}, {"plane", byPlane}, {"morphological", byMorphology}};
  std::vector<std::string> names;
  for (const Filter& rival : rivals) names.emplace_back(rival.name);
  names.emplace_back("Lisco");
  for (const std::string& terrain : settings.terrains) describeTerrain(terrain);  // throws if unknown
  for (const std::string& sensor : settings.sensors) makeSensor(sensor);
  for (const std::string& seed : settings.seeds) countOf(seed, "--seeds", 0);
  std::printf("| terrain | sensor |");
  for (const std::string& name : names) std::printf(" %s |", name.c_str());
  std::printf("\n|---|---|");
  for (std::size_t i = 0; i < names.size(); ++i) std::printf("---|");
  std::printf("\n");
  std::vector<Summary> summaries(names.size());
  for (const std::string& terrain : settings.terrains)
    for (const std::string& sensor : settings.sensors) {
      std::vector<Counts> counts(names.size());
      Details details;
      for (const std::string& seed : settings.seeds) {
        const Simulated drive = simulated(settings, terrain, sensor, countOf(seed, "--seeds", 0));
        const std::vector<Decisions> decided = byLisco(drive.rotations);
        for (std::size_t rotation = 0; rotation < settings.rotations; ++rotation) {
          const SimulatedScan& scan = drive.rotations[rotation];
          for (std::size_t i = 0; i < rivals.size(); ++i) counts[i].add(scan, rivals[i].decide(scan, settings.height));
          counts.back().add(scan, decided[rotation]);
        }
        details.add(drive, decided);
      }
      std::printf("| %s | %s |", terrain.c_str(), sensor.c_str());
      for (std::size_t i = 0; i < names.size(); ++i) {
        summaries[i].add(counts[i], terrain + ", " + sensor);
        std::printf(" %s |", cellsOf(counts[i]).c_str());
      }
      std::printf("\n");
      if (with_details) details.print();
      std::fflush(stdout);
    }
  std::printf("\n| filter | F1: mean | least | lost: mean | most |\n|---|--:|---|--:|---|\n");
  for (std::size_t i = 0; i < names.size(); ++i) summaries[i].print(names[i]);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  namespace po = boost::program_options;
  return lisco_apps::runProgram("ground_truth", [&] {
    Settings settings;
    bool only_lisco = false;
    bool with_details = false;
    po::options_description options(
        "Usage: ground_truth [options]\n\n"
        "Compares ground filters with the truth of simulated drives, and prints two tables in Markdown: per filter "
        "the\n"
        "precision, recall and F1 of the ground and the part of the objects' returns that is lost, in per cent; and\n"
        "their means");
    const auto list = [](const char* name, std::vector<std::string>& items) {
      return textOption(name, [&items](const std::string& text) { items = itemsOf(text); });
    };
    // clang-format off
    options.add_options()
      ("terrains", list("NAME,...", settings.terrains), "of lisco_simulate (default: all)")
      ("sensors", list("NAME,...", settings.sensors), "of lisco_simulate (default: all)")
      ("seeds", list("N,...", settings.seeds), "a drive each (default 1,2,3)")
      ("rotations", countOption("--rotations", settings.rotations, 1, 1000), "of each drive (default 2)")
      ("slope", numberOption("DEG", "--slope", settings.slope), "of the terrains with a slope (default 10)")
      ("height", numberOption("M", "--height", settings.height), "of the sensor above the ground (default 1.8)")
      ("speed", numberOption("M/S", "--speed", settings.speed), "of the sensor (default 8)")
      ("sway", numberOption("DEG", "--sway", settings.sway), "amplitude of its roll and pitch (default 2)")
      ("only-lisco", po::bool_switch(&only_lisco), "leave out the other filters")
      ("details", po::bool_switch(&with_details), "after each row, where Lisco goes wrong");
    // clang-format on
    po::variables_map given;
    if (!readCommandLine(argc, argv, "ground_truth", options, nullptr, given)) return 0;
    return run(settings, only_lisco, with_details);
  });
}
