// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "endless_streams.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ostream>
#include <utility>

#include "oracle.h"

namespace lisco_test {

namespace {

constexpr double kPi = 3.14159265358979323846;

/// Of a column, radians.
double azimuthOf(const lisco::EndlessParameters& parameters, double position) {
  return parameters.start_azimuth + (parameters.clockwise ? -2 : 2) * kPi * (position - std::floor(position));
}

class EndlessOracle {
 public:
  explicit EndlessOracle(const lisco::EndlessParameters& parameters) : parameters_(parameters) {}

  std::vector<Delivery> operator()(const std::vector<StreamColumn>& columns) {
    // Large positions are counted from the first turn: exactly, with the rounding of a stream that begins at 0.
    constexpr double kLarge = 1e6;
    if (!columns.empty() && std::fabs(columns.front().position) > kLarge)
      first_turn_ = std::floor(columns.front().position);
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const double position = columns[c].position - first_turn_;
      const auto eighth = static_cast<std::int64_t>(std::floor(8 * position));
      closeUpTo(position, c);
      if (c > 0 && eighth != static_cast<std::int64_t>(std::floor(8 * (columns[c - 1].position - first_turn_))))
        for (std::size_t root = 0; root < members_.size(); ++root)
          if (isOpen(root) && firstOf(root).eighth <= eighth - 8) close(root, c, true);
      for (const lisco::Return& cell : columns[c].cells)
        if (isValid({cell.x, cell.y, cell.z})) add(cell, columns[c].position, position, eighth);
      closeUpTo(position, c);  // outliers have no neighbours
    }
    for (std::size_t root = 0; root < members_.size(); ++root)
      if (isOpen(root)) close(root, columns.size(), false);
    std::sort(deliveries_.begin(), deliveries_.end());
    return deliveries_;
  }

  std::size_t outliers() const { return outliers_; }

 private:
  struct Member {
    lisco::Return cell;
    double given_position;
    std::int64_t eighth;
    bool is_outlier;
    double reach_end;
  };
  enum class State { kOpen, kWhole, kCut };

  void add(const lisco::Return& cell, double given_position, double position, std::int64_t eighth) {
    const double east = static_cast<double>(cell.x) - static_cast<double>(parameters_.origin[0]);
    const double north = static_cast<double>(cell.y) - static_cast<double>(parameters_.origin[1]);
    const double rho = std::hypot(east, north);
    const double off = std::remainder(std::atan2(north, east) - azimuthOf(parameters_, position), 2 * kPi);
    Member own{cell, given_position, eighth, rho > 0 && std::fabs(off) > parameters_.stagger + 1e-4, position};
    outliers_ += own.is_outlier ? 1 : 0;
    const double eps = std::fabs(static_cast<double>(parameters_.tolerance));
    if (!own.is_outlier) {
      own.reach_end = static_cast<double>(eighth + 4) / 8;
      if (rho > eps * (1 + lisco::kNearMargin))
        own.reach_end =
            std::min(own.reach_end, position + (std::asin(eps / rho) + 2 * parameters_.stagger) / (2 * kPi));
    }
    const std::size_t number = all_.size();
    all_.push_back(own);
    root_of_.push_back(number);
    members_.push_back({number});
    state_.push_back(State::kOpen);
    continued_.push_back(false);
    for (std::size_t other = 0; other < number; ++other) {
      const Member& before = all_[other];
      if (before.is_outlier || own.is_outlier || eighth - before.eighth > 3) continue;
      if (!areNeighbours({before.cell.x, before.cell.y, before.cell.z}, {cell.x, cell.y, cell.z},
                         parameters_.tolerance))
        continue;
      ASSERT_NE(state_[root_of_[other]], State::kWhole) << "a delivered cluster was reached";
      if (state_[root_of_[other]] == State::kCut)
        continued_[root_of_[number]] = true;
      else
        join(root_of_[number], root_of_[other]);
    }
  }

