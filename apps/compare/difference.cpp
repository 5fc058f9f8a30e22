// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "compare/difference.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include <pcl/search/kdtree.h>

#include "core/neighbour.h"
#include "io/text.h"

namespace lisco_apps {
namespace {

using Labels = std::vector<std::uint32_t>;

std::size_t at(pcl::index_t index) {
  return static_cast<std::size_t>(index);
}

bool sameVector(const Clusters& a, const Clusters& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const pcl::PointIndices& x, const pcl::PointIndices& y) {
    return x.indices == y.indices && x.header.frame_id == y.header.frame_id && x.header.seq == y.header.seq &&
           x.header.stamp == y.header.stamp;
  });
}

std::set<pcl::Indices> setsOf(const Clusters& clusters) {
  std::set<pcl::Indices> sets;
  for (const auto& cluster : clusters) sets.insert(cluster.indices);
  return sets;
}

using LabelPairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;

/// The best naming: pairs of corresponding labels of the reference and the baseline (0 for 0).
LabelPairs bestNaming(const pcl::Indices& returns, const Labels& expected, const Labels& found) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> shared;
  for (const auto index : returns) ++shared[{expected[at(index)], found[at(index)]}];
  std::vector<std::pair<std::size_t, std::pair<std::uint32_t, std::uint32_t>>> by_size;
  for (const auto& [labels, points] : shared) by_size.push_back({points, labels});
  std::sort(by_size.rbegin(), by_size.rend());
  LabelPairs pairs;
  std::set<std::uint32_t> named, taken;
  for (const auto& [points, labels] : by_size) {
    const auto& [a, b] = labels;
    if ((a == 0) != (b == 0) || named.count(a) != 0 || taken.count(b) != 0) continue;
    named.insert(a);
    taken.insert(b);
    pairs.insert(labels);
  }
  return pairs;
}

/// Two points that only one of the two connects.
struct DecidingPair {
  pcl::index_t a, b;
  float d2;
  const char* kind;
};
constexpr const char* kKeptApart = "neighbours, which the method keeps apart";
constexpr const char* kJoined = "not connected, which the method joins";
constexpr const char* kMissed = "neighbours; PCL's tree missed this pair";

/// A pair of neighbours by the definition, one of `inside` and one of `joined`: the tree over `joined` is searched a
/// little beyond the tolerance, so that its own rounding misses none.
std::optional<DecidingPair> missedPair(const Problem& problem, pcl::search::KdTree<ComparedPoint>& tree_of_joined,
                                       const pcl::Indices& inside, const pcl::Indices& joined) {
  constexpr double kBeyond = 1 + 1e-4;
  constexpr double kMaxRadius = 1e18;  // metres; beyond, squares overflow in the tree
  const ComparedCloud& cloud = *problem.cloud;
  const lisco::Tolerance tolerance(static_cast<float>(problem.tolerance));
  const double radius = tolerance.reach() * kBeyond;
  pcl::Indices near;
  std::vector<float> squared;
  for (const auto index : inside) {
    const ComparedPoint& p = cloud[at(index)];
    if (radius < kMaxRadius)
      tree_of_joined.radiusSearch(p, radius, near, squared);
    else
      near = joined;
    for (const auto other : near) {
      const ComparedPoint& q = cloud[at(other)];
      const float d2 = lisco::squaredDistance(p.x - q.x, p.y - q.y, p.z - q.z);
      if (d2 < tolerance.squared()) return DecidingPair{index, other, d2, kMissed};
    }
  }
  return std::nullopt;
}

