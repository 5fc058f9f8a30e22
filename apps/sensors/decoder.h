// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "packet_order.h"
#include "packet_source.h"
#include "sensor_model.h"

namespace lisco_apps {

/// What one laser measured, in the sensor's frame (x forward, y left, z up), metres. x, y, z and intensity are NaN
/// without a return.
struct Cell {
  float x, y, z;
  float intensity;  ///< 0..255
};

/// One firing of all lasers.
struct Column {
  const std::vector<Cell>& cells;  ///< from the top laser to the bottom one
  double azimuth;                  ///< when its first laser fires, by the sensor: degrees clockwise, 0 <= azimuth < 360
  double time_us;                  ///< the same by its clock: microseconds past the hour, and beyond it by little
  /// Whether at least a whole turn is missing before it, or nobody knows how much.
  bool after_break;
};

/// Makes columns of a Velodyne sensor's packets.
///
///   Decoder decoder (makeSensorModel ("hdl32e"));
///   while (source.next (packet) == PacketSource::Arrival::kPacket)
///     decoder.decode (packet, [] (const Column& column) { ... });
///
/// The lasers of a column fire one after the other while the sensor turns on, so each gets an azimuth of its own, by how
/// far the sensor turns from one block to the next: the median of all such steps seen lately, since a single azimuth
/// is a rounded number. Dual returns: the stronger of both is kept, as the sensor by itself sends it if it is to send one.
/// Late packets are dropped, see PacketOrder.
///
/// Not by PCL's HDLGrabber and VLPGrabber, which read the same packets: they leave out that the lasers fire one after
/// the other (in the captures of the tests, that moves returns by up to 0.23 m), drop what did not return, so that
/// columns cannot be told, and know neither the end of a capture nor the VLS-128. What they compute of an HDL-64E's
/// calibration is computed here too.
///
/// Nothing is allocated from packet to packet. Any bytes are fine.
class Decoder {
 public:
  enum class Kind {
    kData,
    kLate,      ///< data that came too late, and was left out
    kPosition,  ///< of the sensor's GPS
    kForeign,   ///< none of this sensor: by its length, its blocks' flags, or an azimuth that is none
  };

  struct Counts {
    std::uint64_t data = 0, late = 0, position = 0, foreign = 0;
    std::uint64_t says_other_model = 0;  ///< of the data: its factory bytes name another one. They are known to lie
    std::uint64_t dual = 0;              ///< of the data: with two returns per laser
    std::uint64_t columns = 0;
  };

  explicit Decoder(SensorModel model);

  /// Calls visit for each column of the packet, in the order of their times.
  Kind decode(const Packet& packet, const std::function<void(const Column&)>& visit);

  const SensorModel& model() const { return model_; }
  const Counts& counts() const { return counts_; }
  const PacketOrder& order() const { return order_; }

  /// How far the sensor turns from one block of all lasers to the next, degrees, 0 if it stands still or that is not
  /// known yet.
  double step() const { return step_; }
  /// Sets it instead of measuring it, as whoever has the whole capture can: see stepIn().
  void setStep(double degrees);

  /// Columns of a full turn, and microseconds it takes, by the mean of the steps that lie within twice and half the median; 0 if
  /// the sensor stands still.
  double columnsPerTurn() const;
  double turnUs() const { return columnsPerTurn() * model_.firing_period_us; }
  /// How far the azimuths of a column's lasers lie apart, degrees.
  double stagger() const;
  /// Microseconds from the last packet to the next one, if that one is of the same mode.
  double packetPeriodUs() const { return packet_period_us_; }

 private:
  static constexpr std::size_t kBlocks = 12;
  static constexpr std::size_t kStepLimit = 256;  ///< hundredths of a degree; no sensor turns so fast

  /// How a packet's blocks make firings: block k of group g's return r is at g * group + k * part + r * second.
  struct Layout {
    std::size_t groups, group, part, second;
    bool isDual() const { return second != 0; }
  };
  /// Lasers that look into the same azimuth.
  struct Direction {
    std::size_t block;  ///< of a firing's blocks
    double azimuth_offset, delay_us;
    double cosine = 0, sine = 0;  ///< of the azimuth now
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
  void decodeFiring(const std::uint8_t* group, const Layout& layout, std::size_t firing);

  SensorModel model_;
  std::vector<Direction> directions_;
  std::vector<Row> rows_;  ///< as the model's lasers
  std::vector<Cell> cells_;
  Counts counts_;
  PacketOrder order_;
  double packet_period_us_;
  double step_ = 0;
  double mean_step_ = 0;
  bool step_is_set_ = false;
  std::optional<unsigned> last_azimuth_;
  std::array<std::uint32_t, kStepLimit> steps_{};  ///< how often each was seen, hundredths of a degree
  std::uint32_t step_count_ = 0;
};

/// Decoder::step() of all packets of a capture, which is read to its end.
double stepIn(PacketSource& capture, const SensorModel& model);

}  // namespace lisco_apps
