// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

#include "bodies.h"
#include "input.h"
#include "lisco/column_clusterer.h"
#include "lisco/endless_clusterer.h"
#include "lisco/window_clusterer.h"
#include "oracle.h"
#include "shapes.h"

namespace lisco_test {
namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};
constexpr std::size_t kMaxPoints = 96;  // of one clusterer since its beginning
constexpr std::size_t kMaxLasers = 6;

/// \throws Finding unless the call throws an Error
template <typename Error, typename Call>
void holdThrows(Call&& call, const char* what) {
  try {
    call();
  } catch (const Error&) {
    return;
  }
  throw Finding(what);
}

float coordinateFrom(Input& input) {
  const unsigned how = input.byte();
  if (how == 255) return input.rawFloat();
  return (static_cast<float>(how) - 128.0F) / 8.0F;
}

/// The returns added since the beginning, and cells that hold them.
struct Given {
  struct Place {
    std::size_t laser, column;
  };
  std::vector<Point> points;  ///< by source index
  std::vector<Place> places;
  std::size_t columns = 0;
  std::vector<lisco::Return> cells;

  void clear() {
    points.clear();
    places.clear();
    columns = 0;
  }

  /// The next column, of which some cells are empty.
  void addColumn(Input& input, std::size_t lasers) {
    cells.clear();
    for (std::size_t laser = 0; laser < lasers; ++laser) {
      cells.push_back(lisco::kNoReturn);
      if (input.chance() || points.size() == kMaxPoints) continue;
      const Point point{coordinateFrom(input), coordinateFrom(input), coordinateFrom(input)};
      cells.back() = {point.x, point.y, point.z, static_cast<std::uint32_t>(points.size())};
      points.push_back(point);
      places.push_back({laser, columns});
    }
    ++columns;
  }

  /// The points of columns first..end-1; the others are no returns.
  std::vector<Point> pointsIn(std::size_t first, std::size_t end) const {
    std::vector<Point> some = points;
    for (std::size_t i = 0; i < some.size(); ++i)
      if (places[i].column < first || places[i].column >= end) some[i] = {0, 0, 0};
    return some;
  }
};

template <typename Clusterer>
std::vector<std::uint32_t> holdExact(Clusterer& clusterer, const std::vector<Point>& points, float tolerance) {
  std::vector<std::uint32_t> subcluster_of(points.size(), kNone);
  std::size_t returns = 0;
  clusterer.forEachRun([&](const std::uint32_t* source_indices, std::size_t count, std::uint32_t subcluster) {
    returns += count;
    for (std::size_t i = 0; i < count; ++i) {
      hold(source_indices[i] < points.size() && subcluster_of[source_indices[i]] == kNone,
           "a return comes twice, or from nowhere");
      subcluster_of[source_indices[i]] = subcluster;
    }
  });
  hold(returns == clusterer.returnCount(), "the number of returns");
  hold(areTrueClusters(points, tolerance, subcluster_of, clusterer.subclusterCount(),
                       [&](std::uint32_t subcluster) { return clusterer.sizeOf(subcluster); }),
       "the clusters are not the oracle's");
  return subcluster_of;
}

/// A clusterer and its expected state.
class Rotations {
 public:
  void act(Input& input) {
    const unsigned what = input.byte();
    switch (what % 8) {
      case 0:
        return begin(input);
      case 1:
        if (what / 8 % 16 != 0) return addColumn(input);
        clusterer_ = std::make_unique<lisco::ColumnClusterer>();
        begun_ = false;
        given_.clear();
        return;
      case 2:
      case 3:
        return addColumns(input, what / 8);
      case 4:
        return query();
      default:
        return addColumn(input);
    }
  }

  void end() {
    if (begun_) query();
  }

