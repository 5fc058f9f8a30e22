// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Packets and captures by the sensors' manuals.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "sensors/capture_bytes.h"
#include "sensors/packet_source.h"
#include "sensors/velodyne_encoder.h"

namespace lisco_test {

using lisco_apps::Bytes;
using lisco_apps::Frame;
using lisco_apps::Measured;
using PacketEncoder = lisco_apps::VelodyneEncoder;

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

/// A capture in the classic format.
Bytes captureOf(const std::vector<Frame>& frames, std::uint32_t link_type = 1, bool nanoseconds = false);

void writeFile(const std::filesystem::path& file, const Bytes& content);

}  // namespace lisco_test
