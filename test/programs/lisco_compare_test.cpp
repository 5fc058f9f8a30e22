// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// lisco_compare, run as a program.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "lisco/version.h"
#include "program_test.h"

namespace {

namespace fs = std::filesystem;

struct LabelledPoint {
  float x, y, z;
  unsigned label = 0;
};
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr double kDegree = 3.14159265358979323846 / 180;

/// A scan as an organized ASCII PCD, row by row.
std::string pcdOf(const std::vector<LabelledPoint>& points, std::size_t rows, bool with_labels = false) {
  std::ostringstream pcd;
  pcd.precision(9);
  pcd << "VERSION 0.7\nFIELDS x y z" << (with_labels ? " label" : "") << "\nSIZE 4 4 4" << (with_labels ? " 4" : "")
      << "\nTYPE F F F" << (with_labels ? " U" : "") << "\nCOUNT 1 1 1" << (with_labels ? " 1" : "") << "\nWIDTH "
      << points.size() / rows << "\nHEIGHT " << rows << "\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " << points.size()
      << "\nDATA ascii\n";
  for (const LabelledPoint& p : points) {
    if (std::isnan(p.x))
      pcd << "nan nan nan";
    else
      pcd << p.x << ' ' << p.y << ' ' << p.z;
    if (with_labels) pcd << ' ' << p.label;
    pcd << '\n';
  }
  return pcd.str();
}

LabelledPoint polar(double range, double azimuth, double elevation, unsigned label = 0) {
  return {static_cast<float>(range * std::cos(elevation * kDegree) * std::cos(azimuth * kDegree)),
          static_cast<float>(range * std::cos(elevation * kDegree) * std::sin(azimuth * kDegree)),
          static_cast<float>(range * std::sin(elevation * kDegree)), label};
}

/// A turn of 4 x 180 cells: three walls of 3 x 20 returns (labels 5, 6 and 7) 6 m away over a row of ground 2 m below.
/// The first two walls are 3 steps, 0.6 m, apart; the third is alone.
std::string threeWalls(bool with_labels = false) {
  std::vector<LabelledPoint> points;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 180; ++column) {
      const bool wall[3] = {column >= 10 && column < 30, column >= 32 && column < 52, column >= 100 && column < 120};
      const auto at = std::find(wall, wall + 3, true) - wall;
      if (row == 3)
        points.push_back(polar(10, 2 * column, -12));
      else if (at < 3)
        points.push_back(polar(6, 2 * column, 1 - row, 5 + static_cast<unsigned>(at)));
      else
        points.push_back({kNan, kNan, kNan});
    }
  return pcdOf(points, 4, with_labels);
}

/// Two rows of ten returns, one exactly below the other, but 12 columns later: a staggered sensor.
std::vector<LabelledPoint> staggeredRows() {
  std::vector<LabelledPoint> points(2 * 720, {kNan, kNan, kNan});
  for (std::size_t i = 0; i < 10; ++i) {
    const double azimuth = 150 + 0.5 * static_cast<double>(i);
    points[300 + i] = polar(10, azimuth, 0);
    points[720 + 312 + i] = polar(10, azimuth, -1);
  }
  return points;
}

const std::vector<std::string> kTitles{"PCL, KdTree (false)", "PCL, KdTree as in its tutorial", "PCL, Octree",
                                       "voxel grid",          "Lisco as in the paper",          "Lisco for PCL"};

class LiscoCompare : public ProgramTest {
 protected:
  LiscoCompare() : ProgramTest(LISCO_COMPARE) {}

  void writeScan() const { write("walls.pcd", threeWalls()); }
  nlohmann::json jsonIn(const std::string& name) const { return nlohmann::json::parse(textOf(folder_ / name)); }

  static std::size_t linesOf(const std::string& text) {
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
  }
  static std::size_t countOf(const std::string& part, const std::string& text) {
    std::size_t count = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++count;
    return count;
  }
  static void expectSaid(const std::string& part, const std::string& text) {
    EXPECT_NE(text.find(part), std::string::npos) << "missing: " << part << "\n" << text;
  }
  /// Whether a table has a line with this title whose other columns match a regular expression.
  static bool tableSays(const std::string& text, const std::string& title, const std::string& rest) {
    std::string escaped;
    for (const char c : title) escaped += (c == '(' || c == ')') ? std::string("\\") + c : std::string(1, c);
    return std::regex_search(text, std::regex("\n  " + escaped + " +" + rest + "\n"));
  }
};

const std::string kTimed = "2( +[0-9.]+){4}";
const std::string kNotTimed = "-( +-){4}";

