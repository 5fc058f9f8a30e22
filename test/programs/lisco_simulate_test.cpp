// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// lisco_simulate, run as a program.
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <pcl/PCLPointCloud2.h>
#include <pcl/io/pcd_io.h>

#include "io/scan_file.h"
#include "program_test.h"

namespace {

namespace fs = std::filesystem;

class LiscoSimulate : public ProgramTest {
 protected:
  LiscoSimulate() : ProgramTest(LISCO_SIMULATE) {}

  /// The number before some words, or -1.
  static long numberBefore(const std::string& text, const std::string& words) {
    const std::size_t end = text.find(words);
    if (end == std::string::npos) return -1;
    const std::size_t begin = text.find_last_not_of("0123456789", end - 1) + 1;
    return begin < end ? std::stol(text.substr(begin, end - begin)) : -1;
  }

  /// Checks that the arguments in the first line of a file make it again. \param first the first of these options
  void expectMadeAgain(const std::string& file, const std::string& first) const {
    const std::string text = textOf(folder_ / file);
    const std::string line = text.substr(0, text.find('\n'));
    EXPECT_EQ(line.rfind("# made by lisco_simulate ", 0), 0U) << line;
    const std::size_t arguments = line.find(first);
    ASSERT_NE(arguments, std::string::npos) << line;
    ASSERT_EQ(run(line.substr(arguments, line.find(';') - arguments) + " -o again.pcd").status, 0) << line;
    EXPECT_TRUE(text == textOf(folder_ / "again.pcd"));
  }
};

TEST_F(LiscoSimulate, WritesTheFiveScenesOfThePaper) {
  const long paper[] = {26891, 16218, 39028, 18229, 64518};
  for (int scene = 1; scene <= 5; ++scene) {
    SCOPED_TRACE(scene);
    const std::string file = "scene" + std::to_string(scene) + ".pcd";
    const Outcome outcome = run("--scene " + std::to_string(scene) + " --seed 3 -o " + file);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    EXPECT_EQ(numberBefore(outcome.out, " cells"), 72000) << outcome.out;
    EXPECT_NE(outcome.out.find("the paper's scene gave " + std::to_string(paper[scene - 1])), std::string::npos)
        << outcome.out;
    for (const char* kind : scene < 5
                                ? std::vector<const char*>{"car", "person", "tree", "lamp post", "house"}
                                : std::vector<const char*>{"person", "table", "chair", "shelf", "boxes", "column"})
      EXPECT_NE(outcome.out.find(std::string(" x ") + kind), std::string::npos) << kind << ": " << outcome.out;
    EXPECT_NE(outcome.out.find("cluster it with --ground-z -1.6\n"), std::string::npos) << outcome.out;

    // The summary agrees with the file.
    const auto cloud = lisco_apps::readScan(folder_ / file).cloud;
    EXPECT_EQ(cloud->height, 64U);
    EXPECT_EQ(cloud->width, 1125U);
    long returns = 0;
    for (const auto& point : *cloud) returns += std::isnan(point.x) ? 0 : 1;
    const auto above = static_cast<long>(lisco_apps::returnsAbove(*cloud, -1.6F).size());
    const std::string line =
        "returns   " + std::to_string(returns) + ", " + std::to_string(above) + " above the ground (z >= -1.6 m)";
    EXPECT_NE(outcome.out.find(line), std::string::npos) << outcome.out;
    EXPECT_NEAR(static_cast<double>(above), static_cast<double>(paper[scene - 1]),
                0.02 * static_cast<double>(paper[scene - 1]));
  }
}

TEST_F(LiscoSimulate, WritesTheObjectOfEveryReturn) {
  const Outcome outcome = run("--scene 1 -o scan.pcd");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  pcl::PCLPointCloud2 cloud;
  ASSERT_EQ(pcl::PCDReader().read((folder_ / "scan.pcd").string(), cloud), 0);
  EXPECT_EQ(cloud.height, 64U);
  EXPECT_EQ(cloud.width, 1125U);
  ASSERT_EQ(cloud.fields.size(), 4U);
  EXPECT_EQ(cloud.fields[2].name, "z");
  EXPECT_EQ(cloud.fields[3].name, "label");
  EXPECT_EQ(cloud.fields[3].datatype, pcl::PCLPointField::UINT32);
  std::set<std::uint32_t> labels;
  for (std::size_t cell = 0; cell < std::size_t{64} * 1125; ++cell) {
    float z;
    std::uint32_t label;
    std::memcpy(&z, &cloud.data[cell * cloud.point_step + cloud.fields[2].offset], 4);
    std::memcpy(&label, &cloud.data[cell * cloud.point_step + cloud.fields[3].offset], 4);
    ASSERT_TRUE(!std::isnan(z) || label == 0) << "cell " << cell;
    ASSERT_TRUE(!(z > -1.6F) || label != 0) << "cell " << cell << ": only the ground has no object";
    labels.insert(label);
  }
  const long objects = numberBefore(outcome.out, ": 1 x sensor car");
  ASSERT_GT(objects, 10);
  EXPECT_GE(static_cast<long>(labels.size()), objects * 3 / 4);
  EXPECT_LE(*labels.rbegin(), static_cast<std::uint32_t>(objects));

  const std::string text = textOf(folder_ / "scan.pcd");
  EXPECT_LT(text.find("--ground-z -1.6"), text.find('\n'));
  expectMadeAgain("scan.pcd", "--scene");
}

TEST_F(LiscoSimulate, GivesEqualScansForEqualSeedsOnly) {
  for (const char* arguments : {"-o one.pcd", "-o same.pcd --seed 1", "-o other.pcd --seed 2"})
    ASSERT_EQ(run(std::string("--scene 2 --sensor vlp16 ") + arguments).status, 0);
  EXPECT_TRUE(textOf(folder_ / "one.pcd") == textOf(folder_ / "same.pcd"));
  EXPECT_FALSE(textOf(folder_ / "one.pcd") == textOf(folder_ / "other.pcd"));
}

TEST_F(LiscoSimulate, SimulatesSensorsOfAnySize) {
  struct Size {
    std::uint32_t lasers, steps;
  };
  const std::map<std::string, Size> sensors = {{"hdl64e", {64, 1125}},
                                               {"hdl32e", {32, 2170}},
                                               {"vlp16", {16, 1808}},
                                               {"vls128", {128, 1808}},
                                               {"os1-128", {128, 1024}},
                                               {"vlp16 --lasers 33", {33, 1808}},
                                               {"vls128 --lasers 1 --steps 1", {1, 1}},
                                               {"hdl64e --steps 4500", {64, 4500}}};
  for (const auto& [arguments, size] : sensors) {
    SCOPED_TRACE(arguments);
    const Outcome outcome = run("--scene 5 --drop-outs 0 -o scan.pcd --sensor " + arguments);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(numberBefore(outcome.out, " cells"), static_cast<long>(size.lasers) * size.steps) << outcome.out;
    EXPECT_EQ(outcome.out.find("the paper's scene gave") != std::string::npos, arguments == "hdl64e") << outcome.out;
    const auto cloud = lisco_apps::readScan(folder_ / "scan.pcd").cloud;
    EXPECT_EQ(cloud->height, size.lasers);
    EXPECT_EQ(cloud->width, size.steps);
    for (const auto& point : *cloud) ASSERT_TRUE(std::isfinite(point.x)) << "the room is closed";
  }
}

TEST_F(LiscoSimulate, AppliesNoiseAndDropOuts) {
  ASSERT_EQ(run("--scene 5 --noise 0 --drop-outs 0 -o exact.pcd").status, 0);
  ASSERT_EQ(run("--scene 5 --noise 0.3 --drop-outs 0.5 -o poor.pcd").status, 0);
  const auto exact = lisco_apps::readScan(folder_ / "exact.pcd").cloud;
  const auto poor = lisco_apps::readScan(folder_ / "poor.pcd").cloud;
  double returns = 0;
  double squares = 0;
  for (std::size_t i = 0; i < poor->size(); ++i) {
    if (std::isnan((*poor)[i].x)) continue;
    ++returns;
    squares += static_cast<double>(((*poor)[i].getVector3fMap() - (*exact)[i].getVector3fMap()).squaredNorm());
  }
  EXPECT_NEAR(returns / 72000, 0.5, 0.01);
  EXPECT_NEAR(std::sqrt(squares / returns), 0.3, 0.01);
}

TEST_F(LiscoSimulate, AddsTheVehicle) {
  const Outcome outcome = run("--scene 3 --vehicle -o scan.pcd");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("1 x vehicle"), std::string::npos) << outcome.out;
  const auto cloud = lisco_apps::readScan(folder_ / "scan.pcd").cloud;
  long returns = 0;
  long near = 0;
  for (const auto& point : *cloud) {
    returns += std::isnan(point.x) ? 0 : 1;
    near += point.getVector3fMap().norm() < 1.5F ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(near) / static_cast<double>(returns), 0.25, 0.01);
  EXPECT_EQ(numberBefore(outcome.out, " nearer than 1.5 m"), near) << outcome.out;
  expectMadeAgain("scan.pcd", "--scene");

