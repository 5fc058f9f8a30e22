// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// The benchmark of ground filters, run as a program.
#include <algorithm>
#include <array>
#include <cstdio>
#include <sstream>
#include <string>
#include <vector>

#include "program_test.h"

namespace {

class GroundTruth : public ProgramTest {
 protected:
  GroundTruth() : ProgramTest(GROUND_TRUTH) {}

  /// Precision, recall, F1 and losses of a filter, per cent.
  struct Scores {
    double precision = 0, recall = 0, f1 = 0, lost = 0;
  };
  /// Of each filter, in the row that begins like this.
  static std::vector<Scores> scoresOf(const std::string& table, const std::string& row) {
    std::vector<Scores> all;
    const std::size_t begin = table.find("\n" + row);
    EXPECT_NE(begin, std::string::npos) << table;
    if (begin == std::string::npos) return all;
    std::istringstream cells(
        table.substr(begin + 1 + row.size(), table.find('\n', begin + 1) - begin - 1 - row.size()));
    for (std::string cell; std::getline(cells, cell, '|');) {
      Scores scores;
      if (std::sscanf(cell.c_str(), " %lf / %lf / **%lf** / %lf", &scores.precision, &scores.recall, &scores.f1,
                      &scores.lost) == 4)
        all.push_back(scores);
    }
    return all;
  }
};

TEST_F(GroundTruth, ScoresTheFilters) {
  const std::string options = " --sensors hdl32e --seeds 1 --rotations 1 --speed 0 --sway 0";
  const Outcome flat = run("--terrains plane,slope" + options);
  ASSERT_EQ(flat.status, 0) << flat.err;
  EXPECT_EQ(flat.err, "");
  const std::vector<Scores> on_plane = scoresOf(flat.out, "| plane | hdl32e |");
  const std::vector<Scores> on_slope = scoresOf(flat.out, "| slope | hdl32e |");
  ASSERT_EQ(on_plane.size(), 4U) << flat.out;
  ASSERT_EQ(on_slope.size(), 4U) << flat.out;
  for (const Scores& scores : on_plane) {
    EXPECT_NEAR(scores.f1, 2 * scores.precision * scores.recall / (scores.precision + scores.recall), 0.11);
    EXPECT_GE(scores.lost, 0);
    EXPECT_LE(scores.lost, 100);
  }
  // A height finds all of a plane and little of a slope; a plane finds both.
  EXPECT_GT(on_plane[0].recall, 99.9);
  EXPECT_LT(on_slope[0].f1, 70);
  EXPECT_GT(on_plane[1].f1, 95);
  EXPECT_GT(on_slope[1].f1, 95);
  EXPECT_GT(on_plane[3].f1, 95);
  for (const char* filter : {"height", "plane", "morphological", "Lisco"})
    EXPECT_NE(flat.out.find(std::string("\n| ") + filter + " | "), std::string::npos) << flat.out;

  const Outcome again = run("--only-lisco --details --terrains slope" + options);
  ASSERT_EQ(again.status, 0) << again.err;
  const std::vector<Scores> alone = scoresOf(again.out, "| slope | hdl32e |");
  ASSERT_EQ(alone.size(), 1U) << again.out;
  EXPECT_EQ(alone[0].f1, on_slope[3].f1);
  EXPECT_NE(again.out.find("\nsensor car "), std::string::npos) << again.out;
}

TEST_F(GroundTruth, FindsTheCrestsAndSlopesOfAField) {
  const Outcome outcome = run("--only-lisco --terrains field --sensors vls128 --seeds 7 --rotations 1");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::vector<Scores> scores = scoresOf(outcome.out, "| field | vls128 |");
  ASSERT_EQ(scores.size(), 1U) << outcome.out;
  EXPECT_GT(scores[0].f1, 95.5);
}

TEST_F(GroundTruth, RefusesUnknownNamesInOneLine) {
  expectRefusal("--terrains lake", {"lake"});
  expectRefusal("--sensors hdl65", {"hdl65"});
  expectRefusal("--seeds x", {"--seeds"});
  expectRefusal("--rotations 0", {"--rotations"});
  expectRefusal("stray", {"stray"});
}

TEST_F(GroundTruth, FindsFieldsWithTheHardestSensors) {
  const Outcome outcome = run("--terrains field --sensors vlp16,vls128 --only-lisco");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  for (const char* row : {"| field | vlp16 |", "| field | vls128 |"}) {
    const std::vector<Scores> scores = scoresOf(outcome.out, row);
    ASSERT_EQ(scores.size(), 1U) << outcome.out;
    EXPECT_GE(scores[0].f1, 93) << outcome.out;
    EXPECT_LE(scores[0].lost, 2) << outcome.out;
  }
}

}  // namespace
