// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "sensors/velodyne_encoder.h"

#include <cmath>

#include "io/little_endian.h"

namespace lisco_apps {

VelodyneEncoder::VelodyneEncoder(const std::string& name, bool is_dual)
    : model_byte(0), model_(velodynePackets(name)), is_dual_(is_dual) {
  if (!model_.factory_bytes.empty()) model_byte = model_.factory_bytes.back();
}

std::size_t VelodyneEncoder::firingsPerPacket() const {
  return 12 / (model_.flags.size() * (is_dual_ ? 2 : 1)) * model_.firings;
}

Bytes VelodyneEncoder::next(const World& world) {
  const std::size_t blocks = model_.flags.size();
  const std::size_t returns = is_dual_ ? 2 : 1;
  const std::size_t lasers_per_firing = kLasersPerBlock / model_.firings;
  const bool tells_mode = !model_.factory_bytes.empty();
  Bytes packet;
  for (std::size_t group = 0; group < firingsPerPacket() / model_.firings; ++group) {
    for (std::size_t i = 0; i < blocks * returns; ++i) {
      // The HDL-64E repeats the firing, the others each block.
      const std::size_t block = tells_mode ? i / returns : i % blocks;
      const bool second = (tells_mode ? i % returns : i / blocks) == 1;
      putNumber(packet, model_.flags[block]);
      putNumber(packet, static_cast<std::uint16_t>(azimuth));
      for (std::size_t cell = 0; cell < kLasersPerBlock; ++cell) {
        const Measured measured =
            world(firing_ + cell / lasers_per_firing, kLasersPerBlock * block + cell % lasers_per_firing, second);
        putNumber(packet, measured.distance);
        packet.push_back(measured.intensity);
      }
    }
    azimuth = (azimuth + step) % 36000;
    firing_ += model_.firings;
  }
  packet.resize(1200, 0xFF);  // the rest of the VLS-128's dual packets
  putNumber(packet, static_cast<std::uint32_t>(std::llround(std::fmod(time_us, 3600e6))));
  time_us += packetPeriodUs();
  packet.push_back(tells_mode ? (is_dual_ ? 0x39 : 0x37) : 'H');
  packet.push_back(model_byte);
  return packet;
}

}  // namespace lisco_apps
