// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/text.h"
#include "sensors/packet_source.h"

namespace lisco_apps {

/// The measurement of one laser, in the sensor's frame (see Decoder), metres. All NaN without a return.
struct Cell {
  float x, y, z;
  float intensity;  ///< as the sensor counts it, >= 0
};

inline constexpr Cell kNoCell{std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::quiet_NaN(),
                              std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::quiet_NaN()};

/// One firing of all lasers.
struct Column {
  const std::vector<Cell>& cells;  ///< from the top laser to the bottom one; with two returns each, 2 * laser + return
  double azimuth;    ///< of the sensor as its first laser fires: degrees clockwise from +x, 0 <= azimuth < 360
  double time_us;    ///< then, by the sensor's clock: microseconds past the hour, may pass the next one
  bool after_break;  ///< at least a whole turn is missing before it, or an unknown part, or its number of cells differs
  /// Whether a rotation starts with it; nullopt: by its azimuth.
  std::optional<bool> starts_rotation = std::nullopt;
};

/// A sensor in another frame than its own.
struct SensorPlace {
  std::array<float, 3> origin{};  ///< metres
  std::array<float, 2> tilt{};    ///< by which its horizon rises along x and y, metres per metre
  std::array<float, 3> stated{};  ///< origin that the input states, from which ranges count

  /// Whether two places differ by no more than estimates from one cloud to the next do, whatever the input states.
  bool isAbout(const SensorPlace& other) const;
};

/// Which of the returns of a laser and firing are given, if a packet carries several: the strongest, the last, which is
/// the farthest, or all of them.
enum class ReturnChoice { kStrongest, kLast, kBoth };

/// How the turning from the azimuth of a Velodyne's block to the firing of a laser is counted: as a common driver does
/// from the azimuths of one packet, or by the manual's firing times. See doc/sensors.md.
enum class Turning { kDriver, kManual };

/// What a decoder must know of its sensor.
struct DecoderOptions {
  std::string sensor;  ///< one of decodableSensors ()
  fs::path calibration;
  fs::path metadata;
  std::string metadata_json;  ///< instead of the file, for example of a recording's message; empty: none
  ReturnChoice returns = ReturnChoice::kBoth;
  Turning turning = Turning::kDriver;  ///< of Velodyne's sensors
};

/// Decodes a sensor's packets to columns:
///   const std::unique_ptr<Decoder> decoder = makeDecoder (options);
///   while (source.next (packet) == PacketSource::Arrival::kPacket)
///     decoder->decode (packet, [] (const Column& column) { ... });
///
/// The frame is the sensor's own, z up. Each decoder names its axes. Columns of packets that come late are dropped.
/// Does not allocate memory from packet to packet. Accepts any bytes.
class Decoder {
 public:
  using Visitor = std::function<void(const Column&)>;

  enum class Kind {
    kData,
    kLate,      ///< data that came late, and was dropped
    kPosition,  ///< of the sensor's GPS or IMU
    kForeign,   ///< not this sensor's
  };

  struct Counts {
    std::uint64_t data = 0, late = 0, position = 0, foreign = 0;  ///< packets, each one of these
    std::uint64_t says_other_model = 0;  ///< data that names another model, which is unreliable
    std::uint64_t dual = 0;              ///< data with two returns per laser
    std::uint64_t missing = 0;           ///< data that never came, or late
    std::uint64_t clock_jumps = 0;       ///< the sensor's clock was set, or another recording began
    std::uint64_t columns = 0;
  };

  virtual ~Decoder() = default;

  /// Calls visit for each column of the packet, in the order of time.
  virtual Kind decode(const Packet& packet, const Visitor& visit) = 0;

  /// Gives the columns of packets that wait for others before them: to be called at the end of the packets, and when
  /// none has come for a while.
  virtual void flush(const Visitor& /*visit*/) {}

  /// Measures on a whole capture, which is read to its end, what is less exact while decoding. openPackets () calls it.
  virtual void prepare(PacketSource& /*capture*/) {}

  const std::string& name() const { return name_; }
  /// Degrees above the horizon, of each laser from top to bottom.
  const std::vector<double>& elevations() const { return elevations_; }
  std::size_t lasers() const { return elevations_.size(); }
  /// Upper bound of the azimuth between a column and its returns of 0.5 m or more, radians, at up to 20 turns a second.
  double stagger() const { return stagger_; }
  const Counts& counts() const { return counts_; }

  /// Where the sensor is in the frame of the last columns; those of packets are in its own.
  virtual SensorPlace sensorPlace() const { return {}; }
  /// The sense of rotation of the last columns, seen from above. All sensors whose packets are decoded turn clockwise.
  virtual bool turnsClockwise() const { return true; }

  /// The azimuth at which the sensor's own frames begin, degrees clockwise from +x; nullopt if it has none.
  virtual std::optional<double> rotationStart() const { return std::nullopt; }
  // Times are 0 if they are unknown, as those of clouds are.
  /// Columns and microseconds of a full turn; 0 if the sensor does not turn, too.
  virtual double columnsPerTurn() const { return 0; }
  virtual double turnUs() const { return 0; }
  /// Microseconds from packet to packet, of this sensor in the mode of the last packet.
  virtual double packetPeriodUs() const { return 0; }
  /// Microseconds between the last two packets that were not late.
  virtual double gapUs() const { return 0; }
  /// Median time between the first packets, microseconds. Far from packetPeriodUs (), the packets are another sensor's.
  virtual double usualGapUs() const { return 0; }

 protected:
  Decoder(std::string name, std::vector<double> elevations, double stagger)
      : name_(std::move(name)), elevations_(std::move(elevations)), stagger_(stagger) {}
  Decoder(const Decoder&) = default;
  Decoder& operator=(const Decoder&) = default;

  Counts counts_;

 private:
  std::string name_;
  std::vector<double> elevations_;
  double stagger_;
};

/// The sensors that makeDecoder () accepts.
std::vector<std::string> decodableSensors();

/// The sensors that send packets of this layout; those that need files are among them.
std::vector<std::string> sensorsThatSend(const Packet& packet);

/// The UDP port that the sensor's maker has set.
std::uint16_t defaultPort(const std::string& sensor);

/// \throws std::runtime_error with one line if the sensor is unknown, or if a file it needs is missing, malformed, or
///         given to a sensor that has none
std::unique_ptr<Decoder> makeDecoder(const DecoderOptions& options);

}  // namespace lisco_apps
