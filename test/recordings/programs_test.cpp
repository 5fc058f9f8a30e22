// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// The programs on recordings.
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "../programs/program_test.h"
#include "bags.h"
#include "io/little_endian.h"
#include "recordings/recording.h"

namespace {

namespace fs = std::filesystem;
using lisco_test::TestPoint;
using lisco_test::TestRecording;

class Programs : public ProgramTest {
 protected:
  Programs() : ProgramTest(LISCO_CLUSTER) {}

  /// Clouds of two walls, 0.1 s apart, in firing order; a second topic of texts.
  static TestRecording walls(std::size_t clouds) {
    TestRecording recording{{{"/points", "sensor_msgs/msg/PointCloud2"}, {"/text", "std_msgs/msg/String"}}, {}};
    for (std::size_t i = 0; i < clouds; ++i) {
      std::vector<TestPoint> points;
      for (unsigned column = 0; column < 60; ++column)
        for (unsigned ring = 0; ring < 4; ++ring) {
          const double azimuth = (column < 30 ? 0 : 3.1) - 0.02 * (column % 30);
          points.push_back({static_cast<float>(10 * std::cos(azimuth)), static_cast<float>(10 * std::sin(azimuth)),
                            0.1F * static_cast<float>(ring), static_cast<std::uint16_t>(ring),
                            1e-3F * static_cast<float>(column)});
        }
      const std::int64_t time = 1'600'000'000'000'000'000 + 100'000'000 * static_cast<std::int64_t>(i);
      recording.messages.push_back({1, time, "text"});
      recording.messages.push_back({0, time, lisco_test::pointCloud2(points)});
    }
    return recording;
  }
  void writeMcap(const TestRecording& recording, const std::string& name) const {
    lisco_test::writeMcap(recording, folder_ / name);
  }
  static std::size_t countOf(const std::string& part, const std::string& text) {
    std::size_t count = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; ++at) ++count;
    return count;
  }
  static fs::path data() {
    const char* const folder = std::getenv("LISCO_TEST_DATA");
    return folder != nullptr ? folder : LISCO_TEST_DATA_DEFAULT;
  }
};

TEST_F(Programs, ClusterEachCloudOfARecording) {
  writeMcap(walls(7), "a.mcap");
  lisco_test::writeDb3(walls(7), folder_ / "a.db3");
  for (const char* const name : {"a.mcap", "a.db3"}) {
    const Outcome outcome = run(std::string(name) + " -t 0.5 --ground none -o results");
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(countOf("clusters  2 of at least 10", outcome.out), 7U) << outcome.out;
    EXPECT_EQ(countOf("arranged by ring in 4 rows x 60 columns", outcome.out), 7U);
    EXPECT_TRUE(fs::exists(folder_ / "results/000001_1600000000.000000/labels.pcd"));
    EXPECT_TRUE(fs::exists(folder_ / "results/000007_1600000000.600000/clusters.csv"));
    fs::remove_all(folder_ / "results");
  }
}

TEST_F(Programs, TakeAPartOfARecording) {
  writeMcap(walls(20), "a.mcap");
  Outcome outcome = run("a.mcap -t 0.5 --ground none --from 0.45 --to 1.35 --every 3");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  for (const char* const item : {"a.mcap 6 at 1600000000.5", "a.mcap 9 at ", "a.mcap 12 at "})
    EXPECT_NE(outcome.out.find(item), std::string::npos) << outcome.out;
  EXPECT_EQ(countOf("a.mcap ", outcome.out), 3U);
  outcome = runLine(std::string(LISCO_STREAM) + " a.mcap -t 0.5 --ground none --from 0.45 --to 1.35 --every 3");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(countOf("60 columns, 240 returns, 2 clusters, largest 120", outcome.out), 3U) << outcome.out;
  expectRefusal("a.mcap -t 0.5 --ground none --from 3 --to 2", {"--to is before --from"});
}

