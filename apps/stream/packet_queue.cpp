// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "stream/packet_queue.h"

#include <signal.h>

#include <chrono>
#include <cstring>
#include <utility>

namespace lisco_apps {

PacketQueue::PacketQueue(std::unique_ptr<PacketSource> source)
    : source_(std::move(source)), bytes_(new std::uint8_t[kMaxBytes]), slots_(kMaxPackets) {
  // The thread leaves signals to the others.
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  thread_ = std::thread([this] { receive(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

PacketQueue::~PacketQueue() {
  stop();
}

void PacketQueue::stop() {
  stop_ = true;
  if (!thread_.joinable()) return;
  thread_.join();
  ended_ = true;
}

/// Where a packet of this size fits in behind the last one; nullopt if the queue is full.
std::optional<std::size_t> PacketQueue::spaceFor(std::size_t size) const {
  if (slots_.empty()) return 0;
  if (slots_.full()) return std::nullopt;
  const std::size_t first = slots_.front().begin, end = slots_.back().begin + slots_.back().size;
  if (slots_.back().begin < first) return end + size <= first ? std::optional(end) : std::nullopt;
  if (end + size <= kMaxBytes) return end;
  return size < first ? std::optional<std::size_t>(0) : std::nullopt;
}

void PacketQueue::receive() {
  Packet packet;
  while (!stop_) {
    const Arrival arrival = source_->next(packet);
    if (arrival == Arrival::kNothing) continue;
    const std::lock_guard<std::mutex> lock(mutex_);
    ended_ = arrival == Arrival::kEnd;
    filled_.notify_one();
    if (ended_) return;
    const std::optional<std::size_t> begin = spaceFor(packet.size);
    if (!begin) continue;
    if (packet.size > 0) std::memcpy(bytes_.get() + *begin, packet.data, packet.size);
    slots_.push_back({*begin, packet.size, packet.time_us});
  }
}

PacketSource::Arrival PacketQueue::next(Packet& packet) {
  constexpr std::chrono::milliseconds kMaxWait{50};
  std::unique_lock<std::mutex> lock(mutex_);
  if (std::exchange(holds_slot_, false)) slots_.pop_front();
  if (!filled_.wait_for(lock, kMaxWait, [this] { return !slots_.empty() || ended_; })) return Arrival::kNothing;
  if (slots_.empty()) return Arrival::kEnd;
  const Slot& slot = slots_.front();
  holds_slot_ = true;
  ++packets_;
  packet = {bytes_.get() + slot.begin, slot.size, slot.time_us};
  return Arrival::kPacket;
}

}  // namespace lisco_apps
