// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "hesai_packets.h"

#include <cmath>
#include <stdexcept>

namespace lisco_test {
namespace {

void add(Bytes& bytes, std::uint64_t number, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) bytes.push_back(static_cast<std::uint8_t>(number >> (8 * i)));
}

}  // namespace

HesaiEncoder::HesaiEncoder(const std::string& name, std::uint8_t wanted_mode) : mode(wanted_mode), name_(name) {
  if (name == "pandar40p") {
    lasers_ = 40, blocks = 10, unit_bytes_ = 3, period_us = 55.56;
  } else if (name == "pandar64") {
    lasers_ = 64, blocks = 6, unit_bytes_ = 3, period_us = 55.56;
  } else if (name == "pandarqt64") {
    lasers_ = 64, blocks = 4, period_us = 166.667;
  } else if (name == "pandarxt16") {
    lasers_ = 16, blocks = 8, period_us = 50;
  } else if (name == "pandarxt32") {
    lasers_ = 32, blocks = 8, period_us = 50;
  } else if (name == "pandarxt32m") {
    lasers_ = 32, blocks = 6, period_us = 50;
  } else if (name == "pandarqt128") {
    lasers_ = 128, blocks = 2, period_us = 111.11;
  } else {
    throw std::invalid_argument(name);
  }
}

Bytes HesaiEncoder::next(const World& world) {
  const bool is_40 = name_ == "pandar40p", is_64 = name_ == "pandar64", is_qt64 = name_ == "pandarqt64",
             is_qt128 = name_ == "pandarqt128";
  Bytes packet;
  if (is_64) {
    packet = {0xEE, 0xFF, 64, static_cast<std::uint8_t>(blocks), 0, distance_unit, 0, 0};
  } else if (!is_40) {
    packet = {0xEE,
              0xFF,
              static_cast<std::uint8_t>(is_qt64 || is_qt128 ? 3 : 6),
              static_cast<std::uint8_t>(is_qt128 ? 2 : 1),
              0,
              0,
              static_cast<std::uint8_t>(lasers_),
              static_cast<std::uint8_t>(blocks),
              1,
              distance_unit,
              static_cast<std::uint8_t>(returns()),
              static_cast<std::uint8_t>(is_qt128 ? 0x0D : 1)};
  }
  for (std::size_t block = 0; block < blocks; ++block) {
    if (is_40) add(packet, 0xEEFF, 2);
    add(packet, azimuth, 2);
    for (std::size_t laser = 0; laser < lasers_; ++laser) {
      const Measured measured = world(firing_, laser, block % returns());
      add(packet, measured.distance, 2);
      packet.push_back(measured.intensity);
      if (unit_bytes_ == 4 && has_confidence) packet.push_back(0xFF);
    }
    if ((block + 1) % returns() != 0) continue;
    azimuth = (azimuth + step) % 36000;
    ++firing_;
  }
  const auto now = static_cast<std::uint64_t>(std::llround(std::fmod(time_us, 3600e6)));
  const auto add_date = [&] {
    const std::uint8_t year = is_40 || is_64 ? 24 : 124;
    for (const std::uint64_t part : {std::uint64_t{year}, std::uint64_t{5}, std::uint64_t{6}, std::uint64_t{7},
                                     now / 60000000, now / 1000000 % 60})
      add(packet, part, 1);
  };
  if (is_qt128) packet.resize(packet.size() + 4 + (has_safety ? 17 : 0), 0x11);
  if (is_40 || is_64 || is_qt64) {
    packet.resize(packet.size() + (is_qt64 ? 10 : 8), 0x22);
    add(packet, 600, 2);
    add(packet, now % 1000000, 4);
    packet.push_back(mode);
    packet.push_back(0x42);
    add_date();
  } else {
    packet.resize(packet.size() + (is_qt128 ? 12 : 10), 0x22);
    packet.push_back(mode);
    add(packet, 600, 2);
    add_date();
    add(packet, now % 1000000, 4);
    packet.push_back(0x42);
  }
  if (has_number) add(packet, number, 4);
  if (is_qt128 && has_check_sums) packet.resize(packet.size() + 4 + 32, 0x33);
  ++number;
  time_us += period_us * static_cast<double>(firingsPerPacket());
  return packet;
}

}  // namespace lisco_test