TEST_F(Programs, StreamCloudsColumnByColumn) {
  writeMcap(walls(5), "a.mcap");
  const std::string stream = std::string(LISCO_STREAM) + " a.mcap -t 0.5 --ground none";
  Outcome outcome = runLine(stream + " --json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(countOf("{\"rotation\":", outcome.out), 5U);
  EXPECT_EQ(countOf("\"size\":120", outcome.out), 10U);
  outcome = runLine(stream + " --mode endless --json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_GT(countOf("\"size\":", outcome.out), 1U);
}

TEST_F(Programs, StreamTheCloudsOfAFolder) {
  fs::create_directories(folder_ / "clouds");
  std::ostringstream pcd;
  pcd << "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 60\nHEIGHT 4\nPOINTS 240\nDATA ascii\n";
  for (int ring = 0; ring < 4; ++ring)
    for (int column = 0; column < 60; ++column) {
      const double azimuth = (column < 30 ? 0 : 3.1) - 0.02 * (column % 30);
      pcd << 10 * std::cos(azimuth) << ' ' << 10 * std::sin(azimuth) << ' ' << 0.1 * ring << '\n';
    }
  for (const char* const name : {"a.pcd", "b.pcd", "c.pcd"}) std::ofstream(folder_ / "clouds" / name) << pcd.str();
  const std::string stream = std::string(LISCO_STREAM) + " clouds -t 0.5 --ground none";
  Outcome outcome = runLine(stream);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(countOf("60 columns, 240 returns, 2 clusters, largest 120", outcome.out), 3U) << outcome.out;
  EXPECT_EQ(countOf("rotation ", runLine(stream + " --every 2").out), 2U);
  EXPECT_EQ(countOf("clouds      3\nrotations   3\n", runLine(stream + " --stats").out), 1U);
  EXPECT_EQ(countOf("rotation ", runLine(std::string(LISCO_STREAM) + " clouds/b.pcd -t 0.5 --ground none").out), 1U);

  std::ofstream(folder_ / "clouds/b.pcd") << "no cloud";
  outcome = runLine(stream);
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(countOf("2 clusters", outcome.out), 2U) << outcome.out;
  EXPECT_EQ(countOf("b.pcd", outcome.err), 1U) << outcome.err;
  EXPECT_EQ(countOf("1 of 3 files could not be read", outcome.err), 1U) << outcome.err;
}

TEST_F(Programs, StreamFloatsAsTold) {
  // Three rings, firing by firing, of seven fields, which do not show their number: the last four are random.
  std::string bin;
  std::uint32_t state = 1;
  for (int firing = 0; firing < 300; ++firing)
    for (int ring = 0; ring < 3; ++ring) {
      const double azimuth = -2 * 3.14159265 * firing / 300;
      for (const double value : {10 * std::cos(azimuth), 10 * std::sin(azimuth), 0.2 * ring})
        lisco_apps::putNumber(bin, static_cast<float>(value));
      lisco_apps::putNumber(bin, 0.5F);
      lisco_apps::putNumber(bin, static_cast<float>(ring));
      for (int i = 0; i < 2; ++i)
        lisco_apps::putNumber(bin, static_cast<float>((state = state * 1664525U + 1013904223U) >> 8U));
    }
  std::ofstream(folder_ / "a.bin", std::ios::binary) << bin;
  const std::string stream = std::string(LISCO_STREAM) + " a.bin -t 0.5 --ground none";
  Outcome outcome = runLine(stream + " --bin-fields 7");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(countOf("300 columns, 900 returns, 1 clusters", outcome.out), 1U) << outcome.out << outcome.err;
  outcome = runLine(stream + " --bin-fields 8");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.err,
            "lisco_stream: a.bin: is no cloud of 8 floats a point: its size, 25200 bytes, is no multiple of 32\n");
}

