// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "recordings/topic_reader.h"
#include "sensors/packet_source.h"

namespace lisco_apps {

/// The maker of the sensor whose packets such messages hold, as a user writes it; "" if they hold
/// none.
std::string makerOfPackets(const std::string& type);

/// The UDP payloads in a message: velodyne_msgs/VelodyneScan, pandar_msgs/PandarScan, nebula_msgs/NebulaPackets, and
/// PacketMsg of Ouster's drivers.
/// \param packets receives them, up to a fault; they point into the message
/// \throws Broken if the message is malformed
void packetsIn(const Message& message, const Topic& topic, std::vector<Packet>& packets);

/// The text of a std_msgs/String. \throws Broken if it is malformed
std::string textIn(const Message& message, const Topic& topic);

/// The packets in the messages of a topic. Of malformed messages, those before the fault; they count as foreign, and
/// are an error at the end.
class MessagePackets : public PacketSource {
 public:
  explicit MessagePackets(std::unique_ptr<TopicReader> reader) : reader_(std::move(reader)) {}

  Arrival next(Packet& packet) override;
  double share() const override { return reader_->share(); }

 private:
  std::string malformedOnes() const;

  std::unique_ptr<TopicReader> reader_;
  std::vector<Packet> waiting_;  ///< of the current message
  std::size_t next_ = 0;
  std::uint64_t malformed_ = 0;  ///< messages
  std::string first_malformed_;  ///< its number in the topic, and why
};

}  // namespace lisco_apps