  void join(std::size_t a, std::size_t b) {
    if (a == b) return;
    for (const std::size_t member : members_[a]) root_of_[member] = b;
    members_[b].insert(members_[b].end(), members_[a].begin(), members_[a].end());
    members_[a].clear();
    continued_[b] = continued_[b] || continued_[a];
  }

  bool isOpen(std::size_t root) const { return !members_[root].empty() && state_[root] == State::kOpen; }
  const Member& firstOf(std::size_t root) const {
    return all_[*std::min_element(members_[root].begin(), members_[root].end())];
  }
  double reachEndOf(std::size_t root) const {
    double end = -1e300;
    for (const std::size_t member : members_[root]) end = std::max(end, all_[member].reach_end);
    return end;
  }
  void closeUpTo(double position, std::size_t column) {
    for (std::size_t root = 0; root < members_.size(); ++root)
      if (isOpen(root) && reachEndOf(root) <= position) close(root, column, false);
  }
  void close(std::size_t root, std::size_t column, bool cut) {
    state_[root] = cut ? State::kCut : State::kWhole;
    Delivery delivery{{}, cut, continued_[root], firstOf(root).given_position, -1e300, reachEndOf(root), column};
    for (const std::size_t member : members_[root]) {
      delivery.members.push_back(all_[member].cell.source_index);
      delivery.last_position = std::max(delivery.last_position, all_[member].given_position);
    }
    std::sort(delivery.members.begin(), delivery.members.end());
    delivery.reach_end += first_turn_;
    deliveries_.push_back(delivery);
  }

  lisco::EndlessParameters parameters_;
  std::vector<Member> all_;
  std::vector<std::size_t> root_of_;
  std::vector<std::vector<std::size_t>> members_;
  std::vector<State> state_;
  std::vector<bool> continued_;
  std::vector<Delivery> deliveries_;
  std::size_t outliers_ = 0;
  double first_turn_ = 0;
};

}  // namespace

EndlessTruth endlessTruth(const EndlessStream& stream) {
  EndlessOracle oracle(stream.parameters);
  std::vector<Delivery> deliveries = oracle(stream.columns);
  return {std::move(deliveries), oracle.outliers()};
}

std::ostream& operator<<(std::ostream& out, const Delivery& delivery) {
  out << (delivery.cut ? "cut " : "") << (delivery.continued ? "continued " : "") << "reached up to "
      << delivery.reach_end << ", by column " << delivery.column << ":";
  for (const std::uint32_t member : delivery.members) out << ' ' << member;
  return out;
}

