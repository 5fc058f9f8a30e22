// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Captures of real sensors against organized scans decoded by other software.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <ostream>
#include <string>
#include <vector>

#include "endless_streams.h"
#include "pcd_scan.h"
#include "sensors/capture_file.h"
#include "sensors/rotation_cutter.h"
#include "sensors/velodyne_decoder.h"

namespace lisco_test {
namespace {

namespace fs = std::filesystem;
using lisco_apps::CaptureFile;
using lisco_apps::Cell;
using lisco_apps::Column;
using lisco_apps::Packet;
using lisco_apps::VelodyneDecoder;

struct Case {
  const char *capture, *sensor, *scan;
  std::size_t rotation;           ///< of the capture's rotations, cut where it begins
  std::uint64_t data, positions;  ///< packets
  bool says_other_model;
  /// How far a return may lie from the scan's if the step is measured while decoding, metres. The scan was decoded with
  /// the median step of the whole capture.
  double tolerance;
};
void PrintTo(const Case& c, std::ostream* out) {
  *out << c.scan;
}

const Case kCases[] = {
    {"hdl32e_outdoor", "hdl32e", "hdl32e_outdoor_0", 2, 2702, 299, false, 1e-6},
    {"hdl32e_outdoor", "hdl32e", "hdl32e_outdoor_1", 12, 2702, 299, false, 1e-6},
    {"vlp16_close", "vlp16", "vlp16_close_0", 10, 1902, 367, true, 3e-3},
    {"vlp16_street", "vlp16", "vlp16_street_0", 0, 84, 16, true, 1e-6},
    {"vls128_street", "vls128", "vls128_street_0", 0, 2193, 0, false, 1e-6},
};

fs::path dataFolder() {
  const char* const folder = std::getenv("LISCO_TEST_DATA");
  return folder != nullptr ? folder : LISCO_TEST_DATA_DEFAULT;
}

class RealCapture : public testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    if (!fs::is_directory(dataFolder() / "captures"))
      GTEST_SKIP() << "no real captures: there is no folder " << dataFolder() / "captures"
                   << "; set LISCO_TEST_DATA to the data folder";
  }
  fs::path file() const { return dataFolder() / "captures" / (std::string(GetParam().capture) + ".pcap"); }

  /// Gives all columns, with the number of their rotation, to visit (column, rotation).
  template <typename Visit>
  void decodeAll(VelodyneDecoder& decoder, Visit&& visit) const {
    CaptureFile source(file());
    lisco_apps::RotationCutter cutter;
    std::size_t rotations = 0;
    Packet packet;
    while (source.next(packet) == CaptureFile::Arrival::kPacket)
      decoder.decode(packet, [&](const Column& column) {
        if (cutter.startsRotation(column.azimuth, column.after_break)) ++rotations;
        visit(column, rotations - 1);
      });
    EXPECT_EQ(source.error(), "");
    EXPECT_EQ(source.foreign(), 0U);
  }

  /// Compares the rotation of the scan with the scan: the same cells without returns, the same intensities.
  /// \return largest difference of a coordinate, metres
  double differenceFromScan(VelodyneDecoder& decoder) const {
    const Scan scan = readPcd(dataFolder() / "scans" / (std::string(GetParam().scan) + ".pcd"));
    double most = 0;
    std::size_t width = 0, unlike = 0, differing = 0, returns = 0;
    decodeAll(decoder, [&](const Column& column, std::size_t rotation) {
      if (rotation != GetParam().rotation) return;
      const std::size_t x = width++;
      if (x >= scan.width || column.cells.size() != scan.height) return;
      for (std::size_t row = 0; row < scan.height; ++row) {
        const Cell &ours = column.cells[row], &theirs = scan.cells[row * scan.width + x];
        if (std::isnan(ours.x) != std::isnan(theirs.x)) ++unlike;
        if (std::isnan(ours.x) || std::isnan(theirs.x)) continue;
        ++returns;
        if (ours.intensity != theirs.intensity) ++unlike;
        const double difference = std::hypot(ours.x - theirs.x, ours.y - theirs.y, ours.z - theirs.z);
        if (difference > 0) ++differing;
        most = std::max(most, difference);
      }
    });
    EXPECT_EQ(width, scan.width);
    EXPECT_EQ(decoder.model().lasers.size(), scan.height);
    EXPECT_EQ(unlike, 0U);
    EXPECT_GT(returns, 10000U);
    std::printf("%s: %zu of %zu returns differ, by up to %g m\n", GetParam().scan, differing, returns, most);
    return most;
  }
};
INSTANTIATE_TEST_SUITE_P(Captures, RealCapture, testing::ValuesIn(kCases),
                         [](const auto& test) { return std::string(test.param.scan); });

