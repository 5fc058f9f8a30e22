// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

#include "sensors/capture_bytes.h"
#include "sensors/velodyne_model.h"

namespace lisco_apps {

/// The measurement of one laser.
struct Measured {
  std::uint16_t distance = 0;  ///< in the sensor's units, 0: no return
  std::uint8_t intensity = 0;
};

/// Makes the packets of a Velodyne sensor that turns steadily, which VelodyneDecoder decodes.
class VelodyneEncoder {
 public:
  /// \param firing counts from 0
  /// \param laser number of the laser, see Laser
  /// \param second whether the second return of dual mode is asked for
  using World = std::function<Measured(std::size_t firing, std::size_t laser, bool second)>;

  /// \param name one of velodyneModelNames ()
  /// \throws std::runtime_error if the name is unknown
  explicit VelodyneEncoder(const std::string& name, bool is_dual = false);

  Bytes next(const World& world);

  std::size_t lasers() const { return kLasersPerBlock * model_.flags.size() / model_.firings; }
  std::size_t firingsPerPacket() const;
  double packetPeriodUs() const { return model_.firing_period_us * static_cast<double>(firingsPerPacket()); }

  unsigned azimuth = 0;     ///< of the next block, hundredths of a degree
  unsigned step = 20;       ///< from one block of all lasers to the next
  double time_us = 5e6;     ///< of the next packet, past the hour
  std::uint8_t model_byte;  ///< the last of a packet

 private:
  static constexpr std::size_t kLasersPerBlock = 32;

  VelodyneModel model_;  ///< without lasers
  bool is_dual_;
  std::size_t firing_ = 0;
};

}  // namespace lisco_apps
