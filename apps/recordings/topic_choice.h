// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <string>

#include "recordings/recording.h"

namespace lisco_apps {

/// What a topic's messages are to these programs.
enum class TopicKind {
  kClouds,   ///< sensor_msgs/PointCloud2
  kPackets,  ///< see makerOfPackets ()
  kOther,
};

TopicKind kindOf(const Topic& topic);

/// Chooses a topic of clouds or packets.
/// \param name of the topic; empty: the only one that fits. Packets fit if there are no clouds, and clouds do not if
///        packets are wanted
/// \param wants_packets whether a sensor was named, which is of use for packets only
/// \return index in Recording::topics ()
/// \throws std::runtime_error with the recording's topics, if there is no such one
std::size_t chooseTopic(const Recording& recording, const fs::path& file, const std::string& name, bool wants_packets);

/// The text of the first message of std_msgs/String on a topic named `metadata`, preferably beside the given topic;
/// empty if there is none. Opens the recording anew.
std::string metadataIn(const fs::path& file, const std::string& packet_topic);

}  // namespace lisco_apps
