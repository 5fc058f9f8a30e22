// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Packets of Hesai's sensors, by their manuals.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "packets.h"

namespace lisco_test {

/// Packets of a sensor that turns steadily, ten times a second.
class HesaiEncoder {
 public:
  /// \param second the number of the return, from 0
  using World = std::function<Measured(std::size_t firing, std::size_t laser, std::size_t second)>;

  /// \param mode of returns, as in the packets: 0x37 strongest, 0x39 last and strongest, 0x3D three
  explicit HesaiEncoder(const std::string& name, std::uint8_t mode = 0x37);

  Bytes next(const World& world);

  std::size_t lasers() const { return lasers_; }
  std::size_t returns() const { return mode == 0x3D ? 3 : mode >= 0x39 ? 2 : 1; }
  std::size_t firingsPerPacket() const { return blocks / returns(); }

  std::uint8_t mode;
  unsigned azimuth = 0;  ///< of the next block, hundredths of a degree
  double time_us = 5e6;  ///< of the next packet, past the hour
  std::uint32_t number = 77;
  bool has_number = true;
  double period_us = 0;  ///< of a firing
  unsigned step = 20;    ///< from firing to firing
  std::uint8_t distance_unit = 4;
  std::size_t blocks = 0;      ///< of a packet
  bool has_confidence = true;  ///< of the QT128's measurements
  bool has_safety = true;      ///< of the QT128's packets
  bool has_check_sums = true;  ///< behind the tail of the QT128's packets, with the signature

 private:
  std::string name_;
  std::size_t lasers_ = 0, unit_bytes_ = 4;
  std::size_t firing_ = 0;
};

}  // namespace lisco_test