TEST_F(LiscoCompare, ShowsThatTheClustersAreIdentical) {
  writeScan();
  const Outcome outcome = run("walls.pcd --tolerance 0.3 --ground-z -1.5 --runs 2");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.err, "");
  expectSaid("\nwalls.pcd: 4 rows x 180 columns, 180 returns above -1.5 m, clusters of at least 10\n", outcome.out);
  expectSaid("\n  tolerance 0.3 m: 3 clusters\n", outcome.out);
  EXPECT_TRUE(tableSays(outcome.out, kTitles[0], "2 +[0-9.]+ +[0-9.]+ +[0-9.]+ +1\\.00  reference")) << outcome.out;
  for (std::size_t i = 1; i < kTitles.size(); ++i)
    EXPECT_TRUE(tableSays(outcome.out, kTitles[i], kTimed + "  identical")) << kTitles[i] << outcome.out;
  EXPECT_EQ(outcome.out.find("DIFFERENT"), std::string::npos);
  EXPECT_EQ(outcome.out.find("true objects"), std::string::npos);
  for (const std::string& title : kTitles) EXPECT_EQ(countOf(title + " ", outcome.out), 1U) << title;
  EXPECT_EQ(filesLeft(), std::vector<std::string>({"walls.pcd"}));
}

TEST_F(LiscoCompare, ComparesAtEachTolerance) {
  writeScan();
  const Outcome outcome = run("walls.pcd --tolerance 0.1,0.3,0.7 --ground-z -1.5 --runs 2 --min-size 20");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  expectSaid("tolerance 0.1 m: 0 clusters\n", outcome.out);
  expectSaid("tolerance 0.3 m: 3 clusters\n", outcome.out);
  expectSaid("tolerance 0.7 m: 2 clusters\n", outcome.out);
  expectSaid("clusters of at least 20\n", outcome.out);
  EXPECT_EQ(countOf("  identical\n", outcome.out), 15U);
  EXPECT_TRUE(std::regex_search(outcome.out, std::regex("\nvoxel grid +3/3( +[0-9.]+){4}\n"))) << outcome.out;
}

TEST_F(LiscoCompare, ReadsFoldersAndManyInputs) {
  for (const char* folder : {"one", "two"}) fs::create_directory(folder_ / folder);
  write("one/b.pcd", threeWalls());
  write("one/a.pcd", threeWalls());
  write("two/a.bin", floats({5, 0, 0, 1, 5, 0.1F, 0, 1, 9, 0, 0, 1}));
  write("single.pcd", threeWalls());
  const Outcome outcome =
      run("one two single.pcd --tolerance 0.3 --check-only --min-size 1 --baselines pcl,lisco --json all.json");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  const auto json = jsonIn("all.json");
  std::vector<std::string> names;
  for (const auto& input : json["inputs"]) names.push_back(input["name"]);
  EXPECT_EQ(names, std::vector<std::string>({"a", "b", "a-2", "single"}));
  EXPECT_EQ(json["inputs"][2]["file"], "two/a.bin");
  EXPECT_EQ(json["inputs"][2]["returns"], 3);
  EXPECT_EQ(json["inputs"][2]["cases"][0]["clusters"], 2);
  expectSaid("two/a.bin: unorganized, 3 returns, clusters of at least 1\n", outcome.out);
}

TEST_F(LiscoCompare, WritesJson) {
  writeScan();
  for (const char* runs : {"3", "2"}) {  // the second run replaces the file
    ASSERT_EQ(run(std::string("walls.pcd --tolerance 0.3,0.7 --ground-z -1.5 --json walls.json --runs ") + runs).status,
              0);
    const auto json = jsonIn("walls.json");
    EXPECT_EQ(json["program"], "lisco_compare");
    EXPECT_EQ(json["version"], LISCO_VERSION);
    EXPECT_EQ(json["runs"], std::stoi(runs));
    EXPECT_EQ(json["min_size"], 10);
    EXPECT_EQ(json["unorganized"], false);
    EXPECT_TRUE(json["failures"].empty());
    ASSERT_EQ(json["inputs"].size(), 1U);
    const auto& input = json["inputs"][0];
    EXPECT_EQ(input["name"], "walls");
    EXPECT_EQ(input["rows"], 4);
    EXPECT_EQ(input["columns"], 180);
    EXPECT_EQ(input["returns"], 180);
    EXPECT_EQ(input["ground_method"], "height:-1.5");
    EXPECT_EQ(input["ground_z"], -1.5);
    EXPECT_TRUE(input["ground"].is_number_unsigned());
    ASSERT_EQ(input["cases"].size(), 2U);
    EXPECT_EQ(input["cases"][1]["tolerance"], 0.7);
    EXPECT_EQ(input["cases"][1]["clusters"], 2);
    for (const auto& one : input["cases"]) {
      ASSERT_EQ(one["baselines"].size(), 6U);
      for (const auto& baseline : one["baselines"]) {
        EXPECT_EQ(baseline["identical"], true);
        EXPECT_EQ(baseline["must_agree"], baseline["baseline"] == "lisco");
        EXPECT_EQ(baseline["times_ms"].size(), static_cast<std::size_t>(std::stoi(runs)));
        EXPECT_GT(baseline["ratio"].get<double>(), 0);
        double sum = 0;
        for (const auto& time : baseline["times_ms"]) sum += time.get<double>();
        EXPECT_NEAR(baseline["mean_ms"].get<double>(), sum / std::stoi(runs), 1e-9);
      }
    }
  }
  EXPECT_EQ(filesLeft(), std::vector<std::string>({"walls.json", "walls.pcd"}));
}