  ASSERT_EQ(run("--scene 3 -o bare.pcd").status, 0);
  EXPECT_FALSE(textOf(folder_ / "bare.pcd") == textOf(folder_ / "scan.pcd"));
}

TEST_F(LiscoSimulate, WritesTheWorstCases) {
  for (const char* name : {"room", "wall", "random", "sheets", "singletons", "blocked", "poles"}) {
    SCOPED_TRACE(name);
    const Outcome outcome = run(std::string("--case ") + name + " --sensor vlp16 --lasers 20 --seed 3 -o scan.pcd");
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    EXPECT_EQ(outcome.out.rfind(std::string("case ") + name + ": ", 0), 0U) << outcome.out;
    EXPECT_EQ(outcome.out.find("ground"), std::string::npos) << outcome.out;
    const auto cloud = lisco_apps::readScan(folder_ / "scan.pcd").cloud;
    EXPECT_EQ(cloud->height, 20U);
    EXPECT_EQ(cloud->width, 1808U);
    long returns = 0;
    for (const auto& point : *cloud) returns += std::isnan(point.x) ? 0 : 1;
    EXPECT_GT(returns, 5000);
    EXPECT_NE(outcome.out.find("returns   " + std::to_string(returns) + "\n"), std::string::npos) << outcome.out;
    expectMadeAgain("scan.pcd", "--case");
  }
  // The gap is used, and recorded in the file.
  ASSERT_EQ(run("--case sheets --gap 0.25 -o near.pcd").status, 0);
  ASSERT_EQ(run("--case sheets -o far.pcd").status, 0);
  EXPECT_FALSE(textOf(folder_ / "near.pcd") == textOf(folder_ / "far.pcd"));
  expectMadeAgain("near.pcd", "--case");
}

