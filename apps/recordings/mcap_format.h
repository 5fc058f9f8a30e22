// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <boost/crc.hpp>

/// What reader and writer of MCAP files (https://mcap.dev/spec) share.
namespace lisco_apps::mcap {

inline constexpr std::array<std::uint8_t, 8> kMagic{0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};

/// Of a chunk's records, CRC-32; 0 in a file stands for none.
inline std::uint32_t checkSum(const std::uint8_t* data, std::size_t size) {
  boost::crc_32_type sum;
  sum.process_bytes(data, size);
  return sum.checksum();
}

/// Kinds of records.
enum class Kind : std::uint8_t {
  kHeader = 1,
  kFooter = 2,
  kSchema = 3,
  kChannel = 4,
  kMessage = 5,
  kChunk = 6,
  kMessageIndex = 7,
  kChunkIndex = 8,
  kStatistics = 11,
  kSummaryOffset = 14,
  kDataEnd = 15,
};

}  // namespace lisco_apps::mcap
