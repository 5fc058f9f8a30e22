// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// Writes a simulated scan of one of the scenes of the paper's evaluation, or of a worst case, or the scans of a drive
// through a street on uneven ground.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <boost/algorithm/string/join.hpp>
#include <boost/program_options.hpp>

#include "io/interruption.h"
#include "io/options.h"
#include "io/output_file.h"
#include "io/text.h"
#include "lisco/version.h"
#include "simulate/drive_files.h"
#include "simulate/drive_packets.h"
#include "simulation/cases.h"
#include "simulation/drive.h"
#include "simulation/motion.h"
#include "simulation/scanner.h"
#include "simulation/scenes.h"
#include "simulation/sensor.h"
#include "simulation/street.h"
#include "simulation/terrain.h"

namespace {

namespace po = boost::program_options;
using namespace lisco_apps;
using namespace lisco_simulation;

constexpr double kMinGap = 0.001;  // metres
constexpr double kMaxGap = 100;
constexpr double kMaxSlope = 30;  // degrees
constexpr double kMaxSway = 30;
constexpr double kMinHeight = 0.2;  // metres
constexpr double kMaxHeight = 5;
constexpr double kMaxSpeed = 100;     // metres per second
constexpr double kMaxTurnRate = 360;  // degrees per second
constexpr double kMaxDrive = 10'000;  // metres
constexpr int kMaxRotations = 100'000;
constexpr std::size_t kMaxCells = 20'000'000;  // about a gigabyte of memory

struct Options {
  int scene = 0;  ///< 0: a worst case or a terrain
  bool vehicle = false;
  std::string worst_case;
  double gap = 0.41;  ///< of some cases, metres
  std::string sensor = simulatedSensors().front();
  std::size_t lasers = 0;  ///< 0: the sensor's own number
  std::size_t steps = 0;
  Disturbance disturbance;
  unsigned seed = 1;
  std::string terrain;
  double slope = 10;     ///< degrees
  double height = 1.8;   ///< metres
  double turn_rate = 0;  ///< degrees per second
  double roll = 0;       ///< degrees
  double pitch = 0;
  Motion motion;
  std::size_t rotations = 1;
  bool pcap = false;
  fs::path output;

