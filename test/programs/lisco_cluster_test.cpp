// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// lisco_cluster, run as a program.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

#include "io/cloud_file.h"
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
  EXPECT_NE(outcome.out.find("4 rows x 41 columns, 160 returns, 120 above the ground"), std::string::npos)
      << outcome.out;
  EXPECT_NE(outcome.out.find("clusters  2 of at least 10"), std::string::npos) << outcome.out;

  EXPECT_EQ(textOf(folder_ / "results/clusters.csv"),
            "id,size,centroid_x,centroid_y,centroid_z,min_x,min_y,min_z,max_x,max_y,max_z,nearest_range\n"
            "1,60,5.0000,-1.0500,0.1000,5.0000,-2.0000,0.0000,5.0000,-0.1000,0.2000,5.0010\n"
            "2,60,9.0000,2.9500,0.1000,9.0000,2.0000,0.0000,9.0000,3.9000,0.2000,9.2195\n");
  for (const char* picture : {"range_image.png", "top_view.png"}) {
    SCOPED_TRACE(picture);
    const std::string png = textOf(folder_ / "results" / picture);
    ASSERT_GT(png.size(), 1000U);
    EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
  }
  const std::string labels = textOf(folder_ / "results/labels.pcd");
  EXPECT_NE(labels.find("FIELDS x y z label\n"), std::string::npos);
  EXPECT_NE(labels.find("WIDTH 41\nHEIGHT 4\n"), std::string::npos);
  EXPECT_FALSE(fs::exists(folder_ / "results/clusters"));

  // The binary part: x y z label of every cell, the walls labelled, ground and no-return 0.
  const std::string data = labels.substr(labels.find("DATA binary\n") + 12);
  ASSERT_EQ(data.size(), 164U * 16U);
  const auto label = [&data](std::size_t row, std::size_t column) {
    std::uint32_t value;
    std::memcpy(&value, data.data() + (row * 41 + column) * 16 + 12, 4);
    return value;
  };
  EXPECT_EQ(label(0, 0), 1U);
  EXPECT_EQ(label(2, 40), 2U);
  EXPECT_EQ(label(1, 20), 0U);
  EXPECT_EQ(label(3, 5), 0U);
}

TEST_F(LiscoCluster, WritesOneCloudPerClusterOnRequest) {
  write("walls.pcd", twoWalls());
  ASSERT_EQ(run("walls.pcd --tolerance 0.3 --ground-z -1.5 -o results --clouds").status, 0);
  for (const char* name : {"cluster_0001.pcd", "cluster_0002.pcd"})
    EXPECT_EQ(lisco_apps::readCloudFile(folder_ / "results/clusters" / name)->size(), 60U) << name;
  // A second run replaces the clouds; a run without clouds removes them and keeps foreign files.
  write("results/clusters/mine.txt", "keep me");
  ASSERT_EQ(run("walls.pcd --tolerance 0.3 --ground-z -1.5 -o results --clouds").status, 0);
  EXPECT_TRUE(fs::exists(folder_ / "results/clusters/cluster_0002.pcd"));
  ASSERT_EQ(run("walls.pcd --tolerance 0.3 --ground-z -1.5 -o results").status, 0);
  EXPECT_FALSE(fs::exists(folder_ / "results/clusters/cluster_0002.pcd"));
  EXPECT_EQ(textOf(folder_ / "results/clusters/mine.txt"), "keep me");
  fs::remove(folder_ / "results/clusters/mine.txt");
  ASSERT_EQ(run("walls.pcd --tolerance 0.3 --ground-z -1.5 -o results").status, 0);
  EXPECT_FALSE(fs::exists(folder_ / "results/clusters"));
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

  const auto csv = lisco_apps::readCloudFile(folder_ / "b.csv");
  EXPECT_NEAR(csv->at(0, 0).x, 5.0F, 1e-5F);
  EXPECT_NEAR(csv->at(1, 0).y, 5.0F * std::cos(1.5507963F), 1e-5F);
  EXPECT_NEAR(csv->at(1, 1).z, 9.0F * std::sin(0.1F), 1e-5F);
  EXPECT_TRUE(std::isnan(csv->at(0, 1).x));
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
  EXPECT_NE(outcome.out.find("more than half of these returns: is it the ground (see --ground-z)"), std::string::npos)
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
  EXPECT_EQ(std::count(table.begin(), table.end(), ','), 3 * 11);
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
       {"--tolerance", "--min-size", "--max-size", "--ground-z", "--output", "--clouds", "--threads"})
    EXPECT_NE(help.out.find(option), std::string::npos) << option;
  EXPECT_EQ(run("--version").out.rfind("lisco_cluster " LISCO_VERSION, 0), 0U);
}

}  // namespace