EndlessStream randomEndlessStream(Random& random, std::optional<double> first_position,
                                  const lisco::EndlessParameters* given) {
  EndlessStream stream;
  lisco::EndlessParameters& parameters = stream.parameters;
  parameters.tolerance = static_cast<float>(random.magnitude(0.05, 2.0));
  parameters.clockwise = random.chance(0.5);
  parameters.start_azimuth = random.chance(0.5) ? 0.0 : random.between(-4.0, 4.0);
  parameters.stagger = random.chance(0.3) ? random.between(0.0, 0.05) : random.between(0.05, 0.39);
  parameters.block_columns = random.oneOf(std::vector<std::size_t>{1, 2, 7, 16, 64});
  if (random.chance(0.3))
    parameters.origin = {static_cast<float>(random.between(-5, 5)), static_cast<float>(random.between(-5, 5)), 1.0F};
  if (given != nullptr) parameters = *given;
  const std::size_t lasers = 1 + random.below(3);
  const std::size_t steps = 12 + random.below(60);
  const double turns = random.between(0.5, 4.0);
  const double room = random.chance(0.4) ? random.between(0.5, 6.0) : 1e9;  // a wall all around, or none
  const double things = random.unit();
  const double losses = random.chance(0.3) ? 0.2 : 0.0;
  const double outliers = random.chance(0.2) ? 0.05 : 0.0;
  const double near = random.chance(0.3) ? random.unit() : 0.0;
  struct Thing {
    double azimuth, width, range, speed, approach;
  };
  std::vector<Thing> all_things;
  for (std::size_t i = 0; i < 6; ++i)
    all_things.push_back({random.between(0, 2 * kPi), random.magnitude(0.02, 3.0), random.magnitude(0.3, 20.0),
                          random.between(-1.0, 1.0), random.between(-0.3, 0.3)});
  std::vector<double> offsets(lasers);
  for (double& offset : offsets) offset = random.between(-1.0, 1.0) * parameters.stagger;
  double position = random.chance(0.5) ? 0.0 : random.between(-3.0, 1000.0);
  if (first_position) position = *first_position;
  const double end = position + turns;
  std::uint32_t number = 0;
  while (position < end) {
    StreamColumn column{position, {}};
    for (std::size_t laser = 0; laser < lasers; ++laser) {
      double azimuth = azimuthOf(parameters, position) + offsets[laser];
      double range = room;
      for (const Thing& thing : all_things) {
        const double off = std::remainder(azimuth - thing.azimuth - thing.speed * position, 2 * kPi);
        if (things < 0.8 && std::fabs(off) < thing.width / 2)
          range = std::min(range, std::max(0.1, thing.range + thing.approach * std::fmod(position, 4.0)));
      }
      if (random.chance(near)) range = random.between(0.0, 1.5) * static_cast<double>(parameters.tolerance);
      if (random.chance(outliers)) azimuth += random.between(0.5, 5.5);
      range *= random.between(0.999, 1.001);
      lisco::Return cell{static_cast<float>(static_cast<double>(parameters.origin[0]) + range * std::cos(azimuth)),
                         static_cast<float>(static_cast<double>(parameters.origin[1]) + range * std::sin(azimuth)),
                         static_cast<float>(0.3 * static_cast<double>(laser)), number};
      if (range > 1e6) cell.x = random.chance(0.5) ? std::numeric_limits<float>::quiet_NaN() : 0.0F;
      if (range > 1e6) cell.y = cell.z = 0.0F;
      column.cells.push_back(cell);
      ++number;
    }
    while (!column.cells.empty() && random.chance(0.05)) column.cells.pop_back();
    if (!random.chance(losses)) stream.columns.push_back(column);
    if (!random.chance(0.02)) position += random.between(0.5, 1.5) / static_cast<double>(steps);
    if (random.chance(losses / 10)) position += random.magnitude(0.05, 2.0);
  }
  return stream;
}

EndlessStream latestNeighbours(Random& random, double first_position) {
  EndlessStream stream;
  lisco::EndlessParameters& parameters = stream.parameters;
  parameters.tolerance = static_cast<float>(random.magnitude(0.001, 1.0));
  parameters.clockwise = random.chance(0.5);
  parameters.stagger = random.chance(0.5) ? random.between(0.001, 0.03) : random.between(0.03, 0.39);
  parameters.block_columns = random.chance(0.7) ? 1 : 16;
  const double sense = parameters.clockwise ? -1 : 1;
  constexpr double kInside = 1e-6;  // radians, of the stagger, and of the tolerance
  double position = first_position;
  std::uint32_t number = 0;
  for (int pair = 0; pair < 4; ++pair) {
    const double rho = static_cast<double>(parameters.tolerance) * random.magnitude(1.5, 3000.0);
    const double gap = static_cast<double>(parameters.tolerance) * (1 - kInside);
    const double tangent = std::asin(gap / rho);  // on a tangent lies the neighbour farthest in azimuth
    const double first = azimuthOf(parameters, position) + sense * (parameters.stagger - kInside);
    const double second = first + sense * tangent;
    const double second_rho = rho * std::cos(tangent);
    const auto at = [&](double azimuth, double range) {
      return lisco::Return{static_cast<float>(range * std::cos(azimuth)), static_cast<float>(range * std::sin(azimuth)),
                           0.0F, number++};
    };
    stream.columns.push_back({position, {at(first, rho)}});
    double latest = position + (tangent + 2 * (parameters.stagger - kInside)) / (2 * kPi);
    while (sense * std::remainder(azimuthOf(parameters, latest) - second, 2 * kPi) > parameters.stagger - kInside)
      latest = std::nextafter(latest, -INFINITY);
    latest = std::max(latest, position);
    stream.columns.push_back({latest, {}});
    stream.columns.push_back({latest, {at(second, second_rho)}});
    position = std::max(latest, position + 1.0);
  }
  return stream;
}