  bool isFolder() const { return output.extension() != ".pcd"; }
};

constexpr double kDegree = kPi / 180;

void checkKnown(const std::string& name, const std::vector<std::string>& names, const std::string& what) {
  if (std::find(names.begin(), names.end(), name) == names.end())
    throw std::runtime_error("there is no " + what + " '" + name + "'; known are " + boost::join(names, ", "));
}

/// The sensors of which there are only packets.
std::vector<std::string> packetOnlySensors() {
  const std::vector<std::string> simulated = simulatedSensors();
  std::vector<std::string> names;
  for (const std::string& name : packetSensorNames())
    if (std::find(simulated.begin(), simulated.end(), name) == simulated.end()) names.push_back(name);
  return names;
}

std::string usageText() {
  std::string usage =
      "Usage: lisco_simulate --scene N -o SCAN.pcd [options]\n"
      "       lisco_simulate --case NAME -o SCAN.pcd [options]\n"
      "       lisco_simulate --terrain NAME -o SCAN.pcd|FOLDER [options]\n\n"
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
      "or a drive through a street with moving cars and people, parked cars, posts, trees that overhang the\n"
      "road, walls, houses and a bridge, on one of these terrains:\n";
  for (const std::string& name : terrainNames())
    usage += formatted("  %-11s %s\n", name.c_str(), describeTerrain(name).c_str());
  usage +=
      "Writes an organized cloud, a row per laser and a column per step, with fields x y z label; the label\n"
      "is the number of the object that was hit, 0 the ground. Cells without return are NaN. Cases have no ground.\n"
      "A drive can be written into a folder: rotation_000001.pcd and so on, each column in the sensor's frame of\n"
      "its moment; poses.csv, the sensor's pose at each column; objects.csv, the objects by their labels; and with\n"
      "--pcap, capture.pcap: the sensor's packets of the same returns, for lisco_stream.\n\n"
      "Options";
  return usage;
}

void checkRange(const char* option, double value, double least, double most, const char* unit) {
  if (value < least || value > most)
    throw std::runtime_error(formatted("%s must be from %g to %g %s, not %g", option, least, most, unit, value));
}

/// Checks the options of drives. \param given the names of all options given
void checkDrive(const Options& options, const po::variables_map& given) {
  static constexpr const char* kOfDrives[] = {"slope", "height",      "speed",        "yaw-rate", "roll",
                                              "pitch", "roll-period", "pitch-period", "rotations"};
  for (const char* const option : kOfDrives)
    if (given.count("terrain") == 0 && given.count(option) != 0)
      throw std::runtime_error(std::string("--") + option + " needs --terrain");
  if (given.count("terrain") == 0) return;
  checkKnown(options.terrain, terrainNames(), "terrain");
  if (given.count("slope") != 0 && !terrainHasSlope(options.terrain))
    throw std::runtime_error("--slope is of --terrain slope, hill and ramp only");
  checkRange("--slope", options.slope, 0, kMaxSlope, "degrees");
  checkRange("--height", options.height, kMinHeight, kMaxHeight, "metres");
  checkRange("--speed", options.motion.speed, -kMaxSpeed, kMaxSpeed, "metres per second");
  checkRange("--yaw-rate", options.turn_rate, -kMaxTurnRate, kMaxTurnRate, "degrees per second");
  checkRange("--roll", options.roll, -kMaxSway, kMaxSway, "degrees");
  checkRange("--pitch", options.pitch, -kMaxSway, kMaxSway, "degrees");
  for (const auto& [option, period] : {std::pair("--roll-period", options.motion.roll_seconds),
                                       std::pair("--pitch-period", options.motion.pitch_seconds)})
    checkRange(option, period, 0.1, 1000, "seconds");
  const double seconds = static_cast<double>(options.rotations) * options.motion.turn_seconds;
  if (std::fabs(options.motion.speed) * seconds > kMaxDrive)
    throw std::runtime_error(formatted("the drive is longer than %g metres: fewer --rotations", kMaxDrive));
}

/// \return false if --help or --version was given
bool parse(int argc, char** argv, Options& options) {
  po::options_description shown(usageText());
  const std::string cases = boost::join(caseNames(), ", ");
  const std::string terrains = boost::join(terrainNames(), ", ");
  const std::string sensors = boost::join(simulatedSensors(), ", ") + " (default " + options.sensor +
                              "); with --pcap only: " + boost::join(packetOnlySensors(), ", ");
  const std::string pcap = "adds capture.pcap, the packets of a " + boost::join(packetSensorNames(), ", ") +
                           ", to the folder; lasers, steps (1800 unless given) and duration of a rotation are those of "
                           "the packets";
  // clang-format off
  shown.add_options()
    ("scene", countOption("--scene", options.scene, 1, kScenes), "1 to 5")
    ("case", po::value<std::string>(&options.worst_case)->value_name("NAME"), cases.c_str())
    ("terrain", po::value<std::string>(&options.terrain)->value_name("NAME"), terrains.c_str())
    ("vehicle", po::bool_switch(&options.vehicle),
     "adds the vehicle below the sensor as one more object (scenes 1 to 4): roof, rack, mast and mirrors nearer than "
     "1.5 m, with a quarter of the returns of a default hdl64e")
    ("gap", numberOption("M", "--gap", options.gap),
     "between the two sheets, or between singletons, in metres (default 0.41)")
    ("slope", numberOption("DEG", "--slope", options.slope),
     "of the terrains slope, hill and ramp, 0 to 30 degrees (default 10)")
    ("height", numberOption("M", "--height", options.height),
     "of the sensor above the terrain, 0.2 to 5 metres (default 1.8); from 1.65 m on it stands on a car")
    ("speed", numberOption("M/S", "--speed", options.motion.speed),
     "of the sensor, ahead, in metres per second (default 0)")
    ("yaw-rate", numberOption("DEG/S", "--yaw-rate", options.turn_rate),
     "at which the sensor's vehicle turns to the left, in degrees per second (default 0)")
    ("roll", numberOption("DEG", "--roll", options.roll),
     "amplitude of the sensor's roll, up to 30 degrees, in full at the start (default 0: upright on any slope)")
    ("pitch", numberOption("DEG", "--pitch", options.pitch), "amplitude of its pitch, likewise")
    ("roll-period", numberOption("S", "--roll-period", options.motion.roll_seconds),
     "of the roll, in seconds (default 1.7)")
    ("pitch-period", numberOption("S", "--pitch-period", options.motion.pitch_seconds),
     "of the pitch, in seconds (default 1.3)")
    ("rotations", countOption("--rotations", options.rotations, 1, kMaxRotations),
     "of the sensor on the terrain (default 1), of 0.1 s each; several are written into a folder")
    ("pcap", po::bool_switch(&options.pcap), pcap.c_str())
    ("output,o", pathOption("FILE", "--output", options.output),
     "the scan to write (PCD); of a terrain also a folder; folders above it are made")
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
  const auto worlds = given.count("scene") + given.count("case") + given.count("terrain");
  if (worlds == 0) throw std::runtime_error("--scene, --case or --terrain is missing; see --help");
  if (worlds > 1) throw std::runtime_error("--scene, --case and --terrain exclude each other");
  if (given.count("case") != 0) checkKnown(options.worst_case, caseNames(), "case");
  checkRange("--gap", options.gap, kMinGap, kMaxGap, "metres");
  if (options.vehicle && (options.scene < 1 || options.scene > 4))
    throw std::runtime_error("--vehicle needs a street: --scene 1, 2, 3 or 4");
  if (given.count("gap") != 0 && (given.count("case") == 0 || !caseHasGap(options.worst_case)))
    throw std::runtime_error("--gap is of --case sheets and --case singletons only");
  checkDrive(options, given);
  if (options.output.empty()) throw std::runtime_error("--output is missing; see --help");
  if (options.isFolder() && (options.terrain.empty() || options.output.extension() == ".pcap"))
    throw std::runtime_error("--output must end in .pcd" +
                             std::string(options.terrain.empty() ? "" : " or be a folder, with --pcap for packets") +
                             ", not be '" + options.output.string() + "'");
  if (options.pcap && given.count("terrain") == 0) throw std::runtime_error("--pcap needs --terrain");
  if (options.pcap && given.count("lasers") != 0) throw std::runtime_error("--pcap and --lasers exclude each other");
  if (!options.isFolder() && (options.rotations > 1 || options.pcap))
    throw std::runtime_error(std::string(options.pcap ? "--pcap" : "--rotations") +
                             " needs a folder as --output, not '" + options.output.string() + "'");
  options.disturbance.seed = options.seed;
  constexpr double kMaxNoise = 10;  // metres
  if (options.disturbance.range_noise < 0 || options.disturbance.range_noise > kMaxNoise)
    throw std::runtime_error(formatted("--noise must be 0 to %g", kMaxNoise));
  if (options.disturbance.drop_outs < 0 || options.disturbance.drop_outs >= 1)
    throw std::runtime_error("--drop-outs must be at least 0 and less than 1");
  options.motion.turn_rate = options.turn_rate * kDegree;
  options.motion.roll = options.roll * kDegree;
  options.motion.pitch = options.pitch * kDegree;
  return true;
}

Sensor sensorFor(const Options& options) {
  const std::vector<std::string> with_pcap = packetOnlySensors();
  if (!options.pcap && std::find(with_pcap.begin(), with_pcap.end(), options.sensor) != with_pcap.end())
    throw std::runtime_error("--sensor " + options.sensor + " is of --terrain with --pcap only");
  if (!options.pcap) checkKnown(options.sensor, simulatedSensors(), "sensor");
  const auto check = [](std::size_t lasers, std::size_t steps) {
    if (std::max<std::size_t>(lasers, 1) > kMaxCells / std::max<std::size_t>(steps, 1))
      throw std::runtime_error("more than " + std::to_string(kMaxCells) + " cells: fewer --lasers or --steps");
  };
  check(options.lasers, options.steps);  // before memory is allocated
  Sensor sensor = options.pcap ? packetSensor(options.sensor, options.steps)
                               : makeSensor(options.sensor, options.lasers, options.steps);
  check(sensor.lasers(), sensor.steps);
  return sensor;
}

/// The shortest text of a number that gives it again.
std::string shortest(double number) {
  char text[32];
  const auto [end, error] = std::to_chars(std::begin(text), std::end(text), number);
  return {text, end};
}

std::string argumentsOfDrive(const Options& options) {
  std::ostringstream arguments;
  arguments << "--terrain " << options.terrain;
  if (terrainHasSlope(options.terrain)) arguments << " --slope " << shortest(options.slope);
  arguments << " --height " << shortest(options.height) << " --speed " << shortest(options.motion.speed)
            << " --yaw-rate " << shortest(options.turn_rate) << " --roll " << shortest(options.roll)
            << " --roll-period " << shortest(options.motion.roll_seconds) << " --pitch " << shortest(options.pitch)
            << " --pitch-period " << shortest(options.motion.pitch_seconds) << " --rotations " << options.rotations;
  if (options.pcap) arguments << " --pcap";
  return arguments.str();
}

/// The arguments that give the same scan again, without the name of the file.
std::string argumentsOf(const Options& options, const Sensor& sensor) {
  std::ostringstream arguments;
  if (options.scene != 0)
    arguments << "--scene " << options.scene << (options.vehicle ? " --vehicle" : "");
  else if (!options.worst_case.empty())
    arguments << "--case " << options.worst_case;
  else
    arguments << argumentsOfDrive(options);
  if (!options.worst_case.empty() && caseHasGap(options.worst_case)) arguments << " --gap " << shortest(options.gap);
  arguments << " --seed " << options.seed << " --sensor " << options.sensor;
  if (!options.pcap) arguments << " --lasers " << sensor.lasers();
  arguments << " --steps " << sensor.steps << " --noise " << shortest(options.disturbance.range_noise)
            << " --drop-outs " << shortest(options.disturbance.drop_outs);
  return arguments.str();
}

/// "3 x car, 2 x tree", in the order of first appearance.
template <typename Objects>
std::string kindsOf(const Objects& objects) {
  std::vector<std::string> kinds;
  std::map<std::string, int> counts;
  for (const auto& object : objects)
    if (counts[object.kind]++ == 0) kinds.push_back(object.kind);
  for (std::string& kind : kinds) kind = std::to_string(counts[kind]) + " x " + kind;
  return boost::join(kinds, ", ");
}

void printSensor(const Options& options, const SimulatedScan& scan) {
  std::printf("  sensor    %s, %zu lasers x %zu steps = %zu cells\n", options.sensor.c_str(), scan.lasers, scan.steps,
              scan.cells.size());
  std::printf("  returns   %zu", scan.returns());
}

void printScene(const Options& options, const Sensor& sensor, const Scene& scene, const SimulatedScan& scan) {
  static constexpr const char* kDescriptions[kScenes] = {"a few objects near the sensor", "a few objects far away",
                                                         "many objects near the sensor", "many objects far away",
                                                         "a closed, crowded room"};
  const auto ground_z = static_cast<double>(scene.ground_z);
  std::printf("scene %d of the paper: %s (seed %u)\n", options.scene, kDescriptions[options.scene - 1], options.seed);
  std::printf("  objects   %zu: %s\n", scene.objects.size(), kindsOf(scene.objects).c_str());
  printSensor(options, scan);
  std::printf(", %zu above the ground (z >= %g m)", scan.returnsAbove(scene.ground_z), ground_z);
  const Sensor paper = makeSensor(simulatedSensors().front());
  if (options.vehicle)
    std::printf("; %zu nearer than %g m", scan.returnsWithin(kVehicleRange), kVehicleRange);
  else if (sensor.name == paper.name && sensor.lasers() == paper.lasers() && sensor.steps == paper.steps)
    std::printf("; the paper's scene gave %zu", kReturnsInPaper[options.scene - 1]);
  std::printf("\n  written   %s; cluster it with --ground-z %g\n", options.output.c_str(), ground_z);
}

/// Drives through a street on a terrain.
int drive(const Options& options, const Sensor& sensor, const std::string& comment) {
  Motion motion = options.motion;
  if (options.pcap) motion.turn_seconds = turnSeconds(sensor);
  const double seconds = static_cast<double>(options.rotations) * motion.turn_seconds;
  const Terrain ground = makeTerrain(options.terrain, options.slope * kDegree, options.seed);
  Drive drive(makeStreet(ground, motion, seconds, options.height, options.seed), sensor, options.disturbance, motion,
              options.height);
  std::printf("terrain %s: %s (seed %u)\n", options.terrain.c_str(), describeTerrain(options.terrain).c_str(),
              options.seed);
  const World& world = drive.world();
  std::printf("  objects   %zu: %s%s\n", world.bodies.size() + (world.carrier.empty() ? 0 : 1),
              kindsOf(world.bodies).c_str(), world.carrier.empty() ? "" : ", 1 x sensor car");
  std::printf("  sensor    %s, %zu lasers x %zu steps, %g m above the ground\n", options.sensor.c_str(),
              sensor.lasers(), sensor.steps, options.height);
  DriveCounts counts;
  if (options.isFolder()) {
    Interruption::listen();
    counts = writeDrive(drive, options.rotations, options.pcap, comment, options.output);
  } else {
    counts = writeRotation(drive, comment, options.output);
  }
  std::printf("  returns   %zu in %zu rotation%s, %zu of them of the ground (label 0)\n  written   %s\n",
              counts.returns, options.rotations, options.rotations == 1 ? "" : "s", counts.ground,
              options.output.c_str());
  return 0;
}

int simulate(const Options& options) {
  const Sensor sensor = sensorFor(options);
  const MadeFolders parents(options.isFolder() ? fs::path() : options.output.parent_path());
  if (!options.isFolder()) checkMayWrite(options.output, kSignature);
  std::ostringstream comment;
  comment << kSignature << LISCO_VERSION << ": " << argumentsOf(options, sensor);
  if (!options.terrain.empty()) return drive(options, sensor, comment.str());
  if (options.scene == 0) {
    const SimulatedScan rotation = scanCase(options.worst_case, sensor, options.disturbance, options.gap);
    writeOwnFile(options.output, pcdOf(rotation, comment.str()), kSignature);
    std::printf("case %s: %s (seed %u)\n", options.worst_case.c_str(), describeCase(options.worst_case).c_str(),
                options.seed);
    printSensor(options, rotation);
    std::printf("\n  written   %s\n", options.output.c_str());
    return 0;
  }
  Scene scene = makeScene(options.scene, options.seed);
  if (options.vehicle) addVehicle(scene, options.seed);
  const SimulatedScan rotation = scan(scene, sensor, options.disturbance);
  comment << "; remove the ground with --ground-z " << scene.ground_z;
  writeOwnFile(options.output, pcdOf(rotation, comment.str()), kSignature);
  printScene(options, sensor, scene, rotation);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return runProgram("lisco_simulate", [&] {
    Options options;
    return parse(argc, argv, options) ? simulate(options) : 0;
  });
}
