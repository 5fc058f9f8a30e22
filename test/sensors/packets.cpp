// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "packets.h"

#include <cmath>
#include <fstream>
#include <stdexcept>

namespace lisco_test {
namespace {

template <typename Number>
void addLittle(Bytes& bytes, Number number) {
  for (std::size_t i = 0; i < sizeof(Number); ++i) bytes.push_back(static_cast<std::uint8_t>(number >> (8 * i)));
}
void addBig(Bytes& bytes, std::size_t number) {
  bytes.push_back(static_cast<std::uint8_t>(number >> 8U));
  bytes.push_back(static_cast<std::uint8_t>(number));
}

constexpr std::uint16_t kFlags[] = {0xEEFF, 0xDDFF, 0xCCFF, 0xBBFF};

}  // namespace

PacketEncoder::PacketEncoder(const std::string& name, bool is_dual)
    : model_byte(0), is_dual_(is_dual), tells_mode_(name != "hdl64e") {
  if (name == "vlp16") {
    firings_per_block_ = 2, period_us_ = 55.296, model_byte = 0x22;
  } else if (name == "hdl32e") {
    period_us_ = 46.08, model_byte = 0x21;
  } else if (name == "hdl64e") {
    blocks_per_firing_ = 2, period_us_ = 48.;
  } else if (name == "vls128") {
    blocks_per_firing_ = 4, period_us_ = 55.2, model_byte = 0xA1;
  } else {
    throw std::invalid_argument(name);
  }
}

std::size_t PacketEncoder::firingsPerPacket() const {
  return 12 / (blocks_per_firing_ * (is_dual_ ? 2 : 1)) * firings_per_block_;
}

Bytes PacketEncoder::next(const World& world) {
  const std::size_t returns = is_dual_ ? 2 : 1;
  const std::size_t lasers_per_block = 32 / firings_per_block_;
  Bytes packet;
  for (std::size_t group = 0; group < firingsPerPacket() / firings_per_block_; ++group) {
    for (std::size_t i = 0; i < blocks_per_firing_ * returns; ++i) {
      // The HDL-64E repeats the firing, the others each block.
      const std::size_t block = tells_mode_ ? i / returns : i % blocks_per_firing_;
      const bool second = (tells_mode_ ? i % returns : i / blocks_per_firing_) == 1;
      addLittle(packet, kFlags[block]);
      addLittle(packet, static_cast<std::uint16_t>(azimuth));
      for (std::size_t cell = 0; cell < 32; ++cell) {
        const Measured measured =
            world(firing_ + cell / lasers_per_block, 32 * block + cell % lasers_per_block, second);
        addLittle(packet, measured.distance);
        packet.push_back(measured.intensity);
      }
    }
    azimuth = (azimuth + step) % 36000;
    firing_ += firings_per_block_;
  }
  packet.resize(1200, 0xFF);  // the rest of the VLS-128's dual packets
  addLittle(packet, static_cast<std::uint32_t>(std::llround(std::fmod(time_us, 3600e6))));
  time_us += packetPeriodUs();
  packet.push_back(tells_mode_ ? (is_dual_ ? 0x39 : 0x37) : 'H');
  packet.push_back(model_byte);
  return packet;
}

PacketEncoder::World constantWorld(Measured measured) {
  return [measured](std::size_t, std::size_t, bool) { return measured; };
}

lisco_apps::Packet asPacket(const Bytes& payload, std::int64_t time_us) {
  return {payload.data(), payload.size(), time_us};
}

Bytes operator+(Bytes first, const Bytes& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

Bytes udpOf(const Bytes& payload, std::uint16_t port) {
  Bytes header;
  addBig(header, 443);
  addBig(header, port);
  addBig(header, 8 + payload.size());
  addBig(header, 0);
  return header + payload;
}

Bytes ipv4Of(const Bytes& content, std::uint8_t protocol, std::uint16_t fragment) {
  Bytes header{0x46, 0};  // 24 bytes: with options
  addBig(header, 24 + content.size());
  addBig(header, 0);
  addBig(header, fragment);
  header.push_back(64);
  header.push_back(protocol);
  header.resize(24);
  return header + content;
}

Bytes ipv6Of(const Bytes& content, bool with_options) {
  const Bytes options = with_options ? Bytes{17, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0} : Bytes{};
  Bytes header{0x60, 0, 0, 0};
  addBig(header, options.size() + content.size());
  header.push_back(with_options ? 0 : 17);
  header.resize(40);
  return header + options + content;
}

Bytes ethernetOf(const Bytes& content, std::uint16_t type, std::size_t tags) {
  Bytes header(12, 0xAA);
  for (std::size_t i = 0; i < tags; ++i) {
    addBig(header, i + 1 < tags ? 0x88A8 : 0x8100);
    addBig(header, 7);
  }
  addBig(header, type);
  return header + content;
}

Bytes captureOf(const std::vector<Frame>& frames, std::uint32_t link_type, bool nanoseconds) {
  Bytes capture;
  addLittle(capture, nanoseconds ? 0xA1B23C4DU : 0xA1B2C3D4U);
  addLittle(capture, std::uint32_t{0x00040002});
  addLittle(capture, std::uint64_t{0});
  addLittle(capture, std::uint32_t{65535});
  addLittle(capture, link_type);
  for (const Frame& frame : frames) {
    addLittle(capture, static_cast<std::uint32_t>(frame.time_us / 1000000));
    addLittle(capture, static_cast<std::uint32_t>(frame.time_us % 1000000 * (nanoseconds ? 1000 : 1)));
    addLittle(capture, static_cast<std::uint32_t>(frame.data.size()));
    addLittle(capture, static_cast<std::uint32_t>(frame.data.size() + frame.left_out));
    capture = std::move(capture) + frame.data;
  }
  return capture;
}

void writeFile(const std::filesystem::path& file, const Bytes& content) {
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(content.data()), static_cast<std::streamsize>(content.size()));
}

}  // namespace lisco_test