/// Searches the pair in the reference's component of `point`. The labels are those of clusters of any size; points
/// without a label are joined with none.
std::optional<DecidingPair> decidingPair(const Problem& problem, pcl::index_t point, const Labels& expected,
                                         const Labels& found) {
  const auto joined_with = [&found](pcl::index_t a, pcl::index_t b) {
    return found[at(a)] != 0 && found[at(a)] == found[at(b)];
  };
  pcl::IndicesPtr inside = std::make_shared<pcl::Indices>();
  pcl::IndicesPtr joined = std::make_shared<pcl::Indices>();
  for (const auto index : *problem.returns)
    if (expected[at(index)] == expected[at(point)])
      inside->push_back(index);
    else if (joined_with(index, point))
      joined->push_back(index);

  pcl::search::KdTree<ComparedPoint> tree;
  pcl::Indices near;
  std::vector<float> squared;
  const double radius = std::fabs(static_cast<double>(static_cast<float>(problem.tolerance)));
  tree.setInputCloud(problem.cloud, inside);
  for (const auto index : *inside) {
    tree.radiusSearch((*problem.cloud)[at(index)], radius, near, squared);
    for (std::size_t i = 0; i < near.size(); ++i)
      if (near[i] != index && !joined_with(near[i], index)) return DecidingPair{index, near[i], squared[i], kKeptApart};
  }
  if (joined->empty()) return std::nullopt;
  tree.setInputCloud(problem.cloud, joined);
  std::optional<DecidingPair> nearest = missedPair(problem, tree, *inside, *joined);
  if (nearest) return nearest;
  for (const auto index : *inside)
    if (joined_with(index, point) && tree.nearestKSearch((*problem.cloud)[at(index)], 1, near, squared) == 1 &&
        (!nearest || squared[0] < nearest->d2))
      nearest = DecidingPair{index, near[0], squared[0], kJoined};
  return nearest;
}

std::string inWords(std::uint32_t label, const Clusters& clusters) {
  if (label == 0) return "noise";
  return formatted("cluster %u (%zu points)", label, clusters[label - 1].indices.size());
}

std::string whereIs(const Problem& problem, pcl::index_t index) {
  const ComparedCloud& cloud = *problem.cloud;
  const ComparedPoint& p = cloud[at(index)];
  std::string text = formatted("point %d (%.6g, %.6g, %.6g)", index, static_cast<double>(p.x), static_cast<double>(p.y),
                               static_cast<double>(p.z));
  if (cloud.height > 1) text += formatted(" row %zu column %zu", at(index) / cloud.width, at(index) % cloud.width);
  return text;
}

/// The neighbours of a point, nearest first, with both labels.
std::string neighboursOf(const Problem& problem, pcl::index_t point, const Labels& expected, const Labels& found) {
  const ComparedCloud& cloud = *problem.cloud;
  const lisco::Tolerance tolerance(static_cast<float>(problem.tolerance));
  const ComparedPoint& p = cloud[at(point)];
  std::vector<std::pair<float, pcl::index_t>> neighbours;
  for (const auto index : *problem.returns) {
    const ComparedPoint& q = cloud[at(index)];
    const float d2 = lisco::squaredDistance(p.x - q.x, p.y - q.y, p.z - q.z);
    if (index != point && d2 < tolerance.squared()) neighbours.push_back({d2, index});
  }
  std::sort(neighbours.begin(), neighbours.end());
  constexpr std::size_t kShown = 4;
  std::string text = formatted("its %zu neighbours within %g m", neighbours.size(), problem.tolerance);
  if (!neighbours.empty()) text += ", with their distances, clusters by PCL and clusters by the method:";
  for (std::size_t i = 0; i < std::min(neighbours.size(), kShown); ++i) {
    const auto [d2, index] = neighbours[i];
    text += formatted(" %d (%.4f m, %u, %u)", index, static_cast<double>(std::sqrt(d2)), expected[at(index)],
                      found[at(index)]);
  }
  if (neighbours.size() > kShown) text += " ...";
  return text;
}

}  // namespace

