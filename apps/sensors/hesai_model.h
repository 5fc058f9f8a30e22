// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "io/text.h"
#include "sensors/laser.h"

namespace lisco_apps {

/// A rotating Hesai sensor and its packets, little-endian: a header, blocks (azimuth in hundredths of a degree, and of
/// each laser the distance, the reflectivity and in some a spare byte), and a tail.
struct HesaiModel {
  /// How a packet begins.
  enum class Header {
    kNone,   ///< each block begins with a flag, as of the Pandar40P
    kShort,  ///< 8 bytes, as of the Pandar64
    kLong,   ///< 12 bytes
  };
  /// Bytes of the tail, from its first one.
  struct Tail {
    std::size_t size, mode, date, time;
  };
  /// What varies from packet to packet.
  struct Form {
    std::size_t blocks;
    std::size_t unit_bytes;       ///< of a laser in a block
    std::size_t before_tail = 0;  ///< bytes between the blocks and the tail
  };
  /// What may follow the tail.
  struct End {
    std::size_t bytes;
    bool has_number;  ///< the first four of them are the packet's number
  };
  /// A packet's form and end.
  struct Shape {
    const Form* form;
    bool has_number;
  };

  std::string name;
  std::vector<Laser> lasers;  ///< from top to bottom
  Header header = Header::kLong;
  std::vector<Form> forms;  ///< the usual one first
  Tail tail{};
  double firing_period_us = 0;  ///< from one firing of all lasers to the next
  std::vector<End> ends{{0, false}, {4, true}};

  std::size_t laserCount() const { return lasers.size(); }
  std::size_t headerBytes() const { return header == Header::kLong ? 12 : header == Header::kShort ? 8 : 0; }
  std::size_t blockBytes(const Form& form) const {
    return (header == Header::kNone ? 4 : 2) + form.unit_bytes * lasers.size();
  }
  std::size_t tailAt(const Form& form) const {
    return headerBytes() + form.blocks * blockBytes(form) + form.before_tail;
  }
  /// Of a packet up to the end of its tail.
  std::size_t leastBytes(const Form& form) const { return tailAt(form) + tail.size; }
  /// By the length of a packet; nullopt if it has none of the forms.
  std::optional<Shape> shapeOf(std::size_t bytes) const;
};

/// The names that makeHesaiModel () accepts.
std::vector<std::string> hesaiModelNames();

/// A sensor by its manual: pandar40p, pandar64, pandarqt64, pandarxt16, pandarxt32, pandarxt32m, pandarqt128.
/// \param calibration_file the angles of the sensor's own lasers, see readHesaiCalibration (); empty: the nominal ones
/// \throws std::runtime_error with one line if the name is unknown, or if readHesaiCalibration () throws
HesaiModel makeHesaiModel(const std::string& name, const fs::path& calibration_file = {});

/// A sensor whose lasers lack the angles that its calibration has, which knows its packets.
HesaiModel hesaiLayout(const std::string& name);

/// The lasers in the order of their numbers, from the CSV file that Hesai delivers with each sensor ("angle correction
/// file"): lines of the laser's number, from 1, its elevation and its azimuth offset, degrees. Other lines, such as
/// headings and check sums, are left out.
/// \throws std::runtime_error with one line if it is missing, malformed, or does not describe each of the lasers
std::vector<Laser> readHesaiCalibration(const fs::path& file, std::size_t lasers);

}  // namespace lisco_apps
