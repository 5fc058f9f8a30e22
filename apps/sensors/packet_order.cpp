// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "sensors/packet_order.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/sorted_element.h"

namespace lisco_apps {
namespace {

constexpr std::int64_t kHourUs = 3600LL * 1000000;
constexpr std::int32_t kMaxNumbersAhead = 1000000;  ///< beyond it, another recording has begun

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
    if (late_in_a_row_ <= kMaxLate) return Place::kLate;
    clock_stands_ = gap == 0;
  }
  const bool is_new_clock = is_late || std::abs(gap) > kMaxGapUs;
  if (!is_new_clock && gap > 0 && gaps_ < first_gaps_.size()) {
    first_gaps_[gaps_++] = static_cast<double>(gap);
    if (gaps_ == first_gaps_.size()) usual_gap_us_ = lisco::sortedElement(first_gaps_, first_gaps_.size() / 2);
  }
  const std::int64_t periods = std::llround(static_cast<double>(gap) / period_us);
  return advance(timestamp_us, is_new_clock, gap, std::max<std::int64_t>(periods, 1) - 1);
}

PacketOrder::Place PacketOrder::placeByNumber(std::uint32_t number, std::uint32_t timestamp_us) {
  const bool is_first = !last_number_;
  const std::int32_t ahead = is_first ? 1 : static_cast<std::int32_t>(number - *last_number_);
  if (ahead <= 0 && ++late_in_a_row_ <= kMaxLate) return Place::kLate;
  const std::int64_t gap = is_first ? 0 : (between(newest_, timestamp_us) + kHourUs) % kHourUs;
  last_number_ = number;
  return advance(timestamp_us, ahead <= 0 || ahead > kMaxNumbersAhead || gap > kMaxGapUs, gap, ahead - 1);
}

/// A packet that is not late. \param missing packets before it, unless the clock is new
PacketOrder::Place PacketOrder::advance(std::uint32_t timestamp_us, bool is_new_clock, std::int64_t gap,
                                        std::int64_t missing) {
  started_ = true;
  newest_ = timestamp_us;
  late_in_a_row_ = 0;
  gap_us_ = is_new_clock ? 0. : static_cast<double>(gap);
  if (is_new_clock) {
    ++clock_jumps_;
    return Place::kNewClock;
  }
  missing_ += static_cast<std::uint64_t>(missing);
  return missing > 0 ? Place::kAfterGap : Place::kNext;
}

}  // namespace lisco_apps