 private:
  void begin(Input& input) {
    constexpr std::array<int, 8> kSteps{0, 0, 511, 512, 512, 640, 16385, -5};
    lisco::Parameters parameters;
    parameters.tolerance = toleranceFrom(input, 0.5F);
    const unsigned flags = input.byte();
    parameters.sensor.steps_per_turn = kSteps[flags % 8];
    parameters.sensor.clockwise = (flags & 8U) != 0;
    parameters.sensor.elevation_step = (flags & 16U) != 0 ? input.rawFloat() : 0.3F;
    if ((flags & 32U) != 0) parameters.sensor.roughness = input.rawFloat();
    if ((flags & 64U) != 0) parameters.sensor.far_distance = input.rawFloat();
    if ((flags & 128U) != 0)
      parameters.sensor.origin = {input.rawFloat(), coordinateFrom(input), coordinateFrom(input)};
    parameters.block_columns = input.byte();
    const unsigned more = input.byte();
    parameters.threads = more % 4;
    parameters.lasers = more / 4 % 2 != 0 ? kMaxLasers : 0;
    parameters.expected_returns = more / 8;
    clusterer_->begin(parameters);
    parameters_ = parameters;
    begun_ = true;
    given_.clear();
  }

  void addColumn(Input& input) {
    const std::size_t lasers = input.below(kMaxLasers + 2);
    if (!begun_)
      return holdThrows<std::logic_error>([&] { clusterer_->addColumn(nullptr, 0); }, "a column before begin ()");
    if (lasers > kMaxLasers && parameters_.lasers != 0) {
      std::array<lisco::Return, kMaxLasers + 1> cells{};
      return holdThrows<std::invalid_argument>([&] { clusterer_->addColumn(cells.data(), lasers); }, "too many cells");
    }
    given_.addColumn(input, lasers);
    clusterer_->addColumn(given_.cells.data(), lasers);
  }

  /// Adds some columns at once, the first of which hold returns.
  void addColumns(Input& input, unsigned how) {
    constexpr std::array<std::size_t, 8> kCounts{0, 1, 2, 15, 16, 64, 100, 1400};
    const std::size_t count = kCounts[how % 8];
    const std::size_t lasers = how / 8 % 4 == 0 ? input.below(kMaxLasers + 1) : kMaxLasers;
    if (!begun_ || given_.columns + count > 6000) return;
    columns_.clear();
    for (std::size_t column = 0; column < std::min<std::size_t>(count, 4); ++column) {
      given_.addColumn(input, lasers);
      columns_.push_back(given_.cells);
    }
    given_.columns += count - columns_.size();
    clusterer_->addColumns(count, lasers, [&](std::size_t laser, std::size_t column) {
      return column < columns_.size() ? columns_[column][laser] : lisco::kNoReturn;
    });
  }

  void query() {
    clusterer_->update();
    if (!begun_) return;
    const std::vector<std::uint32_t> subcluster_of = holdExact(*clusterer_, given_.points, parameters_.tolerance);
    for (std::size_t i = 0; i < given_.points.size(); ++i)
      hold(clusterer_->subclusterAt(given_.places[i].laser, given_.places[i].column) == subcluster_of[i],
           "the subcluster at a place");
    hold(clusterer_->subclusterAt(kMaxLasers + 3, 0) == kNone, "the subcluster of an unknown laser");
    hold(clusterer_->subclusterAt(0, given_.columns) == kNone, "the subcluster of a column to come");
  }

  std::unique_ptr<lisco::ColumnClusterer> clusterer_ = std::make_unique<lisco::ColumnClusterer>();
  lisco::Parameters parameters_;
  bool begun_ = false;
  Given given_;
  std::vector<std::vector<lisco::Return>> columns_;
};

class Windows {
 public:
  void act(Input& input) {
    const unsigned what = input.byte();
    switch (what % 8) {
      case 0:
        return begin(input);
      case 1:
        if (columns_of_window_ > 0) holdExactWindow();
        return;
      default:
        for (unsigned i = 0; i <= what / 64; ++i) addColumn(input);
    }
  }

  void end() {
    if (columns_of_window_ > 0) holdExactWindow();
  }

