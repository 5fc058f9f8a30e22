// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// The ground filter on real scans.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include "ground_quality.h"
#include "io/scan_file.h"
#include "lisco/ground_filter.h"

namespace lisco_test {
namespace {

namespace fs = std::filesystem;

/// A scan, and what the ground filter must reach on it.
struct GroundScan {
  const char* name;
  std::size_t most_flat;       ///< flat clusters, at 0.4 m
  std::size_t least_not_flat;  ///< other clusters
  double most_lost;            ///< share of the returns more than 0.5 m above the local ground
};

void PrintTo(const GroundScan& scan, std::ostream* out) {
  *out << scan.name;
}

class GroundOnRealScan : public testing::TestWithParam<GroundScan> {
 protected:
  void SetUp() override {
    const char* const folder = std::getenv("LISCO_TEST_DATA");
    const fs::path scans = fs::path(folder != nullptr ? folder : LISCO_TEST_DATA_DEFAULT) / "scans";
    if (!fs::is_directory(scans))
      GTEST_SKIP() << "no real scans: there is no folder " << scans << "; set LISCO_TEST_DATA to the data folder";
    cloud_ = lisco_apps::readScan(scans / (std::string(GetParam().name) + ".pcd")).cloud;
  }

  lisco::Return cell(std::size_t laser, std::size_t column) const {
    const auto& point = cloud_->points[laser * cloud_->width + column];
    return {point.x, point.y, point.z, 0};
  }

  std::vector<std::uint8_t> filtered() const {
    const auto cells = [this](std::size_t laser, std::size_t column) { return cell(laser, column); };
    std::vector<std::uint8_t> ground(cloud_->size(), 7);
    lisco::GroundFilter filter;
    filter.filter(parameters(), cloud_->width, cloud_->height, cells, ground.data());
    return ground;
  }

  lisco::GroundParameters parameters() const {
    const auto cells = [this](std::size_t laser, std::size_t column) { return cell(laser, column); };
    return lisco::estimateGround(cloud_->width, cloud_->height, {0.0F, 0.0F, 0.0F}, lisco::CellSource(cells));
  }

  lisco_apps::Cloud::Ptr cloud_;
};

TEST_P(GroundOnRealScan, LeavesFewRingsAndLosesFewReturns) {
  std::vector<std::int32_t> labels;
  std::vector<std::uint8_t> flat;
  const auto quality =
      lisco_benchmarks::measureGround(*cloud_, filtered(), lisco_benchmarks::localGround(*cloud_), 0.4, labels, flat);
  EXPECT_LE(quality.flat, GetParam().most_flat);
  EXPECT_GE(quality.clusters - quality.flat, GetParam().least_not_flat);
  EXPECT_LE(static_cast<double>(quality.lost), GetParam().most_lost * static_cast<double>(quality.elevated));
}

TEST_P(GroundOnRealScan, EqualsColumnByColumn) {
  std::vector<std::uint8_t> ground(cloud_->size(), 7);
  const auto visit = [&](std::size_t column, const std::uint8_t* decisions, std::size_t lasers) {
    for (std::size_t laser = 0; laser < lasers; ++laser) ground[laser * cloud_->width + column] = decisions[laser];
  };
  lisco::GroundFilter filter;
  filter.begin(parameters(), cloud_->height);
  std::vector<lisco::Return> cells(cloud_->height);
  for (std::size_t column = 0; column < cloud_->width; ++column) {
    for (std::size_t laser = 0; laser < cells.size(); ++laser) cells[laser] = cell(laser, column);
    filter.addColumn(cells.data(), cells.size(), visit);
  }
  filter.finish(visit);
  EXPECT_EQ(ground, filtered());
}

INSTANTIATE_TEST_SUITE_P(
    Scans, GroundOnRealScan,
    testing::Values(GroundScan{"hdl64e_kitti_0", 2, 111, 0.001}, GroundScan{"vls128_deskewed_0", 35, 374, 0.001},
                    GroundScan{"os1_128_outdoor_0", 2, 271, 0.001}, GroundScan{"hdl32e_outdoor_0", 94, 122, 0.001},
                    GroundScan{"vls128_street_0", 56, 534, 0.004}, GroundScan{"hdl64e_city_0", 0, 79, 0.001}),
    [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace lisco_test