Difference differenceOf(const Problem& problem, const Baseline& reference, const Clusters& expected,
                        const Baseline& baseline, const Clusters& found, bool locate) {
  Difference difference;
  if (sameVector(expected, found)) return difference;
  difference.identical = false;
  const std::set<pcl::Indices> expected_sets = setsOf(expected);
  const std::set<pcl::Indices> found_sets = setsOf(found);
  difference.same_sets = expected_sets == found_sets && expected.size() == found.size();
  if (difference.same_sets) {
    difference.details = "the same clusters in another order or with other headers\n";
    return difference;
  }
  for (const pcl::Indices& cluster : expected_sets) difference.clusters += 1 - found_sets.count(cluster);

  const std::size_t points = problem.cloud->size();
  const Labels expected_label = labelsOf(expected, points);
  const Labels found_label = labelsOf(found, points);
  const LabelPairs naming = bestNaming(*problem.returns, expected_label, found_label);
  std::optional<pcl::index_t> first;
  for (const auto index : *problem.returns) {
    if (naming.count({expected_label[at(index)], found_label[at(index)]}) != 0) continue;
    ++difference.mislabelled;
    if (!first) first = index;
  }
  difference.details =
      formatted("PCL finds %zu clusters, the method %zu; %zu of PCL's are not among them; %zu of %zu points differ\n",
                expected.size(), found.size(), difference.clusters, difference.mislabelled, problem.returns->size());
  if (!first) {
    difference.details += "the method lists points twice, or points that are no returns\n";
    return difference;
  }
  if (!locate) return difference;
  difference.details += "first: " + whereIs(problem, *first) + ": by PCL in " +
                        inWords(expected_label[at(*first)], expected) + ", by the method in " +
                        inWords(found_label[at(*first)], found) + "\n" +
                        neighboursOf(problem, *first, expected_label, found_label) + "\n";

  Problem any_size = problem;
  any_size.min_size = 1;
  any_size.max_size = Problem().max_size;
  Clusters expected_components, found_components;
  reference.extract(any_size, expected_components);
  baseline.extract(any_size, found_components);
  const auto pair =
      decidingPair(any_size, *first, labelsOf(expected_components, points), labelsOf(found_components, points));
  if (pair) {
    const double r2 = static_cast<double>(lisco::Tolerance(static_cast<float>(problem.tolerance)).squared());
    difference.details += "the pair that decides: " + whereIs(problem, pair->a) + " and " + whereIs(problem, pair->b) +
                          formatted(", d2 = %.9g, r2 = %.9g: ", static_cast<double>(pair->d2), r2) + pair->kind + "\n";
    difference.missed_by_reference = pair->kind == kMissed;
  }
  return difference;
}

ObjectScore scoreObjects(const Problem& problem, const Clusters& clusters,
                         const std::vector<std::uint32_t>& object_of) {
  const Labels label = labelsOf(clusters, problem.cloud->size());
  std::map<std::uint32_t, std::size_t> returns;                  // per object
  std::map<std::uint32_t, std::set<std::uint32_t>> clusters_of;  // per object
  std::map<std::uint32_t, std::set<std::uint32_t>> objects_in;   // per cluster
  for (const auto index : *problem.returns) {
    const std::uint32_t object = object_of[at(index)];
    if (object == 0) continue;
    ++returns[object];
    if (label[at(index)] == 0) continue;
    clusters_of[object].insert(label[at(index)]);
    objects_in[label[at(index)]].insert(object);
  }
  ObjectScore score;
  for (const auto& [object, count] : returns) {
    if (count < problem.min_size) continue;
    ++score.objects;
    const std::set<std::uint32_t>& own = clusters_of[object];
    const bool split = own.size() > 1;
    const bool merged = std::any_of(own.begin(), own.end(), [&](auto c) { return objects_in[c].size() > 1; });
    score.split += split ? 1 : 0;
    score.merged += merged ? 1 : 0;
    score.missed += own.empty() ? 1 : 0;
    score.whole += own.size() == 1 && !merged ? 1 : 0;
  }
  return score;
}

}  // namespace lisco_apps
