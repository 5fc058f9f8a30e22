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

#include <boost/circular_buffer.hpp>

#include "sensors/packet_source.h"

namespace lisco_apps {

/// Receives a source's packets in a thread of its own, which bridges pauses of the reader of about a second. Packets
/// that come to a full queue are lost.
class PacketQueue : public PacketSource {
 public:
  explicit PacketQueue(std::unique_ptr<PacketSource> source);
  ~PacketQueue() override;
  PacketQueue(const PacketQueue&) = delete;
  PacketQueue& operator=(const PacketQueue&) = delete;

  Arrival next(Packet& packet) override;

  /// Ends receiving. next () gives what has been received, then the end.
  void stop();

 private:
  static constexpr std::size_t kCapacity = 8192;  ///< packets: more than any of these sensors sends in a second
  struct Slot {
    std::array<std::uint8_t, kMaxPacketBytes> data;
    std::size_t size;
    std::int64_t time_us;
  };

  void receive();

  std::unique_ptr<PacketSource> source_;
  boost::circular_buffer<Slot> slots_;
  std::mutex mutex_;  ///< guards the slots and the next three
  std::condition_variable filled_;
  bool ended_ = false;
  bool holds_slot_ = false;  ///< whether the reader's current packet is in the first slot
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace lisco_apps
