// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "recordings/topic_choice.h"

#include <algorithm>

#include <boost/algorithm/string/predicate.hpp>

#include "recordings/bytes.h"
#include "recordings/packet_messages.h"

namespace lisco_apps {
namespace {

std::string topicLinesOf(const std::vector<Topic>& topics) {
  std::size_t name_width = 0;
  std::size_t type_width = 0;
  for (const Topic& topic : topics) {
    name_width = std::max(name_width, topic.name.size());
    type_width = std::max(type_width, topic.type.size());
  }
  std::string list;
  for (const Topic& topic : topics)
    list += formatted("\n  %-*s  %-*s  %llu message%s", static_cast<int>(name_width), topic.name.c_str(),
                      static_cast<int>(type_width), topic.type.c_str(), static_cast<unsigned long long>(topic.messages),
                      topic.messages == 1 ? "" : "s") +
            (kindOf(topic) == TopicKind::kClouds    ? ", clouds"
             : kindOf(topic) == TopicKind::kPackets ? ", packets of " + makerOfPackets(topic.type)
                                                    : "");
  return list.empty() ? "\n  (none)" : list;
}

/// "/a/b" of "/a/b/c"
std::string namespaceOf(const std::string& name) {
  const std::size_t slash = name.rfind('/');
  return slash == std::string::npos ? "" : name.substr(0, slash);
}

}  // namespace

TopicKind kindOf(const Topic& topic) {
  if (topic.serialization == Serialization::kOther) return TopicKind::kOther;
  if (topic.type == "sensor_msgs/PointCloud2") return TopicKind::kClouds;
  return makerOfPackets(topic.type).empty() ? TopicKind::kOther : TopicKind::kPackets;
}

std::size_t chooseTopic(const Recording& recording, const fs::path& file, const std::string& name, bool wants_packets) {
  const std::vector<Topic>& topics = recording.topics();
  const auto refuse = [&](const std::string& why) { fail(file, why + "; its topics are:" + topicLinesOf(topics)); };
  std::vector<std::size_t> fitting;
  const auto collect = [&](auto&& fits) {
    for (std::size_t i = 0; i < topics.size(); ++i)
      if (fits(topics[i])) fitting.push_back(i);
  };
  if (!name.empty()) {
    collect([&](const Topic& topic) { return topic.name == name || topic.name == "/" + name; });
    if (fitting.empty()) refuse("has no topic '" + name + "'");
    if (kindOf(topics[fitting.front()]) == TopicKind::kOther)
      refuse("topic '" + name + "' holds neither clouds nor packets that are known");
    return fitting.front();
  }
  const auto holds = [](const Topic& topic, TopicKind kind) { return topic.messages > 0 && kindOf(topic) == kind; };
  if (!wants_packets) collect([&](const Topic& topic) { return holds(topic, TopicKind::kClouds); });
  if (fitting.empty()) collect([&](const Topic& topic) { return holds(topic, TopicKind::kPackets); });
  if (fitting.size() > 1) {
    // Ouster's drivers record the packets of the motion sensor as messages of the same type.
    const auto lidar = std::remove_if(fitting.begin(), fitting.end(), [&](std::size_t i) {
      return boost::contains(topics[i].type, "ouster") && boost::contains(topics[i].name, "imu");
    });
    if (lidar != fitting.begin()) fitting.erase(lidar, fitting.end());
  }
  if (fitting.empty())
    refuse(std::string(wants_packets ? "holds no packets that are known, as --sensor asks for"
                                     : "holds no messages of clouds or packets that are known") +
           (recording.error().empty() ? "" : " before it breaks off"));
  if (fitting.size() > 1) refuse("has several topics that fit: choose one by --topic");
  return fitting.front();
}

std::string metadataIn(const fs::path& file, const std::string& packet_topic) {
  const std::unique_ptr<Recording> recording = openRecording(file);
  const std::vector<Topic>& topics = recording->topics();
  std::vector<std::size_t> fitting;
  for (std::size_t i = 0; i < topics.size(); ++i)
    if (topics[i].type == "std_msgs/String" && boost::ends_with(topics[i].name, "metadata")) fitting.push_back(i);
  const auto beside = std::find_if(fitting.begin(), fitting.end(), [&](std::size_t i) {
    return namespaceOf(topics[i].name) == namespaceOf(packet_topic);
  });
  if (beside != fitting.end()) fitting = {*beside};
  if (fitting.empty()) return {};
  recording->select(fitting);
  Message message;
  if (!recording->next(message)) return {};
  try {
    return textIn(message, topics[message.topic]);
  } catch (const Broken&) {
    return {};
  }
}

}  // namespace lisco_apps
