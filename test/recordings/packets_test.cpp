// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <cstdlib>
#include <optional>

#include "bags.h"
#include "io/little_endian.h"
#include "recordings/bytes.h"
#include "recordings/cdr_text.h"
#include "recordings/packet_messages.h"

namespace lisco_test {
namespace {

using lisco_apps::CdrText;
using lisco_apps::Message;
using lisco_apps::Packet;
using lisco_apps::Serialization;
using lisco_apps::Topic;

Message messageOf(const std::string& data) {
  return {0, 5'000'000'000, reinterpret_cast<const std::uint8_t*>(data.data()), data.size()};
}

std::string contentOf(const Packet& packet) {
  return {reinterpret_cast<const char*>(packet.data), packet.size};
}

/// A nebula_msgs/NebulaPackets.
std::string twoNebulaPackets() {
  CdrText message;
  message.header(1'000'000'000, "lidar");
  message.number(std::uint32_t{2});
  for (const char* const data : {"odd", "four"}) {
    message.time(2'000'003'000);
    message.number(static_cast<std::uint32_t>(std::string(data).size()));
    message.bytes() += data;
  }
  return message.done();
}

TEST(PacketMessages, OfTwoNebulaPackets) {
  const Topic topic{"/p", "nebula_msgs/NebulaPackets", Serialization::kCdr, 1};
  std::vector<Packet> packets;
  const std::string message = twoNebulaPackets();  // packets point into it
  lisco_apps::packetsIn(messageOf(message), topic, packets);
  ASSERT_EQ(packets.size(), 2U);
  EXPECT_EQ(contentOf(packets[0]), "odd");
  EXPECT_EQ(contentOf(packets[1]), "four");
  EXPECT_EQ(packets[1].time_us, 2'000'003);
}

TEST(PacketMessages, OfHesaiWithTheirLengths) {
  CdrText message;
  message.header(1'000'000'000, "");
  message.number(std::uint32_t{2});
  for (const std::uint32_t size : {1080U, 1500U}) {
    message.time(0);
    message.bytes() += std::string(1500, 'p');
    message.number(size);
  }
  const Topic topic{"/p", "pandar_msgs/PandarScan", Serialization::kCdr, 1};
  std::vector<Packet> packets;
  lisco_apps::packetsIn(messageOf(message.done()), topic, packets);
  ASSERT_EQ(packets.size(), 2U);
  EXPECT_EQ(packets[0].size, 1080U);
  EXPECT_EQ(packets[1].size, 1500U);
  EXPECT_EQ(packets[0].time_us, 5'000'000) << "without a time of its own, the message's";
}

TEST(PacketMessages, OfRos1) {
  std::string message;
  for (const std::uint32_t value : {9U, 1U, 2U}) lisco_apps::putNumber(message, value);
  lisco_apps::putText(message, "velodyne");
  lisco_apps::putNumber(message, std::uint32_t{1});
  for (const std::uint32_t value : {3U, 4000U}) lisco_apps::putNumber(message, value);
  message += std::string(1206, 'v');
  const Topic topic{"/p", "velodyne_msgs/VelodyneScan", Serialization::kRos1, 1};
  std::vector<Packet> packets;
  lisco_apps::packetsIn(messageOf(message), topic, packets);
  ASSERT_EQ(packets.size(), 1U);
  EXPECT_EQ(contentOf(packets[0]), std::string(1206, 'v'));
  EXPECT_EQ(packets[0].time_us, 3'000'004);
}

TEST(PacketMessages, ThatEndTooEarlyAreRefused) {
  CdrText message;
  message.number(std::uint32_t{100});
  message.bytes() += "too few";
  const Topic topic{"/p", "ouster_sensor_msgs/PacketMsg", Serialization::kCdr, 1};
  std::vector<Packet> packets;
  EXPECT_THROW(lisco_apps::packetsIn(messageOf(message.done()), topic, packets), lisco_apps::Broken);
  EXPECT_THROW(lisco_apps::packetsIn(messageOf(""), topic, packets), lisco_apps::Broken);
}

TEST(PacketMessages, OfOlderOusterDriversHaveAByteMore) {
  const Topic topic{"/p", "ouster_ros/PacketMsg", Serialization::kRos1, 1};
  std::vector<Packet> packets;
  for (const std::size_t bytes : {12608U, 12609U}) {
    std::string message;
    lisco_apps::putNumber(message, static_cast<std::uint32_t>(bytes));
    message += std::string(bytes, 'o');
    lisco_apps::packetsIn(messageOf(message), topic, packets);
    ASSERT_EQ(packets.size(), 1U);
    EXPECT_EQ(packets[0].size, 12608U);
  }
}

class RecordedMessages : public FolderTest {};

TEST_F(RecordedMessages, GiveTheirPacketsUpToAFaultAndSaySo) {
  TestRecording recording{{{"/p", "nebula_msgs/msg/NebulaPackets"}}, {}};
  for (std::int64_t i = 0; i < 3; ++i)
    recording.messages.push_back({0, 1'600'000'000'000'000'000 + i, twoNebulaPackets()});
  recording.messages[1].data.pop_back();
  writeMcap(recording, file("a.mcap"));
  lisco_apps::MessagePackets source(
      std::make_unique<lisco_apps::TopicReader>(lisco_apps::openRecording(file("a.mcap")), 0));
  Packet packet;
  std::vector<std::string> contents;
  while (source.next(packet) == lisco_apps::PacketSource::Arrival::kPacket) contents.push_back(contentOf(packet));
  EXPECT_EQ(contents, (std::vector<std::string>{"odd", "four", "odd", "odd", "four"}));
  EXPECT_EQ(source.foreign(), 1U);
  EXPECT_EQ(source.error(), "1 message of /p malformed, the first is number 2: a message that ends too early");
}

struct Bag {
  const char* file;
  std::size_t packets, bytes;
};

class RecordedPackets : public testing::TestWithParam<Bag> {};
INSTANTIATE_TEST_SUITE_P(Data, RecordedPackets,
                         testing::Values(Bag{"pandar40p.db3", 1439, 1262}, Bag{"pandarqt64.db3", 1200, 1072},
                                         Bag{"vlp16.db3", 603, 1206}),
                         [](const auto& bag) {
                           const std::string name = bag.param.file;
                           return name.substr(0, name.find('.'));
                         });

TEST_P(RecordedPackets, AreThoseOfTheSensor) {
  const char* const folder = std::getenv("LISCO_TEST_DATA");
  const std::filesystem::path file =
      std::filesystem::path(folder != nullptr ? folder : LISCO_TEST_DATA_DEFAULT) / "bags" / GetParam().file;
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no " << file;
  auto reader = std::make_unique<lisco_apps::TopicReader>(lisco_apps::openRecording(file), 0);
  lisco_apps::MessagePackets source(std::move(reader));
  Packet packet;
  std::int64_t last_us = 0;
  while (source.next(packet) == lisco_apps::PacketSource::Arrival::kPacket) {
    EXPECT_EQ(packet.size, GetParam().bytes);
    EXPECT_GE(packet.time_us, last_us);
    last_us = packet.time_us;
  }
  EXPECT_EQ(source.packets(), GetParam().packets);
  EXPECT_EQ(source.foreign(), 0U);
  EXPECT_EQ(source.error(), "");
}

}  // namespace
}  // namespace lisco_test