void scale(EndlessStream& stream, double factor) {
  const auto scaled = [factor](float& coordinate) {
    coordinate = static_cast<float>(static_cast<double>(coordinate) * factor);
  };
  for (float& coordinate : stream.parameters.origin) scaled(coordinate);
  for (StreamColumn& column : stream.columns)
    for (lisco::Return& cell : column.cells)
      for (float* coordinate : {&cell.x, &cell.y, &cell.z}) scaled(*coordinate);
}

Delivery deliveryOf(const lisco::EndlessCluster& cluster, std::size_t column) {
  Delivery delivery{{},
                    cluster.isCut(),
                    cluster.isContinued(),
                    cluster.firstPosition(),
                    cluster.lastPosition(),
                    cluster.reachEnd(),
                    column};
  cluster.forEachRun([&](const std::uint32_t* indices, std::size_t count) {
    delivery.members.insert(delivery.members.end(), indices, indices + count);
  });
  std::sort(delivery.members.begin(), delivery.members.end());
  return delivery;
}

std::vector<Delivery> deliveriesOf(lisco::EndlessClusterer& clusterer, const EndlessStream& stream) {
  std::vector<Delivery> deliveries;
  std::size_t column = 0;
  clusterer.begin(stream.parameters, [&](const lisco::EndlessCluster& cluster) {
    Delivery delivery = deliveryOf(cluster, column);
    EXPECT_EQ(delivery.members.size(), cluster.size());
    EXPECT_LE(cluster.lastPosition() - cluster.firstPosition(), 1.0);  // at most, up to rounding
    deliveries.push_back(std::move(delivery));
  });
  for (; column < stream.columns.size(); ++column)
    clusterer.addColumn(stream.columns[column].cells.data(), stream.columns[column].cells.size(),
                        stream.columns[column].position);
  clusterer.finish();
  std::sort(deliveries.begin(), deliveries.end());
  return deliveries;
}

void expectSame(const EndlessStream& stream, const std::vector<Delivery>& expected,
                const std::vector<Delivery>& actual) {
  ASSERT_EQ(expected.size(), actual.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    SCOPED_TRACE(testing::PrintToString(expected[i]) + "\n" + testing::PrintToString(actual[i]));
    ASSERT_EQ(expected[i].members, actual[i].members);
    EXPECT_EQ(expected[i].cut, actual[i].cut);
    EXPECT_EQ(expected[i].continued, actual[i].continued);
    EXPECT_EQ(expected[i].first_position, actual[i].first_position);
    EXPECT_EQ(expected[i].last_position, actual[i].last_position);
    EXPECT_NEAR(expected[i].reach_end, actual[i].reach_end, 1e-3);
    // Rounded reach ends may differ by a column. The block may have to be completed, unless an eighth ends.
    std::size_t in_time = expected[i].column;
    while (!actual[i].cut && in_time > 0 && stream.columns[in_time - 1].position >= actual[i].reach_end &&
           stream.columns[in_time - 1].position > actual[i].last_position)
      --in_time;
    while (!actual[i].cut && in_time < stream.columns.size() && stream.columns[in_time].position < actual[i].reach_end)
      ++in_time;
    EXPECT_GE(actual[i].column, in_time);
    EXPECT_LT(actual[i].column, in_time + stream.parameters.block_columns);
  }
}

}  // namespace lisco_test
