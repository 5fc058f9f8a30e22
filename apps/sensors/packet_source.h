// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace lisco_apps {

/// The longest UDP payload.
inline constexpr std::size_t kMaxPacketBytes = 65527;

/// A UDP payload.
struct Packet {
  const std::uint8_t* data = nullptr;  ///< owned by the source, valid until its next packet
  std::size_t size = 0;
  std::int64_t time_us = 0;  ///< when it was captured or received, microseconds since 1970
};

/// Where a sensor's packets come from.
class PacketSource {
 public:
  enum class Arrival {
    kPacket,
    kNothing,  ///< none came within 100 ms
    kEnd,      ///< no more will come
  };

  virtual ~PacketSource() = default;

  /// Waits for the next packet, at most 100 ms.
  virtual Arrival next(Packet& packet) = 0;

  /// How much of a file has been read, 0 to 1; 0 if unknown.
  virtual double share() const { return 0; }

  /// Packets that next () has given.
  std::uint64_t packets() const { return packets_; }
  /// Frames left out: not UDP, to another port, or fragments of which others are missing.
  std::uint64_t foreign() const { return foreign_; }
  /// One line: why the packets ended early; empty if they did not.
  const std::string& error() const { return error_; }

 protected:
  std::uint64_t packets_ = 0, foreign_ = 0;
  std::string error_;
};

}  // namespace lisco_apps
