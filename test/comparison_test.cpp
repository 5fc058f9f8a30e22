// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// The comparison behind lisco_compare: every kind of difference, the points that prove it, timing, and output files.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <regex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include <pcl/common/io.h>
#include <pcl/segmentation/extract_clusters.h>

#include "compare/comparison.h"
#include "compare/report.h"
#include "oracle.h"
#include "pcl_clouds.h"
#include "random.h"
#include "scans.h"

namespace lisco_test {
namespace {

using namespace lisco_apps;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr double kDegree = 3.14159265358979323846 / 180;

pcl::PointIndices clusterOf(const pcl::Indices& indices) {
  pcl::PointIndices cluster;
  cluster.indices = indices;
  return cluster;
}

Problem problemOf(const ComparedCloud::Ptr& cloud, double tolerance, unsigned min_size) {
  auto returns = std::make_shared<pcl::Indices>();
  for (std::size_t i = 0; i < cloud->size(); ++i)
    if (lisco::isReturn((*cloud)[i].x, (*cloud)[i].y, (*cloud)[i].z)) returns->push_back(static_cast<pcl::index_t>(i));
  Problem problem;
  problem.cloud = cloud;
  problem.returns = returns;
  problem.tolerance = tolerance;
  problem.min_size = min_size;
  return problem;
}

/// Two rows of six. Within 0.5 m of each other: A = {0, 1, 2, 6, 8} and B = {3, 4, 9, 10}; 5 is alone; 7 and 11 are no
/// returns.
///
///   x        1.0   1.4   1.8      5.0   5.4      9.0
///   y  0      0 --- 1 --- 2        3 --- 4        5
///      0.3    6     .     8        9 -- 10        .
Problem twoClusters() {
  auto cloud = std::make_shared<ComparedCloud>(6, 2);
  const std::vector<Point> points{{1, 0, 0},       {1.4F, 0, 0}, {1.8F, 0, 0},    {5, 0, 0},
                                  {5.4F, 0, 0},    {9, 0, 0},    {1, 0.3F, 0},    {kNan, kNan, 0},
                                  {1.8F, 0.3F, 0}, {5, 0.3F, 0}, {5.4F, 0.3F, 0}, {0, 0, 0}};
  for (std::size_t i = 0; i < points.size(); ++i) {
    (*cloud)[i].x = points[i].x;
    (*cloud)[i].y = points[i].y;
    (*cloud)[i].z = points[i].z;
  }
  cloud->header.frame_id = "lidar";
  cloud->header.stamp = 1234567;
  cloud->header.seq = 89;
  return problemOf(cloud, 0.5, 2);
}

/// A baseline that changes PCL's clusters of any size, then filters and sorts as PCL does.
Baseline spoilt(std::function<void(Clusters&)> spoil) {
  return {"spoilt", "a spoilt one", [spoil = std::move(spoil)](const Problem& problem, Clusters& clusters) {
            Problem any_size = problem;
            any_size.min_size = 1;
            any_size.max_size = Problem().max_size;
            Clusters all;
            referenceBaseline().extract(any_size, all);
            spoil(all);
            for (pcl::PointIndices& cluster : all) {
              if (cluster.indices.size() < problem.min_size || cluster.indices.size() > problem.max_size) continue;
              std::sort(cluster.indices.begin(), cluster.indices.end());
              clusters.push_back(cluster);
            }
            std::stable_sort(clusters.begin(), clusters.end(),
                             [](const auto& a, const auto& b) { return a.indices.size() > b.indices.size(); });
          }};
}

pcl::PointIndices& withPoint(Clusters& clusters, pcl::index_t index) {
  return *std::find_if(clusters.begin(), clusters.end(), [&](const pcl::PointIndices& cluster) {
    return std::count(cluster.indices.begin(), cluster.indices.end(), index) > 0;
  });
}

void moveAll(pcl::Indices& from, pcl::Indices& to) {
  to.insert(to.end(), from.begin(), from.end());
  from.clear();
}

Clusters extracted(const Baseline& baseline, const Problem& problem) {
  Clusters clusters;
  baseline.extract(problem, clusters);
  return clusters;
}

/// The pair given in the details.
struct NamedPair {
  std::size_t a, b;
  float d2, r2;
  bool kept_apart;
};

std::optional<NamedPair> pairNamedIn(const std::string& details) {
  static const std::regex pattern(
      "the pair that decides: point ([0-9]+) \\([^)]*\\)[^:]* and point ([0-9]+) \\([^)]*\\)[^:]*, d2 = ([^,]*), "
      "r2 = ([^:]*): (neighbours, which the method keeps apart|not connected, which the method joins)\n");
  std::smatch match;
  if (!std::regex_search(details, match, pattern)) return std::nullopt;
  return NamedPair{std::stoul(match[1]), std::stoul(match[2]), std::stof(match[3]), std::stof(match[4]),
                   match[5].str().front() == 'n' && match[5].str()[1] == 'e'};
}

Point pointOf(const Problem& problem, std::size_t index) {
  const ComparedPoint& p = (*problem.cloud)[index];
  return {p.x, p.y, p.z};
}

/// Checks the pair in the details against the oracle and against the baseline's clusters.
void expectPairDecides(const Problem& problem, const Baseline& baseline, const std::string& details) {
  SCOPED_TRACE(details);
  const std::optional<NamedPair> pair = pairNamedIn(details);
  ASSERT_TRUE(pair.has_value());
  std::vector<Point> points(problem.cloud->size(), {kNan, kNan, kNan});
  for (const auto index : *problem.returns) {
    const auto i = static_cast<std::size_t>(index);
    points[i] = pointOf(problem, i);
  }
  const auto tolerance = static_cast<float>(problem.tolerance);
  ASSERT_NE(pair->a, pair->b);
  ASSERT_TRUE(isValid(points.at(pair->a)) && isValid(points.at(pair->b)));

  Problem any_size = problem;
  any_size.min_size = 1;
  const std::vector<std::uint32_t> label = labelsOf(extracted(baseline, any_size), points.size());
  const bool together = label[pair->a] != 0 && label[pair->a] == label[pair->b];
  const Point a = points[pair->a];
  const Point b = points[pair->b];
  const float dx = a.x - b.x;
  const float dy = a.y - b.y;
  const float dz = a.z - b.z;
  EXPECT_FLOAT_EQ(pair->d2, dx * dx + dy * dy + dz * dz);
  EXPECT_FLOAT_EQ(pair->r2, tolerance * tolerance);
  if (pair->kept_apart) {
    EXPECT_TRUE(areNeighbours(a, b, tolerance));
    EXPECT_LT(pair->d2, pair->r2);
    EXPECT_FALSE(together);
    return;
  }
  EXPECT_TRUE(together);
  for (const Cluster& cluster : trueClusters(points, tolerance))
    EXPECT_FALSE(std::count(cluster.members.begin(), cluster.members.end(), pair->a) > 0 &&
                 std::count(cluster.members.begin(), cluster.members.end(), pair->b) > 0);
}

Difference differenceFrom(const Problem& problem, const Baseline& baseline) {
  return differenceOf(problem, referenceBaseline(), extracted(referenceBaseline(), problem), baseline,
                      extracted(baseline, problem));
}

void expectSaid(const Difference& difference, const std::vector<std::string>& lines) {
  for (const std::string& line : lines)
    EXPECT_NE(difference.details.find(line), std::string::npos) << "missing: " << line << "\n" << difference.details;
}

TEST(Difference, IsEmptyForTheReference) {
  const Problem problem = twoClusters();
  ASSERT_EQ(extracted(referenceBaseline(), problem).size(), 2U);
  ASSERT_EQ(extracted(referenceBaseline(), problem)[0].indices, pcl::Indices({0, 1, 2, 6, 8}));
  ASSERT_EQ(extracted(referenceBaseline(), problem)[1].indices, pcl::Indices({3, 4, 9, 10}));
  const Difference difference = differenceFrom(problem, spoilt([](Clusters&) {}));
  EXPECT_TRUE(difference.identical);
  EXPECT_TRUE(difference.same_sets);
  EXPECT_EQ(difference.clusters, 0U);
  EXPECT_EQ(difference.mislabelled, 0U);
  EXPECT_EQ(difference.details, "");
}

TEST(Difference, NoticesASplitCluster) {
  const Problem problem = twoClusters();
  const Baseline baseline = spoilt([](Clusters& clusters) {
    withPoint(clusters, 0).indices = {1, 2, 8};
    clusters.push_back(clusterOf({0, 6}));
  });
  const Difference difference = differenceFrom(problem, baseline);
  EXPECT_FALSE(difference.identical);
  EXPECT_FALSE(difference.same_sets);
  EXPECT_EQ(difference.clusters, 1U);
  EXPECT_EQ(difference.mislabelled, 2U);  // 0 and 6: the larger part keeps its label
  expectSaid(difference,
             {"PCL finds 2 clusters, the method 3; 1 of PCL's are not among them; 2 of 10 points differ\n",
              "first: point 0 (1, 0, 0) row 0 column 0: by PCL in cluster 1 (5 points), by the method in cluster 3 (2 "
              "points)\n",
              "its 2 neighbours within 0.5 m, with their distances, clusters by PCL and clusters by the method: 6 "
              "(0.3000 m, 1, 3) "
              "1 (0.4000 m, 1, 2)\n",
              "the pair that decides: point 0 (1, 0, 0) row 0 column 0 and point 1 (1.4, 0, 0) row 0 column 1, "
              "d2 = 0.159999982, r2 = 0.25: neighbours, which the method keeps apart\n"});
  expectPairDecides(problem, baseline, difference.details);
}

TEST(Difference, NoticesJoinedClusters) {
  const Problem problem = twoClusters();
  const Baseline baseline =
      spoilt([](Clusters& clusters) { moveAll(withPoint(clusters, 3).indices, withPoint(clusters, 0).indices); });
  const Difference difference = differenceFrom(problem, baseline);
  EXPECT_FALSE(difference.same_sets);
  EXPECT_EQ(difference.clusters, 2U);
  EXPECT_EQ(difference.mislabelled, 4U);  // B: A is larger and keeps its label
  expectSaid(
      difference,
      {"first: point 3 (5, 0, 0) row 0 column 3: by PCL in cluster 2 (4 points), by the method in cluster 1 (9 points)",
       "not connected, which the method joins"});
  expectPairDecides(problem, baseline, difference.details);
  // The nearest two of them are 3.2 m apart.
  EXPECT_NEAR(pairNamedIn(difference.details)->d2, 10.24F, 1e-5F);
}

TEST(Difference, NamesTheNearestPairOfJoinedClusters) {
  const Problem problem = twoClusters();
  auto mirrored = std::make_shared<ComparedCloud>(*problem.cloud);
  for (std::size_t row = 0; row < 12; row += 6)
    std::reverse(mirrored->begin() + static_cast<long>(row), mirrored->begin() + static_cast<long>(row) + 6);
  const Problem reversed = problemOf(mirrored, 0.5, 2);
  const Baseline baseline =
      spoilt([](Clusters& clusters) { moveAll(withPoint(clusters, 1).indices, withPoint(clusters, 5).indices); });
  const Difference difference = differenceFrom(reversed, baseline);
  expectSaid(difference, {"first: point 1 (5.4, 0, 0) row 0 column 1: by PCL in cluster 2 (4 points)"});
  expectPairDecides(reversed, baseline, difference.details);
  EXPECT_NEAR(pairNamedIn(difference.details)->d2, 10.24F, 1e-5F);
}

// The tree of PCL misses the pair: doc/contract.md.
TEST(Difference, NamesThePairThatPclsTreeMisses) {
  auto cloud = std::make_shared<ComparedCloud>();
  pcl::copyPointCloud(*cloudWithAMissedPair(), *cloud);
  const Problem problem = problemOf(cloud, kMissingTolerance, 1);
  const std::vector<Baseline> baselines = allBaselines();
  const auto lisco = std::find_if(baselines.begin(), baselines.end(),
                                  [](const Baseline& baseline) { return baseline.key == "lisco"; });
  ASSERT_NE(lisco, baselines.end());
  const Difference difference = differenceFrom(problem, *lisco);
  EXPECT_FALSE(difference.identical);
  EXPECT_TRUE(difference.missed_by_reference);
  expectSaid(difference, {"point 0 (0.102016, 0.10739, 0.184661)", "neighbours; PCL's tree missed this pair\n"});
}

TEST(Difference, NoticesNoiseThatJoins) {
  const Problem problem = twoClusters();
  const Baseline baseline =
      spoilt([](Clusters& clusters) { moveAll(withPoint(clusters, 5).indices, withPoint(clusters, 3).indices); });
  const Difference difference = differenceFrom(problem, baseline);
  EXPECT_EQ(difference.clusters, 1U);
  EXPECT_EQ(difference.mislabelled, 1U);
  expectSaid(difference, {"first: point 5 (9, 0, 0) row 0 column 5: by PCL in noise, by the method in cluster",
                          "its 0 neighbours within 0.5 m\n"});
  expectPairDecides(problem, baseline, difference.details);
  EXPECT_NEAR(pairNamedIn(difference.details)->d2, 12.96F, 1e-5F);
}

TEST(Difference, NoticesADroppedCluster) {
  const Problem problem = twoClusters();
  const Baseline baseline = spoilt([](Clusters& clusters) { withPoint(clusters, 3).indices.clear(); });
  const Difference difference = differenceFrom(problem, baseline);
  EXPECT_FALSE(difference.same_sets);
  EXPECT_EQ(difference.clusters, 1U);
  EXPECT_EQ(difference.mislabelled, 4U);
  expectSaid(difference,
             {"PCL finds 2 clusters, the method 1",
              "first: point 3 (5, 0, 0) row 0 column 3: by PCL in cluster 2 (4 points), by the method in noise"});
  expectPairDecides(problem, baseline, difference.details);
}

// Points that are in no cluster of any size are not joined.
TEST(Difference, DistinguishesDroppedClustersFromJoinedOnes) {
  const Problem problem = twoClusters();
  const Baseline baseline = spoilt([](Clusters& clusters) { clusters.clear(); });
  const Difference difference = differenceFrom(problem, baseline);
  EXPECT_EQ(difference.clusters, 2U);
  EXPECT_EQ(difference.mislabelled, 9U);
  expectPairDecides(problem, baseline, difference.details);
  EXPECT_TRUE(pairNamedIn(difference.details)->kept_apart);
}

TEST(Difference, NamesNoPairForADroppedSingleton) {
  Problem problem = twoClusters();
  problem.min_size = 1;
  const Difference difference =
      differenceFrom(problem, spoilt([](Clusters& clusters) { withPoint(clusters, 5).indices.clear(); }));
  EXPECT_EQ(difference.clusters, 1U);
  EXPECT_EQ(difference.mislabelled, 1U);
  expectSaid(difference,
             {"first: point 5 (9, 0, 0) row 0 column 5: by PCL in cluster 3 (1 points), by the method in noise"});
  EXPECT_FALSE(pairNamedIn(difference.details).has_value()) << difference.details;
}

TEST(Difference, NoticesAnotherOrder) {
  const Problem problem = twoClusters();
  const Clusters expected = extracted(referenceBaseline(), problem);
  const Clusters reversed(expected.rbegin(), expected.rend());
  const Difference difference = differenceOf(problem, referenceBaseline(), expected, referenceBaseline(), reversed);
  EXPECT_FALSE(difference.identical);
  EXPECT_TRUE(difference.same_sets);
  EXPECT_EQ(difference.clusters, 0U);
  EXPECT_EQ(difference.mislabelled, 0U);
  EXPECT_EQ(difference.details, "the same clusters in another order or with other headers\n");
}

TEST(Difference, NoticesEveryFieldOfTheHeader) {
  const Problem problem = twoClusters();
  const Clusters expected = extracted(referenceBaseline(), problem);
  ASSERT_EQ(expected[1].header.frame_id, "lidar");
  const std::vector<std::function<void(pcl::PCLHeader&)>> changes{[](auto& header) { header.frame_id = "base"; },
                                                                  [](auto& header) { ++header.stamp; },
                                                                  [](auto& header) { ++header.seq; }};
  for (const auto& change : changes) {
    Clusters found = expected;
    change(found[1].header);
    const Difference difference = differenceOf(problem, referenceBaseline(), expected, referenceBaseline(), found);
    EXPECT_FALSE(difference.identical);
    EXPECT_TRUE(difference.same_sets);
  }
}

TEST(Difference, NoticesAnotherOrderOfIndices) {
  const Problem problem = twoClusters();
  const Clusters expected = extracted(referenceBaseline(), problem);
  Clusters found = expected;
  std::swap(found[0].indices[0], found[0].indices[1]);
  EXPECT_FALSE(differenceOf(problem, referenceBaseline(), expected, referenceBaseline(), found).identical);
}

TEST(Difference, NoticesAPointListedTwice) {
  const Problem problem = twoClusters();
  const Clusters expected = extracted(referenceBaseline(), problem);
  Clusters found = expected;
  found[0].indices.push_back(8);
  Difference difference = differenceOf(problem, referenceBaseline(), expected, referenceBaseline(), found);
  EXPECT_FALSE(difference.identical);
  EXPECT_FALSE(difference.same_sets);
  EXPECT_EQ(difference.clusters, 1U);
  EXPECT_EQ(difference.mislabelled, 0U);
  expectSaid(difference, {"the method lists points twice, or points that are no returns\n"});
  // A whole cluster.
  found = expected;
  found.push_back(found[1]);
  difference = differenceOf(problem, referenceBaseline(), expected, referenceBaseline(), found);
  EXPECT_FALSE(difference.identical);
  EXPECT_FALSE(difference.same_sets);
}

TEST(Difference, NoticesANoReturnInACluster) {
  const Problem problem = twoClusters();
  const Clusters expected = extracted(referenceBaseline(), problem);
  for (const pcl::index_t no_return : {7, 11}) {
    Clusters found = expected;
    found[1].indices.push_back(no_return);
    const Difference difference = differenceOf(problem, referenceBaseline(), expected, referenceBaseline(), found);
    EXPECT_FALSE(difference.identical);
    EXPECT_FALSE(difference.same_sets);
    EXPECT_EQ(difference.clusters, 1U);
    EXPECT_EQ(difference.mislabelled, 0U);
    expectSaid(difference, {"the method lists points twice, or points that are no returns\n"});
  }
}

TEST(Difference, NamesTheRightPairOnRandomScans) {
  std::size_t kept_apart = 0;
  std::size_t joined = 0;
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    float spacing = 0;
    const Scan scan = seed % 2 == 0 ? boxesAround(random, 60, 4) : latticeScan(random, spacing);
    const Problem problem =
        problemOf(cloudOf<ComparedPoint>(scan), static_cast<double>(criticalTolerance(random, scan)),
                  1 + static_cast<unsigned>(random.below(3)));
    if (problem.returns->empty()) continue;
    const std::uint64_t way = random.below(3);
    const std::uint64_t choice = random.below(1000);
    const Baseline baseline = spoilt([way, choice](Clusters& clusters) {
      pcl::Indices& one = clusters[choice % clusters.size()].indices;
      pcl::Indices& other = clusters[(choice * 7 + 1) % clusters.size()].indices;
      if (way == 0 && one.size() > 1) {  // every other point to a new one
        pcl::Indices kept, moved;
        for (std::size_t i = 0; i < one.size(); ++i) (i % 2 == 0 ? kept : moved).push_back(one[i]);
        one = kept;
        clusters.push_back(clusterOf(moved));
      } else if (way == 1 && one.size() > 1) {  // dissolved
        for (const auto index : pcl::Indices(one)) clusters.push_back(clusterOf({index}));
        withPoint(clusters, clusters.back().indices.front()).indices.clear();
      } else if (&one != &other) {
        moveAll(one, other);
      }
    });
    const Difference difference = differenceFrom(problem, baseline);
    if (difference.identical || difference.same_sets) continue;
    expectPairDecides(problem, baseline, difference.details);
    if (testing::Test::HasFailure()) return;
    (pairNamedIn(difference.details)->kept_apart ? kept_apart : joined) += 1;
  }
  EXPECT_GT(kept_apart, 10U);
  EXPECT_GT(joined, 10U);
}

TEST(Labels, CountFromOne) {
  EXPECT_EQ(labelsOf({clusterOf({1, 3}), clusterOf({0})}, 5), std::vector<std::uint32_t>({2, 1, 0, 1, 0}));
  EXPECT_EQ(labelsOf({}, 2), std::vector<std::uint32_t>({0, 0}));
}

// --- Objects -------------------------------------------------------------------------------------------------------

/// Scores clusters of twelve points, of which 0 to 9 are returns, for objects of at least 2.
ObjectScore scoreOf(const std::vector<pcl::Indices>& clusters, const std::vector<std::uint32_t>& object_of) {
  auto cloud = std::make_shared<ComparedCloud>(12, 1);
  for (std::size_t i = 0; i < 12; ++i) (*cloud)[i].x = i < 10 ? 1.0F : kNan;
  Clusters all;
  for (const pcl::Indices& cluster : clusters) all.push_back(clusterOf(cluster));
  return scoreObjects(problemOf(cloud, 0.5, 2), all, object_of);
}

void expectScore(const ObjectScore& score, const std::vector<std::size_t>& expected) {
  EXPECT_EQ(std::vector<std::size_t>({score.objects, score.whole, score.split, score.merged, score.missed}), expected);
}

TEST(Objects, AreWhole) {
  expectScore(scoreOf({{0, 1, 2}, {3, 4, 5}}, {7, 7, 7, 9, 9, 9, 0, 0, 0, 0, 0, 0}), {2, 2, 0, 0, 0});
  // Returns without an object do not matter.
  expectScore(scoreOf({{0, 1, 8}, {3, 4, 9}}, {7, 7, 7, 9, 9, 9, 0, 0, 0, 0, 0, 0}), {2, 2, 0, 0, 0});
}

TEST(Objects, AreSplit) {
  expectScore(scoreOf({{0, 1}, {2, 3}, {4, 5}}, {7, 7, 7, 7, 9, 9, 0, 0, 0, 0, 0, 0}), {2, 1, 1, 0, 0});
}

TEST(Objects, AreMerged) {
  expectScore(scoreOf({{0, 1, 2, 3}, {4, 5}}, {7, 7, 9, 9, 3, 3, 0, 0, 0, 0, 0, 0}), {3, 1, 0, 2, 0});
  // One may be split and merged.
  expectScore(scoreOf({{0, 1}, {2, 3, 4}}, {7, 7, 7, 9, 9, 0, 0, 0, 0, 0, 0, 0}), {2, 0, 1, 2, 0});
}

TEST(Objects, AreMissed) {
  expectScore(scoreOf({{0, 1}}, {7, 7, 9, 9, 9, 0, 0, 0, 0, 0, 0, 0}), {2, 1, 0, 0, 1});
  expectScore(scoreOf({}, {7, 7, 9, 9, 9, 0, 0, 0, 0, 0, 0, 0}), {2, 0, 0, 0, 2});
}

TEST(Objects, OfTooFewReturnsDoNotCount) {
  // 9 has one return, 5 only cells without a return; but 9's spoils the cluster of 7.
  expectScore(scoreOf({{0, 1, 2}}, {7, 7, 9, 0, 0, 0, 0, 0, 0, 0, 5, 5}), {1, 0, 0, 1, 0});
  expectScore(scoreOf({{0, 1}}, {7, 7, 9, 0, 0, 0, 0, 0, 0, 0, 5, 5}), {1, 1, 0, 0, 0});
}

// --- Times ---------------------------------------------------------------------------------------------------------

Times timesOf(const std::vector<double>& runs) {
  Times times;
  times.runs = times.cold = runs;
  return times;
}

TEST(Timing, GivesMeanMedianMinMax) {
  EXPECT_DOUBLE_EQ(timesOf({1, 2, 6}).mean(), 3);
  EXPECT_DOUBLE_EQ(median({6, 1, 2}), 2);
  EXPECT_DOUBLE_EQ(median({6, 1, 2, 4}), 3);
  EXPECT_DOUBLE_EQ(median({5}), 5);
  EXPECT_DOUBLE_EQ(quantile({5, 1, 4, 2, 3}, 0.25), 2);
  EXPECT_DOUBLE_EQ(quantile({5, 1, 4, 2, 3}, 0.75), 4);
  EXPECT_DOUBLE_EQ(quantile({2, 1}, 0.25), 1.25);
  EXPECT_DOUBLE_EQ(quantile({2, 1}, 1), 2);
  EXPECT_DOUBLE_EQ(quantile({7}, 0.75), 7);
  EXPECT_DOUBLE_EQ(timesOf({4, 1, 2}).min(), 1);
  EXPECT_DOUBLE_EQ(timesOf({1, 4, 2}).max(), 4);
}

TEST(Timing, ConfidenceIsStudents) {
  // Student's t at 99.5%, from a table: 63.657 for 1 degree of freedom, 9.925 for 2, 2.861 for 19.
  EXPECT_NEAR(timesOf({1, 3}).confidence99(), 63.657 * std::sqrt(2.0) / std::sqrt(2.0), 1e-3);
  EXPECT_NEAR(timesOf({1, 2, 3}).confidence99(), 9.925 / std::sqrt(3.0), 1e-3);
  std::vector<double> twenty;
  for (int i = 1; i <= 20; ++i) twenty.push_back(i);
  EXPECT_NEAR(timesOf(twenty).confidence99(), 2.861 * std::sqrt(35.0 / 20.0), 1e-3);
  EXPECT_EQ(timesOf({2, 2, 2}).confidence99(), 0);
  EXPECT_TRUE(std::isnan(timesOf({1}).confidence99()));
}

TEST(Timing, AveragesRatiosGeometrically) {
  EXPECT_NEAR(geometricMean({2, 0.5}), 1, 1e-12);
  EXPECT_NEAR(geometricMean({1, 10, 100}), 10, 1e-12);
  EXPECT_NEAR(geometricMean({7}), 7, 1e-12);
}

/// Runs contestants A, B, ... \return the calls in order, with "|" before each round
std::string turnsOf(const std::vector<std::size_t>& runs, double tried_ms, std::vector<Times>* times = nullptr) {
  std::string log;
  std::vector<Contestant> contestants;
  for (std::size_t i = 0; i < runs.size(); ++i)
    contestants.push_back({[&log, i] { log += static_cast<char>('A' + i); }, tried_ms, runs[i]});
  std::size_t expected_round = 0;
  const std::size_t most = runs.empty() ? 0 : *std::max_element(runs.begin(), runs.end());
  const std::vector<Times> measured =
      timeInTurn(contestants, TimeKind::kWall, [&](std::size_t round, std::size_t rounds) {
        EXPECT_EQ(round, expected_round++);
        EXPECT_EQ(rounds, most);
        log += "|";
      });
  EXPECT_EQ(measured.size(), runs.size());
  for (std::size_t i = 0; i < measured.size(); ++i) {
    EXPECT_EQ(measured[i].runs.size(), runs[i]);
    EXPECT_EQ(measured[i].cold.size(), runs[i]);
  }
  if (times != nullptr) *times = measured;
  return log;
}

TEST(Timing, RunsRoundByRound) {
  EXPECT_EQ(turnsOf({3, 3}, 1000), "|AB|AB|AB");
  EXPECT_EQ(turnsOf({}, 1000), "");
}

TEST(Timing, RunsShortOnesTwice) {
  EXPECT_EQ(turnsOf({2, 2}, 49.9), "|AABB|AABB");
  EXPECT_EQ(turnsOf({2, 2}, 50), "|AB|AB");
}

TEST(Timing, SpreadsFewerRunsEvenly) {
  const std::string turns = turnsOf({20, 3, 20}, 1000);
  EXPECT_EQ(std::count(turns.begin(), turns.end(), 'A'), 20);
  EXPECT_EQ(std::count(turns.begin(), turns.end(), 'B'), 3);
  std::vector<std::size_t> rounds;  // of B
  for (std::size_t at = 0; (at = turns.find('B', at)) != std::string::npos; ++at)
    rounds.push_back(static_cast<std::size_t>(std::count(turns.begin(), turns.begin() + static_cast<long>(at), '|')));
  ASSERT_EQ(rounds.size(), 3U);
  for (std::size_t i = 1; i < rounds.size(); ++i) {
    EXPECT_GE(rounds[i] - rounds[i - 1], 6U);
    EXPECT_LE(rounds[i] - rounds[i - 1], 7U);
  }
  EXPECT_EQ(turnsOf({4, 2}, 1000), "|A|AB|A|AB");
}

TEST(Timing, CountsTheSecondOfTwoRuns) {
  int calls = 0;
  const auto slow_first = [&calls] {
    if (calls++ % 2 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  };
  const std::vector<Times> times = timeInTurn({{slow_first, 1, 3}}, TimeKind::kWall, [](std::size_t, std::size_t) {});
  EXPECT_GE(*std::min_element(times[0].cold.begin(), times[0].cold.end()), 20);
  EXPECT_LT(times[0].min(), 15);
  EXPECT_EQ(calls, 6);
  // The only run of a long one counts as both.
  calls = 0;
  const std::vector<Times> once = timeInTurn({{slow_first, 1000, 2}}, TimeKind::kWall, [](std::size_t, std::size_t) {});
  EXPECT_EQ(once[0].cold, once[0].runs);
}

TEST(Timing, MeasuresTheDurationOfACall) {
  const double milliseconds = runMs([] { std::this_thread::sleep_for(std::chrono::milliseconds(20)); });
  EXPECT_GE(milliseconds, 20);
  EXPECT_LT(milliseconds, 2000);
}

// --- Comparing -----------------------------------------------------------------------------------------------------

/// Two rows: a car of three returns per row, one no-return, and ground.
Cloud smallCloud() {
  Cloud cloud(5, 2);
  for (std::size_t i = 0; i < 10; ++i) cloud[i] = {5, 0.1F * static_cast<float>(i % 5), i < 5 ? 0.5F : 0.4F};
  cloud[3] = {5, 0.3F, -1.7F};
  cloud[4] = {kNan, kNan, kNan};
  cloud[8] = {5, 0.3F, -1.8F};
  cloud[9] = {0, 0, 0};
  cloud.header.frame_id = "lidar";
  return cloud;
}

ComparedScan prepareAbove(const Cloud& cloud, std::vector<std::uint32_t> object_of, float ground_z, bool unorganized) {
  return prepareScan(cloud, std::move(object_of), returnsAbove(cloud, ground_z), unorganized);
}

TEST(PrepareScan, KeepsTheOrganizationAndBlanksTheGround) {
  const ComparedScan scan = prepareAbove(smallCloud(), {1, 1, 1, 2, 0, 1, 1, 1, 2, 0}, -1.5F, false);
  EXPECT_EQ(*scan.returns, pcl::Indices({0, 1, 2, 5, 6, 7}));
  EXPECT_EQ(scan.cloud->width, 5U);
  EXPECT_EQ(scan.cloud->height, 2U);
  EXPECT_FALSE(scan.cloud->is_dense);
  EXPECT_EQ(scan.cloud->header.frame_id, "lidar");
  EXPECT_TRUE(std::isnan((*scan.cloud)[3].x));
  EXPECT_TRUE(std::isnan((*scan.cloud)[8].z));
  EXPECT_EQ((*scan.cloud)[6].y, 0.1F);
  EXPECT_EQ(scan.object_of, std::vector<std::uint32_t>({1, 1, 1, 2, 0, 1, 1, 1, 2, 0}));
}

TEST(PrepareScan, KeepsTheGroundByDefault) {
  const ComparedScan scan = prepareAbove(smallCloud(), {}, -std::numeric_limits<float>::infinity(), false);
  EXPECT_EQ(*scan.returns, pcl::Indices({0, 1, 2, 3, 5, 6, 7, 8}));
  EXPECT_EQ((*scan.cloud)[3].z, -1.7F);
  EXPECT_TRUE(scan.object_of.empty());
  // A return at this height is above the ground.
  const ComparedScan at_its_height = prepareAbove(smallCloud(), {}, -1.7F, false);
  EXPECT_EQ(at_its_height.returns->size(), 7U);
  EXPECT_EQ((*at_its_height.cloud)[3].z, -1.7F);
}

TEST(PrepareScan, TakesReturnsOnlyWhenUnorganized) {
  const ComparedScan scan = prepareAbove(smallCloud(), {11, 12, 13, 14, 15, 16, 17, 18, 19, 20}, -1.5F, true);
  EXPECT_EQ(*scan.returns, pcl::Indices({0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(scan.cloud->size(), 6U);
  EXPECT_EQ(scan.cloud->height, 1U);
  EXPECT_EQ((*scan.cloud)[3].y, 0.0F);
  EXPECT_EQ((*scan.cloud)[5].y, 0.2F);
  EXPECT_EQ((*scan.cloud)[5].z, 0.4F);
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_EQ(scan.object_of[i], std::vector<std::uint32_t>({11, 12, 13, 16, 17, 18})[i]);
}

TEST(PrepareScan, RefusesAScanWithoutReturns) {
  for (const bool unorganized : {false, true}) {
    EXPECT_THROW(prepareAbove(smallCloud(), {}, 1.0F, unorganized), std::runtime_error);
    EXPECT_THROW(prepareAbove(Cloud(), {}, 1.0F, unorganized), std::runtime_error);
  }
}

ComparedScan boxes(std::uint64_t seed) {
  Random random(seed);
  ComparedScan scan;
  const Problem problem = problemOf(cloudOf<ComparedPoint>(boxesAround(random, 120, 6)), 1, 1);
  scan.cloud = std::make_shared<ComparedCloud>(*problem.cloud);
  scan.returns = std::make_shared<pcl::Indices>(*problem.returns);
  return scan;
}

CompareSettings settingsOf(std::vector<Baseline> baselines, std::size_t runs) {
  CompareSettings settings;
  settings.baselines = std::move(baselines);
  settings.must_agree = {"lisco"};
  settings.runs = runs;
  return settings;
}

const auto kNoProgress = [](const std::string&, double) {};

TEST(Compare, ComparesClustersWithoutRuns) {
  const CompareSettings settings = settingsOf(allBaselines(), 0);
  const CaseResult result = compareAt(boxes(1), 0.4, settings, kNoProgress);
  ASSERT_EQ(result.baselines.size(), settings.baselines.size());
  EXPECT_GT(result.clusters, 2U);
  EXPECT_FALSE(result.objects.has_value());
  for (const BaselineResult& entry : result.baselines) {
    EXPECT_FALSE(entry.times.has_value());
    EXPECT_EQ(entry.failure, "");
    if (entry.baseline->key != "pcl-default" && entry.baseline->key != "paper") {
      EXPECT_TRUE(entry.difference.identical) << entry.baseline->key << "\n" << entry.difference.details;
      EXPECT_EQ(entry.clusters, result.clusters);
    }
  }
}

TEST(Compare, TimesAllButPclsDefault) {
  const CompareSettings settings = settingsOf(allBaselines(), 2);
  double last = 0;
  const CaseResult result = compareAt(boxes(1), 0.4, settings, [&](const std::string& what, double share) {
    EXPECT_FALSE(what.empty());
    EXPECT_GE(share, last);
    EXPECT_LT(share, 1);
    last = share;
  });
  EXPECT_GT(last, 0);
  for (const BaselineResult& entry : result.baselines) {
    ASSERT_EQ(entry.times.has_value(), entry.baseline->key != "pcl-default") << entry.baseline->key;
    EXPECT_EQ(entry.times.value_or(timesOf({0, 0})).runs.size(), 2U);
  }
  EXPECT_DOUBLE_EQ(*result.ratio(*result.find("pcl")), 1);
  EXPECT_FALSE(result.ratio(*result.find("pcl-default")).has_value());
  EXPECT_EQ(result.find("unknown"), nullptr);
}

TEST(Compare, DoesNotTimeAMismatchThatMustAgree) {
  std::size_t calls = 0;
  Baseline wrong = spoilt([&calls](Clusters& clusters) {
    ++calls;
    clusters.erase(clusters.begin());  // the largest
  });
  CompareSettings settings = settingsOf({referenceBaseline(), wrong}, 2);
  EXPECT_TRUE(compareAt(boxes(1), 0.4, settings, kNoProgress).baselines[1].times.has_value());
  settings.must_agree.emplace_back("spoilt");
  calls = 0;
  const CaseResult result = compareAt(boxes(1), 0.4, settings, kNoProgress);
  EXPECT_FALSE(result.baselines[1].times.has_value());
  EXPECT_TRUE(result.baselines[0].times.has_value());
  EXPECT_FALSE(result.baselines[1].difference.identical);
  EXPECT_EQ(calls, 2U);  // its clusters, and those of any size for the details
}

TEST(Compare, ReportsWhyABaselineFailed) {
  Baseline unable{"unable", "unable", [](const Problem&, Clusters&) { throw std::runtime_error("too many cells"); }};
  Baseline rows = referenceBaseline();
  rows.needs_rows = true;
  const CompareSettings settings = settingsOf({unable, rows}, 2);
  ComparedScan scan = boxes(1);
  CaseResult result = compareAt(scan, 0.4, settings, kNoProgress);
  EXPECT_EQ(result.baselines[0].failure, "too many cells");
  EXPECT_FALSE(result.baselines[0].times.has_value());
  EXPECT_EQ(result.baselines[1].failure, "");
  scan.cloud->width = static_cast<std::uint32_t>(scan.cloud->size());
  scan.cloud->height = 1;
  result = compareAt(scan, 0.4, settings, kNoProgress);
  EXPECT_EQ(result.baselines[1].failure, "needs an organized cloud");
  EXPECT_FALSE(result.baselines[1].times.has_value());
}

TEST(Compare, GivesSlowBaselinesFewerRuns) {
  Baseline slow = spoilt([](Clusters&) { std::this_thread::sleep_for(std::chrono::milliseconds(20)); });
  CompareSettings settings = settingsOf({referenceBaseline(), slow}, 6);
  const auto runs = [&](double max_seconds, std::size_t wanted) {
    settings.max_seconds = max_seconds;
    settings.runs = wanted;
    return compareAt(boxes(1), 0.4, settings, kNoProgress).baselines[1].times->runs.size();
  };
  EXPECT_EQ(runs(0.001, 6), 3U);
  EXPECT_EQ(runs(0.001, 2), 2U);
  EXPECT_EQ(runs(60, 6), 6U);
}

TEST(Compare, ScoresObjectsIfTheyAreKnown) {
  ComparedScan scan = prepareAbove(smallCloud(), {1, 1, 1, 2, 0, 1, 1, 1, 2, 0}, -1.5F, false);
  CompareSettings settings = settingsOf({referenceBaseline()}, 0);
  settings.min_size = 3;
  const CaseResult result = compareAt(scan, 0.3, settings, kNoProgress);
  ASSERT_TRUE(result.objects.has_value());
  EXPECT_EQ(result.objects->objects, 1U);
  EXPECT_EQ(result.objects->whole, 1U);
}

// Lisco and the grid on all scans; PCL's other trees where no distance is near the tolerance.
TEST(Baselines, FindPclsClusters) {
  const std::vector<Baseline> baselines = allBaselines();
  EXPECT_EQ(baselines.front().key, kReferenceKey);
  std::size_t compared = 0;
  std::size_t refused = 0;
  for (std::uint64_t seed = 0; seed < 120; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const bool tidy = seed % 4 == 0;
    const Scan scan = tidy ? boxesAround(random, 90, 5) : randomScan(random, 300);
    const double tolerance = tidy ? random.between(0.1, 1.0) : static_cast<double>(criticalTolerance(random, scan));
    const Problem problem =
        problemOf(cloudOf<ComparedPoint>(scan), tolerance, 1 + static_cast<unsigned>(random.below(8)));
    if (problem.returns->empty()) continue;
    const Clusters expected = extracted(referenceBaseline(), problem);
    for (const Baseline& baseline : baselines) {
      if (baseline.key == "pcl-default" || baseline.key == "paper") continue;
      if (baseline.key == "pcl-octree" && !tidy) continue;
      SCOPED_TRACE(baseline.key);
      Clusters found;
      try {
        found = extracted(baseline, problem);
      } catch (const std::runtime_error& error) {
        EXPECT_EQ(baseline.key, "grid") << error.what();
        ++refused;
        continue;
      }
      const Difference difference = differenceOf(problem, referenceBaseline(), expected, baseline, found);
      EXPECT_TRUE(difference.identical) << difference.details;
      ++compared;
    }
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(compared, 300U);
  EXPECT_LT(refused, 20U);
}

TEST(Baselines, ThePaperFindsPclsClustersOnARegularScan) {
  ComparedCloud::Ptr cloud = std::make_shared<ComparedCloud>(72, 3);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 72; ++column) {
      const double azimuth = 5 * kDegree * column;
      const double elevation = (1 - row) * kDegree;
      const double range = column / 6 % 3 == 1 ? 9.0 : 5.0;
      auto& point = cloud->at(column, row);
      point.x = static_cast<float>(range * std::cos(elevation) * std::cos(azimuth));
      point.y = static_cast<float>(range * std::cos(elevation) * std::sin(azimuth));
      point.z = static_cast<float>(range * std::sin(elevation));
    }
  const lisco_reference::NominalSensor sensor = nominalSensor(*cloud);
  EXPECT_NEAR(sensor.delta_alpha, 5 * kDegree, 1e-9);
  EXPECT_NEAR(sensor.delta_theta, 1 * kDegree, 1e-6);
  for (const double tolerance : {0.1, 0.3, 0.5, 0.9, 2.0}) {
    const Problem problem = problemOf(cloud, tolerance, 2);
    for (const Baseline& baseline : allBaselines())
      if (baseline.key == "paper" || baseline.key == "lisco") {
        EXPECT_EQ(differenceFrom(problem, baseline).details, "") << baseline.key << ' ' << tolerance;
      }
  }
}

// Distances far below and above those of sensors: identical clusters, or a reason.
TEST(Baselines, AcceptAnyScale) {
  for (const double scale : {1e-30, 1e-24, 1e-15, 1e-10, 1e-7, 1e15, 1e30, -1e-30, -1e-10, -1e-7}) {
    SCOPED_TRACE(scale);
    auto cloud = std::make_shared<ComparedCloud>(4, 3);
    for (std::size_t i = 0; i < 12; ++i) {
      (*cloud)[i].x = static_cast<float>(scale * (1 + 0.5 * static_cast<double>(i % 6)));
      (*cloud)[i].y = static_cast<float>(scale * (i < 6 ? 1 : 2));
      (*cloud)[i].z = static_cast<float>(scale);
    }
    if (scale > 0) (*cloud)[11].x = (*cloud)[11].y = 50.0F;  // an object of its own
    ComparedScan scan;
    scan.cloud = cloud;
    scan.returns = std::make_shared<pcl::Indices>(*problemOf(cloud, 1, 1).returns);
    CompareSettings settings = settingsOf(allBaselines(), 0);
    settings.min_size = 1;
    for (const double tolerance : {1.2 * std::fabs(scale), 1e-60, 1e-6, 1.0, 1e60}) {
      const CaseResult result = compareAt(scan, tolerance, settings, kNoProgress);
      for (const char* key : {"pcl-octree", "grid", "lisco"}) {
        const BaselineResult& entry = *result.find(key);
        if (entry.baseline->key == "pcl-octree" && tolerance > 1e18) continue;  // its squares overflow
        EXPECT_TRUE(entry.difference.identical || !entry.failure.empty()) << key << " at " << tolerance << "\n"
                                                                          << entry.difference.details;
      }
      EXPECT_EQ(result.find("lisco")->failure, "");
    }
  }
}

// --- Files for machines --------------------------------------------------------------------------------------------

/// Rows of cells; quotes are undone.
std::vector<std::vector<std::string>> cellsOf(const std::string& csv) {
  std::vector<std::vector<std::string>> rows{{""}};
  bool quoted = false;
  for (std::size_t i = 0; i < csv.size(); ++i) {
    const char c = csv[i];
    if (quoted && c == '"' && i + 1 < csv.size() && csv[i + 1] == '"')
      rows.back().back() += csv[++i];
    else if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      rows.back().emplace_back();
    else if (c == '\n' && !quoted)
      rows.push_back({""});
    else
      rows.back().back() += c;
  }
  EXPECT_FALSE(quoted);
  EXPECT_EQ(rows.back(), std::vector<std::string>({""})) << "the last line ends";
  rows.pop_back();
  return rows;
}

/// One input at two tolerances with times of three baselines.
struct Example {
  CompareSettings settings = settingsOf({referenceBaseline(), {}, {}}, 2);
  std::vector<InputResult> inputs{1};

  Example() {
    settings.min_size = 5;
    settings.tolerances = {0.1, 0.25};
    settings.baselines[1] = {"fast", "a fast one", {}};
    settings.baselines[2] = {"wrong", "a wrong one", {}};
    settings.must_agree = {"fast"};
    InputResult& input = inputs[0];
    input.name = "my \"best\" scan, of all";
    input.file = "/tmp/my \"best\" scan, of all.pcd";
    input.rows = 16;
    input.columns = 1800;
    input.returns = 20000;
    input.ground = groundChoiceOf("height:-1.5");
    for (const double tolerance : settings.tolerances) {
      CaseResult& result = input.cases.emplace_back();
      result.tolerance = tolerance;
      result.clusters = 7;
      for (const Baseline& baseline : settings.baselines) {
        BaselineResult& entry = result.baselines.emplace_back();
        entry.baseline = &baseline;
        entry.clusters = 7;
      }
      result.baselines[0].times = timesOf({10, 30, 20});
      result.baselines[0].times->cold = {30, 50, 40};
      result.baselines[1].times = timesOf({2, 4});
      result.baselines[1].times->cold = {4, 6};
      result.baselines[2].clusters = 8;
      result.baselines[2].difference = {false, false, 1, 12, false, "a \"quoted\"\nsecond line\n"};
    }
    input.cases[1].objects = ObjectScore{9, 5, 2, 1, 3};
    input.cases[1].baselines[2].failure = "needs an organized cloud";
  }
  Example(const Example&) = delete;
};

TEST(Report, CsvHoldsAllResults) {
  const Example example;
  const std::string csv = csvOf(example.inputs, example.settings);
  EXPECT_EQ(csv.rfind(kCsvSignature, 0), 0U);
  const auto rows = cellsOf(csv);
  ASSERT_EQ(rows.size(), 1U + 3U + 3U);
  std::vector<std::map<std::string, std::string>> values;
  for (const auto& row : rows) {
    ASSERT_EQ(row.size(), rows[0].size());
    auto& value = values.emplace_back();
    for (std::size_t i = 0; i < row.size(); ++i) value[rows[0][i]] = row[i];
  }
  const auto expect = [&](std::size_t row, const std::map<std::string, std::string>& expected) {
    for (const auto& [column, value] : expected) EXPECT_EQ(values[row].at(column), value) << row << ' ' << column;
  };
  for (std::size_t row = 1; row < rows.size(); ++row)
    expect(row, {{"input", "my \"best\" scan, of all"},
                 {"rows", "16"},
                 {"columns", "1800"},
                 {"returns", "20000"},
                 {"ground_z", "-1.5"},
                 {"min_size", "5"},
                 {"reference_clusters", "7"}});
  expect(1, {{"baseline", "pcl"},
             {"tolerance", "0.1"},
             {"identical", "yes"},
             {"runs", "3"},
             {"mean_ms", "20"},
             {"confidence99_ms", "57.3011"},
             {"median_ms", "20"},
             {"cold_median_ms", "40"},
             {"min_ms", "10"},
             {"lower_quartile_ms", "15"},
             {"upper_quartile_ms", "25"},
             {"max_ms", "30"},
             {"ratio", "1"},
             {"objects", ""},
             {"missed", ""}});
  expect(2, {{"baseline", "fast"},
             {"identical", "yes"},
             {"mislabelled", "0"},
             {"runs", "2"},
             {"mean_ms", "3"},
             {"median_ms", "3"},
             {"cold_median_ms", "5"},
             {"min_ms", "2"},
             {"max_ms", "4"},
             {"ratio", "6.66667"}});
  expect(3, {{"baseline", "wrong"},
             {"clusters", "8"},
             {"identical", "no"},
             {"mislabelled", "12"},
             {"runs", "0"},
             {"mean_ms", ""},
             {"max_ms", ""},
             {"ratio", ""}});
  expect(5, {{"baseline", "fast"},
             {"tolerance", "0.25"},
             {"objects", "9"},
             {"whole", "5"},
             {"split", "2"},
             {"merged", "1"},
             {"missed", "3"}});
  expect(6, {{"clusters", ""},
             {"identical", ""},
             {"mislabelled", ""},
             {"runs", "0"},
             {"failure", "needs an organized cloud"}});
  expect(5, {{"failure", ""}});
}

TEST(Report, JsonHoldsAllResults) {
  const Example example;
  const std::string text = jsonTextOf(example.inputs, example.settings, {"other.pcd: does not exist"});
  EXPECT_LT(text.find(kJsonSignature), 1000U);
  const auto json = nlohmann::json::parse(text);
  EXPECT_EQ(json["program"], "lisco_compare");
  EXPECT_EQ(json["min_size"], 5);
  EXPECT_EQ(json["runs"], 2);
  EXPECT_EQ(json["failures"], nlohmann::json({"other.pcd: does not exist"}));
  ASSERT_EQ(json["inputs"].size(), 1U);
  const auto& input = json["inputs"][0];
  EXPECT_EQ(input["name"], "my \"best\" scan, of all");
  EXPECT_EQ(input["file"], "/tmp/my \"best\" scan, of all.pcd");
  EXPECT_EQ(input["rows"], 16);
  EXPECT_EQ(input["columns"], 1800);
  EXPECT_EQ(input["returns"], 20000);
  EXPECT_EQ(input["ground_z"], -1.5);
  ASSERT_EQ(input["cases"].size(), 2U);
  const auto& first = input["cases"][0];
  EXPECT_EQ(first["tolerance"], 0.1);
  EXPECT_EQ(first["clusters"], 7);
  EXPECT_FALSE(first.contains("objects"));
  const auto& fast = first["baselines"][1];
  EXPECT_EQ(fast["baseline"], "fast");
  EXPECT_EQ(fast["title"], "a fast one");
  EXPECT_EQ(fast["must_agree"], true);
  EXPECT_EQ(fast["identical"], true);
  EXPECT_FALSE(fast.contains("difference"));
  EXPECT_EQ(fast["times_ms"], nlohmann::json({2.0, 4.0}));
  EXPECT_EQ(fast["runs"], 2);
  EXPECT_EQ(fast["mean_ms"], 3.0);
  EXPECT_EQ(fast["median_ms"], 3.0);
  EXPECT_EQ(fast["cold_median_ms"], 5.0);
  EXPECT_NEAR(fast["ratio"].get<double>(), 20.0 / 3, 1e-9);
  EXPECT_NEAR(fast["confidence99_ms"].get<double>(), 63.657, 1e-3);
  const auto& wrong = first["baselines"][2];
  EXPECT_EQ(wrong["must_agree"], false);
  EXPECT_EQ(wrong["identical"], false);
  EXPECT_EQ(wrong["clusters"], 8);
  EXPECT_EQ(wrong["difference"]["same_sets"], false);
  EXPECT_EQ(wrong["difference"]["clusters"], 1);
  EXPECT_EQ(wrong["difference"]["mislabelled"], 12);
  EXPECT_EQ(wrong["difference"]["details"], "a \"quoted\"\nsecond line\n");
  EXPECT_FALSE(wrong.contains("times_ms"));
  const auto& second = input["cases"][1];
  EXPECT_EQ(second["objects"],
            nlohmann::json({{"count", 9}, {"whole", 5}, {"split", 2}, {"merged", 1}, {"missed", 3}}));
  EXPECT_EQ(second["baselines"][2]["failure"], "needs an organized cloud");
}

TEST(Report, FilesHoldNoNan) {
  Example example;
  example.inputs[0].ground = {};
  example.inputs[0].name = "no \xff UTF-8";
  for (BaselineResult& entry : example.inputs[0].cases[0].baselines) entry.times = timesOf({1});
  const auto json = nlohmann::json::parse(jsonTextOf(example.inputs, example.settings, {}));
  EXPECT_TRUE(json["inputs"][0]["ground_z"].is_null());
  EXPECT_TRUE(json["inputs"][0]["cases"][0]["baselines"][0]["confidence99_ms"].is_null());
  const std::string csv = csvOf(example.inputs, example.settings);
  EXPECT_EQ(csv.find("nan"), std::string::npos) << csv;
  EXPECT_EQ(csv.find("inf"), std::string::npos) << csv;
}

TEST(Report, RatiosAreOfMedians) {
  const Example example;
  const CaseResult& result = example.inputs[0].cases[0];
  EXPECT_NEAR(*result.ratio(result.baselines[1]), 20.0 / 3, 1e-12);
  EXPECT_NEAR(*result.coldRatio(result.baselines[1]), 40.0 / 5, 1e-12);
  EXPECT_FALSE(result.ratio(result.baselines[2]).has_value());
  EXPECT_FALSE(result.coldRatio(result.baselines[2]).has_value());
}

TEST(Report, TableNamesAllBaselinesAndDifferences) {
  const Example example;
  const std::string heading = headingOf(example.inputs[0], example.settings);
  EXPECT_NE(heading.find("16 rows x 1800 columns, 20000 returns above -1.5 m, clusters of at least 5\n"),
            std::string::npos)
      << heading;
  const std::string table = tableOf(example.inputs[0].cases[0]);
  for (const char* part : {"tolerance 0.1 m: 7 clusters", "PCL, KdTree (false)", "reference\n", "a fast one",
                           "    6.67  identical\n", "DIFFERENT: 12 points, 8 clusters\n", "    second line\n"})
    EXPECT_NE(table.find(part), std::string::npos) << part << "\n" << table;
  const std::string second = tableOf(example.inputs[0].cases[1]);
  EXPECT_NE(second.find("true objects: 9; 5 whole, 2 split, 1 merged with others, 3 missed\n"), std::string::npos);
  EXPECT_NE(second.find("not possible: needs an organized cloud\n"), std::string::npos);
  const std::string summary = summaryOf(example.inputs, example.settings);
  EXPECT_TRUE(std::regex_search(summary, std::regex("a fast one +2/2 +6\\.67 +6\\.67 +6\\.67 +8\\.00\n"))) << summary;
  EXPECT_TRUE(std::regex_search(summary, std::regex("a wrong one +0/1 +- +- +- +-\n"))) << summary;
}

TEST(Report, SumsUpSeveralCasesOnly) {
  Example example;
  example.settings.tolerances.pop_back();
  example.inputs[0].cases.pop_back();
  EXPECT_EQ(summaryOf(example.inputs, example.settings), "");
}

TEST(Report, NamesItsCharts) {
  CompareSettings settings;
  settings.tolerances = {0.1, 1};
  EXPECT_EQ(chartsOf({"a"}, settings),
            std::vector<std::string>({"time_over_tolerance_a.png", "time_over_tolerance_a.svg"}));
  EXPECT_EQ(chartsOf({"a", "b"}, settings),
            std::vector<std::string>({"time_over_tolerance_a.png", "time_over_tolerance_a.svg",
                                      "time_over_tolerance_b.png", "time_over_tolerance_b.svg",
                                      "time_over_tolerance.png", "time_over_tolerance.svg", "time_over_points_0.1.png",
                                      "time_over_points_0.1.svg", "time_over_points_1.png", "time_over_points_1.svg"}));
}

}  // namespace
}  // namespace lisco_test
