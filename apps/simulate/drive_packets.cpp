// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "simulate/drive_packets.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <system_error>

#include <boost/algorithm/string/join.hpp>

#include "sensors/capture_bytes.h"

namespace lisco_apps {
namespace {

using lisco_simulation::Sensor;
using lisco_simulation::SimulatedCell;
using lisco_simulation::SimulatedScan;

constexpr std::uint16_t kPort = 2368;
constexpr std::size_t kTurn = 36000;                       // hundredths of a degree
constexpr std::size_t kMaxBlock = 200;                     // likewise: larger steps are missing packets to a decoder
constexpr std::uint8_t kIntensity = 100;                   // of all returns
constexpr std::int64_t kStartUs = 1767225600LL * 1000000;  // 2026-01-01 00:00 UTC

}  // namespace

std::vector<std::string> packetSensorNames() {
  std::vector<std::string> names;
  for (const std::string& name : velodyneModelNames())
    if (name != "hdl64e") names.push_back(name);  // which has a calibration of its own
  return names;
}

Sensor packetSensor(const std::string& name, std::size_t steps) {
  const std::vector<std::string> known = packetSensorNames();
  if (std::find(known.begin(), known.end(), name) == known.end())
    throw std::runtime_error("--pcap is for --sensor " + boost::join(known, ", ") + " only");
  const VelodyneModel model = makeVelodyneModel(name);
  Sensor sensor;
  sensor.name = name;
  sensor.steps = steps != 0 ? steps : 1800;
  sensor.range_unit = model.distance_unit;
  const std::size_t blocks = sensor.steps / model.firings;
  if (sensor.steps % model.firings != 0 || blocks == 0 || kTurn % blocks != 0 || kTurn / blocks > kMaxBlock)
    throw std::runtime_error(formatted("--pcap needs --steps of %zu times a divisor of %zu, at least %zu in all",
                                       model.firings, kTurn, model.firings * kTurn / kMaxBlock));
  const double step_degrees = 360 / static_cast<double>(sensor.steps);
  for (const Laser& laser : model.lasers) {
    const double turned = laser.azimuth_offset + step_degrees * laser.delay_us / model.firing_period_us;
    sensor.elevation.push_back(laser.elevation * kRadiansPerDegree);
    sensor.stagger.push_back(turned * kRadiansPerDegree);
  }
  return sensor;
}

double turnSeconds(const Sensor& sensor) {
  return 1e-6 * velodynePackets(sensor.name).firing_period_us * static_cast<double>(sensor.steps);
}

PacketWriter::PacketWriter(const fs::path& file, const Sensor& sensor)
    : file_(file), stream_(file, std::ios::binary), encoder_(sensor.name), distance_unit_(sensor.range_unit) {
  const VelodyneModel model = makeVelodyneModel(sensor.name);
  encoder_.azimuth = kTurn / 2;
  encoder_.step = static_cast<unsigned>(kTurn * model.firings / sensor.steps);
  encoder_.time_us = 0;
  row_of_.resize(model.lasers.size());
  for (std::size_t row = 0; row < model.lasers.size(); ++row) row_of_[model.lasers[row].number] = row;
  if (!stream_) fail(file_, "cannot be written");
  const Bytes header = captureHeader();
  stream_.write(reinterpret_cast<const char*>(header.data()), static_cast<std::streamsize>(header.size()));
}

void PacketWriter::writePacket() {
  const std::size_t count = encoder_.firingsPerPacket();
  const std::size_t packet = firings_ / count + 1;
  const std::int64_t sent_us = kStartUs + std::llround(encoder_.packetPeriodUs() * static_cast<double>(packet));
  const auto world = [this](std::size_t firing, std::size_t laser, bool) { return waiting_[firing - firings_][laser]; };
  const Bytes record = captureRecord({broadcastFrame(encoder_.next(world), kPort), sent_us, 0});
  stream_.write(reinterpret_cast<const char*>(record.data()), static_cast<std::streamsize>(record.size()));
  firings_ += count;
  waiting_.clear();
}

void PacketWriter::add(const SimulatedScan& scan) {
  for (std::size_t step = 0; step < scan.steps; ++step) {
    std::vector<Measured> firing(row_of_.size());
    for (std::size_t laser = 0; laser < firing.size(); ++laser) {
      const SimulatedCell& cell = scan.at(row_of_[laser], step);
      if (std::isnan(cell.x)) continue;
      const double distance = length(placeOf(cell)) / distance_unit_;
      if (distance > std::numeric_limits<std::uint16_t>::max()) continue;  // by its noise
      firing[laser] = {static_cast<std::uint16_t>(std::lround(distance)), kIntensity};
    }
    waiting_.push_back(std::move(firing));
    if (waiting_.size() == encoder_.firingsPerPacket()) writePacket();
  }
}

void PacketWriter::finish() {
  if (!waiting_.empty()) {
    waiting_.resize(encoder_.firingsPerPacket(), std::vector<Measured>(row_of_.size()));
    writePacket();
  }
  errno = 0;
  stream_.close();
  if (!stream_) fail(file_, "cannot be written: " + std::generic_category().message(errno));
}

}  // namespace lisco_apps