TEST_F(LiscoCompare, WritesCsv) {
  write("my, \"own\" walls.pcd", threeWalls());
  for (int time = 0; time < 2; ++time)
    ASSERT_EQ(run("'my, \"own\" walls.pcd' --tolerance 0.3,0.7 --ground-z -1.5 --csv walls.csv --runs 2").status, 0);
  const std::string csv = textOf(folder_ / "walls.csv");
  EXPECT_EQ(linesOf(csv), 1U + 2U * 6U);
  EXPECT_EQ(csv.rfind("input,rows,columns,returns,ground_z,tolerance,min_size,reference_clusters,baseline,clusters,"
                      "identical,mislabelled,runs,mean_ms,",
                      0),
            0U)
      << csv;
  EXPECT_EQ(countOf("\n\"my, \"\"own\"\" walls\",4,180,180,-1.5,0.3,10,3,", csv), 6U) << csv;
  EXPECT_EQ(countOf("\n\"my, \"\"own\"\" walls\",4,180,180,-1.5,0.7,10,2,lisco,2,yes,0,2,", csv), 1U) << csv;
  // Each line has as many cells as the first, but for the comma in the name.
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  const std::size_t commas = countOf(",", line);
  while (std::getline(lines, line)) EXPECT_EQ(countOf(",", line), commas + 1) << line;
}

TEST_F(LiscoCompare, KeepsForeignFiles) {
  writeScan();
  write("mine.json", "{\"my own\": \"notes\"}");
  write("mine.csv", "input,rows\n");
  write("empty.csv", "");
  fs::create_directory(folder_ / "folder");
  const std::string options = "walls.pcd --tolerance 0.3 --runs 2 ";
  expectRefusal(options + "--json mine.json", {"mine.json", "not written by this program"});
  expectRefusal(options + "--csv mine.csv", {"mine.csv", "not written by this program"});
  expectRefusal(options + "--csv empty.csv", {"empty.csv", "not written by this program"});
  expectRefusal(options + "--csv walls.pcd", {"walls.pcd", "not written by this program"});
  expectRefusal(options + "--view mine.csv", {"mine.csv", "not written by this program"});
  expectRefusal(options + "--json folder", {"folder", "is no file"});
  EXPECT_EQ(textOf(folder_ / "mine.json"), "{\"my own\": \"notes\"}");
  EXPECT_EQ(textOf(folder_ / "mine.csv"), "input,rows\n");
  EXPECT_EQ(textOf(folder_ / "walls.pcd"), threeWalls());
}

