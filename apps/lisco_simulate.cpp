// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// Writes a simulated scan of one of the scenes of the paper's evaluation, or of a worst case.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <boost/algorithm/string/join.hpp>
#include <boost/program_options.hpp>

#include "io/options.h"
#include "io/output_file.h"
#include "io/text.h"
#include "lisco/version.h"
#include "simulation/cases.h"
#include "simulation/scanner.h"
#include "simulation/scenes.h"
#include "simulation/sensor.h"

namespace {

namespace po = boost::program_options;
using namespace lisco_apps;
using namespace lisco_simulation;

/// First words of every file of this program.
constexpr const char* kSignature = "# made by lisco_simulate ";

constexpr double kMinGap = 0.001;  // metres
constexpr double kMaxGap = 100;
constexpr std::size_t kMaxCells = 20'000'000;  // about a gigabyte of memory

struct Options {
  int scene = 0;  ///< 0: a worst case
  bool vehicle = false;
  std::string worst_case;
  double gap = 0.41;  ///< of some cases, metres
  std::string sensor = sensorNames().front();
  std::size_t lasers = 0;  ///< 0: the sensor's own number
  std::size_t steps = 0;
  Disturbance disturbance;
  unsigned seed = 1;
  fs::path output;
};

void checkKnown(const std::string& name, const std::vector<std::string>& names, const std::string& what) {
  if (std::find(names.begin(), names.end(), name) == names.end())
    throw std::runtime_error("there is no " + what + " '" + name + "'; known are " + boost::join(names, ", "));
}

/// \return false if --help or --version was given
bool parse(int argc, char** argv, Options& options) {
  std::string usage =
      "Usage: lisco_simulate --scene N -o SCAN.pcd [options]\n"
      "       lisco_simulate --case NAME -o SCAN.pcd [options]\n\n"
      "Simulates one rotation of a LiDAR in one of the five scenes of the evaluation of Lisco's paper:\n"
      "  1  a few objects near the sensor: cars, people, trees, lamp posts, houses\n"
      "  2  the same objects far away\n"
      "  3  many objects near, among them a row of parked cars on each side\n"
      "  4  the same objects far away\n"
      "  5  a closed, crowded room\n"
      "or one of these cases, each a worst case of clustering in one way:\n";
  for (const std::string& name : caseNames())
    usage += formatted("  %-11s %s\n", name.c_str(), describeCase(name).c_str());
  usage +=
      "Writes an organized cloud, a row per laser and a column per step, with fields x y z label; the label\n"
      "is the number of the object that was hit, 0 the ground. Cells without return are NaN. Cases have no ground.\n\n"
      "Options";
  po::options_description shown(usage);
  const std::string cases = boost::join(caseNames(), ", ");
  const std::string sensors = boost::join(sensorNames(), ", ") + " (default " + options.sensor + ")";
  // clang-format off
  shown.add_options()
    ("scene", countOption("--scene", options.scene, 1, kScenes), "1 to 5")
    ("case", po::value<std::string>(&options.worst_case)->value_name("NAME"), cases.c_str())
    ("vehicle", po::bool_switch(&options.vehicle),
     "adds the vehicle below the sensor as one more object (scenes 1 to 4): roof, rack, mast and mirrors nearer than "
     "1.5 m, with a quarter of the returns of a default hdl64e")
    ("gap", numberOption("M", "--gap", options.gap),
     "between the two sheets, or between singletons, in metres (default 0.41)")
    ("output,o", pathOption("FILE", "--output", options.output), "the scan to write (PCD)")
    ("seed", countOption("--seed", options.seed, 0),
     "seed of the layout, noise and drop-outs (default 1)")
    ("sensor", po::value<std::string>(&options.sensor)->value_name("NAME"), sensors.c_str())
    ("lasers", countOption("--lasers", options.lasers, 1),
     "another number of lasers, between the sensor's highest and lowest")
    ("steps", countOption("--steps", options.steps, 1), "another number of steps of the rotation")
    ("noise", numberOption("M", "--noise", options.disturbance.range_noise),
     "standard deviation of the ranges in metres (default 0.02)")
    ("drop-outs", numberOption("P", "--drop-outs", options.disturbance.drop_outs),
     "part of the returns that is lost (default 0.005)");
  // clang-format on
  po::variables_map given;
  if (!readCommandLine(argc, argv, "lisco_simulate", shown, nullptr, given)) return false;
  if (given.count("scene") == 0 && given.count("case") == 0)
    throw std::runtime_error("--scene or --case is missing; see --help");
  if (given.count("scene") != 0 && given.count("case") != 0)
    throw std::runtime_error("--scene and --case exclude each other");
  if (options.scene == 0) checkKnown(options.worst_case, caseNames(), "case");
  if (options.gap < kMinGap || options.gap > kMaxGap)
    throw std::runtime_error(formatted("--gap must be from 0.001 to 100 metres, not %g", options.gap));
  if (options.vehicle && (options.scene < 1 || options.scene > 4))
    throw std::runtime_error("--vehicle needs a street: --scene 1, 2, 3 or 4");
  if (given.count("gap") != 0 && (options.scene != 0 || !caseHasGap(options.worst_case)))
    throw std::runtime_error("--gap is of --case sheets and --case singletons only");
  if (options.output.empty()) throw std::runtime_error("--output is missing; see --help");
  if (options.output.extension() != ".pcd")
    throw std::runtime_error("--output must end in .pcd, not be '" + options.output.string() + "'");
  options.disturbance.seed = options.seed;
  if (options.disturbance.range_noise < 0) throw std::runtime_error("--noise must not be negative");
  if (options.disturbance.drop_outs < 0 || options.disturbance.drop_outs >= 1)
    throw std::runtime_error("--drop-outs must be at least 0 and less than 1");
  return true;
}

Sensor sensorFor(const Options& options) {
  checkKnown(options.sensor, sensorNames(), "sensor");
  const auto check = [](std::size_t lasers, std::size_t steps) {
    if (std::max<std::size_t>(lasers, 1) > kMaxCells / std::max<std::size_t>(steps, 1))
      throw std::runtime_error("more than " + std::to_string(kMaxCells) + " cells: fewer --lasers or --steps");
  };
  check(options.lasers, options.steps);  // before memory is allocated
  Sensor sensor = makeSensor(options.sensor, options.lasers, options.steps);
  check(sensor.lasers(), sensor.steps);
  return sensor;
}

/// The content of the file.
std::string pcdOf(const Scan& scan, const std::string& comment) {
  static_assert(sizeof(Cell) == 16, "cells are written as they are");
  std::string content = pcdHeader(comment, "x y z label", "F F F U", scan.steps, scan.lasers);
  content.append(reinterpret_cast<const char*>(scan.cells.data()), scan.cells.size() * sizeof(Cell));
  return content;
}

/// The arguments that give the same scan again, without the name of the file.
std::string argumentsOf(const Options& options, const Sensor& sensor) {
  std::ostringstream arguments;
  if (options.scene != 0)
    arguments << "--scene " << options.scene << (options.vehicle ? " --vehicle" : "");
  else
    arguments << "--case " << options.worst_case;
  if (options.scene == 0 && caseHasGap(options.worst_case)) arguments << " --gap " << options.gap;
  arguments << " --seed " << options.seed << " --sensor " << options.sensor << " --lasers " << sensor.lasers()
            << " --steps " << sensor.steps << " --noise " << options.disturbance.range_noise << " --drop-outs "
            << options.disturbance.drop_outs;
  return arguments.str();
}

/// "3 x car, 2 x tree", in the order of first appearance.
std::string kindsOf(const Scene& scene) {
  std::vector<std::string> kinds;
  std::map<std::string, int> counts;
  for (const Object& object : scene.objects)
    if (counts[object.kind]++ == 0) kinds.push_back(object.kind);
  for (std::string& kind : kinds) kind = std::to_string(counts[kind]) + " x " + kind;
  return boost::join(kinds, ", ");
}

void printSensor(const Options& options, const Scan& scan) {
  std::printf("  sensor    %s, %zu lasers x %zu steps = %zu cells\n", options.sensor.c_str(), scan.lasers, scan.steps,
              scan.cells.size());
  std::printf("  returns   %zu", scan.returns());
}

void printScene(const Options& options, const Sensor& sensor, const Scene& scene, const Scan& scan) {
  static constexpr const char* kDescriptions[kScenes] = {"a few objects near the sensor", "a few objects far away",
                                                         "many objects near the sensor", "many objects far away",
                                                         "a closed, crowded room"};
  const auto ground_z = static_cast<double>(scene.ground_z);
  std::printf("scene %d of the paper: %s (seed %u)\n", options.scene, kDescriptions[options.scene - 1], options.seed);
  std::printf("  objects   %zu: %s\n", scene.objects.size(), kindsOf(scene).c_str());
  printSensor(options, scan);
  std::printf(", %zu above the ground (z >= %g m)", scan.returnsAbove(scene.ground_z), ground_z);
  const Sensor paper = makeSensor(sensorNames().front());
  if (options.vehicle)
    std::printf("; %zu nearer than %g m", scan.returnsWithin(kVehicleRange), kVehicleRange);
  else if (sensor.name == paper.name && sensor.lasers() == paper.lasers() && sensor.steps == paper.steps)
    std::printf("; the paper's scene gave %zu", kReturnsInPaper[options.scene - 1]);
  std::printf("\n  written   %s; cluster it with --ground-z %g\n", options.output.c_str(), ground_z);
}

int simulate(const Options& options) {
  checkMayWrite(options.output, kSignature);
  const Sensor sensor = sensorFor(options);
  std::ostringstream comment;
  comment << kSignature << LISCO_VERSION << ": " << argumentsOf(options, sensor);
  if (options.scene == 0) {
    const Scan rotation = scanCase(options.worst_case, sensor, options.disturbance, options.gap);
    writeOwnFile(options.output, pcdOf(rotation, comment.str()), kSignature);
    std::printf("case %s: %s (seed %u)\n", options.worst_case.c_str(), describeCase(options.worst_case).c_str(),
                options.seed);
    printSensor(options, rotation);
    std::printf("\n  written   %s\n", options.output.c_str());
    return 0;
  }
  Scene scene = makeScene(options.scene, options.seed);
  if (options.vehicle) addVehicle(scene, options.seed);
  const Scan rotation = scan(scene, sensor, options.disturbance);
  comment << "; remove the ground with --ground-z " << scene.ground_z;
  writeOwnFile(options.output, pcdOf(rotation, comment.str()), kSignature);
  printScene(options, sensor, scene, rotation);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return runProgram("lisco_simulate", [&] {
    Options options;
    if (!parse(argc, argv, options)) return 0;
    return simulate(options);
  });
}
