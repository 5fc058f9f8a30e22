// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <chrono>
#include <memory>
#include <thread>
#include <utility>

#include "latency.h"
#include "sensors/packet_source.h"

namespace lisco_apps {

/// The packets of a capture at the pace at which they were recorded. Breaks of more than ten seconds are left out.
class PacedCapture : public PacketSource {
 public:
  explicit PacedCapture(std::unique_ptr<PacketSource> capture) : capture_(std::move(capture)) {}

  Arrival next(Packet& packet) override {
    if (!waits_) {
      const Arrival arrival = capture_->next(waiting_);
      foreign_ = capture_->foreign();
      error_ = capture_->error();
      if (arrival != Arrival::kPacket) return arrival;
      const std::chrono::microseconds gap(waiting_.time_us - last_time_us_);
      const auto now = Clock::now();
      const bool goes_on = packets_ > 0 && waiting_.time_us >= last_time_us_ && gap <= kLongestBreak;
      due_ = goes_on ? due_ + gap : now;
      last_time_us_ = waiting_.time_us;
      waits_ = true;
    }
    // Whoever calls wants to see from time to time whether to go on.
    const auto patience_ends = Clock::now() + kPatience;
    if (due_ > patience_ends) {
      std::this_thread::sleep_until(patience_ends);
      return Arrival::kNothing;
    }
    std::this_thread::sleep_until(due_);
    waits_ = false;
    ++packets_;
    packet = waiting_;
    return Arrival::kPacket;
  }

 private:
  static constexpr std::chrono::seconds kLongestBreak{10};
  static constexpr std::chrono::milliseconds kPatience{50};

  std::unique_ptr<PacketSource> capture_;
  Packet waiting_;  ///< until it is due
  bool waits_ = false;
  std::int64_t last_time_us_ = 0;
  Clock::time_point due_;
};

}  // namespace lisco_apps