TEST_F(LiscoSimulate, WritesAScanOnEachTerrain) {
  for (const char* name : {"plane", "slope", "hill", "road", "ramp", "field"}) {
    SCOPED_TRACE(name);
    const Outcome outcome = run(std::string("--terrain ") + name + " --sensor hdl32e --seed 3 --roll 2 -o scan.pcd");
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    EXPECT_EQ(outcome.out.rfind(std::string("terrain ") + name + ": ", 0), 0U) << outcome.out;
    for (const char* kind : {"car", "lorry", "person", "tree", "wall", "house", "bridge", "sensor car"})
      EXPECT_NE(outcome.out.find(std::string(" x ") + kind), std::string::npos) << kind << ": " << outcome.out;
    const lisco_apps::Scan scan = lisco_apps::readScan(folder_ / "scan.pcd");
    const auto& cloud = scan.cloud;
    const std::vector<std::uint32_t>& objects = scan.object_of;
    EXPECT_EQ(cloud->height, 32U);
    EXPECT_EQ(cloud->width, 2170U);
    long returns = 0;
    long ground = 0;
    for (std::size_t i = 0; i < cloud->size(); ++i) {
      if (std::isnan((*cloud)[i].x)) continue;
      ++returns;
      ground += objects[i] == 0 ? 1 : 0;
    }
    EXPECT_GT(ground, 10000);
    EXPECT_EQ(numberBefore(outcome.out, " in 1 rotation"), returns) << outcome.out;
    EXPECT_EQ(numberBefore(outcome.out, " of them of the ground"), ground) << outcome.out;
    expectMadeAgain("scan.pcd", "--terrain");
  }
}

