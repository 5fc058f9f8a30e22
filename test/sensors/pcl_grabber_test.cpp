// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// The decoder against PCL's grabber on packets of an HDL-64E, of which there is no capture.
#include <pcl/io/hdl_grabber.h>
#include <pcl/point_types.h>

#include <string>

#include "calibration.h"
#include "packets.h"
#include "random.h"
#include "sensors/velodyne_decoder.h"
#include "temporary_folder.h"

namespace lisco_test {
namespace {

class Grabber : public pcl::HDLGrabber {
 public:
  explicit Grabber(const std::string& calibration_file) : HDLGrabber(calibration_file) {}

  /// In the decoder's axes.
  pcl::PointXYZ point(std::uint16_t azimuth, std::size_t laser, Measured measured) const {
    pcl::PointXYZI point;
    computeXYZI(point, azimuth, {measured.distance, measured.intensity}, laser_corrections_[laser]);
    return {point.y, -point.x, point.z};
  }
};

class PclGrabber : public InTemporaryFolder {};

TEST_F(PclGrabber, ComputesTheSameOfACalibration) {
  const std::string file = (folder_ / "db.xml").string();
  const std::string xml = calibrationXml(usualCalibration);
  writeFile(file, Bytes(xml.begin(), xml.end()));
  const Grabber grabber(file);
  lisco_apps::VelodyneDecoder decoder(lisco_apps::makeVelodyneModel("hdl64e", file));
  PacketEncoder encoder("hdl64e");
  Random random(8);
  std::vector<std::vector<Measured>> sent;
  std::size_t firing = 0;
  for (int i = 0; i < 400; ++i) {
    sent.assign(6, std::vector<Measured>(64));
    for (auto& column : sent)
      for (Measured& measured : column) measured = {static_cast<std::uint16_t>(1 + random.below(60000)), 1};
    const std::size_t first = firing;
    unsigned azimuth = encoder.azimuth;
    const Bytes payload =
        encoder.next([&](std::size_t number, std::size_t laser, bool) { return sent[number - first][laser]; });
    decoder.decode(asPacket(payload), [&](const lisco_apps::Column& column) {
      for (std::size_t row = 0; row < column.cells.size(); ++row) {
        const std::size_t laser = decoder.model().lasers[row].number;
        const pcl::PointXYZ point =
            grabber.point(static_cast<std::uint16_t>(azimuth), laser, sent[firing - first][laser]);
        EXPECT_NEAR(column.cells[row].x, point.x, 1e-5);
        EXPECT_NEAR(column.cells[row].y, point.y, 1e-5);
        EXPECT_NEAR(column.cells[row].z, point.z, 1e-5);
      }
      azimuth = (azimuth + encoder.step) % 36000;
      ++firing;
    });
  }
  EXPECT_EQ(decoder.counts().columns, 2400U);
}

}  // namespace
}  // namespace lisco_test
