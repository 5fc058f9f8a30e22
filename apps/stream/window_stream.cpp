// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "window_stream.h"

namespace lisco_apps {

bool WindowStream::take(const PreparedColumn& column) {
  const auto start = Clock::now();
  if (isOver()) return false;
  if (columns_ == 0 || column.cells.size() != lasers_) {
    lasers_ = column.cells.size();
    columns_ = 0;
    clusterer_.begin({options_.tolerance, window_, hop_, lasers_});
  }
  listener_.column(column);
  const std::size_t slot = columns_++ % window_;
  latest_[slot] = column;
  lost_[slot] = takeLost();
  column.fill(static_cast<std::uint32_t>(slot * lasers_), returns_);
  if (clusterer_.addColumn(returns_.data(), lasers_)) deliver(Clock::now() - start);
  return true;
}

void WindowStream::deliver(Clock::duration took) {
  const auto start = Clock::now();
  const std::size_t columns = clusterer_.columnCount();
  const std::size_t first = (columns_ - columns) % window_;  // slot
  turn_.begin(++rotations_, lasers_, latest_[first].azimuth);
  for (std::size_t column = 0; column < columns; ++column) {
    const std::size_t slot = (first + column) % window_;
    turn_.add(latest_[slot]);
    turn_.lost += lost_[slot];
  }
  collector_.collect(
      clusterer_, options_,
      [&](std::uint32_t index) {
        const std::size_t slot = index / lasers_;
        return (slot + window_ - first) % window_ * lasers_ + index % lasers_;
      },
      turn_, clusters_);
  const auto latency = took + (Clock::now() - start);
  cluster_latency_.add(latency);
  collector_.measure(turn_, clusters_);
  listener_.window(turn_, clusters_, latency);
}

}  // namespace lisco_apps