TEST_F(LiscoSimulate, WritesADriveIntoAFolder) {
  const std::string options = "--terrain road --sensor vlp16 --steps 400 --speed 10 --yaw-rate 20 --pitch 3 ";
  const Outcome outcome = run(options + "--rotations 3 -o sub/drive");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const fs::path drive = folder_ / "sub/drive";
  EXPECT_NE(outcome.out.find(" in 3 rotations"), std::string::npos) << outcome.out;
  std::istringstream poses(textOf(drive / "poses.csv"));
  std::string line;
  std::getline(poses, line);
  EXPECT_EQ(line, "rotation,column,seconds,x,y,z,roll_degrees,pitch_degrees,yaw_degrees");
  int lines = 0;
  std::string last;
  while (std::getline(poses, line)) {
    ++lines;
    last = line;
  }
  EXPECT_EQ(lines, 3 * 400);
  EXPECT_EQ(last.rfind("3,399,0.29975", 0), 0U) << last;
  EXPECT_NE(textOf(drive / "objects.csv").find(",sensor car,"), std::string::npos);
  for (int rotation = 1; rotation <= 3; ++rotation)
    EXPECT_EQ(lisco_apps::readScan(drive / ("rotation_00000" + std::to_string(rotation) + ".pcd")).cloud->width, 400U);
  EXPECT_FALSE(textOf(drive / "rotation_000001.pcd") == textOf(drive / "rotation_000002.pcd"));

  // A shorter one replaces it, and a foreign file stops it.
  ASSERT_EQ(run(options + "--rotations 2 -o sub/drive").status, 0);
  EXPECT_TRUE(fs::exists(drive / "rotation_000002.pcd"));
  EXPECT_FALSE(fs::exists(drive / "rotation_000003.pcd"));
  write("sub/drive/rotation_000009.pcd", "mine");
  expectRefusal(options + "-o sub/drive", {"rotation_000009.pcd", "not written by this program"});
  EXPECT_EQ(textOf(drive / "rotation_000009.pcd"), "mine");
  fs::create_directory(folder_ / "theirs");
  write("theirs/poses.csv", "mine");
  expectRefusal(options + "-o theirs", {"poses.csv", "not written by this program"});
}

TEST_F(LiscoSimulate, NamesTheArgumentsThatGiveTheSameFile) {
  ASSERT_EQ(run("--case sheets --gap 0.41234567 --steps 100 -o a.pcd").status, 0);
  const std::string text = textOf(folder_ / "a.pcd");
  const std::size_t begin = text.find("--case");
  const std::string arguments = text.substr(begin, text.find('\n') - begin);
  EXPECT_NE(arguments.find("--gap 0.41234567 "), std::string::npos) << arguments;
  ASSERT_EQ(run(arguments + " -o b.pcd").status, 0);
  EXPECT_TRUE(textOf(folder_ / "b.pcd") == text);
}

TEST_F(LiscoSimulate, LeavesNothingWhenInterrupted) {
  const Outcome outcome = runLine("sh -c '" + program_ +
                                  " --terrain plane --sensor vlp16 --rotations 10000 -o drive & p=$!; sleep 1; "
                                  "kill -INT $p; wait $p'");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("interrupted"), std::string::npos) << outcome.err;
  EXPECT_FALSE(fs::exists(folder_ / "drive"));
}

TEST_F(LiscoSimulate, WritesPacketsBesideADrive) {
  const std::string options = "--terrain ramp --sensor vlp16 --rotations 2 -o drive";
  const Outcome outcome = run(options + " --pcap");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  // 75 packets of 24 firings are a turn; each record is 16 bytes, 42 of headers, and a packet.
  EXPECT_EQ(fs::file_size(folder_ / "drive/capture.pcap"), 24U + 150U * (16 + 42 + 1206));
  EXPECT_EQ(lisco_apps::readScan(folder_ / "drive/rotation_000002.pcd").cloud->width, 1800U);
  ASSERT_EQ(run(options).status, 0);
  EXPECT_FALSE(fs::exists(folder_ / "drive/capture.pcap"));
}

