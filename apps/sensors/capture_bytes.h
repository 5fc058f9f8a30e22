// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Captures of packets, byte by byte.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lisco_apps {

using Bytes = std::vector<std::uint8_t>;

/// Appends the two lowest bytes of a number, the higher one first.
inline void addBig(Bytes& bytes, std::size_t number) {
  bytes.push_back(static_cast<std::uint8_t>(number >> 8U));
  bytes.push_back(static_cast<std::uint8_t>(number));
}

/// A frame, the time of its capture in microseconds since 1970, and the bytes that its truncation left out.
struct Frame {
  Bytes data;
  std::int64_t time_us = 0;
  std::size_t left_out = 0;
};

/// The beginning of a capture in the classic pcap format. \param link_type 1: Ethernet
Bytes captureHeader(std::uint32_t link_type = 1, bool nanoseconds = false);
/// A frame as it follows there.
Bytes captureRecord(const Frame& frame, bool nanoseconds = false);

/// The Ethernet frame of a sensor's UDP packet: a broadcast over IPv4.
Bytes broadcastFrame(const Bytes& payload, std::uint16_t port);

}  // namespace lisco_apps
