// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "sensors/capture_bytes.h"

#include "io/little_endian.h"

namespace lisco_apps {

Bytes captureHeader(std::uint32_t link_type, bool nanoseconds) {
  Bytes header;
  putNumber(header, nanoseconds ? 0xA1B23C4DU : 0xA1B2C3D4U);
  putNumber(header, std::uint32_t{0x00040002});  // version 2.4
  putNumber(header, std::uint64_t{0});
  putNumber(header, std::uint32_t{65535});
  putNumber(header, link_type);
  return header;
}

Bytes captureRecord(const Frame& frame, bool nanoseconds) {
  Bytes record;
  putNumber(record, static_cast<std::uint32_t>(frame.time_us / 1000000));
  putNumber(record, static_cast<std::uint32_t>(frame.time_us % 1000000 * (nanoseconds ? 1000 : 1)));
  putNumber(record, static_cast<std::uint32_t>(frame.data.size()));
  putNumber(record, static_cast<std::uint32_t>(frame.data.size() + frame.left_out));
  record.insert(record.end(), frame.data.begin(), frame.data.end());
  return record;
}

Bytes broadcastFrame(const Bytes& payload, std::uint16_t port) {
  constexpr std::size_t kEthernet = 14, kIp = 20, kUdp = 8;
  Bytes frame(6, 0xFF);
  frame.insert(frame.end(), {0x60, 0x76, 0x88, 0, 0, 1});
  addBig(frame, 0x0800);
  addBig(frame, 0x4500);
  addBig(frame, kIp + kUdp + payload.size());
  addBig(frame, 0);
  addBig(frame, 0x4000);  // not to be fragmented
  addBig(frame, 0x4011);  // 64 hops, UDP
  addBig(frame, 0);       // the checksum
  frame.insert(frame.end(), {192, 168, 1, 201, 255, 255, 255, 255});
  std::size_t sum = 0;
  for (std::size_t i = kEthernet; i < kEthernet + kIp; i += 2)
    sum += static_cast<std::size_t>(frame[i]) << 8U | frame[i + 1];
  while (sum > 0xFFFF) sum = (sum & 0xFFFFU) + (sum >> 16U);
  frame[kEthernet + 10] = static_cast<std::uint8_t>(~sum >> 8U);
  frame[kEthernet + 11] = static_cast<std::uint8_t>(~sum);
  addBig(frame, port);
  addBig(frame, port);
  addBig(frame, kUdp + payload.size());
  addBig(frame, 0);  // without a checksum
  frame.insert(frame.end(), payload.begin(), payload.end());
  return frame;
}

}  // namespace lisco_apps
