// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Recordings made for tests.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "recordings/recording.h"

namespace lisco_test {

struct TestTopic {
  std::string name, type;
};
struct TestMessage {
  std::size_t topic;
  std::int64_t time_ns;
  std::string data;
};
struct TestRecording {
  std::vector<TestTopic> topics;
  std::vector<TestMessage> messages;
};

/// A temporary folder, removed at the end of a test.
class FolderTest : public testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;
  std::filesystem::path file(const std::string& name) const { return folder_ / name; }
  /// Makes a copy of the first bytes of a file.
  std::filesystem::path beginningOf(const std::filesystem::path& whole, std::uintmax_t bytes) const;

  std::filesystem::path folder_;
};

/// Two topics, /a (std_msgs/msg/String) and /b; messages 0.1 s apart, taking turns, of the given size.
TestRecording alternating(std::size_t messages, std::size_t bytes);

void writeDb3(const TestRecording& recording, const std::filesystem::path& file);
void writeMcap(const TestRecording& recording, const std::filesystem::path& file);
/// \param compression none, lz4 or bz2
/// \param is_finished false: without an index, as a recorder leaves it that was killed
void writeRos1Bag(const TestRecording& recording, const std::string& compression, bool is_finished,
                  const std::filesystem::path& file);

/// The messages that a reader gives.
struct ReadMessage {
  std::string topic;
  std::int64_t time_ns;
  std::string data;
};
std::vector<ReadMessage> messagesOf(lisco_apps::Recording& recording);

/// Fails unless messages are the first ones of a recording.
void expectBeginning(const TestRecording& recording, const std::vector<ReadMessage>& messages);

/// A message in CDR of a PointCloud2 of one row: x, y, z (float32), ring (uint16), time (float32).
struct TestPoint {
  float x, y, z;
  std::uint16_t ring;
  float time;
};
std::string pointCloud2(const std::vector<TestPoint>& points, bool is_ros1 = false);

}  // namespace lisco_test
