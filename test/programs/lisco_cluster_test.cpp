// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// lisco_cluster, run as a program.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <boost/algorithm/string/replace.hpp>
#include <nlohmann/json.hpp>

#include "io/scan_file.h"
#include "lisco/version.h"
#include "program_test.h"

namespace {

namespace fs = std::filesystem;

class LiscoCluster : public ProgramTest {
 protected:
  LiscoCluster() : ProgramTest(LISCO_CLUSTER) {}
};

/// Two walls of 3 x 20 returns 5 m and 9 m ahead of the sensor, as an organized ASCII PCD with one no-return
/// per row, over a row of ground.
std::string twoWalls() {
  std::ostringstream pcd;
  pcd << "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 41\nHEIGHT 4\n"
         "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 164\nDATA ascii\n";
  for (int row = 0; row < 4; ++row) {
    for (int i = 0; i < 20; ++i) pcd << "5 " << -2 + 0.1 * i << ' ' << (row < 3 ? 0.1 * row : -1.8) << '\n';
    pcd << "nan nan nan\n";
    for (int i = 0; i < 20; ++i) pcd << "9 " << 2 + 0.1 * i << ' ' << (row < 3 ? 0.1 * row : -1.8) << '\n';
  }
  return pcd.str();
}

TEST_F(LiscoCluster, WritesLabelsTableAndPictures) {
  write("walls.pcd", twoWalls());
  const Outcome outcome = run("walls.pcd --tolerance 0.3 --ground-z -1.5 -o results");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_NE(outcome.out.find("4 rows x 41 columns, 160 returns\n"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("ground    40 returns (25 %) left out, below z = -1.5 m\n"), std::string::npos)
      << outcome.out;
  EXPECT_NE(outcome.out.find("clusters  2 of at least 10"), std::string::npos) << outcome.out;

  EXPECT_EQ(textOf(folder_ / "results/clusters.csv"),
            "id,size,centroid_x,centroid_y,centroid_z,min_x,min_y,min_z,max_x,max_y,max_z,nearest_range,"
            "box_x,box_y,box_z,yaw,length,width,height,density\n"
            "1,60,5.0000,-1.0500,0.1000,5.0000,-2.0000,0.0000,5.0000,-0.1000,0.2000,5.0010,"
            "5.0000,-1.0500,0.1000,-90.0000,1.9000,0.0000,0.2000,157.8947\n"
            "2,60,9.0000,2.9500,0.1000,9.0000,2.0000,0.0000,9.0000,3.9000,0.2000,9.2195,"
            "9.0000,2.9500,0.1000,-90.0000,1.9000,0.0000,0.2000,157.8947\n");
  for (const char* picture : {"range_image.png", "top_view.png"}) {
    SCOPED_TRACE(picture);
    const std::string png = textOf(folder_ / "results" / picture);
    ASSERT_GT(png.size(), 1000U);
    EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
  }
  const std::string labels = textOf(folder_ / "results/labels.pcd");
  EXPECT_NE(labels.find("FIELDS x y z label ground\nSIZE 4 4 4 4 1\nTYPE F F F U U\n"), std::string::npos);
  EXPECT_NE(labels.find("WIDTH 41\nHEIGHT 4\n"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder_ / "results/clusters"));

  // The binary part: x y z label ground of every cell, the walls labelled, ground and no-return 0.
  const std::string data = labels.substr(labels.find("DATA binary\n") + 12);
  ASSERT_EQ(data.size(), 164U * 17U);
  const auto label = [&data](std::size_t row, std::size_t column) {
    std::uint32_t value;
    std::memcpy(&value, data.data() + (row * 41 + column) * 17 + 12, 4);
    return value;
  };
  for (std::size_t cell = 0; cell < 164; ++cell)
    EXPECT_EQ(data[cell * 17 + 16], cell >= 123 && cell != 143 ? 1 : 0) << cell;
  EXPECT_EQ(label(0, 0), 1U);
  EXPECT_EQ(label(2, 40), 2U);
  EXPECT_EQ(label(1, 20), 0U);
  EXPECT_EQ(label(3, 5), 0U);
}

TEST_F(LiscoCluster, WritesOneCloudPerClusterOnRequest) {
  write("walls.pcd", twoWalls());
  ASSERT_EQ(run("walls.pcd --tolerance 0.3 --ground-z -1.5 -o results --clouds").status, 0);
  for (const char* name : {"cluster_0001.pcd", "cluster_0002.pcd"})
    EXPECT_EQ(lisco_apps::readScan(folder_ / "results/clusters" / name).cloud->size(), 60U) << name;
  // A second run replaces the clouds; a run without clouds removes them and keeps foreign files.
  write("results/clusters/mine.txt", "keep me");
  ASSERT_EQ(run("walls.pcd --tolerance 0.3 --ground-z -1.5 -o results --clouds").status, 0);
  EXPECT_TRUE(fs::exists(folder_ / "results/clusters/cluster_0002.pcd"));
  ASSERT_EQ(run("walls.pcd --tolerance 0.3 --ground-z -1.5 -o results").status, 0);
  EXPECT_FALSE(fs::exists(folder_ / "results/clusters/cluster_0002.pcd"));
  EXPECT_EQ(textOf(folder_ / "results/clusters/mine.txt"), "keep me");
  fs::remove(folder_ / "results/clusters/mine.txt");
  for (const char* clouds : {" --clouds", ""})
    ASSERT_EQ(run(std::string("walls.pcd --tolerance 0.3 --ground-z -1.5 -o results") + clouds).status, 0);
  EXPECT_FALSE(fs::exists(folder_ / "results/clusters"));
}

/// A turn of 32 lasers x 900 steps over flat ground 2 m below, with a wall of 60 columns 8 m ahead; of it, the columns
/// within `width` of that wall's middle.
std::string rotatingScan(int width = 450) {
  const auto floats = [](const std::vector<float>& values) {
    return std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
  };
  std::string data;
  for (int row = 0; row < 32; ++row)
    for (int column = 450 - width; column < 450 + width; ++column) {
      const double elevation = (2 - row) * 0.015;
      const double azimuth = 3.14159265 - column * (2 * 3.14159265 / 900);
      double range = elevation < 0 ? 2 / -std::sin(elevation) : 200;
      if (std::abs(column - 450) < 30) range = std::min(range, 8 / std::cos(azimuth));
      if (range > 100) range = std::nan("");
      data += floats({static_cast<float>(range * std::cos(elevation) * std::cos(azimuth)),
                      static_cast<float>(range * std::cos(elevation) * std::sin(azimuth)),
                      static_cast<float>(range * std::sin(elevation))});
    }
  return "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " + std::to_string(2 * width) +
         "\nHEIGHT 32\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + std::to_string(64 * width) + "\nDATA binary\n" + data;
}

TEST_F(LiscoCluster, LeavesOutTheGroundUnlessToldOtherwise) {
  write("turn.pcd", rotatingScan());
  const std::string with_ground = run("turn.pcd --tolerance 1 --ground none").out;
  EXPECT_EQ(with_ground.find("ground  "), std::string::npos) << with_ground;
  const Outcome outcome = run("turn.pcd --tolerance 1");
  EXPECT_NE(outcome.out.find("left out, by slope; --ground none keeps them"), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find("clusters  1 of at least 10"), std::string::npos) << outcome.out;
  EXPECT_EQ(run("turn.pcd --tolerance 1 --ground slope --json").out.find("\"ground\":0,"), std::string::npos);
  EXPECT_NE(run("turn.pcd --tolerance 1 --ground height:-1.9").out.find("below z = -1.9 m"), std::string::npos);
}

TEST_F(LiscoCluster, LeavesOutTheGroundOfASector) {
  std::string sector = rotatingScan(100);
  write("organized.pcd", sector);
  sector.replace(sector.find("WIDTH 200\nHEIGHT 32"), 19, "WIDTH 6400\nHEIGHT 1");
  write("unorganized.pcd", sector);
  for (const std::string name : {"organized.pcd", "unorganized.pcd"}) {
    const Outcome outcome = run(name + " --tolerance 1");
    EXPECT_NE(outcome.out.find("left out, by slope; --ground none keeps them"), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("clusters  1 of at least 10"), std::string::npos) << outcome.out;
  }
}

TEST_F(LiscoCluster, LeavesOutNothingWhereNoSensorTurns) {
  // Of a map, many points are straight below the origin.
  std::ostringstream map;
  map << "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2500\nHEIGHT 1\n"
         "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2500\nDATA ascii\n";
  for (int i = 0; i < 2500; ++i) map << -5 + 0.2 * (i % 50) << ' ' << -5 + 0.2 * (i / 50) << " -2\n";
  write("map.pcd", map.str());
  const Outcome outcome = run("map.pcd --tolerance 0.3");
  EXPECT_NE(outcome.out.find("ground    nothing left out: this is not the scan of a rotating sensor\n"),
            std::string::npos)
      << outcome.out;
  write("walls.pcd", twoWalls());
  const std::string walls = run("walls.pcd --tolerance 0.3").out;
  EXPECT_NE(walls.find("ground    nothing left out: none was found\n"), std::string::npos) << walls;
}

TEST_F(LiscoCluster, TakesTheGroundOfEachInput) {
  write("a.pcd", twoWalls());
  write("b.pcd", twoWalls());
  const Outcome outcome = run("a.pcd b.pcd --tolerance 0.3 --ground-z b=-1.5 --ground a=none --ground c=none --json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "lisco_cluster: --ground names 'c', which is no input\n");
  std::istringstream lines(outcome.out);
  std::string line;
  std::map<std::string, int> ground;
  while (std::getline(lines, line)) {
    const auto json = nlohmann::json::parse(line);
    ground[json["scan"]] = json["ground"];
  }
  EXPECT_EQ(ground, (std::map<std::string, int>{{"a.pcd", 0}, {"b.pcd", 40}}));
}

TEST_F(LiscoCluster, NamesTheOptionThatNamesNoInput) {
  write("a.pcd", twoWalls());
  EXPECT_EQ(run("a.pcd --tolerance 0.3 --ground-z b=-1.5").err,
            "lisco_cluster: --ground-z names 'b', which is no input\n");
  EXPECT_EQ(run("a.pcd --tolerance 0.3 --ground a.pcd=none").err,
            "lisco_cluster: --ground names 'a.pcd', which is no input: NAME is given without .pcd\n");
}

TEST_F(LiscoCluster, LeavesOutReturnsByRangeAndPlace) {
  write("walls.pcd", twoWalls());
  const auto counts = [this](const std::string& options) {
    const auto json = nlohmann::json::parse(run("walls.pcd --tolerance 0.3 --ground none --json " + options).out);
    return std::vector<int>{json["returns"], json["ignored"], json["clustered"]};
  };
  EXPECT_EQ(counts(""), (std::vector<int>{160, 0, 160}));
  EXPECT_EQ(counts("--min-range 6"), (std::vector<int>{160, 80, 80}));
  EXPECT_EQ(counts("--max-range 6"), (std::vector<int>{160, 80, 80}));
  EXPECT_EQ(counts("--ignore-box 4,-9,-9,6,9,-0.05"), (std::vector<int>{160, 20, 140}));
  EXPECT_EQ(counts("--ignore-box 4,-9,-9,6,9,9 --ignore-box 8,-9,-9,9,9,-1"), (std::vector<int>{160, 100, 60}));
  EXPECT_NE(run("walls.pcd --tolerance 0.3 --min-range 6").out.find("ignored   80 returns (50 %) by range or place"),
            std::string::npos);
  write("walls.pcd", boost::replace_all_copy(twoWalls(), "VIEWPOINT 0 0 0", "VIEWPOINT 10 0 0"));
  EXPECT_EQ(counts("--min-range 4.9"), (std::vector<int>{160, 80, 80}));  // from the sensor
}

TEST_F(LiscoCluster, SaysThatMapCoordinatesAreRounded) {
  const auto summary = [this](const std::string& point) {
    write("map.pcd",
          "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\n"
          "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 1\nDATA ascii\n" +
              point + "\n");
    return run("map.pcd --tolerance 1").out;
  };
  const char* const note = "note      coordinates as large as these are rounded to multiples of 0.5 m: subtract";
  EXPECT_NE(summary("500000 5400000 1").find(note), std::string::npos);
  EXPECT_NE(summary("500000 -5400000 1").find(note), std::string::npos);
  EXPECT_EQ(summary("500000 2000000 1").find("rounded"), std::string::npos);
}

TEST_F(LiscoCluster, FindsTheGroundOfEachRotationByItself) {
  const Outcome simulated =
      runLine(std::string(LISCO_SIMULATE) + " --terrain ramp --sensor hdl32e --speed 10 --rotations 3 --pcap -o drive");
  ASSERT_EQ(simulated.status, 0) << simulated.err;
  const auto groundIn = [&](const std::string& arguments) {
    const Outcome outcome = run(arguments + " -t 0.4 --json");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    std::vector<int> ground;
    std::istringstream lines(outcome.out);
    for (std::string line; std::getline(lines, line);) ground.push_back(nlohmann::json::parse(line)["ground"]);
    return ground;
  };
  const std::vector<int> ground =
      groundIn("drive/capture.pcap --sensor hdl32e -o results --write labels --bag out.mcap");
  ASSERT_EQ(ground.size(), 3U);
  EXPECT_GT(ground[0], 1000);
  EXPECT_EQ(groundIn("results/*/labels.pcd"), ground);
}

TEST_F(LiscoCluster, PrintsALineOfJsonPerScan) {
  write("a.pcd", twoWalls());
  write("b\xFF.pcd", twoWalls());
  const Outcome outcome = run(". --tolerance 0.3 --ground-z -1.5 --json -o results --write json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(std::count(outcome.out.begin(), outcome.out.end(), '\n'), 2) << outcome.out;
  const auto json = nlohmann::json::parse(outcome.out.substr(0, outcome.out.find('\n')));
  EXPECT_EQ(json["scan"], "a.pcd");
  EXPECT_EQ(json["tolerance"], 0.3);
  ASSERT_EQ(json["clusters"].size(), 2U);
  const auto& cluster = json["clusters"][0];
  EXPECT_EQ(cluster["id"], 1);
  EXPECT_EQ(cluster["size"], 60);
  EXPECT_EQ(cluster["oriented_box"]["length"], 1.9);
  EXPECT_EQ(cluster["oriented_box"]["yaw"], -90.);
  EXPECT_TRUE(json["time_ms"].contains("cluster"));
  const auto written = nlohmann::json::parse(textOf(folder_ / "results/a/clusters.json"));
  EXPECT_EQ(written["clusters"], json["clusters"]);
  EXPECT_FALSE(written.contains("time_ms"));
}

TEST_F(LiscoCluster, WritesTheResultsAskedFor) {
  write("walls.pcd", twoWalls());
  const auto written = [this](const std::string& options) {
    EXPECT_EQ(run("walls.pcd --tolerance 0.3 -o results " + options).status, 0) << options;
    std::vector<std::string> files;
    for (const auto& entry : fs::directory_iterator(folder_ / "results"))
      if (entry.path().filename() != ".lisco_results") files.push_back(entry.path().filename().string());
    std::sort(files.begin(), files.end());
    return files;
  };
  using Files = std::vector<std::string>;
  EXPECT_EQ(written("--write table"), Files({"clusters.csv"}));
  EXPECT_EQ(written(""), Files({"clusters.csv", "labels.pcd", "range_image.png", "top_view.png", "view.html"}));
  EXPECT_EQ(written("--write json,clouds"), Files({"clusters", "clusters.json"}));
  EXPECT_EQ(written("--write labels --clouds"), Files({"clusters", "labels.pcd"}));
  EXPECT_EQ(written("--write semantickitti"), Files({"labels.label", "labels.npy"}));
}

TEST_F(LiscoCluster, WritesSemanticKittiAndNumpyLabels) {
  write("walls.pcd", twoWalls());
  ASSERT_EQ(run("walls.pcd --tolerance 0.3 --ground-z -1.5 -o results --write semantickitti").status, 0);
  const std::string labels = textOf(folder_ / "results/labels.label");
  const std::string npy = textOf(folder_ / "results/labels.npy");
  ASSERT_EQ(labels.size(), 164U * 4);
  ASSERT_EQ(npy.size() % 64, 164U * 4 % 64);
  EXPECT_EQ(npy.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
  const std::string header = npy.substr(10, npy.size() - 164 * 4 - 10);
  EXPECT_EQ(header.rfind("{'descr': '<u4', 'fortran_order': False, 'shape': (4, 41), }", 0), 0U) << header;
  EXPECT_EQ(header.back(), '\n');
  EXPECT_EQ(static_cast<unsigned char>(npy[8]) + 256 * static_cast<unsigned char>(npy[9]),
            static_cast<int>(header.size()));
  const auto at = [](const std::string& bytes, std::size_t place) {
    std::uint32_t value;
    std::memcpy(&value, bytes.data() + place, 4);
    return value;
  };
  for (const auto& [point, id] : {std::pair{0U, 1U}, {20U, 0U}, {40U, 2U}, {3U * 41 + 5, 0U}, {3U * 41 + 20, 0U}}) {
    EXPECT_EQ(at(labels, 4 * point), id << 16 | (point == 3U * 41 + 5 ? 49U : 0U));
    EXPECT_EQ(at(npy, npy.size() - 164 * 4 + 4 * point), id);
  }
}

TEST_F(LiscoCluster, MarksTheGroundOfArrangedCloudsInTheOrderOfTheInput) {
  const std::string turn = rotatingScan();
  const std::string cells = turn.substr(turn.find("DATA binary\n") + 12);
  std::string points;
  std::size_t count = 0;
  for (std::size_t column = 0; column < 900; ++column)
    for (std::uint8_t ring = 0; ring < 32; ++ring) {
      const std::string cell = cells.substr((ring * std::size_t{900} + column) * 12, 12);
      float x;
      std::memcpy(&x, cell.data(), sizeof x);
      if (std::isnan(x)) continue;
      points += cell + std::string(1, static_cast<char>(ring));
      ++count;
    }
  const std::string number = std::to_string(count);
  write("firings.pcd", "VERSION 0.7\nFIELDS x y z ring\nSIZE 4 4 4 1\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH " + number +
                           "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + number + "\nDATA binary\n" + points);
  const Outcome outcome = run("firings.pcd --tolerance 1 --json --write labels,semantickitti -o results");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::string labels = textOf(folder_ / "results/labels.pcd");
  EXPECT_NE(labels.find("FIELDS x y z ring label ground\n"), std::string::npos);
  const std::string data = labels.substr(labels.find("DATA binary\n") + 12);
  const std::string kitti = textOf(folder_ / "results/labels.label");
  ASSERT_EQ(data.size(), count * 18);
  ASSERT_EQ(kitti.size(), count * 4);
  int ground = 0;
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < count; ++i) {
    float z;
    std::uint32_t label, of_kitti;
    std::memcpy(&z, &data[18 * i + 8], sizeof z);
    std::memcpy(&label, &data[18 * i + 13], sizeof label);
    std::memcpy(&of_kitti, &kitti[4 * i], sizeof of_kitti);
    const bool is_ground = data[18 * i + 17] == 1;
    ground += is_ground ? 1 : 0;
    wrong += is_ground && (z > -1.5F || label != 0) ? 1 : 0;
    wrong += of_kitti != (label << 16 | (is_ground ? 49U : 0U)) ? 1 : 0;
  }
  EXPECT_EQ(wrong, 0U);
  EXPECT_GT(ground, 10000);
  EXPECT_EQ(nlohmann::json::parse(outcome.out)["ground"], ground);
}

TEST_F(LiscoCluster, RenamesAllFieldsOfAnAddedName) {
  write("twice.pcd",
        "VERSION 0.7\nFIELDS x y z label label\nSIZE 4 4 4 4 4\nTYPE F F F U U\nCOUNT 1 1 1 1 1\nWIDTH 1\nHEIGHT 1\n"
        "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 1\nDATA ascii\n5 0 1 2 3\n");
  ASSERT_EQ(run("twice.pcd --tolerance 0.3 --min-size 1 --ground none -o results").status, 0);
  EXPECT_NE(textOf(folder_ / "results/labels.pcd").find("FIELDS x y z input_label input_label2 label\n"),
            std::string::npos);
}

TEST_F(LiscoCluster, RenamesAGroundFieldOfTheInput) {
  write("ground.pcd",
        "VERSION 0.7\nFIELDS x y z ground\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH 2\nHEIGHT 1\n"
        "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA ascii\n5 0 -2 0.5\n5 0 1 0.25\n");
  for (const auto& [ground, fields] : {std::pair("none", "FIELDS x y z input_ground label\n"),
                                       std::pair("slope", "FIELDS x y z input_ground label\n"),  // turns nowhere
                                       std::pair("height:0", "FIELDS x y z input_ground label ground\n")}) {
    ASSERT_EQ(run(std::string("ground.pcd --tolerance 0.3 --min-size 1 -o results --ground ") + ground).status, 0);
    EXPECT_NE(textOf(folder_ / "results/labels.pcd").find(fields), std::string::npos) << ground;
  }
  const std::string pcd = textOf(folder_ / "results/labels.pcd");
  EXPECT_EQ(pcd.substr(pcd.find("DATA binary\n") + 12), floats({5, 0, -2, 0.5F}) + std::string("\0\0\0\0\1", 5) +
                                                            floats({5, 0, 1, 0.25F}) + std::string("\1\0\0\0\0", 5));
}

TEST_F(LiscoCluster, LeavesOutSemanticKittiLabelsOfTooManyClusters) {
  const auto line = [](std::size_t points) {
    std::vector<float> values;
    for (std::size_t i = 0; i < points; ++i) values.insert(values.end(), {static_cast<float>(i + 1), 1, 0});
    return values;
  };
  const auto pcd = [&](std::size_t points) {
    const std::string count = std::to_string(points);
    return "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH " + count +
           "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + count + "\nDATA binary\n" + floats(line(points));
  };
  const std::string options = " --tolerance 0.3 --min-size 1 --write semantickitti,labels -o results";
  write("most.pcd", pcd(65535));
  const Outcome most = run("most.pcd" + options);
  ASSERT_EQ(most.status, 0) << most.err;
  EXPECT_EQ(fs::file_size(folder_ / "results/labels.label"), 65535U * 4);

  write("more.pcd", pcd(65536));
  const Outcome more = run("more.pcd" + options);
  EXPECT_EQ(more.status, 2);
  EXPECT_EQ(more.err,
            "lisco_cluster: results/labels.label is not written: SemanticKITTI's format has 16 bits for an instance, "
            "65535 clusters at most; there are 65536 (a larger --min-size gives fewer)\n");
  EXPECT_NE(more.out.find("clusters  65536 of"), std::string::npos) << more.out;
  EXPECT_FALSE(fs::exists(folder_ / "results/labels.label"));  // of the run before
  EXPECT_NE(textOf(folder_ / "results/labels.pcd").find("POINTS 65536\n"), std::string::npos);
  EXPECT_GT(fs::file_size(folder_ / "results/labels.npy"), 65536U * 4);
}

TEST_F(LiscoCluster, KeepsAllFieldsOfTheInput) {
  // A byte of padding, a field of two values, types of one to eight bytes, and labels.
  const auto point = [](double x, float y, float z, std::uint8_t ring, std::uint16_t pair, std::int32_t object) {
    std::string bytes(26, '\7');
    std::memcpy(&bytes[0], &x, 8);
    std::memcpy(&bytes[8], &y, 4);
    std::memcpy(&bytes[12], &z, 4);
    std::memcpy(&bytes[16], &ring, 1);
    std::memcpy(&bytes[18], &pair, 2);
    std::memcpy(&bytes[20], &pair, 2);
    std::memcpy(&bytes[22], &object, 4);
    return bytes;
  };
  write("rich.pcd",
        "VERSION 0.7\nFIELDS x y z ring _ pair label\nSIZE 8 4 4 1 1 2 4\nTYPE F F F U U U I\nCOUNT 1 1 1 1 1 2 1\n"
        "WIDTH 3\nHEIGHT 1\nVIEWPOINT 1 2 3 1 0 0 0\nPOINTS 3\nDATA binary\n" +
            point(5.125, 1, 2, 7, 300, -4) + point(5.25, 1, 2, 8, 301, -5) + point(9, 1, 2, 9, 302, -6));
  ASSERT_EQ(run("rich.pcd --tolerance 0.3 --min-size 2 -o results --write labels,clouds").status, 0);
  const std::string pcd = textOf(folder_ / "results/labels.pcd");
  for (const char* line : {"FIELDS x y z ring pair input_label label\n", "SIZE 8 4 4 1 2 4 4\n", "TYPE F F F U U I U\n",
                           "COUNT 1 1 1 1 2 1 1\n", "VIEWPOINT 1 2 3 1 0 0 0\n", "WIDTH 3\nHEIGHT 1\n"})
    EXPECT_NE(pcd.find(line), std::string::npos) << line << pcd.substr(0, 300);
  const std::string data = pcd.substr(pcd.find("DATA binary\n") + 12);
  ASSERT_EQ(data.size(), 3U * 29);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string expected =
        point(i == 2 ? 9 : 5.125 + 0.125 * static_cast<double>(i), 1, 2, static_cast<std::uint8_t>(7 + i),
              static_cast<std::uint16_t>(300 + i), -4 - static_cast<int>(i));
    EXPECT_EQ(data.substr(29 * i, 17), expected.substr(0, 17)) << i;
    EXPECT_EQ(data.substr(29 * i + 17, 8), expected.substr(18, 8)) << i;
    EXPECT_EQ(data[29 * i + 25], i == 2 ? 0 : 1) << i;
  }
  const std::string cluster = textOf(folder_ / "results/clusters/cluster_0001.pcd");
  for (const char* line : {"FIELDS x y z ring pair label\n", "SIZE 8 4 4 1 2 4\n", "TYPE F F F U U I\n",
                           "VIEWPOINT 1 2 3 1 0 0 0\n", "WIDTH 2\nHEIGHT 1\n"})
    EXPECT_NE(cluster.find(line), std::string::npos) << line << cluster.substr(0, 300);
  const std::string cluster_data = cluster.substr(cluster.find("DATA binary\n") + 12);
  ASSERT_EQ(cluster_data.size(), 2U * 25);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(cluster_data.substr(25 * i, 25), data.substr(29 * i, 25)) << i;
  // Its own output is an input, too.
  fs::rename(folder_ / "results/labels.pcd", folder_ / "again.pcd");
  ASSERT_EQ(run("again.pcd --tolerance 0.3 --min-size 2 -o results").status, 0);
  EXPECT_NE(textOf(folder_ / "results/labels.pcd").find("FIELDS x y z ring pair input_label input_label2 label\n"),
            std::string::npos);
}

TEST_F(LiscoCluster, KeepsTheFieldsOfKittiScans) {
  write("scan.bin", floats({5, 0, 0, 0.25F, 5, 0.1F, 0, 0.5F}));
  ASSERT_EQ(run("scan.bin --tolerance 0.3 --min-size 1 -o results").status, 0);
  const std::string pcd = textOf(folder_ / "results/labels.pcd");
  EXPECT_NE(pcd.find("FIELDS x y z intensity label\n"), std::string::npos);
  EXPECT_NE(pcd.find(floats({5, 0.1F, 0, 0.5F}) + std::string("\1\0\0\0", 4)), std::string::npos);
}

TEST_F(LiscoCluster, ReadsEveryFormat) {
  write("a.bin", floats({5, 0, 0, 1, 5, 0.1F, 0, 1, 9, 0, 0, 1}));
  // Two steps of two lasers; straight ahead is alpha = 90 degrees, clockwise from +y.
  write("b.csv", "2,2,0\n5,0,1.5707963\n0,0,0\n5,0,1.5507963\n9.0,0.1,1.5507963\n");
  write("c.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
        "z\nend_header\n"
        "5 0 0\n5 0.1 0\n9 0 0\n");
  write("d.pcd",
        "VERSION 0.7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 3\nHEIGHT 1\nVIEWPOINT 0 0 0 "
        "1 0 0 0\n"
        "POINTS 3\nDATA ascii\n5 0 0\n5 0.1 0\n9 0 0\n");
  const Outcome outcome = run(". --tolerance 0.3 --min-size 1");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  std::size_t found = 0;
  for (std::size_t at = 0; (at = outcome.out.find("clusters  2 of at least 1 ", at)) != std::string::npos; ++at)
    ++found;
  EXPECT_EQ(found, 4U) << outcome.out;
  EXPECT_NE(outcome.out.find("2 rows x 2 columns, 3 returns"), std::string::npos) << outcome.out;

  const auto csv = lisco_apps::readScan(folder_ / "b.csv").cloud;
  EXPECT_NEAR(csv->at(0, 0).x, 5.0F, 1e-5F);
  EXPECT_NEAR(csv->at(1, 0).y, 5.0F * std::cos(1.5507963F), 1e-5F);
  EXPECT_NEAR(csv->at(1, 1).z, 9.0F * std::sin(0.1F), 1e-5F);
  EXPECT_TRUE(std::isnan(csv->at(0, 1).x));
}

TEST_F(LiscoCluster, PassesOverTheTablesOfASimulatedDrive) {
  const Outcome drive = runLine(std::string(LISCO_SIMULATE) + " --terrain plane --sensor vlp16 --rotations 2 -o drive");
  ASSERT_EQ(drive.status, 0) << drive.err;
  ASSERT_TRUE(fs::exists(folder_ / "drive/poses.csv") && fs::exists(folder_ / "drive/objects.csv"));
  const Outcome outcome = run("drive --tolerance 0.5");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.err, "");
  EXPECT_NE(outcome.out.find("rotation_000002.pcd"), std::string::npos) << outcome.out;
  write("drive/points.csv", "x,y,z\n1,2,3\n");  // these are points, which a .csv cannot hold
  const Outcome with_points = run("drive --tolerance 0.5");
  EXPECT_EQ(with_points.status, 2);
  EXPECT_NE(with_points.err.find("points.csv: line 1"), std::string::npos) << with_points.err;
}

TEST_F(LiscoCluster, RefusesBadFilesInOneLine) {
  const std::string good = twoWalls();
  const std::string header =
      "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 4\nHEIGHT 1\nVIEWPOINT 0 0 0 1 "
      "0 0 0\nPOINTS 4\n";
  write("truncated.pcd", good.substr(0, good.size() / 2));
  write("truncated_binary.pcd", header + "DATA binary\n" + floats({1, 2, 3, 4}));
  write("truncated_header.pcd", header.substr(0, 30));
  write("garbage.pcd", "this is no cloud\n");
  write("garbage.ply", "this is no cloud\n");
  write("empty.pcd", "");
  write("no_z.pcd",
        "VERSION 0.7\nFIELDS x y\nSIZE 4 4\nTYPE F F\nCOUNT 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n1 "
        "2\n");
  write("integers.pcd",
        "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE I I I\nCOUNT 1 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA "
        "ascii\n1 2 3\n");
  write("odd.bin", "seventeen bytes!!");
  write("nothing.bin", "");
  write("promises.pcd",
        "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 500000000\nHEIGHT 1\nPOINTS 500000000\n"
        "DATA ascii\n1 2 3\n");
  write("header.csv", "lasers,steps,0\n");
  write("third.csv", "1,1,7\n1,0,0\n");
  write("short.csv", "2,2,0\n1,0,0\n1,0,0\n1,0,0\n");
  write("long.csv", "1,1,0\n1,0,0\n1,0,0\n");
  write("words.csv", "1,1,0\none,0,0\n");
  write("points.csv", "x,y,z\n1,2,3\n");
  write("scan.xyz", "1 2 3\n");
  write("capture.pcap", "packets");
  fs::create_directory(folder_ / "hollow");

  const std::string options = " --tolerance 0.3 -o results";
  expectRefusal("missing.pcd" + options, {"missing.pcd", "does not exist"});
  expectRefusal("truncated.pcd" + options, {"truncated.pcd", "truncated"});
  expectRefusal("truncated_binary.pcd" + options, {"truncated_binary.pcd", "fewer points than its header says"});
  expectRefusal("truncated_header.pcd" + options, {"truncated_header.pcd", "its header breaks off"});
  expectRefusal("garbage.pcd" + options, {"garbage.pcd", "no pcd file"});
  expectRefusal("garbage.ply" + options, {"garbage.ply", "no ply file"});
  expectRefusal("empty.pcd" + options, {"empty.pcd", "is empty"});
  expectRefusal("no_z.pcd" + options, {"no_z.pcd", "no field 'z'"});
  expectRefusal("integers.pcd" + options, {"integers.pcd", "neither float nor double"});
  expectRefusal("odd.bin" + options, {"odd.bin", "17 bytes", "multiple of"});
  expectRefusal("nothing.bin" + options, {"nothing.bin", "is empty"});
  expectRefusal("promises.pcd" + options, {"promises.pcd", "fewer points than its header says"});
  expectRefusal("third.csv" + options, {"third.csv", "line 1"});
  expectRefusal("header.csv" + options, {"header.csv", "line 1", "lasers,steps,0"});
  expectRefusal("points.csv" + options, {"points.csv", "line 1", "make it a .pcd"});
  expectRefusal("short.csv" + options, {"short.csv", "before the 4 cells"});
  expectRefusal("long.csv" + options, {"long.csv", "more than the 1 cells"});
  expectRefusal("words.csv" + options, {"words.csv", "line 2"});
  expectRefusal("scan.xyz" + options, {"scan.xyz", "unknown ending"});
  expectRefusal("capture.pcap" + options, {"capture.pcap", "is no capture of packets"});
  expectRefusal("hollow" + options, {"hollow", "holds no scans"});
}

TEST_F(LiscoCluster, RefusesBadOptionsInOneLine) {
  write("walls.pcd", twoWalls());
  write("file", "");
  expectRefusal("", {"no input"});
  expectRefusal("walls.pcd", {"--tolerance is missing"});
  for (const char* tolerance : {"0", "-0.3", "nan", "inf", "abc", "0.3m", "''"})
    expectRefusal(std::string("walls.pcd --tolerance ") + tolerance,
                  {"--tolerance must be a positive number of metres, not '"});
  expectRefusal("walls.pcd --tolerance", {"--tolerance", "see --help"});
  expectRefusal("walls.pcd --tolerance 0.3 --min-size 0", {"--min-size"});
  expectRefusal("walls.pcd --tolerance 0.3 --min-size -1", {"min-size"});
  expectRefusal("walls.pcd --tolerance 0.3 --max-size 5000000000", {"--max-size"});
  expectRefusal("walls.pcd --tolerance 0.3 --min-size 20 --max-size 10", {"--max-size is smaller"});
  expectRefusal("walls.pcd --tolerance 0.3 --ground-z low", {"--ground-z must be a number, not 'low'"});
  for (const char* method : {"flat", "height", "''", "slope:3"})
    expectRefusal(std::string("walls.pcd --tolerance 0.3 --ground ") + method,
                  {"--ground must be slope, height:Z or none, not '"});
  expectRefusal("walls.pcd --tolerance 0.3 --ground height:low", {"--ground must be a number, not 'low'"});
  expectRefusal("walls.pcd --tolerance 0.3 --ground none --ground-z 1", {"the ground is given twice"});
  expectRefusal("walls.pcd --tolerance 0.3 --ground walls=none --ground-z walls=1", {"the ground is given twice"});
  expectRefusal("walls.pcd --tolerance 0.3 --ground-z =1", {"--ground-z: NAME is empty in '=1'"});
  expectRefusal("walls.pcd --tolerance 0.3 --ground =none", {"--ground: NAME is empty in '=none'"});
  expectRefusal("walls.pcd --tolerance 0.3 --min-range -1", {"--min-range must not be negative"});
  expectRefusal("walls.pcd --tolerance 0.3 --max-range far", {"--max-range must be a number, not 'far'"});
  expectRefusal("walls.pcd --tolerance 0.3 --min-range 5 --max-range 4", {"--max-range is smaller"});
  expectRefusal("walls.pcd --tolerance 0.3 --ignore-box 1,2,3", {"--ignore-box takes six numbers"});
  expectRefusal("walls.pcd --tolerance 0.3 --ignore-box 0,0,0,1,-1,1", {"--ignore-box takes the lower corner first"});
  expectRefusal("walls.pcd --tolerance 0.3 --ignore-box 0,0,0,1,x,1", {"--ignore-box must be a number, not 'x'"});
  expectRefusal("walls.pcd --tolerance 0.3 -o results --write labels,video",
                {"--write: 'video' is none of labels, table, pictures, view, clouds, json, semantickitti"});
  expectRefusal("walls.pcd --tolerance 0.3 -o results --write ''", {"--write: '' is none of"});
  expectRefusal("walls.pcd --tolerance 0.3 --write labels", {"--write needs --output"});
  expectRefusal("walls.pcd --tolerance 0.3 --ground-z nan", {"ground-z"});
  expectRefusal("walls.pcd --tolerance 0.3 --ground-z 1e300", {"ground-z"});
  expectRefusal("walls.pcd --tolerance 0.3 --nonsense", {"nonsense", "see --help"});
  expectRefusal("walls.pcd --tolerance 0.3 --threads -1", {"threads"});
  expectRefusal("walls.pcd --tolerance 0.3 --threads many", {"--threads"});
  expectRefusal("walls.pcd --tolerance 0.3 --clouds", {"--clouds needs --output"});
  expectRefusal("walls.pcd --tolerance 0.3 -o file/results", {"file/results", "cannot be written"});
}

// The usual result of ground left in, or of a tolerance in millimetres.
TEST_F(LiscoCluster, NotesAClusterOfMoreThanHalfOfTheReturns) {
  write("walls.pcd", twoWalls());
  EXPECT_EQ(run("walls.pcd --tolerance 0.3").out.find("note"), std::string::npos);
  const Outcome outcome = run("walls.pcd --tolerance 300");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_NE(outcome.out.find("more than half of these returns: is it the ground (see --ground)"), std::string::npos)
      << outcome.out;
}

TEST_F(LiscoCluster, KeepsForeignFiles) {
  write("walls.pcd", twoWalls());
  fs::create_directory(folder_ / "mine");
  write("mine/clusters.csv", "my own table");
  expectRefusal("walls.pcd --tolerance 0.3 -o mine", {"clusters.csv", "not written by this program"});
  EXPECT_EQ(textOf(folder_ / "mine/clusters.csv"), "my own table");

  // A folder with other files is accepted, and results of an earlier run are replaced.
  fs::create_directory(folder_ / "shared");
  write("shared/notes.txt", "keep me");
  EXPECT_EQ(run("walls.pcd --tolerance 0.3 -o shared").status, 0);
  EXPECT_EQ(run("walls.pcd --tolerance 0.3 -o shared").status, 0);
  EXPECT_EQ(textOf(folder_ / "shared/notes.txt"), "keep me");
}

TEST_F(LiscoCluster, ReplacesOnlyFilesThatItHasWritten) {
  // The scan itself has a name of results, and lies where they go.
  fs::create_directories(folder_ / "own/clusters");
  const std::string scan = twoWalls();
  write("own/labels.pcd", scan);
  const std::vector<std::string> foreign{"labels.label",
                                         "view.html",
                                         "capture.pcap",
                                         "poses.csv",
                                         "clusters/cluster_truth.pcd",
                                         "clusters/cluster_0001.pcd"};
  for (const std::string& file : foreign) write("own/" + file, "mine");
  const std::string options = " --tolerance 0.3 --ground none -o own --write ";
  for (int i = 0; i < 2; ++i) ASSERT_EQ(run("own/labels.pcd" + options + "table").status, 0);
  for (const char* kind : {"labels", "semantickitti", "view", "clouds"})
    expectRefusal("own/labels.pcd" + options + "table," + kind, {"own/", "not written by this program"});
  EXPECT_EQ(runLine(std::string(LISCO_SIMULATE) + " --terrain plane --sensor vlp16 --steps 100 -o own").status, 2);
  EXPECT_EQ(textOf(folder_ / "own/labels.pcd"), scan);
  for (const std::string& file : foreign) EXPECT_EQ(textOf(folder_ / "own" / file), "mine") << file;
  // It is found in the folder, where the table is none.
  const Outcome found = run("own --tolerance 0.3 --ground none");
  EXPECT_EQ(found.status, 0) << found.err;
  EXPECT_EQ(found.out.rfind("labels.pcd\n", 0), 0U) << found.out;
  // A run that is refused leaves no list of files.
  fs::create_directory(folder_ / "other");
  write("other/clusters.csv", "mine");
  expectRefusal("own/labels.pcd --tolerance 0.3 -o other", {"clusters.csv", "not written by this program"});
  EXPECT_FALSE(fs::exists(folder_ / "other/.lisco_results"));
}

TEST_F(LiscoCluster, RemovesNothingOutsideItsFolder) {
  write("walls.pcd", twoWalls());
  write("precious.txt", "mine");
  fs::create_directory(folder_ / "results");
  write("results/.lisco_results",
        "These files:\nlisco_cluster ../precious.txt\nlisco_cluster a/../../precious.txt\n"
        "lisco_cluster " +
            (folder_ / "precious.txt").string() + "\nlisco_cluster \nlisco_cluster .\n");
  EXPECT_EQ(run("walls.pcd --tolerance 0.3 --ground none --write table -o results").status, 0);
  EXPECT_EQ(textOf(folder_ / "precious.txt"), "mine");
  EXPECT_TRUE(fs::exists(folder_ / "results/clusters.csv"));
}

TEST_F(LiscoCluster, WritesIntoItsFolderWhateverTheNamesOfScans) {
  fs::create_directory(folder_ / "scans");
  for (const char* name : {"...pcd", ".pcd", "view.html.pcd", "b.pcd"}) write(std::string("scans/") + name, twoWalls());
  const Outcome outcome = run("scans --tolerance 0.3 --write table,view -o out/results");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder_ / "out/results"))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::count_if(names.begin(), names.end(), [](const auto& name) { return name.rfind("scan", 0) == 0; }), 2);
  EXPECT_EQ(std::count(names.begin(), names.end(), "b") + std::count(names.begin(), names.end(), "view.html"), 2);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "out"), fs::directory_iterator()), 1) << "results alone";
}

