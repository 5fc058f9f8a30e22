// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "stream/window_stream.h"

#include <algorithm>

namespace lisco_apps {

void WindowStream::begin(std::size_t lasers) {
  lasers_ = lasers;
  columns_ = 0;
  clusterer_.begin({options_.tolerance, window_, hop_, lasers});
  cells_.assign(window_ * lasers, kNoCell);
  uses_.assign(window_ * lasers, CellUse::kNothing);
  azimuths_.assign(window_, 0);
  lost_.assign(window_, 0);
}

bool WindowStream::take(const PreparedColumn& column) {
  const auto start = Clock::now();
  if (isOver()) return false;
  if (columns_ == 0 || column.cells.size() != lasers_) begin(column.cells.size());
  listener_.column(column);
  const std::size_t slot = columns_ % window_;
  std::copy(column.cells.begin(), column.cells.end(), cells_.begin() + static_cast<std::ptrdiff_t>(slot * lasers_));
  std::copy(column.uses.begin(), column.uses.end(), uses_.begin() + static_cast<std::ptrdiff_t>(slot * lasers_));
  azimuths_[slot] = column.azimuth;
  lost_[slot] = takeLost();
  column.fill(static_cast<std::uint32_t>(slot * lasers_), returns_);
  ++columns_;
  const bool window_ends = clusterer_.addColumn(returns_.data(), lasers_);
  turn_.time_us = column.origin.time_us;
  if (window_ends) deliver(Clock::now() - start);
  return true;
}

void WindowStream::deliver(Clock::duration took) {
  const auto start = Clock::now();
  const std::size_t columns = clusterer_.columnCount();
  const std::size_t first = (columns_ - columns) % window_;  // slot
  const std::int64_t time_us = turn_.time_us;
  turn_.begin(++rotations_, lasers_, azimuths_[first]);
  turn_.is_window = true;
  turn_.time_us = time_us;
  turn_.returns = clusterer_.returnCount();
  for (std::size_t column = 0; column < columns; ++column) {
    const std::size_t slot = (first + column) % window_;
    const auto from = cells_.begin() + static_cast<std::ptrdiff_t>(slot * lasers_);
    turn_.cells.insert(turn_.cells.end(), from, from + static_cast<std::ptrdiff_t>(lasers_));
    const auto use = uses_.begin() + static_cast<std::ptrdiff_t>(slot * lasers_);
    turn_.uses.insert(turn_.uses.end(), use, use + static_cast<std::ptrdiff_t>(lasers_));
    turn_.ground +=
        static_cast<std::uint64_t>(std::count(use, use + static_cast<std::ptrdiff_t>(lasers_), CellUse::kGround));
    turn_.lost += lost_[slot];
  }
  turn_.labels.assign(turn_.cells.size(), 0);
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
  listener_.found(turn_, clusters_, latency);
}

}  // namespace lisco_apps
