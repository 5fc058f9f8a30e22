// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "sensors/decoder.h"
#include "sensors/echo.h"
#include "sensors/hesai_model.h"
#include "sensors/packet_order.h"

namespace lisco_apps {

/// Decodes a Hesai sensor's packets to columns, in the maker's frame: x to the right, y forward (the azimuth 0), z up.
/// The intensity is the reflectivity.
///
/// The azimuth of a return is that of its block and the offset of its laser, as in the maker's software: the offsets
/// describe a sensor that turns. The strongest of several returns is that of the greatest reflectivity. Late packets,
/// by their numbers, or by their times if they have none, are dropped. Position packets are those of the GPS. Foreign
/// ones are detected by their length, their header, or an azimuth of more than 360 degrees.
class HesaiDecoder : public Decoder {
 public:
  explicit HesaiDecoder(HesaiModel model, ReturnChoice returns = ReturnChoice::kBoth);

  Kind decode(const Packet& packet, const Visitor& visit) override;

  const HesaiModel& model() const { return model_; }

  double columnsPerTurn() const override { return step_sum_ > 0 ? 36000. * step_count_ / step_sum_ : 0; }
  double turnUs() const override { return columnsPerTurn() * model_.firing_period_us; }
  double packetPeriodUs() const override;
  double gapUs() const override { return order_.gap(); }

 private:
  struct Row {
    std::size_t number = 0;  ///< of the laser's measurement in a block
    double elevation_cosine = 0, elevation_sine = 0;
    double offset_cosine = 0, offset_sine = 0;  ///< of the azimuth's offset
  };

  bool isOurs(const Packet& packet, const HesaiModel::Form& form) const;
  std::size_t returnsOf(const std::uint8_t* packet) const;
  const std::uint8_t* block(const std::uint8_t* packet, const HesaiModel::Form& form, std::size_t i) const;
  std::uint32_t timeOf(const std::uint8_t* packet) const;
  void measureStep(const std::uint8_t* packet, bool is_next);
  void decodeFiring(const std::uint8_t* first_block, double distance_unit);

  HesaiModel model_;
  ReturnChoice returns_choice_;
  std::vector<Row> rows_;  ///< as the model's lasers
  std::vector<Cell> cells_;
  HesaiModel::Form form_;    ///< of the last packet
  std::size_t returns_ = 1;  ///< of a laser in the last packet

  PacketOrder order_;

  std::optional<unsigned> last_azimuth_;  ///< hundredths of a degree
  double step_sum_ = 0, step_count_ = 0;  ///< of the latest firings
};

}  // namespace lisco_apps