 private:
  void begin(Input& input) {
    lisco::WindowParameters parameters;
    parameters.tolerance = toleranceFrom(input, 0.5F);
    const unsigned sizes = input.byte();
    parameters.hop_columns = sizes % 8 == 7 ? 65 : sizes % 8;
    parameters.window_columns = parameters.hop_columns * (sizes / 8 % 16) + sizes / 128;
    parameters.lasers = kMaxLasers;
    const std::size_t hop = parameters.hop_columns;
    if (hop == 0 || parameters.window_columns < hop || parameters.window_columns % hop != 0)
      return holdThrows<std::invalid_argument>([&] { clusterer_.begin(parameters); }, "a window that is none");
    clusterer_.begin(parameters);
    parameters_ = parameters;
    given_.clear();
    columns_of_window_ = 0;
  }

  void addColumn(Input& input) {
    const std::size_t lasers = input.below(kMaxLasers + 2);
    if (parameters_.hop_columns == 0)
      return holdThrows<std::logic_error>([&] { clusterer_.addColumn(nullptr, 0); }, "a column before begin ()");
    if (lasers > kMaxLasers) {
      std::array<lisco::Return, kMaxLasers + 1> cells{};
      return holdThrows<std::invalid_argument>([&] { clusterer_.addColumn(cells.data(), lasers); }, "too many cells");
    }
    given_.addColumn(input, lasers);
    const bool ends = clusterer_.addColumn(given_.cells.data(), lasers);
    hold(ends == (given_.columns % parameters_.hop_columns == 0), "a window's end");
    if (!ends) return;
    end_of_window_ = given_.columns;
    columns_of_window_ = std::min(given_.columns, parameters_.window_columns);
    if (input.chance()) holdExactWindow();
  }

  void holdExactWindow() {
    hold(clusterer_.columnCount() == columns_of_window_, "the columns of a window");
    holdExact(clusterer_, given_.pointsIn(end_of_window_ - columns_of_window_, end_of_window_), parameters_.tolerance);
  }

  lisco::WindowClusterer clusterer_;
  lisco::WindowParameters parameters_;
  Given given_;
  std::size_t end_of_window_ = 0, columns_of_window_ = 0;
};

/// Each return is delivered once, by finish () at the latest.
class Endless {
 public:
  void act(Input& input) {
    const unsigned what = input.byte();
    switch (what % 16) {
      case 0:
        return begin(input);
      case 1:
        if (begun_) clusterer_.update();
        hold(clusterer_.returnCount() == returns_, "the number of returns");
        return;
      case 2:
        return finish();
      case 3:
        return addColumnWithoutPosition(input);
      default:
        return addColumn(input, what);
    }
  }

  void end() { finish(); }

 private:
  void begin(Input& input) {
    lisco::EndlessParameters parameters;
    parameters.tolerance = toleranceFrom(input, 0.5F);
    const unsigned flags = input.byte();
    parameters.clockwise = (flags & 1U) != 0;
    parameters.lasers = kMaxLasers;
    parameters.columns_per_turn = (flags & 2U) != 0 ? 24 : 0;
    if ((flags & 4U) != 0) parameters.start_azimuth = static_cast<double>(coordinateFrom(input));
    if ((flags & 8U) != 0) parameters.stagger = static_cast<double>(input.rawFloat());
    if ((flags & 16U) != 0) parameters.origin = {input.rawFloat(), input.rawFloat(), input.rawFloat()};
    parameters.min_size = (flags & 32U) != 0 ? input.byte() : 1;
    parameters.block_columns = input.byte();
    const auto receive = [this](const lisco::EndlessCluster& cluster) {
      std::size_t size = 0;
      cluster.forEachRun([&](const std::uint32_t* indices, std::size_t count) {
        size += count;
        for (std::size_t i = 0; i < count; ++i) {
          hold(indices[i] < delivered_.size() && !delivered_[indices[i]], "a return is delivered twice");
          delivered_[indices[i]] = true;
        }
      });
      hold(size == cluster.size() && size >= parameters_.min_size, "the size of a cluster");
      hold(cluster.lastPosition() >= cluster.firstPosition(), "a cluster that ends before it begins");
      hold(cluster.lastPosition() - cluster.firstPosition() < 1.0, "a cluster longer than a turn");
      hold(cluster.reachEnd() >= cluster.lastPosition(), "a cluster that is out of reach at once");
      delivered_count_ += size;
    };
    const bool is_origin_finite = std::all_of(parameters.origin.begin(), parameters.origin.end(),
                                              [](float coordinate) { return std::isfinite(coordinate); });
    if (!(parameters.stagger >= 0 && parameters.stagger <= lisco::EndlessParameters::kMaxStagger) ||
        !is_origin_finite || !(std::fabs(parameters.start_azimuth) <= lisco::EndlessParameters::kMaxAzimuth))
      return holdThrows<std::invalid_argument>([&] { clusterer_.begin(parameters, receive); },
                                               "a stagger, origin or azimuth out of range");
    clusterer_.begin(parameters, receive);
    parameters_ = parameters;
    begun_ = true;
    given_.clear();
    delivered_.clear();
    returns_ = delivered_count_ = 0;
    position_.reset();
  }