void expectPng(const fs::path& file) {
  SCOPED_TRACE(file);
  std::ifstream stream(file, std::ios::binary);
  const std::string png{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  ASSERT_GT(png.size(), 5000U);
  EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
}

TEST_F(LiscoCompare, DrawsCharts) {
  write("a.pcd", threeWalls());
  write("it's b.pcd", threeWalls());
  for (int time = 0; time < 2; ++time) {
    const Outcome outcome = run("a.pcd \"it's b.pcd\" -t 0.3,0.7 --runs 2 --plot \"charts/of 'all\"");
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const fs::path folder = folder_ / "charts/of 'all";
    std::vector<std::string> drawn;
    for (const auto& entry : fs::directory_iterator(folder)) drawn.push_back(entry.path().filename().string());
    std::sort(drawn.begin(), drawn.end());
    EXPECT_EQ(drawn, std::vector<std::string>({".lisco_results", "time_over_points_0.3.png", "time_over_points_0.3.svg",
                                               "time_over_points_0.7.png", "time_over_points_0.7.svg",
                                               "time_over_tolerance.png", "time_over_tolerance.svg",
                                               "time_over_tolerance_a.png", "time_over_tolerance_a.svg",
                                               "time_over_tolerance_it's b.png", "time_over_tolerance_it's b.svg"}));
    for (const std::string& name : drawn) {
      const std::string suffix = fs::path(name).extension().string();
      if (suffix == ".png") {
        expectPng(folder / name);
      } else if (suffix == ".svg") {
        EXPECT_NE(textOf(folder / name).find("</svg>"), std::string::npos) << name;
      }
    }
  }
}

TEST_F(LiscoCompare, KeepsForeignCharts) {
  writeScan();
  fs::create_directory(folder_ / "mine");
  write("mine/time_over_tolerance_walls.png", "my own");
  expectRefusal("walls.pcd -t 0.3 --runs 2 --plot mine",
                {"mine/time_over_tolerance_walls.png", "not written by this program"});
  EXPECT_EQ(textOf(folder_ / "mine/time_over_tolerance_walls.png"), "my own");
  // A folder with other files is accepted.
  fs::create_directory(folder_ / "shared");
  write("shared/notes.txt", "keep me");
  EXPECT_EQ(run("walls.pcd -t 0.3 --runs 2 --plot shared").status, 0);
  EXPECT_EQ(textOf(folder_ / "shared/notes.txt"), "keep me");
  expectPng(folder_ / "shared/time_over_tolerance_walls.png");
  write("file", "");
  expectRefusal("walls.pcd -t 0.3 --runs 2 --plot file", {"file", "cannot be written"});
  expectRefusal("walls.pcd -t 0.3 --runs 2 --plot file/charts", {"file/charts", "cannot be written"});
}

TEST_F(LiscoCompare, ReportsMissingGnuplot) {
  writeScan();
  const Outcome outcome = runLine("PATH=/nowhere " + program_ + " walls.pcd -t 0.3 --runs 2 --plot charts");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.err, "lisco_compare: charts need gnuplot (Debian's package gnuplot-nox)\n");
  EXPECT_EQ(outcome.out, "");
  EXPECT_FALSE(fs::exists(folder_ / "charts"));
}

TEST_F(LiscoCompare, DrawsNothingWithoutTimes) {
  writeScan();
  const Outcome outcome = run("walls.pcd -t 0.3 --runs 2 --baselines pcl-default --plot charts");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(filesLeft(), std::vector<std::string>({"charts", "charts/.lisco_results", "walls.pcd"}));
}

TEST_F(LiscoCompare, ComparesClustersOnlyWithCheckOnly) {
  writeScan();
  const Outcome outcome = run("walls.pcd -t 0.3 --check-only --csv walls.csv");
  EXPECT_EQ(outcome.status, 0);
  for (std::size_t i = 1; i < kTitles.size(); ++i)
    EXPECT_TRUE(tableSays(outcome.out, kTitles[i], kNotTimed + "  identical")) << outcome.out;
  EXPECT_EQ(outcome.out.find("runs of each"), std::string::npos);
  EXPECT_EQ(countOf(",yes,0,0,,,,,,,,,,,,,,,\n", textOf(folder_ / "walls.csv")), 6U) << textOf(folder_ / "walls.csv");
}

TEST_F(LiscoCompare, ComparesUnorganizedReturns) {
  writeScan();
  const Outcome outcome =
      run("walls.pcd -t 0.3 --runs 2 --ground-z -1.5 --unorganized --json walls.json --csv walls.csv");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  expectSaid("walls.pcd: unorganized, 180 returns above -1.5 m", outcome.out);
  for (std::size_t i = 1; i < kTitles.size(); ++i) {
    if (kTitles[i] != "Lisco as in the paper")
      EXPECT_TRUE(tableSays(outcome.out, kTitles[i], kTimed + "  identical")) << outcome.out;
    else
      EXPECT_TRUE(tableSays(outcome.out, kTitles[i], kNotTimed + "  not possible: needs an organized cloud"))
          << outcome.out;
  }
  const auto baseline = jsonIn("walls.json")["inputs"][0]["cases"][0]["baselines"][4];
  EXPECT_EQ(baseline["baseline"], "paper");
  EXPECT_EQ(baseline["failure"], "needs an organized cloud");
  EXPECT_EQ(linesOf(textOf(folder_ / "walls.csv")), 1U + 6U);
  EXPECT_EQ(countOf(",\"needs an organized cloud\"\n", textOf(folder_ / "walls.csv")), 1U);
  // A baseline that must agree and fails counts as a mismatch.
  EXPECT_EQ(run("walls.pcd -t 0.3 --check-only --unorganized --must-agree paper").status, 1);
}

