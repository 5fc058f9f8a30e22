// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "recordings/topic_choice.h"

#include <fstream>

#include "bags.h"
#include "recordings/cdr_text.h"

namespace lisco_test {
namespace {

using lisco_apps::chooseTopic;
using lisco_apps::openRecording;
using lisco_apps::Recording;

class Topics : public FolderTest {
 protected:
  std::unique_ptr<Recording> recordingOf(const std::vector<TestTopic>& topics) const {
    TestRecording recording{topics, {}};
    for (std::size_t i = 0; i < topics.size(); ++i)
      recording.messages.push_back({i, static_cast<std::int64_t>(i), "x"});
    std::filesystem::remove(file("a.mcap"));
    writeMcap(recording, file("a.mcap"));
    return openRecording(file("a.mcap"));
  }
  std::string chosen(const std::vector<TestTopic>& topics, const std::string& name, bool wants_packets) const {
    const std::unique_ptr<Recording> recording = recordingOf(topics);
    return recording->topics()[chooseTopic(*recording, file("a.mcap"), name, wants_packets)].name;
  }
  std::string refusal(const std::vector<TestTopic>& topics, const std::string& name) const {
    const std::unique_ptr<Recording> recording = recordingOf(topics);
    try {
      chooseTopic(*recording, file("a.mcap"), name, false);
    } catch (const std::runtime_error& why) {
      return why.what();
    }
    ADD_FAILURE() << "no refusal";
    return {};
  }
};

const TestTopic kCloud{"/points", "sensor_msgs/msg/PointCloud2"};
const TestTopic kOtherCloud{"/rear/points", "sensor_msgs/msg/PointCloud2"};
const TestTopic kPackets{"/velodyne_packets", "velodyne_msgs/msg/VelodyneScan"};
const TestTopic kImage{"/image", "sensor_msgs/msg/Image"};

TEST_F(Topics, ChoosesTheOnlyOneThatFits) {
  EXPECT_EQ(chosen({kImage, kCloud}, "", false), "/points");
  EXPECT_EQ(chosen({kImage, kPackets}, "", false), "/velodyne_packets");
  EXPECT_EQ(chosen({kPackets, kCloud}, "", false), "/points");
  EXPECT_EQ(chosen({kPackets, kCloud}, "", true), "/velodyne_packets");
}

TEST_F(Topics, ChoosesTheNamedOne) {
  EXPECT_EQ(chosen({kCloud, kOtherCloud}, "/rear/points", false), "/rear/points");
  EXPECT_EQ(chosen({kCloud, kOtherCloud}, "rear/points", false), "/rear/points");
  EXPECT_EQ(chosen({kPackets, kCloud}, "/velodyne_packets", false), "/velodyne_packets");
}

TEST_F(Topics, LeavesOutTheMotionSensorOfOuster) {
  EXPECT_EQ(chosen({{"/ouster/imu_packets", "ouster_sensor_msgs/msg/PacketMsg"},
                    {"/ouster/lidar_packets", "ouster_sensor_msgs/msg/PacketMsg"}},
                   "", false),
            "/ouster/lidar_packets");
}

TEST_F(Topics, ListsThemWhereThereIsAChoice) {
  const std::string several = refusal({kCloud, kImage, kOtherCloud}, "");
  for (const char* const part :
       {"choose one by --topic", "/points ", "/rear/points ", "/image ", "1 message", "sensor_msgs/PointCloud2"})
    EXPECT_NE(several.find(part), std::string::npos) << several;
  EXPECT_NE(refusal({kImage}, "").find("no messages of clouds or packets"), std::string::npos);
  EXPECT_NE(refusal({kCloud}, "/nothing").find("has no topic '/nothing'"), std::string::npos);
  EXPECT_NE(refusal({kCloud, kImage}, "/image").find("neither clouds nor packets"), std::string::npos);
}

TEST_F(Topics, GiveOustersMetadata) {
  lisco_apps::CdrText text;
  text.text("{\"beam_altitude_angles\": []}");
  TestRecording recording{{{"/left/lidar_packets", "ouster_sensor_msgs/msg/PacketMsg"},
                           {"/right/metadata", "std_msgs/msg/String"},
                           {"/left/metadata", "std_msgs/msg/String"}},
                          {{0, 1, "x"}, {1, 2, "y"}, {2, 3, text.done()}}};
  writeMcap(recording, file("a.mcap"));
  EXPECT_EQ(lisco_apps::metadataIn(file("a.mcap"), "/left/lidar_packets"), "{\"beam_altitude_angles\": []}");
  EXPECT_EQ(lisco_apps::metadataIn(file("a.mcap"), "/right/lidar_packets"), "");  // malformed
}

}  // namespace
}  // namespace lisco_test
