// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

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
/// \param packets receives them; they point into the message
/// \throws Broken if the message is malformed
void packetsIn(const Message& message, const Topic& topic, std::vector<Packet>& packets);

/// The text of a std_msgs/String. \throws Broken if it is malformed
std::string textIn(const Message& message, const Topic& topic);

/// The packets in the messages of a topic. Malformed messages count as foreign.
class MessagePackets : public PacketSource {
 public:
  explicit MessagePackets(std::unique_ptr<TopicReader> reader) : reader_(std::move(reader)) {}

  Arrival next(Packet& packet) override;
  double share() const override { return reader_->share(); }

 private:
  std::unique_ptr<TopicReader> reader_;
  std::vector<Packet> waiting_;  ///< of the current message
  std::size_t next_ = 0;
};

}  // namespace lisco_apps
