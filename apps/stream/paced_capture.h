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

/// The packets of a capture at the pace of their recording. Breaks of more than ten seconds are skipped.
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
      const bool goes_on = packets_ > 0 && waiting_.time_us >= last_time_us_ && gap <= kMaxBreak;
      due_ = goes_on ? due_ + gap : now;
      last_time_us_ = waiting_.time_us;
      waits_ = true;
    }
    const auto return_by = Clock::now() + kMaxWait;
    if (due_ > return_by) {
      std::this_thread::sleep_until(return_by);
      return Arrival::kNothing;
    }
    std::this_thread::sleep_until(due_);
    waits_ = false;
    ++packets_;
    packet = waiting_;
    return Arrival::kPacket;
  }

 private:
  static constexpr std::chrono::seconds kMaxBreak{10};
  static constexpr std::chrono::milliseconds kMaxWait{50};

  std::unique_ptr<PacketSource> capture_;
  Packet waiting_;  ///< until it is due
  bool waits_ = false;
  std::int64_t last_time_us_ = 0;
  Clock::time_point due_;
};

}  // namespace lisco_apps