TEST_F(Programs, WarnOfReturnsOffTheirColumns) {
  std::ostringstream pcd;
  pcd << "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 60\nHEIGHT 40\nPOINTS 2400\nDATA "
         "ascii\n";
  for (int row = 0; row < 40; ++row)  // a wall in front of a camera
    for (int column = 0; column < 60; ++column) pcd << 0.02 * (column - 30.5) << ' ' << 0.02 * (row - 20.5) << " 1\n";
  std::ofstream(folder_ / "camera.pcd") << pcd.str();
  const std::string stream = std::string(LISCO_STREAM) + " camera.pcd -t 0.1 --ground none --mode ";
  EXPECT_EQ(countOf("(outliers)", runLine(stream + "endless").err), 1U);
  EXPECT_EQ(countOf("(outliers)", runLine(stream + "rotation").err), 0U);
}

TEST_F(Programs, CountRangesOfStreamsFromWhereTheInputStatesItsSensor) {
  std::ostringstream pcd;
  pcd << "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 300\nHEIGHT 4\n"
         "VIEWPOINT 1000 2000 100 1 0 0 0\nPOINTS 1200\nDATA ascii\n";
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 300; ++column) {
      const double azimuth = -0.02 * column;
      pcd << 1000 + 5 * std::cos(azimuth) << ' ' << 2000 + 5 * std::sin(azimuth) << ' ' << 100.2 - 0.1 * row << '\n';
    }
  std::ofstream(folder_ / "map.pcd") << pcd.str();
  const std::string stream = std::string(LISCO_STREAM) + " map.pcd -t 0.5 --ground none";
  EXPECT_EQ(countOf("1200 returns, 1 clusters", runLine(stream + " --min-range 4 --max-range 6").out), 1U);
  EXPECT_EQ(countOf(" 0 returns, 0 clusters", runLine(stream + " --min-range 6").out), 1U);
}

TEST_F(Programs, SayWhichOptionsDoNotAct) {
  writeMcap(walls(1), "a.mcap");
  std::ofstream(folder_ / "a.bin", std::ios::binary) << std::string(1600, '\0');
  for (const std::string& program : {program_, std::string(LISCO_STREAM)}) {
    EXPECT_EQ(countOf("a.mcap: --port, --sensor, --return: without effect on clouds",
                      runLine(program + " a.mcap --topic /points -t 0.5 --port 2368 --sensor vlp16 --return last").err),
              1U)
        << program;
    EXPECT_EQ(countOf("--topic, --from, --to: without effect on files of clouds",
                      runLine(program + " a.bin -t 0.5 --topic /p --from 1 --to 2 --bin-fields 4").err),
              1U)
        << program;
    EXPECT_EQ(countOf("without effect", runLine(program + " a.mcap -t 0.5 --from 0 --to 9 --topic /points").err), 0U);
  }
}

TEST_F(Programs, SayWhichCloudsAStreamLeavesOut) {
  TestRecording recording = walls(3);
  recording.messages[3].data.resize(300);
  writeMcap(recording, "a.mcap");
  const Outcome outcome = runLine(std::string(LISCO_STREAM) + " a.mcap -t 0.5 --ground none");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(countOf("240 returns", outcome.out), 2U) << outcome.out;
  EXPECT_EQ(countOf("1 cloud left out: malformed, the first at 1600000000.100000: a message that ends too early",
                    outcome.err),
            1U)
      << outcome.err;
}

TEST_F(Programs, LeaveOutTheGroundOfPacketsAsOfTheirCloud) {
  if (!fs::is_directory(data() / "bags")) GTEST_SKIP() << "no recordings in " << data();
  for (const std::string name : {"pandar40p", "pandarqt64", "pandarxt16", "vlp32c"}) {
    const auto groundOfFirst = [&](const std::string& arguments) {
      const Outcome outcome = run(arguments + " -t 0.5 --json");
      EXPECT_EQ(outcome.status, 0) << outcome.err;
      const std::string before = "\"ground\":";
      const std::size_t at = outcome.out.find(before);
      EXPECT_NE(at, std::string::npos) << outcome.out;
      return at == std::string::npos ? -1 : std::atoi(outcome.out.c_str() + at + before.size());
    };
    const std::string bag = (data() / "bags" / (name + ".db3")).string();
    const int of_packets = groundOfFirst(bag + " --to 0.11 -o " + name + " --write labels");
    EXPECT_EQ(groundOfFirst(name + "/*/labels.pcd"), of_packets) << name;
    EXPECT_GE(of_packets, name == "pandar40p" ? 0 : 50) << name;
  }
}