TEST_F(LiscoSimulate, RefusesBadDrivesInOneLine) {
  expectRefusal("--terrain road --pcap --sensor vlp16 -o scan.pcd", {"--pcap", "folder"});
  expectRefusal("--terrain road --pcap -o drive", {"--pcap", "vlp16", "vls128"});
  expectRefusal("--terrain road --pcap --sensor vlp16 --lasers 16 -o drive", {"--pcap", "--lasers"});
  expectRefusal("--terrain road --pcap --sensor vlp16 --steps 1801 -o drive", {"--pcap", "--steps"});
  expectRefusal("--scene 1 --pcap -o scan.pcd", {"--pcap", "--terrain"});
  for (const char* name : {"planes", "1", "Road"})
    expectRefusal(std::string("-o scan.pcd --terrain=") + name, {"no terrain", "plane", "field"});
  expectRefusal("--terrain road --scene 1 -o scan.pcd", {"--scene", "--terrain"});
  expectRefusal("--terrain road --case room -o scan.pcd", {"--case", "--terrain"});
  expectRefusal("--terrain road --vehicle -o scan.pcd", {"--vehicle"});
  expectRefusal("--terrain road", {"--output"});
  expectRefusal("--terrain road -o drive.pcap", {"--output", "drive.pcap"});
  expectRefusal("--terrain road --rotations 2 -o scan.pcd", {"--rotations", "folder"});
  expectRefusal("--scene 1 -o folder", {"--output", ".pcd"});
  expectRefusal("--terrain road --slope 5 -o scan.pcd", {"--slope", "hill"});
  for (const char* slope : {"-1", "31", "nan", "steep"})
    expectRefusal(std::string("--terrain slope -o scan.pcd --slope=") + slope, {"--slope"});
  for (const char* option : {"height", "speed", "yaw-rate", "roll", "pitch", "roll-period", "pitch-period"})
    for (const char* value : {"1e9", "-1e9", "inf", "x"})
      expectRefusal(std::string("--terrain road -o scan.pcd --") + option + "=" + value, {option});
  for (const char* count : {"0", "-1", "1.5", "100001"})
    expectRefusal(std::string("--terrain road -o drive --rotations=") + count, {"--rotations"});
  expectRefusal("--terrain road -o drive --rotations 100000 --speed 50", {"longer than", "--rotations"});
  for (const char* option : {"--slope 5", "--height 2", "--speed 3", "--yaw-rate 1", "--roll 1", "--pitch 1",
                             "--roll-period 1", "--pitch-period 1", "--rotations 2"})
    expectRefusal(std::string("--scene 1 -o scan.pcd ") + option, {"needs --terrain"});
}

TEST_F(LiscoSimulate, PrintsHelpAndVersion) {
  const Outcome help = run("--help");
  EXPECT_EQ(help.status, 0);
  for (const char* word :
       {"Usage: lisco_simulate", "--scene", "--case", "singletons", "--gap", "--vehicle", "--sensor", "os1-128",
        "--drop-outs", "--terrain", "field", "--rotations", "poses.csv", "--pitch", "--pcap"})
    EXPECT_NE(help.out.find(word), std::string::npos) << word;
  const Outcome version = run("--version");
  EXPECT_EQ(version.status, 0);
  EXPECT_EQ(version.out.rfind("lisco_simulate ", 0), 0U) << version.out;
}

