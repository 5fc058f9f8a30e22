// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace lisco_apps {

/// A UDP payload as it came.
struct Packet {
  const std::uint8_t* data = nullptr;  ///< the source's own, until its next packet
  std::size_t size = 0;
  std::int64_t time_us = 0;  ///< when it was captured or received, microseconds since 1970
};

/// Where a sensor's packets come from.
class PacketSource {
 public:
  enum class Arrival {
    kPacket,
    kNothing,  ///< none came within 100 ms: time to see whether to go on
    kEnd,      ///< none will ever come
  };

  virtual ~PacketSource() = default;

  /// Waits for the next packet, but not for long.
  virtual Arrival next(Packet& packet) = 0;

  /// How many packets next() has given.
  std::uint64_t packets() const { return packets_; }
  /// How much else has passed: what is no UDP, or to another port, or only a part of a packet.
  std::uint64_t foreign() const { return foreign_; }
  /// One line on what ended the packets before their time, empty if nothing did.
  const std::string& error() const { return error_; }

 protected:
  PacketSource() = default;
  PacketSource(const PacketSource&) = default;
  PacketSource& operator=(const PacketSource&) = default;
  PacketSource(PacketSource&&) = default;
  PacketSource& operator=(PacketSource&&) = default;

  std::uint64_t packets_ = 0, foreign_ = 0;
  std::string error_;
};

}  // namespace lisco_apps