// These sensors are on tables.
TEST_F(Programs, KeepTablesAroundSensorsInStreams) {
  if (!fs::is_directory(data() / "bags")) GTEST_SKIP() << "no recordings in " << data();
  for (const auto& [name, most] : {std::pair<const char*, double>{"pandar40p", 0.1},
                                   {"pandarqt64", 0.03},
                                   {"pandarxt16", 0.05},
                                   {"pandarxt32", 0.02},
                                   {"vlp16", 0.02}}) {
    const std::string bag = (data() / "bags" / (std::string(name) + ".db3")).string();
    const Outcome streamed = runLine(std::string(LISCO_STREAM) + " " + bag + " -t 0.5 --rotations 1 --json");
    const auto valueOf = [&](const std::string& key) {
      const std::size_t at = streamed.out.find("\"" + key + "\":");
      EXPECT_NE(at, std::string::npos) << streamed.out << streamed.err;
      return at == std::string::npos ? 0. : std::atof(streamed.out.c_str() + at + key.size() + 3);
    };
    EXPECT_LT(valueOf("ground"), most * valueOf("returns")) << name;
  }
}

// The sensors stand on tables, which are no ground: the floor is 0.9 m below. Most of the packets hold two returns.
TEST_F(Programs, FindTheFloorInOrganizedCloudsOfRooms) {
  if (!fs::is_directory(data() / "bags")) GTEST_SKIP() << "no recordings in " << data();
  const auto ground = [&](const std::string& name, const std::string& method) {
    const std::string bag = (data() / "bags" / (name + ".db3")).string();
    if (!fs::exists(folder_ / name))
      runLine(std::string(LISCO_STREAM) + " " + bag + " -t 0.5 --rotations 1 -o " + name);
    const Outcome outcome = run(name + "/rotation_000001.pcd -t 0.5 --json --ground " + method);
    const std::size_t at = outcome.out.find("\"ground\":");
    EXPECT_NE(at, std::string::npos) << outcome.out << outcome.err;
    return at == std::string::npos ? -1. : std::atof(outcome.out.c_str() + at + 9);
  };
  for (const auto& [name, below] :
       {std::pair<const char*, const char*>{"pandarqt64", "-0.6"}, {"pandarxt16", "-0.8"}}) {
    const double floor = ground(name, std::string("height:") + below), found = ground(name, "slope");
    EXPECT_GT(floor, 1000) << name;
    EXPECT_GT(found, 0.6 * floor) << name;
    EXPECT_LT(found, floor) << name;
  }
  for (const char* name : {"pandar40p", "vlp16"}) EXPECT_EQ(ground(name, "slope"), 0) << name;  // no floor in view
}

TEST_F(Programs, TakeEveryNthRotationOfPackets) {
  const fs::path capture = data() / "captures/hdl32e_outdoor.pcap";
  if (!fs::exists(capture)) GTEST_SKIP() << "no " << capture;
  const std::string stream = std::string(LISCO_STREAM) + " " + capture.string() + " -t 0.5 --ground none";
  const auto lines = [](const std::string& text) {
    std::vector<std::string> found;
    std::istringstream rest(text);
    for (std::string line; std::getline(rest, line);)
      if (line.rfind("rotation ", 0) == 0)
        found.push_back(line.substr(line.find(':'), line.find("returns") - line.find(':')));
    return found;
  };
  const std::vector<std::string> all = lines(runLine(stream).out), some = lines(runLine(stream + " --every 5").out);
  ASSERT_GT(all.size(), 10U);
  ASSERT_EQ(some.size(), (all.size() + 4) / 5);
  for (std::size_t i = 0; i < some.size(); ++i) EXPECT_EQ(some[i], all[5 * i]);
  EXPECT_EQ(runLine(stream + " --every 5 --mode endless").status, 2);
}