TEST_F(LiscoSimulate, RefusesBadOptionsInOneLine) {
  expectRefusal("", {"--scene"});
  expectRefusal("-o scan.pcd", {"--scene"});
  for (const char* scene : {"0", "6", "abc", "1x", "-1", "''"})
    expectRefusal(std::string("-o scan.pcd --scene=") + scene, {"--scene"});
  expectRefusal("-o scan.pcd --scene 1 --case room", {"--scene", "--case"});
  for (const char* name : {"rooms", "1", "Room"})
    expectRefusal(std::string("-o scan.pcd --case=") + name, {"no case", "room", "poles"});
  expectRefusal("--scene 5 --vehicle -o scan.pcd", {"--vehicle"});
  expectRefusal("--case room --vehicle -o scan.pcd", {"--vehicle"});
  for (const char* gap : {"0", "-1", "nan", "wide", "101"})
    expectRefusal(std::string("--case sheets -o scan.pcd --gap=") + gap, {"--gap"});
  expectRefusal("--case room --gap 0.5 -o scan.pcd", {"--gap", "sheets"});
  expectRefusal("--scene 1 --gap 0.5 -o scan.pcd", {"--gap", "sheets"});
  expectRefusal("--case room", {"--output"});
  expectRefusal("--scene 1", {"--output"});
  expectRefusal("--scene 1 -o ''", {"--output"});
  expectRefusal("--scene 1 -o scan.pcd --sensor hdl65", {"hdl65", "hdl64e", "os1-128"});
  for (const char* seed : {"abc", "-1", "1.5", "99999999999"})
    expectRefusal(std::string("--scene 1 -o scan.pcd --seed=") + seed, {"--seed"});
  for (const char* option : {"--lasers", "--steps"})
    for (const char* count : {"0", "-3", "many", "1e3", "4294967297"})
      expectRefusal(std::string("--scene 1 -o scan.pcd ") + option + "=" + count, {option});
  for (const char* noise : {"-0.1", "nan", "inf", "much", "0.1m"})
    expectRefusal(std::string("--scene 1 -o scan.pcd --noise=") + noise, {"--noise"});
  for (const char* part : {"-0.1", "1", "1.5", "nan", "half"})
    expectRefusal(std::string("--scene 1 -o scan.pcd --drop-outs=") + part, {"--drop-outs"});
  for (const char* size : {"--lasers 2147483647", "--steps 2147483647", "--lasers 4096 --steps 65536"})
    expectRefusal(std::string("--scene 1 -o scan.pcd ") + size, {"cells", "--lasers"});
  expectRefusal("--scene 1 -o scan.pcd --fast", {"--fast"});
  expectRefusal("--scene 1 -o scan.pcd stray", {"'stray' is no option", "see --help"});
}

TEST_F(LiscoSimulate, MakesTheFoldersAboveItsOutput) {
  for (const char* world : {"--scene 1", "--case sheets", "--terrain road"}) {
    SCOPED_TRACE(world);
    const Outcome outcome = run(std::string(world) + " --sensor vlp16 -o a/b/scan.pcd");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_TRUE(fs::exists(folder_ / "a/b/scan.pcd"));
    fs::remove_all(folder_ / "a");
  }
  expectRefusal("--scene 1 --sensor hdl65 -o a/b/scan.pcd", {"hdl65"});
  expectRefusal("--terrain road --lasers 4096 --steps 65536 -o a/b/scan.pcd", {"cells"});
}

TEST_F(LiscoSimulate, SaysWhichSensorsHavePacketsOnly) {
  for (const char* world : {"--scene 1", "--terrain road"})
    expectRefusal(std::string(world) + " --sensor vlp32c -o scan.pcd",
                  {"--sensor vlp32c is of --terrain with --pcap only"});
  EXPECT_EQ(run("--terrain road --sensor vlp32c --steps 360 --pcap -o drive").status, 0);
  EXPECT_NE(run("--help").out.find("vlp32c"), std::string::npos);
}

TEST_F(LiscoSimulate, OverwritesOnlyItsOwnFiles) {
  write("mine.pcd", "VERSION 0.7\nFIELDS x y z\n");
  expectRefusal("--scene 1 -o mine.pcd", {"mine.pcd", "not written by this program"});
  expectRefusal("--scene 1 -o mine.pcd/scan.pcd", {"mine.pcd", "cannot be written"});
  expectRefusal("--scene 1 -o mine.pcd/sub/scan.pcd", {"mine.pcd/sub", "cannot be written"});
  fs::create_directory(folder_ / "folder");
  expectRefusal("--scene 1 -o folder", {"folder"});
  EXPECT_EQ(textOf(folder_ / "mine.pcd"), "VERSION 0.7\nFIELDS x y z\n");

  ASSERT_EQ(run("--scene 1 --sensor vlp16 -o scan.pcd").status, 0);
  const std::string first = textOf(folder_ / "scan.pcd");
  ASSERT_EQ(run("--scene 2 --sensor vlp16 -o scan.pcd").status, 0);
  EXPECT_FALSE(first == textOf(folder_ / "scan.pcd"));
}

}  // namespace
