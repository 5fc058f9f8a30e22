// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// What the rotations before say about range images for the next one.
#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

#include "core/far_history.h"

namespace lisco_test {
namespace {

constexpr lisco::FarHistory::Layout kLayout{2000, 64, 2000, 0.4F};
constexpr lisco::FarHistory::Content kContent{60'000, 10'000};

/// Rotations of one layout and content. \return for each, whether it may have had range images
std::vector<bool> rotate(lisco::FarHistory& history, std::size_t rotations, bool are_worthwhile) {
  std::vector<bool> tried;
  for (std::size_t i = 0; i < rotations; ++i) {
    tried.push_back(history.begin(kLayout));
    if (tried.back())
      history.recordTried(are_worthwhile, kContent);
    else
      history.recordLeftOut(kContent);
  }
  return tried;
}

/// Three rotations that are not worth images.
void refuse(lisco::FarHistory& history) {
  ASSERT_EQ(rotate(history, 3, false), std::vector<bool>(3, true));
}

TEST(FarHistory, LeavesOutImagesAfterThreeInTurnThatWereNotWorthIt) {
  lisco::FarHistory history;
  EXPECT_EQ(rotate(history, 2, false), std::vector<bool>(2, true));
  EXPECT_EQ(rotate(history, 3, true), std::vector<bool>(3, true));
  EXPECT_EQ(rotate(history, 5, false), std::vector<bool>({true, true, true, false, false}));
}

TEST(FarHistory, TriesThemAgainEverMoreSeldom) {
  lisco::FarHistory history;
  refuse(history);
  for (const std::size_t rest : {16, 32, 64, 64, 64}) {
    EXPECT_EQ(rotate(history, rest, false), std::vector<bool>(rest, false));
    EXPECT_EQ(rotate(history, 1, false), std::vector<bool>({true}));
  }
}

TEST(FarHistory, StartsAnewWhenTheyAreWorthIt) {
  lisco::FarHistory history;
  refuse(history);
  rotate(history, 16, false);
  EXPECT_EQ(rotate(history, 20, true), std::vector<bool>(20, true));
  refuse(history);
  EXPECT_EQ(rotate(history, 16, false), std::vector<bool>(16, false));
  EXPECT_TRUE(history.begin(kLayout));
}

TEST(FarHistory, StartsAnewWithAnotherLayout) {
  for (const lisco::FarHistory::Layout& other : {lisco::FarHistory::Layout{1400, 64, 2000, 0.4F},
                                                 {2800, 64, 2000, 0.4F},
                                                 {2000, 32, 2000, 0.4F},
                                                 {2000, 64, 1000, 0.4F},
                                                 {2000, 64, 2000, 0.5F}}) {
    lisco::FarHistory history;
    refuse(history);
    EXPECT_TRUE(history.begin(other));
  }
  lisco::FarHistory history;
  refuse(history);
  EXPECT_FALSE(history.begin({2003, 64, 2001, 0.4F})) << "rotations of a sensor differ in some columns";
  EXPECT_FALSE(history.begin({1998, 64, 2000, 0.4F}));
}

TEST(FarHistory, StartsAnewWithOtherContent) {
  for (const lisco::FarHistory::Content& other :
       {lisco::FarHistory::Content{40'000, 10'000}, {90'000, 10'000}, {60'000, 7'000}, {60'000, 14'000}}) {
    lisco::FarHistory history;
    refuse(history);
    EXPECT_FALSE(history.begin(kLayout));
    history.recordLeftOut(other);
    EXPECT_TRUE(history.begin(kLayout)) << other.returns << " returns, " << other.runs << " runs";
  }
  for (const lisco::FarHistory::Content& alike :
       {lisco::FarHistory::Content{55'000, 11'000}, {66'000, 9'000}, {60'000, 0}}) {
    lisco::FarHistory history;
    refuse(history);
    EXPECT_FALSE(history.begin(kLayout));
    history.recordLeftOut(alike);
    EXPECT_FALSE(history.begin(kLayout)) << alike.returns << " returns, " << alike.runs << " runs";
  }
}

}  // namespace
}  // namespace lisco_test
