// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "sensors/packet_source.h"

namespace lisco_apps {

/// Receives a source's packets in a thread of its own, so that none is lost while the ones before it are worked on, as
/// long as that takes less than a second or so. What comes to a full queue is lost.
class PacketQueue : public PacketSource {
 public:
  explicit PacketQueue(std::unique_ptr<PacketSource> source);
  ~PacketQueue() override;
  PacketQueue(const PacketQueue&) = delete;
  PacketQueue& operator=(const PacketQueue&) = delete;

  Arrival next(Packet& packet) override;

  /// Receives no more. next() gives what has been received, then the end.
  void stop();

 private:
  static constexpr std::size_t kRoom = 8192;  ///< packets: more than any of these sensors sends in a second
  struct Slot {
    std::array<std::uint8_t, 2048> data;
    std::size_t size;
    std::int64_t time_us;
  };

  void receive();

  std::unique_ptr<PacketSource> source_;
  std::vector<Slot> slots_;
  std::mutex mutex_;  ///< guards the three after it
  std::condition_variable filled_;
  std::size_t first_ = 0, count_ = 0;
  bool ended_ = false;
  bool holds_slot_ = false;  ///< the first slot is the reader's, until its next packet
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace lisco_apps
