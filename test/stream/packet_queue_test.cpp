// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "stream/packet_queue.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <vector>

namespace lisco_test {
namespace {

using lisco_apps::Packet;
using lisco_apps::PacketQueue;
using lisco_apps::PacketSource;

/// `count` numbered packets, then nothing or the end.
class Numbers : public PacketSource {
 public:
  Numbers(std::size_t count, bool ends) : count_(count), ends_(ends) {}
  Arrival next(Packet& packet) override {
    if (packets_ == count_) return ends_ ? Arrival::kEnd : Arrival::kNothing;
    number_ = static_cast<std::uint8_t>(packets_++);
    packet = {&number_, 1, static_cast<std::int64_t>(packets_)};
    return Arrival::kPacket;
  }

 private:
  std::size_t count_;
  bool ends_;
  std::uint8_t number_ = 0;
};

TEST(PacketQueue, GivesAllPacketsInOrderThenTheEnd) {
  PacketQueue queue(std::make_unique<Numbers>(5000, true));
  Packet packet;
  for (std::size_t i = 0; i < 5000; ++i) {
    ASSERT_EQ(queue.next(packet), PacketSource::Arrival::kPacket);
    EXPECT_EQ(packet.size, 1U);
    EXPECT_EQ(*packet.data, static_cast<std::uint8_t>(i));
    EXPECT_EQ(packet.time_us, static_cast<std::int64_t>(i + 1));
  }
  EXPECT_EQ(queue.next(packet), PacketSource::Arrival::kEnd);
  EXPECT_EQ(queue.next(packet), PacketSource::Arrival::kEnd);
  EXPECT_EQ(queue.packets(), 5000U);
}

TEST(PacketQueue, ReportsThatNoPacketComes) {
  PacketQueue queue(std::make_unique<Numbers>(1, false));
  Packet packet;
  EXPECT_EQ(queue.next(packet), PacketSource::Arrival::kPacket);
  EXPECT_EQ(queue.next(packet), PacketSource::Arrival::kNothing);
}

TEST(PacketQueue, GivesReceivedPacketsAfterStop) {
  PacketQueue queue(std::make_unique<Numbers>(100, false));
  Packet packet;
  ASSERT_EQ(queue.next(packet), PacketSource::Arrival::kPacket);
  while (queue.next(packet) == PacketSource::Arrival::kPacket) {
  }
  queue.stop();
  queue.stop();
  EXPECT_EQ(queue.next(packet), PacketSource::Arrival::kEnd);
  EXPECT_EQ(queue.packets(), 100U);
}

TEST(PacketQueue, LosesOnlyPacketsBeyondItsCapacity) {
  PacketQueue queue(std::make_unique<Numbers>(100000, true));
  Packet packet;
  std::int64_t last = 0;
  while (queue.next(packet) == PacketSource::Arrival::kPacket) {
    EXPECT_GT(packet.time_us, last);
    EXPECT_EQ(*packet.data, static_cast<std::uint8_t>(packet.time_us - 1));
    last = packet.time_us;
  }
  EXPECT_GE(queue.packets(), 1000U);
}

/// Packets of many sizes, each filled with a byte, faster than they can be taken.
class Sizes : public PacketSource {
 public:
  Arrival next(Packet& packet) override {
    if (packets_ == kCount) return Arrival::kEnd;
    const std::size_t size = packets_ * 7919 % 65508;
    content_.assign(size, static_cast<std::uint8_t>(packets_));
    packet = {content_.data(), size, static_cast<std::int64_t>(packets_++)};
    return Arrival::kPacket;
  }
  static constexpr std::uint64_t kCount = 8000;

 private:
  std::vector<std::uint8_t> content_;
};

TEST(PacketQueue, KeepsPacketsOfAnySize) {
  PacketQueue queue(std::make_unique<Sizes>());
  Packet packet;
  std::int64_t last = -1;
  while (queue.next(packet) == PacketSource::Arrival::kPacket) {
    EXPECT_GT(packet.time_us, last);
    last = packet.time_us;
    ASSERT_EQ(packet.size, static_cast<std::size_t>(packet.time_us) * 7919 % 65508);
    for (std::size_t i = 0; i < packet.size; ++i)
      ASSERT_EQ(packet.data[i], static_cast<std::uint8_t>(packet.time_us)) << packet.time_us;
  }
  EXPECT_GE(queue.packets(), 1000U);
}

}  // namespace
}  // namespace lisco_test
