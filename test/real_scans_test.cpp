// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Identity with PCL on real rotations, whole vectors, with and without the ground.
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include "io/scan_file.h"
#include "pcl_client.h"
#include "pcl_clouds.h"
#include "pcl_stream.h"

namespace lisco_test {
namespace {

namespace fs = std::filesystem;
using pcl::PointXYZ;

constexpr pcl::uindex_t kMinPoints = 10;

/// A file of the data folder, and the height of its ground (NaN: it shows none).
struct ScanFile {
  const char* name;
  float ground_z;
  std::vector<double> tolerances{0.1, 0.3, 0.4, 0.7, 1.0};
};

void PrintTo(const ScanFile& file, std::ostream* out) {
  *out << file.name;
}

constexpr float kNoGround = std::numeric_limits<float>::quiet_NaN();
const std::vector<ScanFile> kScanFiles{
    {"hdl32e_outdoor_0", -2.10F},
    {"hdl32e_outdoor_1", -2.10F},
    {"hdl64e_city_0", -1.60F},
    {"hdl64e_city_1", -1.60F},
    {"vlp16_close_0", -0.57F},
    {"vlp16_street_0", -1.99F},
    {"vls128_street_0", -1.74F},
    {"os1_128_outdoor_0", -1.81F},
    {"os1_64_sparse_0", -0.48F},
    {"ring64_zeros", kNoGround},
    // PCL takes minutes for it at the other scans' tolerances.
    {"rgbd_office", kNoGround, {0.02, 0.05, 0.1}},
};

fs::path dataFolder() {
  const char* const folder = std::getenv("LISCO_TEST_DATA");
  return folder != nullptr ? folder : LISCO_TEST_DATA_DEFAULT;
}

class RealScan : public testing::TestWithParam<ScanFile> {
 protected:
  void SetUp() override {
    const fs::path scans = dataFolder() / "scans";
    if (!fs::is_directory(scans))
      GTEST_SKIP() << "no real scans: there is no folder " << scans << "; set LISCO_TEST_DATA to the data folder";
    cloud_ = lisco_apps::readScan(scans / (std::string(GetParam().name) + ".pcd")).cloud;
    ASSERT_GT(cloud_->height, 1U);
  }

  pcl::PointCloud<PointXYZ>::Ptr cloud_;
};

TEST_P(RealScan, EqualsPcl) {
  for (const double tolerance : GetParam().tolerances) {
    SCOPED_TRACE(tolerance);
    EXPECT_FALSE(expectSameAsPcl<PointXYZ>(cloud_, nullptr, {tolerance, kMinPoints}).empty());
  }
}

class RealScanWithGround : public RealScan {};

TEST_P(RealScanWithGround, EqualsPclAboveTheGround) {
  const auto above = std::make_shared<pcl::Indices>(lisco_apps::returnsAbove(*cloud_, GetParam().ground_z));
  EXPECT_LT(above->size(), returnsOf(*cloud_)->size());
  for (const double tolerance : GetParam().tolerances) {
    SCOPED_TRACE(tolerance);
    EXPECT_FALSE(expectSameAsPcl<PointXYZ>(cloud_, above, {tolerance, kMinPoints}).empty());
  }
}

TEST_P(RealScan, EqualsPclUnorganized) {
  expectSameAsPcl<PointXYZ>(unorganized(*cloud_), nullptr, {GetParam().tolerances[1], kMinPoints});
}

TEST_P(RealScan, EqualsPclDisplaced) {
  for (const bool with_origin : {false, true})
    expectSameAsPcl<PointXYZ>(displaced(*cloud_, 1000.0F, 0.0F, 0.0F, with_origin), nullptr,
                              {GetParam().tolerances[1], kMinPoints});
}

// Column by column; the second rotation uses the hints of the first.
TEST_P(RealScan, RotationsEqualTheBatch) {
  const Columns<PointXYZ> columns = columnsOf(*cloud_);
  pcl::LiscoStreamExtraction<PointXYZ> stream;
  for (const double tolerance : GetParam().tolerances) {
    SCOPED_TRACE(tolerance);
    const Request request{tolerance, kMinPoints};
    set(stream, request);
    stream.setHeader(cloud_->header);
    stream.beginRotation();
    for (const auto& column : columns) {
      ASSERT_TRUE(stream.addColumn(column));
      if (stream.getNumberOfColumns() == columns.size() / 2) stream.getNumberOfSubclusters();
    }
    Clusters clusters;
    pcl::PointCloud<PointXYZ> streamed;
    ASSERT_TRUE(stream.endRotation(clusters, streamed));
    EXPECT_TRUE(expectSame(batchClustersOf<PointXYZ>(cloud_, request), clusters));
    ASSERT_EQ(streamed.size(), cloud_->size());
    for (std::size_t i = 0; i < streamed.size(); ++i) ASSERT_TRUE(areSamePoint((*cloud_)[i], streamed[i])) << i;
  }
}

TEST_P(RealScan, WindowsEqualTheBatch) {
  const Columns<PointXYZ> columns = columnsOf(*cloud_);
  const Request request{GetParam().tolerances[1], kMinPoints};
  pcl::LiscoWindowExtraction<PointXYZ> windows;
  set(windows, request);
  const std::size_t hop = columns.size() / 12;
  windows.setHop(hop);
  windows.setWindowSize(4 * hop);
  ASSERT_TRUE(windows.beginStream());
  for (std::size_t end = 1; end <= 2 * columns.size(); ++end) {  // two turns
    if (!windows.addColumn(columns[(end - 1) % columns.size()])) continue;
    Clusters clusters;
    const auto cloud = std::make_shared<pcl::PointCloud<PointXYZ>>();
    ASSERT_TRUE(windows.extract(clusters));
    windows.getWindow(*cloud);
    ASSERT_TRUE(expectSame(batchClustersOf<PointXYZ>(cloud, request), clusters)) << "column " << end;
  }
}

const auto nameOf = [](const auto& file) { return std::string(file.param.name); };

/// The files that show some ground.
std::vector<ScanFile> filesWithGround() {
  std::vector<ScanFile> files;
  for (const ScanFile& file : kScanFiles)
    if (!std::isnan(file.ground_z)) files.push_back(file);
  return files;
}

INSTANTIATE_TEST_SUITE_P(Scans, RealScan, testing::ValuesIn(kScanFiles), nameOf);
INSTANTIATE_TEST_SUITE_P(Scans, RealScanWithGround, testing::ValuesIn(filesWithGround()), nameOf);

}  // namespace
}  // namespace lisco_test
