// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <string>

#include "io/text.h"
#include "simulation/drive.h"
#include "simulation/scanner.h"

namespace lisco_apps {

/// First words of every file of lisco_simulate.
inline constexpr const char* kSignature = "# made by lisco_simulate ";

/// The content of a PCD of a scan, with fields x y z label. \param comment its first line
std::string pcdOf(const lisco_simulation::SimulatedScan& scan, const std::string& comment);

struct DriveCounts {
  std::size_t returns = 0;
  std::size_t ground = 0;
};

/// Writes the first rotation of a drive to a file.
/// \throws std::runtime_error with one line if it cannot be written
DriveCounts writeRotation(lisco_simulation::Drive& drive, const std::string& comment, const fs::path& file);

/// Writes a drive into a folder, all or nothing, in place of an earlier one: rotation_000001.pcd and so on, poses.csv
/// and objects.csv.
/// \param with_packets capture.pcap too; the sensor must be that of packetSensor ()
/// \throws std::runtime_error with one line if it cannot be written
DriveCounts writeDrive(lisco_simulation::Drive& drive, std::size_t rotations, bool with_packets,
                       const std::string& comment, const fs::path& folder);

}  // namespace lisco_apps