  void makeColumn(Input& input, std::size_t lasers) {
    const std::size_t before = given_.points.size();
    given_.addColumn(input, lasers);
    delivered_.resize(given_.points.size(), false);
    for (std::size_t i = before; i < given_.points.size(); ++i) returns_ += isValid(given_.points[i]) ? 1 : 0;
  }

  void addColumn(Input& input, unsigned how) {
    constexpr std::array<double, 16> kSteps{0,     0.125, 0.125, 0.0625, 0.0625, 0.03125, 0.03125, 0.015625,
                                            0.010, 0.5,   0.875, 1,      1.125,  2,       3.25,    -0.125};
    const double position = how / 16 == 15 && input.chance() ? static_cast<double>(input.rawFloat())
                                                             : position_.value_or(0) + kSteps[how / 16];
    const std::size_t lasers = input.below(kMaxLasers + 2);
    if (!begun_)
      return holdThrows<std::logic_error>([&] { clusterer_.addColumn(nullptr, 0, position); },
                                          "a column before begin ()");
    if (lasers > kMaxLasers || !(std::fabs(position) <= 1e12) || (position_ && position < *position_)) {
      std::array<lisco::Return, kMaxLasers + 1> cells{};
      return holdThrows<std::invalid_argument>([&] { clusterer_.addColumn(cells.data(), lasers, position); },
                                               "a column that is wrong");
    }
    makeColumn(input, lasers);
    position_ = position;
    clusterer_.addColumn(given_.cells.data(), lasers, position);
    hold(clusterer_.returnCount() <= returns_, "the number of returns");
    hold(clusterer_.returnsHeld() <= returns_, "more returns are held than have come");
  }

  void addColumnWithoutPosition(Input& input) {
    if (!begun_ || !(parameters_.columns_per_turn > 0))
      return holdThrows<std::logic_error>([&] { clusterer_.addColumn(nullptr, 0); }, "a column without a position");
    const double position = clusterer_.nextPosition();
    if (std::fabs(position) > 1e12) return;
    const std::size_t lasers = input.below(kMaxLasers + 1);
    makeColumn(input, lasers);
    position_ = position;
    clusterer_.addColumn(given_.cells.data(), lasers);
  }

  void finish() {
    if (!begun_) return;
    clusterer_.finish();
    position_.reset();
    hold(clusterer_.returnCount() == returns_, "the number of returns");
    hold(delivered_count_ == returns_ || (parameters_.min_size > 1 && delivered_count_ < returns_),
         "a return is not delivered");
  }

  lisco::EndlessClusterer clusterer_;
  lisco::EndlessParameters parameters_;
  bool begun_ = false;
  Given given_;
  std::vector<bool> delivered_;
  std::size_t returns_ = 0, delivered_count_ = 0;
  std::optional<double> position_;
};

template <typename Clusterer>
void callAnyhow(Input& input) {
  Clusterer clusterer;
  for (int calls = 0; calls < 200 && input.left() > 0; ++calls) clusterer.act(input);
  clusterer.end();
}

}  // namespace

void fuzzStream(const std::uint8_t* data, std::size_t size) {
  Input input(data, size);
  switch (input.below(3)) {
    case 0:
      return callAnyhow<Rotations>(input);
    case 1:
      return callAnyhow<Windows>(input);
    default:
      return callAnyhow<Endless>(input);
  }
}

}  // namespace lisco_test
