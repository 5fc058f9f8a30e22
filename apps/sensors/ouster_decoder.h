// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "sensors/decoder.h"
#include "sensors/echo.h"
#include "sensors/ouster_metadata.h"

namespace lisco_apps {

/// Decodes an Ouster sensor's packets to columns, in the maker's sensor frame: x forward, away from the connector,
/// y left, the origin at the centre of the base. The intensity is the reflectivity.
///
/// A column is one measurement; its azimuth is that of its number, as in the maker's software, and its pixels are
/// staggered. Packets that overtake others wait until those come, or until three more have come. Packets of a frame
/// before are late. Position packets are those of the IMU. Foreign are packets of another size or type, or with
/// measurement numbers that the metadata has not.
class OusterDecoder : public Decoder {
 public:
  OusterDecoder(const OusterMetadata& metadata, ReturnChoice returns);

  /// Whether any of these sensors sends packets of this size and type.
  static bool isFromAny(const Packet& packet);

  Kind decode(const Packet& packet, const Visitor& visit) override;
  void flush(const Visitor& visit) override;

  std::optional<double> rotationStart() const override { return directions_.front().azimuth; }
  double columnsPerTurn() const override { return static_cast<double>(metadata_.columns_per_frame); }
  double turnUs() const override { return 1e6 / metadata_.frames_per_second; }
  double packetPeriodUs() const override;
  double gapUs() const override { return gap_us_; }

 private:
  static constexpr std::size_t kMaxHeld = 3;  ///< packets that wait for one before them

  /// Where the parts of a packet are, bytes.
  struct Layout {
    std::size_t packet = 0, header = 0, column = 0, column_header = 0;
    std::size_t frame_id = 0, frame_id_bytes = 2;
    std::size_t serial_number = 0, initialization = 0;  ///< 0: none
    std::size_t type_bytes = 0;
  };
  struct PixelLayout {
    std::size_t bytes = 0;
    std::size_t returns = 1;
    std::uint32_t range_mask = 0;
    unsigned range_shift = 0;
    struct At {
      std::size_t range = 0, reflectivity = 0, signal = 0;  ///< signal 0: none
    } at[2];
    std::size_t reflectivity_bytes = 1;
  };
  /// A pixel's beam, relative to its column.
  struct Beam {
    std::size_t pixel = 0;
    double along = 0, across = 0, up = 0;  ///< unit vector; across is to the left
  };
  /// Where a column looks, in the lidar frame, and its azimuth in the sensor frame.
  struct Direction {
    double cosine = 0, sine = 0;
    double azimuth = 0;  ///< degrees clockwise from +x
  };
  /// A packet's place in the stream.
  struct Place {
    std::int64_t frame = 0;   ///< counted on where its number begins again
    std::int64_t packet = 0;  ///< of the frame
    std::int64_t order = 0;   ///< in the stream, of the packets that the window lets through
  };
  struct Held {
    Place place;
    std::vector<std::uint8_t> bytes;
  };

  static Layout layoutOf(const OusterMetadata& metadata);
  static PixelLayout pixelLayoutOf(OusterMetadata::Profile profile);
  bool isValid(const std::uint8_t* column) const;
  bool isOurs(const Packet& packet) const;
  bool isOfSensorsState(const Packet& packet) const;
  /// The first measurement's number; nullopt if the packet has none that is valid.
  std::optional<std::size_t> firstColumn(const std::uint8_t* packet) const;
  Place placeOf(const std::uint8_t* packet, std::size_t first_column) const;
  void startAgain(const Visitor& visit);
  void deliver(const std::uint8_t* packet, const Place& place, const Visitor& visit);
  void deliverHeld(const Visitor& visit);
  void decodePixels(const std::uint8_t* column, const Direction& direction);
  Cell cellOf(const Echo& echo, const Beam& beam, const Direction& direction) const;

  OusterMetadata metadata_;
  ReturnChoice returns_;
  Layout layout_;
  PixelLayout pixel_layout_;
  std::vector<Beam> beams_;            ///< from top to bottom
  std::vector<Direction> directions_;  ///< by number of the column
  std::vector<std::int64_t> ranks_;    ///< of a frame's packets: those before it that the window lets through
  std::int64_t packets_per_frame_ = 0;
  double beam_length_ = 0;  ///< of a range, up to where the beam starts, millimetres
  std::size_t cells_per_pixel_ = 1;
  std::vector<Cell> cells_;

  std::vector<Held> held_;  ///< in the order of their places
  std::size_t held_count_ = 0;
  bool started_ = false, is_new_clock_ = false;
  std::uint32_t initialization_ = 0;
  Place last_;  ///< that was delivered
  unsigned late_in_a_row_ = 0;
  double gap_us_ = 0;
};

}  // namespace lisco_apps
