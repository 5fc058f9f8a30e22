// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include "bodies.h"
#include "io/scan_file.h"
#include "recordings/bytes.h"
#include "recordings/packet_messages.h"
#include "recordings/point_cloud2.h"
#include "recordings/recording.h"
#include "recordings/topic_choice.h"
#include "scratch_file.h"

namespace lisco_test {
namespace {

using lisco_apps::Message;
using lisco_apps::Serialization;
using lisco_apps::Topic;

/// A refusal is one line that names the file.
void expectRefusal(const std::runtime_error& refusal, const std::filesystem::path& file) {
  const std::string what = refusal.what();
  hold(what.compare(0, file.string().size(), file.string()) == 0, "a refusal that does not name the file");
}

/// Reads each byte, so that sanitizers see it.
void touch(const std::uint8_t* data, std::size_t size) {
  unsigned sum = 0;
  for (std::size_t i = 0; i < size; ++i) sum += data[i];
  hold(sum + 1 != 0 || size != 0, "memory");
}

void readMessage(const Message& message, const Topic& topic) {
  try {
    std::vector<lisco_apps::Packet> packets;
    lisco_apps::packetsIn(message, topic, packets);
    for (const lisco_apps::Packet& packet : packets) touch(packet.data, packet.size);
  } catch (const lisco_apps::Broken&) {
  }
  try {
    const lisco_apps::Scan scan = lisco_apps::scanOf(lisco_apps::pointCloud2In(message, topic));
    hold(scan.cloud->size() == std::size_t{scan.cloud->width} * scan.cloud->height, "the size of a cloud");
    hold(!scan.arranged || scan.point_of_cell.size() == scan.arranged->size(), "the size of an arrangement");
  } catch (const lisco_apps::Broken&) {
  }
}

void readRecording(const std::filesystem::path& file) {
  try {
    const std::unique_ptr<lisco_apps::Recording> recording = lisco_apps::openRecording(file);
    constexpr int kMessages = 1000;
    Message message;
    for (int i = 0; i < kMessages && recording->next(message); ++i) {
      hold(message.topic < recording->topics().size(), "a topic of a message");
      touch(message.data, message.size);
    }
    hold(recording->share() >= 0 && recording->share() <= 1, "a share");
    hold(recording->error().find('\n') == std::string::npos, "an error of several lines");
    lisco_apps::chooseTopic(*recording, file, "", false);
  } catch (const std::runtime_error& refusal) {
    expectRefusal(refusal, file);
  }
}

void readCloud(const std::filesystem::path& file) {
  try {
    const lisco_apps::Scan scan = lisco_apps::readScan(file);
    hold(scan.cloud->size() == std::size_t{scan.cloud->width} * scan.cloud->height, "the size of a cloud");
    hold(!scan.arranged || scan.point_of_cell.size() == scan.arranged->size(), "the size of an arrangement");
  } catch (const std::runtime_error& refusal) {
    expectRefusal(refusal, file);
  }
}

}  // namespace

void fuzzRecordings(const std::uint8_t* data, std::size_t size) {
  static const std::array<ScratchFile, 3> recordings{ScratchFile(".db3"), ScratchFile(".mcap"), ScratchFile(".bag")};
  static const std::array<ScratchFile, 2> clouds{ScratchFile("_cloud.npy"), ScratchFile("_cloud.bin")};
  static const std::array<const char*, 5> types{"sensor_msgs/PointCloud2", "velodyne_msgs/VelodyneScan",
                                                "pandar_msgs/PandarScan", "nebula_msgs/NebulaPackets",
                                                "ouster_msgs/PacketMsg"};
  if (size == 0) return;
  const std::size_t kind = data[0] % (recordings.size() + clouds.size() + 2 * types.size());
  ++data;
  --size;
  if (kind < recordings.size()) return readRecording(recordings[kind].holding(data, size));
  const std::size_t cloud = kind - recordings.size();
  if (cloud < clouds.size()) return readCloud(clouds[cloud].holding(data, size));
  const std::size_t type = cloud - clouds.size();
  const auto serialization = type < types.size() ? Serialization::kCdr : Serialization::kRos1;
  readMessage({0, 1, data, size}, {"/topic", types[type % types.size()], serialization, 1});
}

}  // namespace lisco_test