TEST_F(LiscoCluster, ContinuesAfterABadFile) {
  write("a.pcd", twoWalls());
  write("b.bin", "odd");
  write("c.pcd", twoWalls());
  fs::create_directory(folder_ / "sub");
  write("sub/a.pcd", twoWalls());
  fs::create_directory(folder_ / "hollow");
  const Outcome outcome = run("a.pcd hollow c.pcd sub b.bin --tolerance 0.3 -o results");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("b.bin"), std::string::npos);
  EXPECT_NE(outcome.err.find("hollow: holds no scans"), std::string::npos);
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 2) << outcome.err;
  for (const char* made : {"a", "c", "a-2"}) EXPECT_TRUE(fs::exists(folder_ / "results" / made / "labels.pcd")) << made;
  EXPECT_FALSE(fs::exists(folder_ / "results/b"));
}

TEST_F(LiscoCluster, WritesEachInputToItsOwnFolder) {
  write("x.pcd", twoWalls());
  write("x-2.pcd", twoWalls());
  write("x.bin", floats({5, 0, 0, 1}));
  const Outcome outcome = run(". --tolerance 0.3 -o results");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  for (const char* made : {"x", "x-2", "x-3"})
    EXPECT_TRUE(fs::exists(folder_ / "results" / made / "labels.pcd")) << made;
}

