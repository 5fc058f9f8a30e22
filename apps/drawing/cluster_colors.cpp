// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "drawing/cluster_colors.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace lisco_apps {
namespace {

/// Pairs of clusters, the lower one in the upper half: whether they touch in a picture; otherwise they are near.
using Pairs = std::unordered_map<std::uint64_t, bool>;

/// Of more pairs, as of single returns, those that are near are left out, then those that touch.
constexpr std::size_t kMaxNearPairs = 500000;
constexpr std::size_t kMaxPairs = 2 * kMaxNearPairs;

/// The clusters of a picture, cell by cell: 0 is none, otherwise 1 + the index of the cluster.
std::vector<std::uint32_t> clustersShown(const ClusterPicture& picture) {
  std::vector<std::uint32_t> shown;
  shown.reserve(picture.map.points.size());
  for (const std::int64_t point : picture.map.points)
    shown.push_back(point == PointMap::kNoPoint ? 0 : picture.labels[static_cast<std::size_t>(point)]);
  return shown;
}

/// Adds the pairs of clusters with cells less than kNearPixels apart. It suffices to look around the cells at the
/// borders of clusters: a step from an inner cell towards another cluster stays in its own and is no farther from it.
void addNeighbours(const ClusterPicture& picture, Pairs& pairs) {
  const PointMap& map = picture.map;
  const std::vector<std::uint32_t> shown = clustersShown(picture);
  // Cells between which the gap is smaller, counted from one to the other.
  const auto reachOf = [](double gap, double size) { return static_cast<int>(std::ceil(gap / size)); };
  const int reach_x = reachOf(kNearPixels, map.cell_width);
  const int reach_y = reachOf(kNearPixels, map.cell_height);
  const int touching_x = reachOf(kTouchingPixels, map.cell_width);
  const int touching_y = reachOf(kTouchingPixels, map.cell_height);
  const auto differsAt = [&](int row, int column, std::uint32_t cluster) {
    return row >= 0 && row < map.rows && column >= 0 && column < map.columns &&
           shown[map.cellAt(row, column)] != cluster;
  };
  for (int row = 0; row < map.rows; ++row)
    for (int column = 0; column < map.columns; ++column) {
      const std::uint32_t cluster = shown[map.cellAt(row, column)];
      if (cluster == 0) continue;
      if (!differsAt(row, column - 1, cluster) && !differsAt(row, column + 1, cluster) &&
          !differsAt(row - 1, column, cluster) && !differsAt(row + 1, column, cluster))
        continue;
      for (int y = row; y <= std::min(map.rows - 1, row + reach_y); ++y) {
        std::uint32_t previous = 0;  // of the same distance class, as cells of a cluster lie side by side
        bool previous_touches = false;
        for (int x = std::max(0, column - reach_x); x <= std::min(map.columns - 1, column + reach_x); ++x) {
          const std::uint32_t other = shown[map.cellAt(y, x)];
          if (other == 0 || other == cluster) continue;
          const bool touches = y - row <= touching_y && std::abs(x - column) <= touching_x;
          if (other == previous && touches == previous_touches) continue;
          previous = other;
          previous_touches = touches;
          const std::uint64_t lower = std::min(cluster, other) - 1;
          const std::uint64_t upper = std::max(cluster, other) - 1;
          if (const auto known = pairs.find(lower << 32 | upper); known != pairs.end())
            known->second = known->second || touches;
          else if (pairs.size() < (touches ? kMaxPairs : kMaxNearPairs))
            pairs.emplace(lower << 32 | upper, touches);
        }
      }
    }
}

struct Neighbour {
  std::uint32_t cluster;
  bool touches;
};
using Neighbours = std::vector<std::vector<Neighbour>>;

Neighbours neighboursIn(const std::vector<ClusterPicture>& pictures, std::size_t clusters) {
  Pairs pairs;
  for (const ClusterPicture& picture : pictures) addNeighbours(picture, pairs);
  Neighbours neighbours(clusters);
  for (const auto& [pair, touches] : pairs) {
    const auto a = static_cast<std::uint32_t>(pair >> 32);
    const auto b = static_cast<std::uint32_t>(pair);
    neighbours[a].push_back({b, touches});
    neighbours[b].push_back({a, touches});
  }
  return neighbours;
}

/// Takes away the cluster with the fewest neighbours, again and again. In the reverse order each cluster has the fewest
/// neighbours before it.
/// \param touching counts neighbours that touch only
/// \return the order, last one first
std::vector<std::uint32_t> smallestLast(const Neighbours& neighbours, bool touching) {
  const auto counts = [touching](const Neighbour& neighbour) { return neighbour.touches || !touching; };
  std::vector<std::size_t> degree;
  std::set<std::pair<std::size_t, std::uint32_t>> rest;
  for (std::uint32_t i = 0; i < neighbours.size(); ++i) {
    degree.push_back(static_cast<std::size_t>(std::count_if(neighbours[i].begin(), neighbours[i].end(), counts)));
    rest.emplace(degree[i], i);
  }
  std::vector<std::uint32_t> order;
  while (!rest.empty()) {
    const std::uint32_t taken = rest.begin()->second;
    rest.erase(rest.begin());
    order.push_back(taken);
    for (const Neighbour& other : neighbours[taken])
      if (counts(other) && rest.erase({degree[other.cluster], other.cluster}) != 0)
        rest.emplace(--degree[other.cluster], other.cluster);
  }
  std::reverse(order.begin(), order.end());
  return order;
}

using Colors = std::vector<std::size_t>;

/// What two neighbours in one colour cost: one pair that touches more than all that are near.
std::size_t costOf(const Neighbour& neighbour) {
  return neighbour.touches ? std::size_t{1} << 32 : 1;
}

/// Gives each cluster in turn the colour that costs least with those before it.
Colors colored(const Neighbours& neighbours, const std::vector<std::uint32_t>& order, std::size_t primary,
               std::size_t colors) {
  const std::size_t none = colors;
  Colors color_of(neighbours.size(), none);
  std::vector<std::size_t> used(colors, 0);  // by all clusters: the colours are used about equally often
  for (const std::uint32_t cluster : order) {
    std::vector<std::size_t> costs(colors, 0);
    for (const Neighbour& other : neighbours[cluster])
      if (const std::size_t color = color_of[other.cluster]; color != none) costs[color] += costOf(other);
    const auto rank = [&](std::size_t color) { return std::make_tuple(costs[color], color >= primary, used[color]); };
    std::size_t best = 0;
    for (std::size_t color = 1; color < colors; ++color)
      if (rank(color) < rank(best)) best = color;
    color_of[cluster] = best;
    ++used[best];
  }
  return color_of;
}

/// A colouring that is improved step by step: of all clusters with neighbours in their colour, the one is recoloured
/// for which it gains most (or loses least), and keeps that colour for some steps. (Tabu search after Hertz and de
/// Werra, 1987.)
class Improvement {
 public:
  Improvement(const Neighbours& neighbours, Colors start, std::size_t colors)
      : neighbours_(neighbours),
        colors_(colors),
        color_of_(std::move(start)),
        costs_(neighbours.size() * colors, 0),
        rests_until_(neighbours.size() * colors, 0) {
    for (std::uint32_t cluster = 0; cluster < neighbours.size(); ++cluster)
      for (const Neighbour& other : neighbours[cluster]) costs_[at(cluster, color_of_[other.cluster])] += costOf(other);
    for (std::uint32_t cluster = 0; cluster < neighbours.size(); ++cluster) {
      cost_ += costs_[at(cluster, color_of_[cluster])];
      updateClashing(cluster);
    }
    cost_ /= 2;  // of pairs
  }