TEST_P(RealCapture, GivesTheReturnsOfTheScan) {
  VelodyneDecoder decoder(lisco_apps::makeVelodyneModel(GetParam().sensor));
  EXPECT_LE(differenceFromScan(decoder), GetParam().tolerance);
  const VelodyneDecoder::Counts& counts = decoder.counts();
  EXPECT_EQ(counts.data, GetParam().data);
  EXPECT_EQ(counts.position, GetParam().positions);
  EXPECT_EQ(counts.foreign + counts.late + counts.dual, 0U);
  EXPECT_EQ(counts.says_other_model, GetParam().says_other_model ? counts.data : 0U);
  EXPECT_EQ(decoder.counts().clock_jumps, 0U);
}

TEST_P(RealCapture, GivesExactReturnsByTheStepOfTheWholeCapture) {
  const lisco_apps::VelodyneModel model = lisco_apps::makeVelodyneModel(GetParam().sensor);
  CaptureFile source(file());
  VelodyneDecoder decoder(model);
  decoder.prepare(source);
  EXPECT_LE(differenceFromScan(decoder), 1e-9);
}

TEST_P(RealCapture, IsForeignToOtherSensors) {
  for (const std::string other : {"vlp16", "hdl32e", "vls128"}) {
    if (other == GetParam().sensor) continue;
    VelodyneDecoder decoder(lisco_apps::makeVelodyneModel(other));
    decodeAll(decoder, [](const Column&, std::size_t) {});
    if (other == "vls128" || GetParam().sensor == std::string("vls128")) {
      EXPECT_EQ(decoder.counts().foreign, GetParam().data);
    } else {
      EXPECT_GT(std::abs(decoder.usualGapUs() / decoder.packetPeriodUs() - 1), 0.5);
    }
  }
}

// Over several rotations, against the definition, which compares all pairs of returns: therefore with eight of the
// lasers only.
TEST_P(RealCapture, IsClusteredEndlesslyAsDefined) {
  const lisco_apps::VelodyneModel model = lisco_apps::makeVelodyneModel(GetParam().sensor);
  CaptureFile source(file());
  VelodyneDecoder decoder(model);
  decoder.prepare(source);
  const std::size_t one_in = model.lasers.size() / 8;
  EndlessStream stream;
  stream.parameters.clockwise = true;
  stream.parameters.stagger = 0.15;
  double position = 0;
  double last = -1;
  std::uint32_t number = 0;
  decodeAll(decoder, [&](const Column& column, std::size_t) {
    if (last >= 0) position += std::max(0.0, std::remainder(column.azimuth - last, 360.0)) / 360;
    if (last < 0) position = column.azimuth / 360;
    last = column.azimuth;
    if (position > 2.6) return;
    stream.columns.push_back({position, {}});
    for (std::size_t laser = 0; laser < column.cells.size(); laser += one_in) {
      const Cell& cell = column.cells[laser];
      stream.columns.back().cells.push_back({cell.x, cell.y, cell.z, number++});
    }
  });
  lisco::EndlessClusterer clusterer;
  for (const float tolerance : {0.3F, 1.0F}) {
    stream.parameters.tolerance = tolerance;
    const EndlessTruth truth = endlessTruth(stream);
    EXPECT_EQ(truth.outliers, 0U);
    const auto across_the_seam =
        std::count_if(truth.deliveries.begin(), truth.deliveries.end(), [](const auto& delivery) {
          return delivery.members.size() >= 10 &&
                 std::floor(delivery.first_position) < std::floor(delivery.last_position);
        });
    EXPECT_GT(across_the_seam, 0);
    expectSame(stream, truth.deliveries, deliveriesOf(clusterer, stream));
  }
}

}  // namespace
}  // namespace lisco_test