TEST_F(LiscoCluster, ShowsSeveralInputsOnOnePage) {
  for (const char* name : {"a.pcd", "b.pcd", "c.pcd"}) write(name, twoWalls());
  const auto scansOf = [this](const std::string& page) {
    const std::string text = textOf(folder_ / page);
    std::size_t scans = 0;
    for (std::size_t at = 0; (at = text.find("class=\"scan\">", at)) != std::string::npos; ++at) ++scans;
    return scans;
  };
  const Outcome outcome = run(". --tolerance 0.3 --threads 2 -o results");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("results/view.html shows 3 scans\n"), std::string::npos) << outcome.out;
  EXPECT_EQ(scansOf("results/view.html"), 3U);
  EXPECT_EQ(scansOf("results/a/view.html"), 1U);
  EXPECT_EQ(run("a.pcd b.pcd --tolerance 0.3 -o results").status, 0);
  EXPECT_EQ(scansOf("results/view.html"), 2U);
  EXPECT_EQ(run("a.pcd b.pcd --tolerance 0.3 --write table -o tables").status, 0);
  EXPECT_FALSE(fs::exists(folder_ / "tables/view.html"));
  write("results/view.html", "my own page");
  expectRefusal("a.pcd b.pcd --tolerance 0.3 -o results", {"view.html"});
  EXPECT_EQ(textOf(folder_ / "results/view.html"), "my own page");
}

