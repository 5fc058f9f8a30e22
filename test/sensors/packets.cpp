// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "packets.h"

#include <fstream>
#include <utility>

namespace lisco_test {

using lisco_apps::addBig;

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
  Bytes capture = lisco_apps::captureHeader(link_type, nanoseconds);
  for (const Frame& frame : frames) capture = std::move(capture) + lisco_apps::captureRecord(frame, nanoseconds);
  return capture;
}

void writeFile(const std::filesystem::path& file, const Bytes& content) {
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(content.data()), static_cast<std::streamsize>(content.size()));
}

}  // namespace lisco_test