TEST_F(Programs, DecodeARotationAlikeInAnyPartOfACapture) {
  const fs::path capture = data() / "captures/vlp16_close.pcap";
  if (!fs::exists(capture)) GTEST_SKIP() << "no " << capture;
  std::string whole;
  for (const char* to : {"0.2", "0.6", "9"}) {
    const Outcome outcome = run(capture.string() + " --sensor vlp16 --tolerance 0.4 --json --to " + std::string(to));
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    auto first = nlohmann::json::parse(outcome.out.substr(0, outcome.out.find('\n')));
    first.erase("time_ms");
    if (whole.empty()) whole = first.dump();
    EXPECT_EQ(first.dump(), whole) << to;
  }
}

TEST_F(Programs, FindTheSensorByItsPackets) {
  if (!fs::is_directory(data() / "bags")) GTEST_SKIP() << "no recordings in " << data();
  const struct {
    const char *file, *sensor;
  } cases[] = {{"captures/hdl32e_outdoor.pcap", "hdl32e"},
               {"captures/vlp16_close.pcap", "vlp16"},
               {"captures/vlp16_street.pcap", "vlp16"},
               {"captures/vls128_street.pcap", "vls128"},
               {"bags/vlp16.db3", "vlp16"},
               {"bags/vlp32c.db3", "vlp32c"},
               {"bags/pandar40p.db3", "pandar40p"},
               {"bags/pandarqt64.db3", "pandarqt64"},
               {"bags/pandarxt16.db3", "pandarxt16"},
               {"bags/pandarxt32.db3", "pandarxt32"}};
  for (const auto& c : cases) {
    const Outcome outcome =
        runLine(std::string(LISCO_STREAM) + " " + (data() / c.file).string() + " -t 0.5 --ground none --rotations 1");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(countOf(std::string("sensor ") + c.sensor + ", by its packets", outcome.err), 1U) << outcome.err;
    EXPECT_EQ(countOf("rotation 1: ", outcome.out), 1U);
  }
  // Of several metadata beside it, the one that describes the packets.
  const Outcome ouster = runLine(std::string(LISCO_STREAM) + " " +
                                 (data() / "ouster/OS-1-64_1024x10_fw20.pcap").string() + " -t 0.5 --ground none");
  EXPECT_EQ(ouster.status, 0) << ouster.err;
  EXPECT_EQ(countOf("metadata beside it: OS-1-64_sensor_config_reduced.json", ouster.err), 1U) << ouster.err;
}

TEST_F(Programs, TakeMetadataBesideOnlyIfItDescribesThePackets) {
  const fs::path capture = data() / "captures/vlp16_close.pcap",
                 metadata = data() / "ouster/OS-1-64_sensor_config_reduced.json";
  if (!fs::exists(capture) || !fs::exists(metadata)) GTEST_SKIP() << "no " << capture << " or " << metadata;
  fs::create_symlink(fs::absolute(capture), folder_ / "drive_velodyne.pcap");
  fs::create_symlink(fs::absolute(metadata), folder_ / "drive.json");
  const Outcome outcome = runLine(std::string(LISCO_STREAM) + " drive_velodyne.pcap -t 0.5 --ground none");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(countOf("sensor vlp16, by its packets", outcome.err), 1U) << outcome.err;
}

TEST_F(Programs, EndAPipeOnASignalWithoutAnError) {
  const fs::path capture = data() / "captures/vlp16_street.pcap";
  if (!fs::exists(capture)) GTEST_SKIP() << "no " << capture;
  const Outcome outcome =
      runLine("sh -c '(head -c 300000 " + capture.string() + "; sleep 4) | " + LISCO_STREAM +
              " /dev/stdin --sensor vlp16 -t 0.5 --ground none & p=$!; sleep 2; kill -INT $p; wait $p'");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_GT(countOf("rotation 1: ", outcome.out), 0U) << outcome.out;
  EXPECT_EQ(countOf("breaks off", outcome.err), 0U) << outcome.err;
}

