// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "sensors/packet_order.h"

#include <cmath>

#include "io/sorted_element.h"

namespace lisco_apps {
namespace {

constexpr std::int64_t kHourUs = 3600LL * 1000000;
constexpr std::int64_t kMaxGapUs = 10LL * 1000000;  ///< beyond it, the clock was set
constexpr unsigned kMaxLate = 16;                   ///< in a row; with more, another recording has begun

/// From one time to another, whichever way around the hour is shorter.
std::int64_t between(std::uint32_t from, std::uint32_t to) {
  const std::int64_t ahead = ((std::int64_t{to} - from) % kHourUs + kHourUs) % kHourUs;
  return ahead > kHourUs / 2 ? ahead - kHourUs : ahead;
}

}  // namespace

PacketOrder::Place PacketOrder::place(std::uint32_t timestamp_us, double period_us) {
  const std::int64_t gap = started_ ? between(newest_, timestamp_us) : 0;
  clock_stands_ = clock_stands_ && gap == 0;
  const bool is_late = started_ && !clock_stands_ && gap <= 0 && gap >= -kMaxGapUs;
  if (is_late) {
    late_in_a_row_ = late_in_a_row_ > 0 && between(newest_late_, timestamp_us) >= 0 ? late_in_a_row_ + 1 : 1;
    newest_late_ = timestamp_us;
    if (late_in_a_row_ <= kMaxLate) {
      ++late_;
      return Place::kLate;
    }
    clock_stands_ = gap == 0;
  }
  const bool is_new_clock = started_ && (is_late || std::abs(gap) > kMaxGapUs);
  started_ = true;
  newest_ = timestamp_us;
  late_in_a_row_ = 0;
  gap_us_ = is_new_clock ? 0. : static_cast<double>(gap);
  if (is_new_clock) {
    ++clock_jumps_;
    return Place::kNewClock;
  }
  if (gap > 0 && gaps_ < first_gaps_.size()) {
    first_gaps_[gaps_++] = gap_us_;
    if (gaps_ == first_gaps_.size()) usual_gap_us_ = sortedElement(first_gaps_, first_gaps_.size() / 2);
  }
  const auto periods = static_cast<std::int64_t>(std::llround(gap_us_ / period_us));
  if (periods < 2) return Place::kNext;
  missing_ += static_cast<std::uint64_t>(periods - 1);
  return Place::kAfterGap;
}

}  // namespace lisco_apps