TEST_F(LiscoCompare, RemovesTheGroundOfAllOrOfOne) {
  write("a.pcd", threeWalls());
  write("b.pcd", threeWalls());
  write("c=d.pcd", threeWalls());
  const auto returns = [&](const std::string& options) {
    EXPECT_EQ(run("a.pcd b.pcd c=d.pcd -t 0.3 --check-only --baselines pcl,lisco --json all.json " + options).status,
              0);
    std::vector<int> counts;
    const auto json = jsonIn("all.json");
    for (const auto& input : json["inputs"]) counts.push_back(input["returns"]);
    return counts;
  };
  EXPECT_EQ(returns(""), std::vector<int>({360, 360, 360}));
  EXPECT_EQ(returns("--ground-z -1.5"), std::vector<int>({180, 180, 180}));
  EXPECT_EQ(returns("--ground-z b=-1.5"), std::vector<int>({360, 180, 360}));
  EXPECT_EQ(returns("--ground-z b=-2.5 --ground-z -1.5"), std::vector<int>({180, 360, 180}));
  EXPECT_EQ(returns("--ground-z c=d=-1.5"), std::vector<int>({360, 360, 180}));
  EXPECT_EQ(returns("--ground-z e=-1.5"), std::vector<int>({360, 360, 360}));
  EXPECT_NE(run("a.pcd -t 0.3 --check-only --ground-z e=-1.5").err.find("--ground-z names 'e', which is no input"),
            std::string::npos);
}

TEST_F(LiscoCompare, LeavesOutReturnsByMethodRangeAndPlace) {
  writeScan();
  const auto returns = [&](const std::string& options) {
    EXPECT_EQ(run("walls.pcd -t 0.3 --check-only --baselines pcl,lisco --json all.json " + options).status, 0);
    return static_cast<int>(jsonIn("all.json")["inputs"][0]["returns"]);
  };
  EXPECT_EQ(returns("--ground none"), 360);
  EXPECT_EQ(returns("--ground height:-1.5"), 180);
  EXPECT_EQ(returns("--ground walls=height:-1.5"), 180);
  EXPECT_EQ(returns("--min-range 8"), 180);
  EXPECT_EQ(returns("--max-range 8"), 180);
  EXPECT_EQ(returns("--ignore-box -20,-20,-3,20,20,-1"), 180);
  expectSaid("  ignored   180 returns (50 %) by range or place\n",
             run("walls.pcd -t 0.3 --check-only --min-range 8").out);
}

TEST_F(LiscoCompare, ScoresTrueObjects) {
  write("walls.pcd", threeWalls(true));
  const Outcome outcome =
      run("walls.pcd -t 0.1,0.3,0.7 --ground-z -1.5 --check-only --json walls.json --csv walls.csv");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  expectSaid("true objects: 3; 0 whole, 0 split, 0 merged with others, 3 missed\n", outcome.out);
  expectSaid("true objects: 3; 3 whole, 0 split, 0 merged with others, 0 missed\n", outcome.out);
  expectSaid("true objects: 3; 1 whole, 0 split, 2 merged with others, 0 missed\n", outcome.out);
  EXPECT_EQ(jsonIn("walls.json")["inputs"][0]["cases"][2]["objects"],
            nlohmann::json({{"count", 3}, {"whole", 1}, {"split", 0}, {"merged", 2}, {"missed", 0}}));
  EXPECT_EQ(countOf(",3,1,0,2,0,\n", textOf(folder_ / "walls.csv")), 6U);
  // Labels follow their returns.
  const Outcome unorganized = run("walls.pcd -t 0.3 --ground-z -1.5 --check-only --unorganized");
  expectSaid("true objects: 3; 3 whole, 0 split, 0 merged with others, 0 missed\n", unorganized.out);
}

TEST_F(LiscoCompare, LeavesOutReturnsByTheirLabel) {
  write("walls.pcd", threeWalls(true));
  const Outcome outcome = run("walls.pcd -t 0.3 --ground-z -1.5 --check-only --ignore-label 5");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  expectSaid("true objects: 2; 2 whole, 0 split, 0 merged with others, 0 missed\n", outcome.out);
  writeScan();
  expectRefusal("walls.pcd -t 0.3 --ignore-label -1", {"--ignore-label must be a whole number"});
}

TEST_F(LiscoCompare, ComparesFlannsTree) {
  writeScan();
  const Outcome outcome = run("walls.pcd -t 0.3 --check-only --baselines pcl,flann,lisco --must-agree flann,lisco");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  expectSaid("FLANN's tree, directly", outcome.out);
}

