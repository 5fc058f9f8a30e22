// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// Simulated drives as packets, decoded again.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "sensors/capture_file.h"
#include "sensors/decoder.h"
#include "sensors/rotation_cutter.h"
#include "simulate/drive_packets.h"
#include "simulation/drive.h"
#include "simulation/street.h"
#include "simulation/terrain.h"
#include "temporary_folder.h"

namespace lisco_apps {
namespace {

using lisco_simulation::Drive;
using lisco_simulation::Sensor;
using lisco_simulation::SimulatedScan;

class DrivePackets : public lisco_test::InTemporaryFolder, public testing::WithParamInterface<std::string> {
 protected:
  static Drive driveOf(const Sensor& sensor) {
    const lisco_simulation::Terrain ground = lisco_simulation::makeTerrain("hill", 0.15, 1);
    lisco_simulation::Motion motion;
    motion.speed = 12;
    motion.roll = 0.05;
    motion.turn_seconds = turnSeconds(sensor);
    return {makeStreet(ground, motion, 1, 1.8, 1), sensor, {}, motion, 1.8};
  }
};
INSTANTIATE_TEST_SUITE_P(Sensor, DrivePackets, testing::ValuesIn(packetSensorNames()),
                         [](const auto& each) { return each.param; });

TEST_P(DrivePackets, DecodeToTheReturnsTheyWereMadeOf) {
  for (const std::size_t steps : {std::size_t{0}, std::size_t{720}}) {
    const Sensor sensor = packetSensor(GetParam(), steps);
    Drive drive = driveOf(sensor);
    const fs::path file = folder_ / "capture.pcap";
    constexpr std::size_t kRotations = 3;
    PacketWriter packets(file, sensor);
    std::vector<SimulatedScan> scans;
    for (std::size_t rotation = 0; rotation < kRotations; ++rotation) {
      scans.push_back(drive.columns(rotation * sensor.steps, sensor.steps));
      packets.add(scans.back());
    }
    packets.finish();

    DecoderOptions options;
    options.sensor = GetParam();
    options.turning = lisco_apps::Turning::kManual;  // as the sensor is simulated
    const auto decoder = makeDecoder(options);
    CaptureFile whole(file);
    decoder->prepare(whole);
    CaptureFile capture(file);
    RotationCutter cutter;
    std::size_t columns = 0;
    std::size_t rotations = 0;
    std::size_t returns = 0;
    double last_us = 0;
    Packet packet;
    while (capture.next(packet) == PacketSource::Arrival::kPacket) {
      const auto kind = decoder->decode(packet, [&](const Column& column) {
        if (cutter.startsRotation(column.azimuth, column.after_break)) {
          EXPECT_TRUE(columns >= kRotations * sensor.steps || columns % sensor.steps == 0) << "column " << columns;
          ++rotations;
        }
        ASSERT_EQ(column.cells.size(), sensor.lasers());
        const std::size_t step = columns % sensor.steps;
        const double expected = 180 + 360 * static_cast<double>(step) / static_cast<double>(sensor.steps);
        ASSERT_NEAR(std::remainder(column.azimuth - expected, 360), 0, 1e-6) << "column " << columns;
        // The time of a packet is a whole number of microseconds.
        ASSERT_NEAR(column.time_us, 1e6 * drive.secondsOf(columns), 1) << "column " << columns;
        last_us = column.time_us;
        for (std::size_t laser = 0; laser < sensor.lasers(); ++laser) {
          const Cell& cell = column.cells[laser];
          if (columns >= kRotations * sensor.steps) {
            ASSERT_TRUE(std::isnan(cell.x)) << "the rest of the last packet";
            continue;
          }
          const lisco_simulation::SimulatedCell& truth = scans[columns / sensor.steps].at(laser, step);
          ASSERT_EQ(std::isnan(cell.x), std::isnan(truth.x)) << "column " << columns << ", laser " << laser;
          if (std::isnan(cell.x)) continue;
          ++returns;
          ASSERT_NEAR(cell.x, truth.x, 1e-4) << "column " << columns << ", laser " << laser;
          ASSERT_NEAR(cell.y, truth.y, 1e-4) << "column " << columns << ", laser " << laser;
          ASSERT_NEAR(cell.z, truth.z, 1e-4) << "column " << columns << ", laser " << laser;
        }
        ++columns;
      });
      ASSERT_EQ(kind, Decoder::Kind::kData);
      if (HasFatalFailure()) return;
    }
    EXPECT_EQ(capture.error(), "");
    EXPECT_EQ(capture.foreign(), 0U);
    EXPECT_GE(columns, kRotations * sensor.steps);
    EXPECT_LT(columns, kRotations * sensor.steps + 24);
    EXPECT_GE(rotations, kRotations);
    EXPECT_EQ(returns, scans[0].returns() + scans[1].returns() + scans[2].returns());
    EXPECT_GT(returns, 5000U);
    EXPECT_EQ(decoder->counts().says_other_model, 0U);
    EXPECT_NEAR(decoder->columnsPerTurn(), static_cast<double>(sensor.steps), 1e-6);
    EXPECT_GT(last_us, 0);
  }
}

TEST(DrivePacketSensors, AreThoseOfPacketsWithTheirSteps) {
  EXPECT_THROW(packetSensor("hdl64e", 0), std::runtime_error);
  EXPECT_THROW(packetSensor("os1-128", 0), std::runtime_error);
  EXPECT_NO_THROW(packetSensor("vlp16", 3600));
  // Blocks of the VLP-16 hold two firings: 901 firings are no whole number of them, and 2 * 7 no whole turn.
  for (const std::size_t steps : {901, 14, 2000 - 1, 2 * 100, 4})
    EXPECT_THROW(packetSensor("vlp16", steps), std::runtime_error) << steps;
  EXPECT_NEAR(turnSeconds(packetSensor("vls128", 1800)), 1800 * 55.2e-6, 1e-12);
}

TEST(DrivePacketSensors, ReportUnwritableFiles) {
  EXPECT_THROW(PacketWriter("/nowhere/capture.pcap", packetSensor("vlp16", 0)), std::runtime_error);
}

}  // namespace
}  // namespace lisco_apps