TEST_F(LiscoCluster, WritesBesideItsInput) {
  write("x.pcd", twoWalls());
  for (int time = 0; time < 2; ++time) {
    const Outcome outcome = run(". --tolerance 0.3 -o .");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.out.rfind("x.pcd\n", 0), 0U) << outcome.out;
  }
}

TEST_F(LiscoCluster, WritesAnyCoordinates) {
  write("far.pcd",
        "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\n"
        "POINTS 2\nDATA ascii\n3e38 1e30 -3e38\n-3e38 -3e38 -3e38\n");
  ASSERT_EQ(run("far.pcd --tolerance 0.3 --min-size 1 -o results").status, 0);
  const std::string table = textOf(folder_ / "results/clusters.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 3);
  EXPECT_EQ(std::count(table.begin(), table.end(), ','), 3 * 19);
}

TEST_F(LiscoCluster, DrawsScansOfAnyShape) {
  std::string header = "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nVIEWPOINT 0 0 0 1 0 0 0\n";
  const std::string data = floats(std::vector<float>(3U * 80000U, 1.5F));
  write("wide.pcd", header + "WIDTH 40000\nHEIGHT 2\nPOINTS 80000\nDATA binary\n" + data);
  write("tall.pcd", header + "WIDTH 1\nHEIGHT 80000\nPOINTS 80000\nDATA binary\n" + data);
  const Outcome outcome = run("wide.pcd tall.pcd --tolerance 0.3 -o results");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(fs::exists(folder_ / "results/tall/range_image.png"));
}

TEST_F(LiscoCluster, GivesEqualResultsOnAnyNumberOfThreads) {
  for (const char* name : {"a.pcd", "b.pcd", "c.pcd", "d.pcd", "e.pcd"}) write(name, twoWalls());
  ASSERT_EQ(run(". --tolerance 0.3 -o one").status, 0);
  for (const char* threads : {"3", "0"}) {
    const std::string folder = std::string("with_") + threads;
    const Outcome outcome =
        run("a.pcd b.pcd c.pcd d.pcd e.pcd --tolerance 0.3 --threads " + std::string(threads) + " -o " + folder);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    for (const char* name : {"a", "b", "c", "d", "e"})
      for (const char* result : {"labels.pcd", "clusters.csv", "range_image.png", "top_view.png", "view.html"})
        EXPECT_EQ(textOf(folder_ / folder / name / result), textOf(folder_ / "one" / name / result))
            << name << ' ' << result;
  }
}

TEST_F(LiscoCluster, ReportsScansInTheOrderOfTheInputsOnAnyNumberOfThreads) {
  // The first takes longer than the others.
  const std::string header = "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";
  write("a.pcd",
        header + "WIDTH 300000\nHEIGHT 1\nPOINTS 300000\nDATA binary\n" + floats(std::vector<float>(900000U, 1.5F)));
  std::string inputs = "a.pcd";
  for (const char* name : {"b.pcd", "broken.pcd", "c.pcd", "d.pcd", "e.pcd"}) {
    write(name, name[1] == 'r' ? "no cloud" : twoWalls());
    inputs += std::string(" ") + name;
  }
  const auto scansIn = [](const Outcome& outcome) {
    std::string scans;
    std::istringstream lines(outcome.out);
    for (std::string line; std::getline(lines, line);) scans += nlohmann::json::parse(line)["scan"].get<std::string>();
    return scans;
  };
  std::string bag;
  for (const char* threads : {"1", "4"}) {
    const Outcome outcome = run(inputs + " --tolerance 0.3 --json --bag out.mcap --threads " + threads);
    EXPECT_EQ(outcome.status, 2) << outcome.err;
    EXPECT_EQ(scansIn(outcome), "a.pcdb.pcdc.pcdd.pcde.pcd") << threads;
    if (bag.empty()) bag = textOf(folder_ / "out.mcap");
    EXPECT_EQ(textOf(folder_ / "out.mcap"), bag) << threads;
  }
}

TEST_F(LiscoCluster, TakesTheFirstOfEveryFewFiles) {
  for (const char* name : {"a.pcd", "b.pcd", "c.pcd", "d.pcd", "e.pcd"}) write(name, twoWalls());
  const Outcome outcome = run(". --tolerance 0.3 --every 2");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  for (const char* name : {"a", "b", "c", "d", "e"})
    EXPECT_EQ(outcome.out.find(std::string(name) + ".pcd\n") != std::string::npos, (name[0] - 'a') % 2 == 0) << name;
}

TEST_F(LiscoCluster, SaysWhichSizesAreWanted) {
  write("walls.pcd", twoWalls());
  const Outcome outcome = run("walls.pcd --tolerance 0.3 --ground none --max-size 20");
  EXPECT_NE(outcome.out.find(" of 10 to 20 returns within 0.3 m of each other; "), std::string::npos) << outcome.out;
  EXPECT_NE(outcome.out.find(" returns are noise or in larger ones\n"), std::string::npos) << outcome.out;
  const auto json = [this](const std::string& options) {
    return nlohmann::json::parse(run("walls.pcd --tolerance 0.3 --json" + options).out);
  };
  EXPECT_EQ(json(" --max-size 20")["max_size"], 20);
  EXPECT_FALSE(json("").contains("max_size"));
}

TEST_F(LiscoCluster, KeepsAllDigitsOfTheViewpoint) {
  const std::string viewpoint = "VIEWPOINT 500123.469 5412345.5 0.123456791 0.707106769 0 0 -0.707106769\n";
  write("map.pcd", boost::replace_all_copy(twoWalls(), "VIEWPOINT 0 0 0 1 0 0 0\n", viewpoint));
  ASSERT_EQ(run("map.pcd --tolerance 0.3 -o results --write labels").status, 0);
  const std::string labels = textOf(folder_ / "results/labels.pcd");
  EXPECT_NE(labels.find(viewpoint), std::string::npos) << labels.substr(0, 300);
}

TEST_F(LiscoCluster, RefusesAViewpointThatIsNotSevenNumbers) {
  for (const char* wrong : {"nan nan nan 1 0 0 0", "1 2 x 1 0 0 0", "1 2 1e99 1 0 0 0", "0 0 0", "0 0 0 1 0 0 0 0"}) {
    write("walls.pcd",
          boost::replace_all_copy(twoWalls(), "VIEWPOINT 0 0 0 1 0 0 0", std::string("VIEWPOINT ") + wrong));
    expectRefusal("walls.pcd --tolerance 0.3", {"walls.pcd", "VIEWPOINT"});
  }
}

TEST_F(LiscoCluster, ScanWithoutAnyReturnHasNoClusters) {
  write("none.pcd",
        "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 2\nVIEWPOINT 0 0 0 "
        "1 0 0 0\n"
        "POINTS 4\nDATA ascii\nnan nan nan\n0 0 0\n0 0 0\nnan nan nan\n");
  const Outcome outcome = run("none.pcd --tolerance 0.3 -o results");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("0 returns"), std::string::npos) << outcome.out;
  EXPECT_TRUE(fs::exists(folder_ / "results/labels.pcd"));
}

TEST_F(LiscoCluster, PrintsHelpAndVersion) {
  const Outcome help = run("--help");
  EXPECT_EQ(help.status, 0);
  for (const char* option :
       {"--tolerance", "--min-size", "--max-size", "--ground-z", "--output", "--clouds", "--threads", "--ground",
        "--min-range", "--max-range", "--ignore-box", "--write", "--json"})
    EXPECT_NE(help.out.find(option), std::string::npos) << option;
  EXPECT_EQ(run("--version").out.rfind("lisco_cluster " LISCO_VERSION, 0), 0U);
}

}  // namespace
