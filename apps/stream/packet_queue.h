// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
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
  /// More than any of these sensors sends in a second.
  static constexpr std::size_t kMaxPackets = 16384, kMaxBytes = std::size_t{48} << 20;
  /// A packet in the ring of bytes, in one piece.
  struct Slot {
    std::size_t begin = 0, size = 0;
    std::int64_t time_us = 0;
  };

  void receive();
  std::optional<std::size_t> spaceFor(std::size_t size) const;

  std::unique_ptr<PacketSource> source_;
  std::unique_ptr<std::uint8_t[]> bytes_;  ///< of the packets in slots_, in their order, around the end
  boost::circular_buffer<Slot> slots_;
  std::mutex mutex_;  ///< guards the slots and the next three
  std::condition_variable filled_;
  bool ended_ = false;
  bool holds_slot_ = false;  ///< whether the reader's current packet is in the first slot
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace lisco_apps
