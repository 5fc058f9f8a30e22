// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "bodies.h"
#include "columns.h"
#include "input.h"
#include "scratch_file.h"
#include "sensors/capture_file.h"
#include "sensors/rotation_cutter.h"
#include "sensors/velodyne_decoder.h"
#include "sensors/velodyne_model.h"

namespace lisco_test {
namespace {

constexpr std::size_t kDataBytes = 1206;

/// The sensors; the HDL-64E with a plausible calibration.
const std::array<lisco_apps::VelodyneModel, 5>& models() {
  static const std::array<lisco_apps::VelodyneModel, 5> all = [] {
    lisco_apps::VelodyneModel hdl64e{"hdl64e", {}, {0xEEFF, 0xDDFF}, 1, 48., 0.002, {}};
    for (std::size_t i = 0; i < 64; ++i) {
      lisco_apps::Laser laser;
      laser.number = i;
      laser.elevation = 2.0 - 0.4 * static_cast<double>(i);
      laser.azimuth_offset = -5.3 + 1.3 * static_cast<double>(i % 8);
      laser.distance_offset = 0.9;
      laser.height = 0.2;
      laser.side = i % 2 == 0 ? 0.026 : -0.026;
      hdl64e.lasers.push_back(laser);
    }
    return std::array<lisco_apps::VelodyneModel, 5>{
        lisco_apps::makeVelodyneModel("vlp16"), lisco_apps::makeVelodyneModel("hdl32e"),
        lisco_apps::makeVelodyneModel("vlp32c"), lisco_apps::makeVelodyneModel("vls128"), hdl64e};
  }();
  return all;
}

/// The same with few lasers, which takes a fraction of the time.
const std::array<lisco_apps::VelodyneModel, 5>& smallModels() {
  static const std::array<lisco_apps::VelodyneModel, 5> all = [] {
    constexpr std::size_t kEvery = 9;
    std::array<lisco_apps::VelodyneModel, 5> small = models();
    for (lisco_apps::VelodyneModel& model : small) {
      std::vector<lisco_apps::Laser> few;
      for (std::size_t i = 0; i < model.lasers.size(); i += kEvery) few.push_back(model.lasers[i]);
      model.lasers = few;
    }
    return small;
  }();
  return all;
}

/// A packet with the layout of the sensor's and random content.
void makePacket(Input& input, const lisco_apps::VelodyneModel& model, std::vector<std::uint8_t>& packet) {
  packet.assign(kDataBytes, 0);
  const unsigned how = input.byte();
  const auto put16 = [&](std::size_t at, unsigned value) {
    packet[at] = static_cast<std::uint8_t>(value & 255U);
    packet[at + 1] = static_cast<std::uint8_t>(value >> 8);
  };
  unsigned azimuth = input.byte() << 8 | input.byte();
  const unsigned step = input.byte();
  const std::size_t blocks = model.flags.size();
  const bool dual = (how & 1U) != 0;
  const bool has_mode = !model.factory_bytes.empty();
  const unsigned filling = input.byte();
  for (std::size_t block = 0; block < 12; ++block) {
    const std::size_t number = dual && has_mode ? block / 2 : block;
    put16(100 * block, model.flags[number % blocks]);
    put16(100 * block + 2, azimuth);
    if ((block + 1) % (dual ? 2 * blocks : blocks) == 0) azimuth = (azimuth + step) % 36000;
    for (std::size_t at = 4; at < 100; ++at)
      packet[100 * block + at] = static_cast<std::uint8_t>(filling * (at + (dual ? block : 0)));
  }
  for (std::size_t at = 1200; at < 1204; ++at) packet[at] = static_cast<std::uint8_t>(input.byte());
  packet[1204] = dual ? 0x39 : 0x37;
  packet[1205] = has_mode ? model.factory_bytes.front() : 0x10;
  for (unsigned i = 0; i < how / 32; ++i)
    packet[(input.byte() << 8 | input.byte()) % kDataBytes] = static_cast<std::uint8_t>(input.byte());
}

void decodePackets(Input& input, const lisco_apps::VelodyneModel& model, lisco_apps::ReturnChoice returns) {
  lisco_apps::VelodyneDecoder decoder(model, returns);
  lisco_apps::RotationCutter cutter;
  std::vector<std::uint8_t> bytes;
  std::uint64_t packets = 0;
  std::uint64_t columns = 0;
  std::size_t cells_before = 0;
  while (input.left() > 0 && packets < 20) {
    const unsigned how = input.byte();
    if (how % 16 == 0) {  // any bytes, of any size
      const std::array<std::size_t, 4> sizes{kDataBytes, 512, input.byte(), input.left()};
      bytes.resize(sizes[how / 16 % 4]);
      for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(input.byte());
      bytes.shrink_to_fit();
    } else if (how % 16 != 1 || bytes.size() != kDataBytes) {
      makePacket(input, model, bytes);
    }  // or a repetition of the last one
    ++packets;
    const auto kind = decoder.decode({bytes.data(), bytes.size(), 0}, [&](const lisco_apps::Column& column) {
      ++columns;
      const std::size_t lasers = model.lasers.size();
      hold(column.cells.size() == lasers || column.cells.size() == 2 * lasers, "the cells of a column");
      hold(cells_before == 0 || column.cells.size() == cells_before || column.after_break, "cells without a break");
      cells_before = column.cells.size();
      holdColumn(column);
      cutter.startsRotation(column.azimuth, column.after_break);
    });
    hold((kind == lisco_apps::VelodyneDecoder::Kind::kPosition) == (bytes.size() == 512), "a packet of the GPS");
    holdCounts(decoder, packets, columns);
    hold(decoder.step() >= 0 && decoder.step() < 2.56, "an implausible step");
  }
}

void readCapture(const std::uint8_t* data, std::size_t size, bool to_a_port) {
  static const ScratchFile file(".pcap");
  try {
    lisco_apps::CaptureFile capture(file.holding(data, size),
                                    to_a_port ? std::optional<std::uint16_t>(2368) : std::nullopt);
    lisco_apps::Packet packet;
    std::uint64_t packets = 0;
    unsigned sum = 0;
    while (capture.next(packet) == lisco_apps::PacketSource::Arrival::kPacket) {
      ++packets;
      hold(packet.size <= size, "a packet larger than its capture");
      for (std::size_t i = 0; i < packet.size; ++i) sum += packet.data[i];
      hold(capture.packets() == packets, "the number of packets");
    }
    hold(sum <= 255 * size, "memory");
    hold(capture.next(packet) == lisco_apps::PacketSource::Arrival::kEnd, "a packet after the end");
    hold(capture.error().find('\n') == std::string::npos, "an error of several lines");
  } catch (const std::runtime_error& refusal) {
    hold(std::string(refusal.what()).find('\n') == std::string::npos, "a refusal of several lines");
  }
}

}  // namespace

void fuzzPackets(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return;
  const unsigned what = data[0];
  if (what % 8 >= 6) return readCapture(data + 1, size - 1, what % 8 == 7);
  Input input(data + 1, size - 1);
  constexpr std::array kChoices{lisco_apps::ReturnChoice::kStrongest, lisco_apps::ReturnChoice::kLast,
                                lisco_apps::ReturnChoice::kBoth};
  const auto& sensors = what / 64 == 3 && input.byte() == 0 ? models() : smallModels();
  decodePackets(input, sensors[what / 8 % sensors.size()], kChoices[what / 64 % 3]);
}

}  // namespace lisco_test
