// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "simulate/drive_files.h"

#include <cmath>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "io/interruption.h"
#include "io/output_file.h"
#include "simulate/drive_packets.h"

namespace lisco_apps {
namespace {

using namespace lisco_simulation;

constexpr const char* kPrefix = "rotation_";
constexpr const char* kEnding = ".pcd";
constexpr const char* kPoses = "poses.csv";
constexpr const char* kObjects = "objects.csv";
constexpr const char* kCapture = "capture.pcap";
constexpr std::size_t kOthers = 3;  // files besides the rotations

double degrees(double radians) {
  return radians * 180 / kPi;
}

void count(const SimulatedScan& scan, DriveCounts& counts) {
  for (const SimulatedCell& cell : scan.cells) {
    if (std::isnan(cell.x)) continue;
    ++counts.returns;
    if (cell.object == 0) ++counts.ground;
  }
}

std::string objectsOf(const World& world) {
  std::string text = "label,kind,x,y,z,yaw_degrees,length,width,height,speed_x,speed_y\n";
  std::size_t number = 0;
  for (const Body& body : world.bodies) {
    const Vector place = standingAfter(body, 0, world.ground).place;
    text += formatted("%zu,%s,%.4f,%.4f,%.4f,%.4f,", ++number, body.kind.c_str(), place.x, place.y, place.z,
                      degrees(body.heading));
    text += body.height > 0 ? formatted("%.4f,%.4f,%.4f", body.length, body.width, body.height) : ",,";
    text += formatted(",%.4f,%.4f\n", body.velocity.x, body.velocity.y);
  }
  if (!world.carrier.empty()) text += formatted("%zu,sensor car,,,,,,,,,\n", number + 1);
  return text;
}

}  // namespace

std::string pcdOf(const SimulatedScan& scan, const std::string& comment) {
  static_assert(sizeof(SimulatedCell) == 16, "cells are written as they are");
  std::string content =
      pcdHeader(comment, {{"x", 'F', 4}, {"y", 'F', 4}, {"z", 'F', 4}, {"label", 'U', 4}}, scan.steps, scan.lasers);
  content.append(reinterpret_cast<const char*>(scan.cells.data()), scan.cells.size() * sizeof(SimulatedCell));
  return content;
}

DriveCounts writeRotation(Drive& drive, const std::string& comment, const fs::path& file) {
  const SimulatedScan scan = drive.columns(0, drive.sensor().steps);
  DriveCounts counts;
  count(scan, counts);
  writeOwnFile(file, pcdOf(scan, comment), kSignature);
  return counts;
}

DriveCounts writeDrive(Drive& drive, std::size_t rotations, bool with_packets, const std::string& comment,
                       const fs::path& folder) {
  const std::size_t steps = drive.sensor().steps;
  std::vector<std::string> names = {kPoses, kObjects, kCapture};
  for (std::size_t rotation = 1; rotation <= rotations; ++rotation)
    names.push_back(formatted("%s%06zu%s", kPrefix, rotation, kEnding));
  DriveCounts counts;
  const auto make = [&](const fs::path& aside) {
    writeOwnFile(aside / kObjects, objectsOf(drive.world()), "label,");
    OwnFile poses(aside / kPoses, "rotation,");
    poses.write("rotation,column,seconds,x,y,z,roll_degrees,pitch_degrees,yaw_degrees\n");
    std::optional<PacketWriter> packets;
    if (with_packets) packets.emplace(aside / kCapture, drive.sensor());
    for (std::size_t rotation = 0; rotation < rotations; ++rotation) {
      if (Interruption::happened()) throw std::runtime_error("interrupted; nothing is written");
      const SimulatedScan scan = drive.columns(rotation * steps, steps);
      count(scan, counts);
      if (packets) packets->add(scan);
      writeOwnFile(aside / names[kOthers + rotation], pcdOf(scan, comment), kSignature);
      for (std::size_t column = 0; column < steps; ++column) {
        const Pose pose = drive.poseOf(rotation * steps + column);
        poses.write(formatted("%zu,%zu,%.6f,%.5f,%.5f,%.5f,%.5f,%.5f,%.5f\n", rotation + 1, column,
                              drive.secondsOf(rotation * steps + column), pose.place.x, pose.place.y, pose.place.z,
                              degrees(pose.roll), degrees(pose.pitch), degrees(pose.yaw)));
      }
    }
    if (packets) packets->finish();
    poses.finish();
  };
  std::error_code unreadable;                // a folder of which writeOwnFolder () says more
  if (fs::is_directory(folder, unreadable))  // rotations of others would be taken for these
    for (const fs::path& cloud : filesIn(folder, kPrefix, kEnding)) names.push_back(cloud.filename().string());
  writeOwnFolder(folder, "lisco_simulate", names, make);
  return counts;
}

}  // namespace lisco_apps
