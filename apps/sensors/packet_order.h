// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace lisco_apps {

/// Detects missing and late packets by the sensor's clock or by their numbers. A packet is late if a later one has come
/// before it; it is to be dropped, as the columns after it have been clustered.
class PacketOrder {
 public:
  enum class Place {
    kNext,
    kAfterGap,  ///< others are missing before it
    kNewClock,  ///< the sensor's clock was set, or another recording begins: the gap is unknown
    kLate,      ///< or a second copy; to be dropped
  };

  static constexpr unsigned kMaxLate = 16;             ///< in a row; with more, another recording has begun
  static constexpr std::int32_t kMaxGapUs = 10000000;  ///< beyond it, the clock was set, or another recording has begun

  /// By the clock.
  /// \param timestamp_us as in the packet, microseconds past the hour
  /// \param period_us from one packet to the next, for this sensor and mode
  Place place(std::uint32_t timestamp_us, double period_us);
  /// By the packet's number, which is that of the packet before and 1, modulo 2^32.
  Place placeByNumber(std::uint32_t number, std::uint32_t timestamp_us);

  /// Microseconds between the last two packets that were not late; 0 if unknown.
  double gap() const { return gap_us_; }

  std::uint64_t missing() const { return missing_; }  ///< packets that never came, or late
  std::uint64_t clockJumps() const { return clock_jumps_; }
  /// Median time between the first packets, microseconds; 0 before the 17th. Far from the sensor's period, the packets
  /// are another sensor's.
  double usualGap() const { return usual_gap_us_; }

 private:
  Place advance(std::uint32_t timestamp_us, bool is_new_clock, std::int64_t gap, std::int64_t missing);

  bool started_ = false;
  bool clock_stands_ = false;      ///< all packets have the same time
  std::uint32_t newest_ = 0;       ///< time of the newest packet
  std::uint32_t newest_late_ = 0;  ///< time of the last late one
  unsigned late_in_a_row_ = 0;     ///< without numbers: in the order of their times
  std::optional<std::uint32_t> last_number_;
  double gap_us_ = 0, usual_gap_us_ = 0;
  std::array<double, 16> first_gaps_{};  ///< unordered once all are known
  std::size_t gaps_ = 0;
  std::uint64_t missing_ = 0, clock_jumps_ = 0;
};

}  // namespace lisco_apps