TEST_F(LiscoCompare, ReportsAMismatch) {
  const std::vector<LabelledPoint> points = staggeredRows();
  write("staggered.pcd", pcdOf(points, 2));
  const Outcome outcome = run("staggered.pcd -t 0.5 --runs 2 --must-agree lisco,paper --json found.json");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(outcome.err,
            "lisco_compare: staggered.pcd at 0.5 m: the clusters of Lisco as in the paper are not PCL's\n");
  // Not timed, as it must agree; the others are.
  EXPECT_TRUE(tableSays(outcome.out, "Lisco as in the paper", kNotTimed + "  DIFFERENT: 10 points, 2 clusters"))
      << outcome.out;
  EXPECT_TRUE(tableSays(outcome.out, "Lisco for PCL", kTimed + "  identical")) << outcome.out;
  expectSaid(
      "  Lisco as in the paper:\n    PCL finds 1 clusters, the method 2; 1 of PCL's are not among them; "
      "10 of 20 points differ\n",
      outcome.out);

  std::smatch first;
  ASSERT_TRUE(std::regex_search(
      outcome.out, first,
      std::regex("    first: point ([0-9]+) \\(([^,]*), ([^,]*), ([^)]*)\\) row ([0-9]+) column "
                 "([0-9]+): by PCL in cluster 1 \\(20 points\\), by the method in cluster [12] \\(10 points\\)\n")))
      << outcome.out;
  const std::size_t index = std::stoul(first[1]);
  ASSERT_TRUE(index == 300 || index == 720 + 312) << index;  // the first of one of the rows
  EXPECT_NEAR(std::stof(first[2]), points[index].x, 1e-4);
  EXPECT_NEAR(std::stof(first[3]), points[index].y, 1e-4);
  EXPECT_NEAR(std::stof(first[4]), points[index].z, 1e-4);
  EXPECT_EQ(std::stoul(first[5]), index / 720);
  EXPECT_EQ(std::stoul(first[6]), index % 720);
  // Five ahead and five below it, and the one right below; the nearest is next to it in its row, 0.0873 m away.
  expectSaid("    its 11 neighbours within 0.5 m, with their distances, clusters by PCL and clusters by the method: " +
                 std::to_string(index + 1) + " (0.0873 m, 1, ",
             outcome.out);

  std::smatch pair;
  ASSERT_TRUE(std::regex_search(outcome.out, pair,
                                std::regex("    the pair that decides: point ([0-9]+) .* and point ([0-9]+) .*, d2 = "
                                           "([0-9.]+), r2 = 0.25: neighbours, which the method keeps apart\n")))
      << outcome.out;
  const LabelledPoint a = points[std::stoul(pair[1])];
  const LabelledPoint b = points[std::stoul(pair[2])];
  EXPECT_NE(std::stoul(pair[1]) / 720, std::stoul(pair[2]) / 720);  // one of each row
  const float d2 = (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y) + (a.z - b.z) * (a.z - b.z);
  EXPECT_NEAR(std::stof(pair[3]), d2, 1e-6);
  EXPECT_LT(d2, 0.25F);

  const auto baseline = jsonIn("found.json")["inputs"][0]["cases"][0]["baselines"][4];
  EXPECT_EQ(baseline["baseline"], "paper");
  EXPECT_EQ(baseline["must_agree"], true);
  EXPECT_EQ(baseline["identical"], false);
  EXPECT_EQ(baseline["clusters"], 2);
  EXPECT_EQ(baseline["difference"]["mislabelled"], 10);
  EXPECT_EQ(baseline["difference"]["clusters"], 1);
  const std::string details = baseline["difference"]["details"];
  EXPECT_NE(details.find("point " + first[1].str() + " ("), std::string::npos);
  EXPECT_NE(details.find("neighbours, which the method keeps apart"), std::string::npos);
  EXPECT_FALSE(baseline.contains("times_ms"));
}

TEST_F(LiscoCompare, AcceptsAMismatchOfBaselinesThatNeedNotAgree) {
  write("staggered.pcd", pcdOf(staggeredRows(), 2));
  const Outcome outcome = run("staggered.pcd -t 0.5 --runs 2 --csv found.csv");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_TRUE(tableSays(outcome.out, "Lisco as in the paper", kTimed + "  DIFFERENT: 10 points, 2 clusters"))
      << outcome.out;
  EXPECT_EQ(countOf(",1,paper,2,no,10,2,", textOf(folder_ / "found.csv")), 1U) << textOf(folder_ / "found.csv");
  // Also without any baseline that must agree.
  EXPECT_EQ(run("staggered.pcd -t 0.5 --check-only --baselines pcl,paper").status, 0);
}

TEST_F(LiscoCompare, ReportsAMismatchWithNothingToDraw) {
  write("staggered.pcd", pcdOf(staggeredRows(), 2));
  const Outcome outcome = run("staggered.pcd -t 0.5 --runs 2 --baselines paper --must-agree paper --plot charts");
  EXPECT_EQ(outcome.status, 1) << outcome.err;
}

TEST_F(LiscoCompare, FailsOnOneMismatchAmongMany) {
  write("a.pcd", threeWalls());
  write("b.pcd", pcdOf(staggeredRows(), 2));
  write("c.pcd", threeWalls());
  EXPECT_EQ(run("a.pcd b.pcd c.pcd -t 0.5 --check-only --must-agree paper").status, 1);
  EXPECT_EQ(run("a.pcd b.pcd c.pcd -t 0.05,0.5 --check-only --must-agree paper").status, 1);
  EXPECT_EQ(run("a.pcd c.pcd -t 0.5 --check-only --must-agree paper").status, 0);
  // A mismatch takes precedence over an unreadable input.
  EXPECT_EQ(run("b.pcd missing.pcd -t 0.5 --check-only --must-agree paper").status, 1);
}

