// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace lisco_apps {

/// Finds out from the sensor's clock which of its packets are missing or late. A late one is one of an earlier time
/// than one that has come already: whoever clusters while the sensor turns has gone on by then, so it is to be dropped.
class PacketOrder {
 public:
  enum class Place {
    kNext,
    kAfterGap,  ///< others are missing before it
    kNewClock,  ///< the sensor's clock was set, or another recording begins: what is missing is unknown
    kLate,      ///< or a second copy; to be dropped
  };

  /// \param timestamp_us as in the packet, microseconds past the hour; it starts anew each hour
  /// \param period_us from one packet to the next, as the packets of this sensor and mode come
  Place place(std::uint32_t timestamp_us, double period_us);

  /// Microseconds from the packet before the last one (late ones aside) to the last one; 0 if that is unknown.
  double gap() const { return gap_us_; }

  std::uint64_t missing() const { return missing_; }  ///< packets that never came, or too late
  std::uint64_t late() const { return late_; }        ///< packets that came too late, or twice
  std::uint64_t clockJumps() const { return clock_jumps_; }
  /// Microseconds from packet to packet as most of the first ones came, 0 if fewer than 16 have. Far from the
  /// period of the sensor, it is another sensor.
  double usualGap() const { return usual_gap_us_; }

 private:
  void measureUsualGap();

  bool started_ = false;
  bool clock_stands_ = false;      ///< packets do not tell their times
  std::uint32_t newest_ = 0;       ///< time of the newest packet
  std::uint32_t newest_late_ = 0;  ///< time of the last late one
  unsigned late_in_a_row_ = 0;     ///< and in the order of their times
  double gap_us_ = 0, usual_gap_us_ = 0;
  std::array<double, 16> first_gaps_{};
  std::size_t gaps_ = 0;
  std::uint64_t missing_ = 0, late_ = 0, clock_jumps_ = 0;
};

}  // namespace lisco_apps
