// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "recordings/packet_messages.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "recordings/message_fields.h"

namespace lisco_apps {
namespace {

using Packets = std::vector<Packet>;

/// A packet with the time at which the driver received it, or else the message's.
Packet packetOf(const std::uint8_t* data, std::size_t size, std::int64_t stamp_ns, const Message& message) {
  return {data, size, (stamp_ns > 0 ? stamp_ns : message.time_ns) / 1000};
}

/// Header; packets, each of a time and `size` bytes.
void readVelodyneScan(MessageFields& fields, const Message& message, Packets& packets) {
  constexpr std::size_t kBytes = 1206;
  fields.header();
  for (auto left = fields.number<std::uint32_t>(); left > 0; --left) {
    const std::int64_t stamp = fields.time();
    packets.push_back(packetOf(fields.bytes(kBytes), kBytes, stamp, message));
  }
}

/// Header; packets, each of a time, 1500 bytes, and how many of them are used.
void readPandarScan(MessageFields& fields, const Message& message, Packets& packets) {
  constexpr std::size_t kBytes = 1500;
  fields.header();
  for (auto left = fields.number<std::uint32_t>(); left > 0; --left) {
    const std::int64_t stamp = fields.time();
    const std::uint8_t* const data = fields.bytes(kBytes);
    const auto size = fields.number<std::uint32_t>();
    if (size > kBytes) throw Broken("a packet of more bytes than its message has");
    packets.push_back(packetOf(data, size, stamp, message));
  }
}

/// Header; packets, each of a time and an array of bytes.
void readNebulaPackets(MessageFields& fields, const Message& message, Packets& packets) {
  fields.header();
  for (auto left = fields.number<std::uint32_t>(); left > 0; --left) {
    const std::int64_t stamp = fields.time();
    const MessageFields::Span data = fields.array();
    packets.push_back(packetOf(data.data, data.size, stamp, message));
  }
}

/// An array of bytes. Older drivers append one to a packet; packets of all profiles have an even number.
void readOusterPacket(MessageFields& fields, const Message& message, Packets& packets) {
  const MessageFields::Span data = fields.array();
  packets.push_back(packetOf(data.data, data.size / 2 * 2, 0, message));
}

struct PacketType {
  std::string_view name;
  std::string_view maker;
  void (*read)(MessageFields& fields, const Message& message, Packets& packets);
};
constexpr std::array<PacketType, 6> kTypes{{
    {"velodyne_msgs/VelodyneScan", "a Velodyne sensor", readVelodyneScan},
    {"pandar_msgs/PandarScan", "a Hesai sensor", readPandarScan},
    {"nebula_msgs/NebulaPackets", "a sensor", readNebulaPackets},
    {"ouster_msgs/PacketMsg", "an Ouster sensor", readOusterPacket},
    {"ouster_sensor_msgs/PacketMsg", "an Ouster sensor", readOusterPacket},
    {"ouster_ros/PacketMsg", "an Ouster sensor", readOusterPacket},
}};

const PacketType* typeNamed(const std::string& name) {
  const auto* const found =
      std::find_if(kTypes.begin(), kTypes.end(), [&](const PacketType& type) { return type.name == name; });
  return found == kTypes.end() ? nullptr : found;
}

}  // namespace

std::string makerOfPackets(const std::string& type) {
  const PacketType* const found = typeNamed(type);
  return found == nullptr ? "" : std::string(found->maker);
}

void packetsIn(const Message& message, const Topic& topic, Packets& packets) {
  packets.clear();
  const PacketType* const type = typeNamed(topic.type);
  if (type == nullptr) throw Broken("a message without packets");
  MessageFields fields(message, topic.serialization);
  type->read(fields, message, packets);
}

std::string textIn(const Message& message, const Topic& topic) {
  return MessageFields(message, topic.serialization).text();
}

std::string MessagePackets::malformedOnes() const {
  if (malformed_ == 0) return "";
  return std::to_string(malformed_) + (malformed_ == 1 ? " message of " : " messages of ") + reader_->topic().name +
         " malformed, the first is number " + first_malformed_;
}

PacketSource::Arrival MessagePackets::next(Packet& packet) {
  while (next_ == waiting_.size()) {
    next_ = 0;
    waiting_.clear();
    Message message;
    if (!reader_->next(message)) {
      error_ = reader_->error().empty() ? malformedOnes() : reader_->error();
      return Arrival::kEnd;
    }
    try {
      packetsIn(message, reader_->topic(), waiting_);
    } catch (const Broken& why) {
      ++foreign_;
      if (++malformed_ == 1) first_malformed_ = std::to_string(reader_->number()) + ": " + why.what();
    }
  }
  packet = waiting_[next_++];
  ++packets_;
  return Arrival::kPacket;
}

}  // namespace lisco_apps
