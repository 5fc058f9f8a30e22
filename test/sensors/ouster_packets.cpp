// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "ouster_packets.h"

#include <sstream>

namespace lisco_test {
namespace {

void add(Bytes& bytes, std::uint64_t number, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) bytes.push_back(static_cast<std::uint8_t>(number >> (8 * i)));
}

template <typename Value>
std::string jsonArrayOf(std::size_t count, Value&& value) {
  std::ostringstream list;
  for (std::size_t i = 0; i < count; ++i) list << (i == 0 ? "[" : ", ") << value(i);
  return list.str() + "]";
}

void addPixel(Bytes& packet, const std::string& profile, std::uint32_t first, std::uint32_t second, unsigned number) {
  const unsigned strength = number % 256, second_strength = (number + 1) % 256;
  if (profile == "LEGACY") {
    add(packet, first & 0xFFFFFU, 4);
    add(packet, strength, 2);
    add(packet, strength, 2);
    add(packet, 5, 2);
    add(packet, 0, 2);
  } else if (profile == "RNG19_RFL8_SIG16_NIR16" || profile == "RNG19_RFL8_SIG16_NIR16_ZONE16") {
    add(packet, (first & 0x7FFFFU) | 0x80000U, 4);  // a flag above the range
    add(packet, strength, 1);
    add(packet, 0, 1);
    add(packet, strength, 2);
    add(packet, 5, 2);
    add(packet, 0, 2);
  } else if (profile == "RNG19_RFL8_SIG16_NIR16_RGB16") {
    add(packet, (first & 0x7FFFFU) | strength << 24U, 4);
    add(packet, strength, 2);
    add(packet, 5, 2);
    add(packet, 0xABCDEF, 8);
  } else if (profile.rfind("RNG19", 0) == 0 || profile == "FIVE_WORD_PIXEL") {
    add(packet, (first & 0x7FFFFU) | strength << 24U, 4);
    add(packet, (second & 0x7FFFFU) | second_strength << 24U, 4);
    add(packet, strength, 2);
    add(packet, second_strength, 2);
    add(packet, 5, 2);
    add(packet, 0, profile == "FIVE_WORD_PIXEL" || profile.find("RGB16") != std::string::npos ? 6 : 2);
  } else {
    add(packet, first / 8 | 0x8000U, 2);
    add(packet, strength, 1);
    add(packet, 5, 1);
    if (profile == "RNG15_RFL8_NIR8_ZONE16") add(packet, 0xABCDEF, 4);
    if (profile.find("DUAL") == std::string::npos) return;
    add(packet, second / 8, 2);
    add(packet, second_strength, 1);
    add(packet, 0, 1);
  }
}

}  // namespace

std::size_t OusterSensor::returns() const {
  return profile.find("DUAL") != std::string::npos || profile == "FIVE_WORD_PIXEL" ? 2 : 1;
}

std::string OusterSensor::metadata(bool in_sections) const {
  const std::string altitudes = jsonArrayOf(pixels, [&](std::size_t i) { return altitude(i); });
  const std::string azimuths = jsonArrayOf(pixels, [&](std::size_t i) { return azimuth(i); });
  std::ostringstream format, beams;
  format << R"({"column_window": [)" << window.first << ", " << window.second << R"(], "columns_per_frame": )"
         << columns << R"(, "columns_per_packet": )" << columns_per_packet << R"(, "pixels_per_column": )" << pixels
         << R"(, "udp_profile_lidar": ")" << profile << '"'
         << (header_type.empty() ? "" : R"(, "header_type": ")" + header_type + '"') << '}';
  beams << R"("beam_altitude_angles": )" << altitudes << R"(, "beam_azimuth_angles": )" << azimuths
        << R"(, "lidar_origin_to_beam_origin_mm": )" << beam_origin_mm;
  const std::string mode = R"("lidar_mode": ")" + std::to_string(columns) + R"(x20")";
  const std::string about = R"("prod_line": "OS-1-32", "prod_sn": "122201000998")";
  const std::string transform =
      R"("lidar_to_sensor_transform": [-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 38.195, 0, 0, 0, 1])";
  if (!in_sections)
    return "{" + about + ", " + mode + ", " + beams.str() + ", " + transform + R"(, "data_format": )" + format.str() +
           "}";
  return R"({"sensor_info": {)" + about + R"(}, "config_params": {)" + mode + R"(}, "beam_intrinsics": {)" +
         beams.str() + R"(}, "lidar_intrinsics": {)" + transform + R"(}, "lidar_data_format": )" + format.str() + "}";
}

std::vector<Bytes> ousterFrame(const OusterSensor& sensor, std::size_t frame, const OusterWorld& world,
                               std::uint32_t initialization) {
  const bool is_legacy = sensor.profile == "LEGACY", is_fusa = sensor.hasSafetyHeader();
  const auto [first, last] = sensor.window;
  const auto is_seen = [first = first, last = last](std::size_t column) {
    return first <= last ? column >= first && column <= last : column >= first || column <= last;
  };
  std::vector<Bytes> packets;
  for (std::size_t begin = 0; begin < sensor.columns; begin += sensor.columns_per_packet) {
    Bytes packet;
    bool is_sent = false;
    if (!is_legacy) {
      add(packet, 1, is_fusa ? 1 : 2);
      if (is_fusa) {
        add(packet, initialization, 3);
        add(packet, frame, 4);
        add(packet, 0, 3);
      } else {
        add(packet, frame % 65536, 2);
        add(packet, initialization, 3);
      }
      add(packet, 122201000998, 5);
      packet.resize(32);
    }
    for (std::size_t column = begin; column < begin + sensor.columns_per_packet; ++column) {
      const bool is_valid = column < sensor.columns && is_seen(column);
      is_sent = is_sent || is_valid;
      add(packet, 1000ULL * (frame * 50000 + column * 50000 / sensor.columns), 8);
      add(packet, column, 2);
      add(packet, is_legacy ? frame % 65536 : is_valid ? 1 : 0, 2);
      if (is_legacy) add(packet, column * 90112 / sensor.columns, 4);
      for (std::size_t pixel = 0; pixel < sensor.pixels; ++pixel)
        addPixel(packet, sensor.profile, is_valid ? world(frame, column, pixel, 0) : 9999,
                 is_valid ? world(frame, column, pixel, 1) : 9999, static_cast<unsigned>(pixel));
      if (is_legacy) add(packet, is_valid ? 0xFFFFFFFF : 0, 4);
    }
    if (!is_legacy) packet.resize(packet.size() + 32);
    if (is_sent) packets.push_back(packet);
  }
  return packets;
}

}  // namespace lisco_test
