// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "io/text.h"
#include "sensors/fragment_assembler.h"
#include "sensors/packet_source.h"

struct pcap;

namespace lisco_apps {

/// The UDP packets of a capture, without pauses: pcap or pcapng, of Ethernet (also with VLAN tags), Linux "cooked",
/// loopback or raw IP, over IPv4 or IPv6, also in fragments. A truncated or damaged file ends where the damage begins,
/// with error () set.
class CaptureFile : public PacketSource {
 public:
  /// \param port only packets to this port; nullopt: to any
  /// \throws std::runtime_error with one line if the file is missing, no capture, or of another kind of network
  explicit CaptureFile(const fs::path& file, std::optional<std::uint16_t> port = std::nullopt);

  Arrival next(Packet& packet) override;
  double share() const override;

 private:
  struct Close {
    void operator()(pcap* capture) const;
  };

  fs::path file_;
  std::optional<std::uint16_t> port_;
  std::unique_ptr<pcap, Close> capture_;
  int link_type_ = 0;
  FragmentAssembler fragments_;
  std::uint64_t foreign_frames_ = 0;
};

}  // namespace lisco_apps
