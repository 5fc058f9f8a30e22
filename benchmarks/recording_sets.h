// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "compare/baselines.h"

namespace lisco_benchmarks {

/// A cloud as users have it, made when it is measured.
struct Recording {
  int set;                         ///< 1 to kSets
  std::string scan;                ///< the scan it is made of
  std::string form;                ///< what became of it: organized, ring order, ...
  std::vector<double> tolerances;  ///< metres, ascending
  std::function<lisco_apps::ComparedCloud::Ptr()> make;

  std::string name() const { return scan + ", " + form; }
};

/// Sets are numbered from 1 to this.
constexpr int kSets = 7;
/// A few words on a set.
const char* titleOf(int set);

/// All recordings, set by set, without ground. Random choices have fixed seeds.
///
/// 1 organized: the rotating scans, a row per laser
/// 2 ring and firing order: their returns, unorganized, laser by laser and firing by firing
/// 3 shuffled, and filtered by PCL's VoxelGrid and a crop
/// 4 moved: organized, ring and firing order in a tilted vehicle's frame and in map coordinates (UTM and the
///   British National Grid, OSGB), with and without sensor_origin_
/// 5 deskewed: scans of a moving sensor in the frame of its first column, organized by firing and by ring (each ring's
///   returns in their azimuth bins, the next free one if it is taken), and unorganized; captures of more than a turn;
///   two returns per firing, interleaved
/// 6 other: RGB-D and airborne scans, a room from several places, worst cases
/// 7 laid out otherwise: a column per laser, as Velodyne's ROS driver organizes clouds; rows in the order in which
///   lasers fire; half of the returns missing, at random; of a sensor tilted by 15 degrees; a sector of 30 degrees; two
///   and more turns beside each other or as more rows, each with other noise
/// \param data the folder of real scans
/// \throws std::runtime_error if the folder holds no scans
std::vector<Recording> allRecordings(const std::filesystem::path& data);

}  // namespace lisco_benchmarks
