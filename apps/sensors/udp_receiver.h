// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstdint>

#include "sensors/packet_source.h"

namespace lisco_apps {

/// The packets that come to a UDP port of this machine (IPv4). Never ends by itself; a signal wakes next () at once.
class UdpReceiver : public PacketSource {
 public:
  /// \param port 0: any that is free
  /// \throws std::runtime_error with one line if the port cannot be bound
  explicit UdpReceiver(std::uint16_t port);
  ~UdpReceiver() override;
  UdpReceiver(const UdpReceiver&) = delete;
  UdpReceiver& operator=(const UdpReceiver&) = delete;

  Arrival next(Packet& packet) override;

  std::uint16_t port() const { return port_; }

 private:
  int socket_;
  std::uint16_t port_ = 0;
  std::array<std::uint8_t, kMaxPacketBytes> buffer_{};
};

}  // namespace lisco_apps