TEST_F(Programs, KeepEarlierCloudsIfAStreamCannotBegin) {
  writeMcap(walls(3), "a.mcap");
  writeMcap(walls(1), "precious.mcap");
  const std::string stream = std::string(LISCO_STREAM) + " a.mcap -t 0.5 --ground none -o out";
  ASSERT_EQ(runLine(stream).status, 0);
  ASSERT_TRUE(fs::exists(folder_ / "out/rotation_000003.pcd"));
  EXPECT_EQ(runLine(stream + " --bag precious.mcap").status, 2);
  EXPECT_TRUE(fs::exists(folder_ / "out/rotation_000003.pcd"));
}

TEST_F(Programs, WriteRotationsAsARecording) {
  TestRecording recording = walls(5);
  for (std::size_t i = 1; i < recording.messages.size(); i += 2) {
    std::string& cloud = recording.messages[i].data;
    cloud.replace(cloud.find("lidar"), 5, "robot");
  }
  writeMcap(recording, "a.mcap");
  const std::string stream = std::string(LISCO_STREAM) + " a.mcap -t 0.5 --bag out.mcap";
  ASSERT_EQ(runLine(stream).status, 0);
  for (const lisco_test::ReadMessage& message :
       lisco_test::messagesOf(*lisco_apps::openRecording(folder_ / "out.mcap")))
    EXPECT_GT(countOf("robot", message.data), 0U) << "the frame, in clouds and in markers";
  const Outcome again = run("out.mcap -t 0.5");
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(countOf("4 rows x 60 columns, 240 returns", again.out), 5U) << again.out;
  EXPECT_EQ(countOf("clusters  2 of", again.out), 5U);
  EXPECT_EQ(countOf("at 1600000000.4", again.out), 1U);
  EXPECT_EQ(runLine(stream + " --mode endless").status, 2);
}