TEST_F(LiscoCompare, ShowsPclsDefaultWithoutTimingIt) {
  // Two walls before the sensor, which PCL takes for the view of a camera.
  std::vector<LabelledPoint> points;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 40; ++column)
      points.push_back(
          {column < 20 ? 5.0F : 9.0F, 0.1F * static_cast<float>(column - 20), 0.1F * static_cast<float>(row)});
  write("walls.pcd", pcdOf(points, 4));
  const Outcome outcome = run("walls.pcd -t 0.3 --runs 2 --baselines lisco,pcl-default,pcl");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_TRUE(tableSays(outcome.out, "Lisco for PCL", kTimed + "  identical"));
  EXPECT_EQ(outcome.out.find("voxel grid"), std::string::npos);
  EXPECT_EQ(outcome.err, "");  // PCL's own messages are silenced
}

TEST_F(LiscoCompare, RunsWithoutTheReference) {
  writeScan();
  const Outcome outcome = run("walls.pcd -t 0.3 --runs 2 --baselines grid,lisco --json walls.json");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_TRUE(tableSays(outcome.out, "Lisco for PCL", "2( +[0-9.]+){3} +-  identical")) << outcome.out;
  EXPECT_TRUE(jsonIn("walls.json")["inputs"][0]["cases"][0]["baselines"][1]["ratio"].is_null());
}

TEST_F(LiscoCompare, ContinuesAfterABadFile) {
  write("a.pcd", threeWalls());
  write("b.bin", "odd");
  write("none.pcd", pcdOf({{kNan, kNan, kNan}, {0, 0, 0}}, 1));
  write("c.pcd", threeWalls());
  fs::create_directory(folder_ / "hollow");
  const Outcome outcome =
      run("hollow a.pcd b.bin none.pcd missing.pcd c.pcd -t 0.3 --runs 2 --json all.json --csv all.csv --plot charts");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(linesOf(outcome.err), 4U) << outcome.err;
  expectSaid("lisco_compare: hollow: holds no scans\n", outcome.err);
  expectSaid(
      "lisco_compare: b.bin: is no cloud of floats: its size, 3 bytes, is no multiple of 12, 16, 20, ... or 64\n",
      outcome.err);
  expectSaid("lisco_compare: none.pcd: no returns to cluster\n", outcome.err);
  expectSaid("lisco_compare: missing.pcd: does not exist\n", outcome.err);
  expectSaid("\na.pcd: 4 rows", outcome.out);
  expectSaid("\nc.pcd: 4 rows", outcome.out);
  EXPECT_TRUE(std::regex_search(outcome.out, std::regex("\nLisco for PCL +2/2 ")));
  const auto json = jsonIn("all.json");
  EXPECT_EQ(json["inputs"].size(), 2U);
  ASSERT_EQ(json["failures"].size(), 4U);
  EXPECT_EQ(json["failures"][3], "missing.pcd: does not exist");
  EXPECT_EQ(linesOf(textOf(folder_ / "all.csv")), 1U + 2U * 6U);
  for (const char* chart : {"_tolerance_a", "_tolerance_c", "_tolerance", "_points_0.3"})
    expectPng(folder_ / ("charts/time_over" + std::string(chart) + ".png"));
}

TEST_F(LiscoCompare, AcceptsAnyScale) {
  std::vector<LabelledPoint> points;
  for (int i = 0; i < 12; ++i) points.push_back({1e-30F * static_cast<float>(i + 1), 1e-30F, 0});
  for (int i = 0; i < 12; ++i) points.push_back({1e17F, 0.1F * static_cast<float>(i), 1});
  write("odd.pcd", pcdOf(points, 2));
  for (const char* tolerance : {"0.3", "1e-60", "1e-12", "1e60"}) {
    const Outcome outcome = run(std::string("odd.pcd --check-only -t ") + tolerance);
    EXPECT_EQ(outcome.status, 0) << tolerance << outcome.err << outcome.out;
    EXPECT_EQ(outcome.err, "") << tolerance;
  }
}

