// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Packets and captures by the sensors' manuals.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "sensors/packet_source.h"

namespace lisco_test {

using Bytes = std::vector<std::uint8_t>;

/// The measurement of one laser.
struct Measured {
  std::uint16_t distance = 0;  ///< in the sensor's units, 0: no return
  std::uint8_t intensity = 0;
};

/// Packets of a Velodyne sensor that turns steadily.
class PacketEncoder {
 public:
  /// \param firing counts from 0
  /// \param second whether the second return of dual mode is asked for
  using World = std::function<Measured(std::size_t firing, std::size_t laser, bool second)>;

  /// \param name one of makeVelodyneModel()'s
  explicit PacketEncoder(const std::string& name, bool is_dual = false);

  Bytes next(const World& world);

  std::size_t lasers() const { return 32 * blocks_per_firing_ / firings_per_block_; }
  std::size_t firingsPerPacket() const;
  double packetPeriodUs() const { return period_us_ * static_cast<double>(firingsPerPacket()); }

  unsigned azimuth = 0;     ///< of the next block, hundredths of a degree
  unsigned step = 20;       ///< from one block of all lasers to the next
  double time_us = 5e6;     ///< of the next packet, past the hour
  std::uint8_t model_byte;  ///< the last of a packet

 private:
  bool is_dual_, tells_mode_;
  std::size_t blocks_per_firing_ = 1, firings_per_block_ = 1;
  double period_us_ = 0;
  std::size_t firing_ = 0;
};

/// Measurements that are equal for all lasers.
PacketEncoder::World constantWorld(Measured measured);

lisco_apps::Packet asPacket(const Bytes& payload, std::int64_t time_us = 0);

// A capture's frames, layer by layer.
Bytes udpOf(const Bytes& payload, std::uint16_t port = 2368);
/// \param fragment the flags and the offset of a fragment
Bytes ipv4Of(const Bytes& content, std::uint8_t protocol = 17, std::uint16_t fragment = 0x4000);
Bytes ipv6Of(const Bytes& content, bool with_options = false);
/// \param tags numbers of nested VLAN tags
Bytes ethernetOf(const Bytes& content, std::uint16_t type = 0x0800, std::size_t tags = 0);
Bytes operator+(Bytes first, const Bytes& second);

/// A frame, the time of its capture, and its truncation.
struct Frame {
  Bytes data;
  std::int64_t time_us = 0;
  std::size_t left_out = 0;
};
/// A capture in the classic format.
Bytes captureOf(const std::vector<Frame>& frames, std::uint32_t link_type = 1, bool nanoseconds = false);

void writeFile(const std::filesystem::path& file, const Bytes& content);

}  // namespace lisco_test
