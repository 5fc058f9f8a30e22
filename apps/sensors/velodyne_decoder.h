// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "sensors/decoder.h"
#include "sensors/echo.h"
#include "sensors/packet_order.h"
#include "sensors/packet_source.h"
#include "sensors/velodyne_model.h"

namespace lisco_apps {

/// Decodes a Velodyne sensor's packets to columns, in a frame of x forward, y left, z up. Position packets are those of
/// its GPS; foreign ones are detected by their length, their blocks' flags, or an azimuth of more than 360 degrees.
///
/// The lasers of a column fire one after the other while the sensor turns, so each gets its own azimuth, by the turning
/// from one block to the next: the median of the latest steps, as a single azimuth is rounded. The strongest of two
/// returns is that of the greater intensity. Late packets are dropped, see PacketOrder.
///
/// With Turning::kDriver, packets named by VelodyneModel::driver are turned as Nebula, Autoware's driver, does: by the
/// difference to the packet's next block of another azimuth, those of the last azimuth by none. Second returns take the
/// azimuth of that next block.
///
/// PCL's HDLGrabber and VLPGrabber ignore the delays of the lasers (up to 0.23 m in the tests' captures), drop cells
/// without a return, report no end of a capture, and do not support the VLS-128.
class VelodyneDecoder : public Decoder {
 public:
  explicit VelodyneDecoder(VelodyneModel model, ReturnChoice returns = ReturnChoice::kBoth,
                           Turning turning = Turning::kDriver);

  /// Whether a packet is laid out as this sensor's data; known of a model without lasers, too.
  bool isData(const Packet& packet) const;

  Kind decode(const Packet& packet, const Visitor& visit) override;
  /// Sets the step to that of the whole capture, instead of the latest packets'.
  void prepare(PacketSource& capture) override;

  const VelodyneModel& model() const { return model_; }

  /// Degrees that the sensor turns from one block of all lasers to the next; 0 if it does not turn, or before the
  /// second packet.
  double step() const { return step_; }

  /// By the mean of the steps between half and twice the median.
  double columnsPerTurn() const override;
  double turnUs() const override { return columnsPerTurn() * model_.firing_period_us; }
  double packetPeriodUs() const override { return packet_period_us_; }
  double gapUs() const override { return order_.gap(); }
  double usualGapUs() const override { return order_.usualGap(); }

 private:
  static constexpr std::size_t kBlocks = 12;
  static constexpr std::size_t kStepLimit = 256;  ///< hundredths of a degree; larger steps have packets missing

  /// How blocks make firings: return r of block k of group g is block g * group + k * part + r * second of the packet.
  struct Layout {
    std::size_t groups, group, part, second;
    bool isDual() const { return second != 0; }
  };
  struct Bearing {
    double cosine = 0, sine = 0;
  };
  static Bearing bearingOf(double degrees);
  /// Lasers of one azimuth.
  struct Direction {
    std::size_t block;  ///< of a firing's blocks
    double azimuth_offset, delay_us;
    std::array<Bearing, 2> bearings = {};  ///< of each return of the current firing
  };
  struct Row {
    std::size_t direction;
    std::size_t offset;   ///< of the measurement in its block, bytes
    double cosine, sine;  ///< of the elevation
  };

  std::optional<Layout> layoutOf(const std::uint8_t* data) const;
  bool isLaidOut(const std::uint8_t* data, const Layout& layout) const;
  void measureStep(const std::uint8_t* data, const Layout& layout);
  double blockPeriodUs() const { return static_cast<double>(model_.firings) * model_.firing_period_us; }
  double azimuthLater(double azimuth, double delay_us) const { return azimuth + step_ * delay_us / blockPeriodUs(); }
  bool isTurnedByDriver(const Layout& layout) const;
  void turnByDriver(const std::uint8_t* data, const Layout& layout, std::size_t group, std::size_t firing);
  void turnByManual(const std::uint8_t* group, const Layout& layout, std::size_t firing);
  Cell cellOf(const Echo& echo, std::size_t row) const;
  void decodeFiring(const std::uint8_t* group, const Layout& layout, std::size_t firing);

  VelodyneModel model_;
  std::vector<Direction> directions_;
  std::vector<Row> rows_;  ///< as the model's lasers
  ReturnChoice returns_;
  Turning turning_;
  std::vector<Cell> cells_;  ///< two of each laser if both returns of a dual packet are given
  PacketOrder order_;
  double packet_period_us_;
  double step_ = 0;
  double mean_step_ = 0;
  bool step_is_set_ = false;  ///< by prepare ()
  std::optional<unsigned> last_azimuth_;
  std::array<std::uint32_t, kStepLimit> steps_{};  ///< histogram by hundredths of a degree
  std::uint32_t step_count_ = 0;
};

}  // namespace lisco_apps