TEST_F(LiscoCompare, RefusesBadOptionsInOneLine) {
  writeScan();
  fs::create_directory(folder_ / "hollow");
  const std::string scan = "walls.pcd --tolerance 0.3 --runs 2 ";
  expectRefusal("", {"no input"});
  expectRefusal("--tolerance 0.3", {"no input"});
  expectRefusal("walls.pcd", {"--tolerance is missing"});
  for (const char* tolerance :
       {"abc", "''", "0", "-0.3", "nan", "inf", "0.3m", "0.1,,0.3", "0.1,", ",", "0.1:0.3", "0.1,0"})
    expectRefusal(std::string("walls.pcd --tolerance ") + tolerance + " --json out.json", {"--tolerance must be"});
  for (const char* runs : {"0", "-1", "abc", "''", "2.5", "5000000000"})
    expectRefusal(std::string("walls.pcd --tolerance 0.3 --runs ") + runs,
                  {"--runs must be a whole number from 1 to 2147483647, not '"});
  for (const char* size : {"0", "-1", "ten"}) expectRefusal(scan + "--min-size " + size, {"--min-size must be"});
  for (const char* seconds : {"0", "-1", "nan", "x"})
    expectRefusal(scan + "--max-seconds " + seconds, {"--max-seconds must be"});
  expectRefusal(scan + "--baselines pcl,unknown",
                {"--baselines: there is no baseline 'unknown'", "pcl-octree", "lisco"});
  expectRefusal(scan + "--baselines ''", {"--baselines: there is no baseline ''"});
  expectRefusal(scan + "--must-agree unknown", {"--must-agree: there is no baseline 'unknown'", "paper"});
  expectRefusal(scan + "--baselines pcl,lisco --must-agree grid", {"--must-agree", "grid", "--baselines"});
  for (const char* ground : {"low", "nan", "walls=", "walls=low", "''"})
    expectRefusal(scan + "--ground-z " + ground, {"--ground-z must be a number"});
  expectRefusal(scan + "--json ''", {"--json is empty"});
  expectRefusal(scan + "--csv ''", {"--csv is empty"});
  expectRefusal(scan + "--plot ''", {"--plot is empty"});
  expectRefusal(scan + "--plot charts --check-only", {"--plot", "--check-only"});
  expectRefusal(scan + "--json same --csv same", {"--json", "--csv", "same"});
  expectRefusal(scan + "--csv same --view same", {"--view", "same"});
  expectRefusal(scan + "--view ''", {"--view is empty"});
  expectRefusal(scan + "--nonsense", {"nonsense"});
  expectRefusal("walls.pcd --tolerance", {"--tolerance"});
  expectRefusal("hollow --tolerance 0.3", {"hollow", "holds no scans"});
  expectRefusal(scan + "--ground-z 5", {"walls.pcd: no returns to cluster"});
}

TEST_F(LiscoCompare, ChecksOutputsBeforeTheRuns) {
  writeScan();
  for (const char* option : {"--json missing/out.json", "--csv missing/out.csv", "--json walls.pcd/out.json"}) {
    expectRefusal(std::string("walls.pcd -t 0.3 --runs 2 ") + option, {"/out.", "cannot be written"});
    EXPECT_EQ(run(std::string("walls.pcd -t 0.3 --runs 2 ") + option).out, "") << option;
  }
  EXPECT_EQ(run("walls.pcd -t 0.3 --runs 2 --plot walls.pcd/charts").out, "");
  EXPECT_EQ(run("walls.pcd -t 0.3 --runs 2 --json same --csv ./same").out, "");
}

TEST_F(LiscoCompare, AcceptsTheFormerNameOfBaselines) {
  writeScan();
  const Outcome outcome = run("walls.pcd -t 0.3 --check-only --rivals pcl,lisco");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out.find("voxel grid"), std::string::npos) << outcome.out;
  EXPECT_EQ(run("--help").out.find("rivals"), std::string::npos);
}

TEST_F(LiscoCompare, ShowsNoProgressInAPipe) {
  writeScan();
  const Outcome outcome = run("walls.pcd walls.pcd -t 0.3,0.7 --runs 2");
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(outcome.out.find('\r'), std::string::npos);
  EXPECT_EQ(outcome.out.find('\033'), std::string::npos);
}

TEST_F(LiscoCompare, PrintsHelpAndVersion) {
  const Outcome help = run("--help");
  EXPECT_EQ(help.status, 0);
  EXPECT_EQ(help.err, "");
  for (const char* option :
       {"--tolerance",  "--min-size",    "--ground-z", "--runs",      "--max-seconds", "--check-only", "--baselines",
        "--must-agree", "--unorganized", "--json",     "--csv",       "--plot",        "--help",       "--version",
        "Exit code",    "pcl-tutorial",  "pcl-octree", "pcl-default", "grid",          "paper"})
    EXPECT_NE(help.out.find(option), std::string::npos) << option;
  const Outcome version = run("--version");
  EXPECT_EQ(version.status, 0);
  EXPECT_EQ(version.out, "lisco_compare " LISCO_VERSION "\n");
}

}  // namespace