  std::size_t cost() const { return cost_; }

  /// \return the best colours found, of the start's or a lower cost
  Colors run() {
    constexpr std::size_t kMaxWork = 20000000;  // colours looked at
    Colors best = color_of_;
    std::size_t best_cost = cost_;
    std::size_t work = 0;
    for (std::size_t step = 1; cost_ > 0 && work < kMaxWork; ++step) {
      work += clashing_.size() * colors_;
      std::uint32_t moved = 0;
      std::size_t to = colors_;
      std::int64_t change = 0;
      for (const std::uint32_t cluster : clashing_)
        for (std::size_t color = 0; color < colors_; ++color) {
          if (color == color_of_[cluster]) continue;
          const auto difference = static_cast<std::int64_t>(costs_[at(cluster, color)]) -
                                  static_cast<std::int64_t>(costs_[at(cluster, color_of_[cluster])]);
          const bool is_best = static_cast<std::int64_t>(cost_) + difference < static_cast<std::int64_t>(best_cost);
          if ((rests_until_[at(cluster, color)] > step && !is_best) || (to != colors_ && difference >= change))
            continue;
          moved = cluster;
          to = color;
          change = difference;
        }
      if (to == colors_) continue;
      rests_until_[at(moved, color_of_[moved])] = step + kRest + step % kRest + clashing_.size() / 2;
      recolor(moved, to);
      if (cost_ >= best_cost) continue;
      best_cost = cost_;
      best = color_of_;
    }
    return best;
  }

 private:
  static constexpr std::size_t kRest = 7;  ///< steps, at least, in which a cluster does not get its last colour again

  std::size_t at(std::uint32_t cluster, std::size_t color) const { return cluster * colors_ + color; }

  void recolor(std::uint32_t cluster, std::size_t color) {
    const std::size_t before = color_of_[cluster];
    cost_ = cost_ + costs_[at(cluster, color)] - costs_[at(cluster, before)];
    color_of_[cluster] = color;
    for (const Neighbour& other : neighbours_[cluster]) {
      costs_[at(other.cluster, before)] -= costOf(other);
      costs_[at(other.cluster, color)] += costOf(other);
      updateClashing(other.cluster);
    }
    updateClashing(cluster);
  }
  void updateClashing(std::uint32_t cluster) {
    if (costs_[at(cluster, color_of_[cluster])] > 0)
      clashing_.insert(cluster);
    else
      clashing_.erase(cluster);
  }

  const Neighbours& neighbours_;
  std::size_t colors_;
  Colors color_of_;
  std::vector<std::size_t> costs_;        ///< of each cluster in each colour, with its neighbours as they are
  std::vector<std::size_t> rests_until_;  ///< step from which a cluster may have a colour again
  std::set<std::uint32_t> clashing_;      ///< with a neighbour in their colour
  std::size_t cost_ = 0;                  ///< of all pairs
};

}  // namespace

std::vector<std::size_t> colorNeighbours(std::size_t clusters, const std::vector<ClusterPicture>& pictures,
                                         std::size_t primary, std::size_t colors) {
  const Neighbours neighbours = neighboursIn(pictures, clusters);
  Colors color_of = colored(neighbours, smallestLast(neighbours, false), primary, colors);
  Improvement first(neighbours, color_of, colors);
  if (first.cost() == 0) return color_of;
  Improvement second(neighbours, colored(neighbours, smallestLast(neighbours, true), primary, colors), colors);
  return (second.cost() < first.cost() ? second : first).run();
}

}  // namespace lisco_apps