TEST_F(Programs, CompareTheCloudsOfARecording) {
  writeMcap(walls(3), "a.mcap");
  const Outcome outcome = runLine(std::string(LISCO_COMPARE) +
                                  " a.mcap -t 0.5 --ground none --check-only --baselines pcl,lisco --json all.json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(countOf("4 rows x 60 columns, 240 returns", outcome.out), 3U) << outcome.out;
  EXPECT_NE(outcome.out.find("3/3"), std::string::npos) << outcome.out;
  EXPECT_EQ(countOf("\"a_00000", textOf(folder_ / "all.json")), 3U);
}

TEST_F(Programs, ListTheTopicsWhereThereIsAChoice) {
  TestRecording recording = walls(2);
  recording.topics.push_back({"/rear", "sensor_msgs/msg/PointCloud2"});
  recording.messages.push_back({2, 1, recording.messages[1].data});
  writeMcap(recording, "a.mcap");
  const Outcome outcome = run("a.mcap -t 0.5 --ground none");
  EXPECT_EQ(outcome.status, 2);
  for (const char* const part : {"--topic", "/points ", "/rear ", "/text "})
    EXPECT_NE(outcome.err.find(part), std::string::npos) << outcome.err;
  EXPECT_EQ(run("a.mcap -t 0.5 --ground none --topic /rear").status, 0);
}

TEST_F(Programs, KeepWhatComesBeforeABreak) {
  writeMcap(walls(2000), "a.mcap");
  fs::resize_file(folder_ / "a.mcap", fs::file_size(folder_ / "a.mcap") * 6 / 10);
  const Outcome outcome = run("a.mcap -t 0.5 --ground none --bag out.mcap");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_GT(countOf("clusters  2 of", outcome.out), 200U);
  EXPECT_EQ(countOf("a.mcap: breaks off at byte", outcome.err), 1U) << outcome.err;
  const auto bag = lisco_apps::openRecording(folder_ / "out.mcap");
  EXPECT_EQ(bag->topics()[0].messages, countOf("clusters  2 of", outcome.out));
  EXPECT_EQ(lisco_test::messagesOf(*bag).size(), 2 * bag->topics()[0].messages);
  EXPECT_EQ(bag->error(), "");
}

TEST_F(Programs, LeaveWholeResultsWhenInterrupted) {
  writeMcap(walls(30000), "a.mcap");
  const Outcome outcome = runLine(
      "sh -c '" + program_ + " a.mcap -t 0.5 --ground none --bag out.mcap & p=$!; sleep 1; kill -INT $p; wait $p'");
  EXPECT_EQ(outcome.status, 2) << outcome.err;
  const std::size_t done = countOf("clusters  2 of", outcome.out);
  EXPECT_GT(done, 0U);
  EXPECT_LT(done, 30000U);
  EXPECT_EQ(countOf("interrupted after " + std::to_string(done) + " scans", outcome.err), 1U) << outcome.err;
  const auto bag = lisco_apps::openRecording(folder_ / "out.mcap");
  EXPECT_EQ(bag->topics()[0].messages, done);
  EXPECT_EQ(lisco_test::messagesOf(*bag).size(), 2 * done);
}

TEST_F(Programs, RefuseToReplaceAForeignRecording) {
  writeMcap(walls(1), "a.mcap");
  writeMcap(walls(1), "precious.mcap");
  const std::string before = textOf(folder_ / "precious.mcap");
  expectRefusal("a.mcap -t 0.5 --ground none --bag precious.mcap", {"precious.mcap", "not written by this program"});
  EXPECT_EQ(textOf(folder_ / "precious.mcap"), before);
  ASSERT_EQ(run("a.mcap -t 0.5 --ground none --bag own.mcap").status, 0);
  EXPECT_EQ(run("a.mcap -t 0.5 --ground none --bag own.mcap").status, 0);
}

TEST_F(Programs, StreamSlidingWindows) {
  const fs::path capture = data() / "captures/vlp16_street.pcap";
  if (!fs::exists(capture)) GTEST_SKIP() << "no " << capture;
  const std::string command =
      std::string(LISCO_STREAM) + " " + capture.string() + " --sensor vlp16 -t 0.4 --ground none --mode windows";
  const Outcome outcome = runLine(command + " --window 600 --hop 200 --json -o windows");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(countOf("{\"window\":", outcome.out), 10U);
  // Each window's clusters are those of its columns as a cloud.
  for (const char* const number : {"000001", "000002", "000005", "000010"}) {
    SCOPED_TRACE(number);
    const std::string file = "windows/rotation_" + std::string(number) + ".pcd";
    const Outcome batch = run(file + " -t 0.4 --ground none -o batch");
    ASSERT_EQ(batch.status, 0) << batch.err;
    std::multiset<std::string> sizes;
    std::istringstream table(textOf(folder_ / "batch/clusters.csv"));
    std::string line;
    std::getline(table, line);
    while (std::getline(table, line))
      sizes.insert(line.substr(line.find(',') + 1, line.find(',', line.find(',') + 1) - line.find(',') - 1));
    std::multiset<std::string> streamed;
    std::istringstream windows(outcome.out);
    while (std::getline(windows, line)) {
      if (line.rfind("{\"window\":" + std::to_string(std::atoi(number)) + ",", 0) != 0) continue;
      for (std::size_t at = 0; (at = line.find("\"size\":", at)) != std::string::npos; ++at)
        streamed.insert(line.substr(at + 7, line.find(',', at) - at - 7));
    }
    EXPECT_GT(sizes.size(), 5U);
    EXPECT_EQ(streamed, sizes);
  }
  for (const char* const sizes : {"", " --window 600", " --window 600 --hop 250"}) {
    const Outcome refusal = runLine(command + sizes);
    EXPECT_EQ(refusal.status, 2);
    EXPECT_NE(refusal.err.find("--mode windows needs --window and --hop"), std::string::npos) << refusal.err;
  }
}

}  // namespace
