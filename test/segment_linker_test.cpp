// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Far returns in a strip of places: by itself on pairs made by hand, and within the engine on whole rotations.
#include "core/far/segment_linker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "core/disjoint_sets.h"
#include "core/ring_block.h"
#include "engine.h"
#include "far_hints.h"
#include "lisco/simd.h"
#include "oracle.h"
#include "random.h"
#include "scans.h"

namespace lisco_test {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr std::uint32_t kFirstPlace = 64;  // of the first return

/// A range image and its linker.
struct FarPart {
  lisco::RangeImage image;
  lisco::SegmentLinker linker;

  void prepare(const lisco::Tolerance& tolerance, const lisco::SensorHints& hints,
               std::size_t columns = ~std::size_t{0}) {
    image.prepare(tolerance, hints, columns);
    linker.prepare(image);
  }
};

/// Far returns alone, without voxels.
class Probe {
 public:
  Probe(float tolerance, const lisco::SensorHints& hints) { begin(tolerance, hints); }

  /// \param columns that each strip is told to expect
  void begin(float tolerance, const lisco::SensorHints& hints, std::size_t columns = ~std::size_t{0}) {
    hints_ = hints;
    tolerance_ = lisco::Tolerance(tolerance);
    lasers_ = 0;
    points_.clear();
    subclusters_.reset(0);
    for (FarPart& strip : strips_) strip.prepare(tolerance_, hints, columns);
    strip_ = &strips_.front();
  }

  /// What follows goes to a strip of its own.
  void useStrip(std::size_t number) { strip_ = &strips_.at(number); }

  /// The point a laser sees in the direction of a place (fractions count) of the strip, at a horizontal distance.
  Point pointAt(double place, double rho, double slope) const {
    const double turn = 2.0 * kPi * (place - kFirstPlace) / hints_.steps_per_turn;
    const double azimuth = 0.3 + (hints_.clockwise ? -turn : turn);
    return {static_cast<float>(rho * std::cos(azimuth)) + hints_.origin[0],
            static_cast<float>(rho * std::sin(azimuth)) + hints_.origin[1],
            static_cast<float>(rho * slope) + hints_.origin[2]};
  }

  /// \return whether it is loose
  bool put(std::size_t laser, std::uint32_t column, const Point& point) {
    const std::uint32_t i = column % lisco::RingBlock::kColumns;
    std::fill_n(row_.x, lisco::RingBlock::kMargin + lisco::RingBlock::kColumns, kNan);
    row_.x[lisco::RingBlock::kMargin + i] = point.x;
    row_.y[lisco::RingBlock::kMargin + i] = point.y;
    row_.z[lisco::RingBlock::kMargin + i] = point.z;
    return putRow(laser, column - i, lisco::RingBlock::kColumns) != 0;
  }
  bool put(std::size_t laser, double place, double rho, double slope) {
    return put(laser, static_cast<std::uint32_t>(std::lround(place)), pointAt(place, rho, slope));
  }

  /// Returns of a laser, one behind the other; each is a run of its own.
  /// \return which are loose
  std::uint64_t putRow(std::size_t laser, std::uint32_t first_column, const std::vector<Point>& points) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      row_.x[lisco::RingBlock::kMargin + i] = points[i].x;
      row_.y[lisco::RingBlock::kMargin + i] = points[i].y;
      row_.z[lisco::RingBlock::kMargin + i] = points[i].z;
    }
    return putRow(laser, first_column, points.size());
  }

  void link() { strip_->linker.link(strip_->image, subclusters_); }
  void linkAll() {
    bool full = false;
    for (FarPart& strip : strips_) strip.linker.linkRest(strip.image, subclusters_);
    for (std::size_t i = 0; i < strips_.size(); ++i) {
      for (std::size_t earlier = 0; earlier <= i; ++earlier)
        strips_[i].linker.linkTo(strips_[i].image, strips_[earlier].image, subclusters_);
      full = full || strips_[i].image.isFull();
    }
    if (full)
      for (FarPart& strip : strips_) strip.image.stopPlacing();
  }
  bool joined(std::uint32_t a, std::uint32_t b) { return subclusters_.find(a) == subclusters_.find(b); }
  bool neighbours(std::size_t a, std::size_t b, float tolerance) const {
    return areNeighbours(points_[a], points_[b], tolerance);
  }
  std::size_t size() const { return points_.size(); }
  const std::vector<Point>& points() const { return points_; }
  const FarPart& strip() const { return *strip_; }
  double nearEnd() const { return static_cast<double>(strip_->image.range.min_range); }

  Clustering clusters() {
    std::map<std::uint32_t, Cluster> by_head;
    for (std::uint32_t i = 0; i < points_.size(); ++i) by_head[subclusters_.find(i)].members.push_back(i);
    Clustering clusters;
    for (auto& [head, cluster] : by_head) clusters.push_back({cluster.members, cluster.members.size()});
    return inOrder(std::move(clusters));
  }

 private:
  std::uint64_t putRow(std::size_t laser, std::uint32_t first_column, std::size_t columns) {
    lisco::measure(row_, columns, tolerance_.squared(), strip_->image.range, measured_);
    for (std::size_t i = 0; i < columns; ++i) {
      if ((measured_.returns >> i & 1U) == 0) continue;
      const auto element = static_cast<std::uint32_t>(points_.size());
      points_.push_back({row_.x[lisco::RingBlock::kMargin + i], row_.y[lisco::RingBlock::kMargin + i],
                         row_.z[lisco::RingBlock::kMargin + i]});
      subclusters_.grow(element + 1);
      subclusters_.create(element);
      measured_.run[i] = element;
    }
    lasers_ = std::max(lasers_, laser + 1);
    strip_->image.addLasers(lasers_);
    if (measured_.far == 0) return 0;
    if (!strip_->image.started) {
      const auto first = static_cast<std::size_t>(__builtin_ctzll(measured_.far));
      strip_->image.start(row_.x[lisco::RingBlock::kMargin + first], row_.y[lisco::RingBlock::kMargin + first],
                          first_column + static_cast<std::uint32_t>(first));
    }
    return strip_->image.place(row_, measured_, laser, first_column);
  }

  std::array<FarPart, 3> strips_;
  FarPart* strip_ = &strips_.front();  ///< in use
  lisco::SensorHints hints_;
  lisco::Tolerance tolerance_;
  lisco::DisjointSets subclusters_;
  std::size_t lasers_ = 0;
  lisco::RingBlock row_{};
  lisco::RingBlockInfo measured_{};
  std::vector<Point> points_;
};

constexpr float kTolerance = 1.0F;
// So that returns are far as soon as can be; the tolerance reaches over about 45 places there.
const lisco::SensorHints kHints = hintsFor(1024, 0.5F);

/// The distance at which so many places are just within the tolerance.
double distanceFor(double places) {
  return 0.9999 * static_cast<double>(kTolerance) / (2.0 * std::sin(places * kPi / kHints.steps_per_turn));
}

/// Over how many places the tolerance reaches where returns begin to be far.
int mostApart() {
  int places = 0;
  while (distanceFor(places + 1) > 1.0001 * minRangeOf(kHints)) ++places;
  return places;
}

TEST(SegmentLinker, ReachesOverManyPlaces) {
  EXPECT_GT(mostApart(), 30);
  EXPECT_LT(mostApart(), 48);
}

TEST(SegmentLinker, IsOfUseOnlyWhereItsHintsAre) {
  FarPart strip;
  const auto inUse = [&strip](float tolerance, const lisco::SensorHints& hints) {
    strip.prepare(lisco::Tolerance(tolerance), hints);
    return strip.image.inUse();
  };
  EXPECT_FALSE(strip.image.inUse());
  EXPECT_TRUE(inUse(1.0F, kHints));
  EXPECT_TRUE(inUse(1.0F, hintsFor(512, 0.02F)));
  EXPECT_TRUE(inUse(1.0F, hintsFor(16384, 0.005F)));
  EXPECT_FALSE(inUse(1.0F, lisco::SensorHints()));
  EXPECT_FALSE(inUse(0.0F, kHints));
  EXPECT_FALSE(inUse(kNan, kHints));
  EXPECT_FALSE(inUse(std::numeric_limits<float>::infinity(), kHints));
  EXPECT_FALSE(inUse(1e15F, kHints));
  for (const int steps :
       {-1000, -1, 0, 1, 511, 16385, std::numeric_limits<int>::max(), std::numeric_limits<int>::min()})
    EXPECT_FALSE(inUse(1.0F, hintsFor(steps, 0.02F))) << steps;
  for (const float step : {kNan, 0.0F, -1.0F, 1e30F, std::numeric_limits<float>::infinity()})
    EXPECT_FALSE(inUse(1.0F, hintsFor(1024, step))) << step;
  lisco::SensorHints hints = kHints;
  const auto near_end = static_cast<float>(minRangeOf(kHints));
  for (const float distance : {0.999F * near_end, 0.0F, -1.0F, kNan}) {
    hints.far_distance = distance;
    EXPECT_FALSE(inUse(1.0F, hints)) << distance;
  }
  hints.far_distance = 1.001F * near_end;
  EXPECT_TRUE(inUse(1.0F, hints));
  for (const float slope : {kNan, 0.51F, -1e30F}) {
    hints.tilt = {0.5F, -0.5F};
    EXPECT_TRUE(inUse(1.0F, hints));
    hints.tilt[1] = slope;
    EXPECT_FALSE(inUse(1.0F, hints)) << slope;
  }
  hints.tilt = {};
  for (const float jitter : {kNan, -1.0F, 1e30F, std::numeric_limits<float>::infinity()}) {
    hints.jitter = jitter;
    EXPECT_EQ(inUse(1.0F, hints), !(jitter > 1.0F)) << jitter << ": farther away";
  }
  hints.jitter = 0.0F;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const float coordinate : {kNan, 1e30F, -std::numeric_limits<float>::infinity()}) {
      hints.origin = {1.0F, 2.0F, 3.0F};
      EXPECT_TRUE(inUse(1.0F, hints));
      hints.origin[axis] = coordinate;
      EXPECT_FALSE(inUse(1.0F, hints)) << coordinate << " on axis " << axis;
    }
}

// Whoever is only among the far has far neighbours only, whatever is rounded.
TEST(SegmentLinker, IsFarFromSomeTolerancesOn) {
  FarPart strip;
  for (const int steps : {512, 1024, 2000, 16384})
    for (const float elevation_step : {1e-4F, 0.001F, 0.01F, 0.1F, 1.0F})
      for (const float tolerance : {1e-16F, 0.1F, 1.0F, 1e10F}) {
        lisco::SensorHints hints = hintsFor(steps, elevation_step);
        hints.origin = {1.0F, 2.0F, 3.0F};
        strip.prepare(lisco::Tolerance(tolerance), hints);
        if (!strip.image.inUse()) continue;
        SCOPED_TRACE(std::to_string(steps) + " steps, " + std::to_string(elevation_step) + ", tolerance " +
                     testing::PrintToString(tolerance));
        const lisco::FarRange& range = strip.image.range;
        EXPECT_EQ(range.origin, hints.origin);
        EXPECT_GE(range.min_range, 2.49F * tolerance);
        EXPECT_GE(static_cast<double>(range.min_range) * std::sin(48.0 * 2.0 * kPi / steps),
                  0.999 * static_cast<double>(tolerance));
        EXPECT_GE(range.interior_min, 1.000005F * range.min_range + tolerance);
        EXPECT_LE(range.interior_min, 1.0001F * (range.min_range + tolerance));
        EXPECT_LE(range.interior_max, 0.99995F * range.max_range - tolerance);
        EXPECT_LE(range.max_range, 1e15F);
      }
  strip.prepare(lisco::Tolerance(1.0F), lisco::SensorHints());
  EXPECT_FALSE(strip.image.inUse());
  lisco::RingBlock row{};
  lisco::RingBlockInfo measured{};
  for (std::size_t i = 0; i < lisco::RingBlock::kColumns; ++i)
    row.x[lisco::RingBlock::kMargin + i] = static_cast<float>(std::pow(10.0, static_cast<double>(i % 39)));
  lisco::measure(row, lisco::RingBlock::kColumns, 1.0F, strip.image.range, measured);
  EXPECT_EQ(measured.far, 0U) << "no strip, nothing far";
}

// Two returns so many places apart, at all places of a group, of all lasers, in both orders, and only just neighbours.
TEST(SegmentLinker, PairsAcrossPlaces) {
  Probe probe(kTolerance, kHints);
  for (int apart = 0; apart <= mostApart(); ++apart)
    for (int first = 100; first < 116; ++first)
      for (const auto& [one, other] : {std::pair{0, 0}, {0, 1}, {1, 0}, {0, 3}, {3, 0}})
        for (const bool clockwise : {false, true}) {
          if (apart == 0 && one == other) continue;
          SCOPED_TRACE(std::to_string(apart) + " places from " + std::to_string(first) + ", lasers " +
                       std::to_string(one) + " and " + std::to_string(other));
          lisco::SensorHints hints = kHints;
          hints.clockwise = clockwise;
          probe.begin(kTolerance, hints);
          const double rho = apart == 0 ? 50.0 : distanceFor(apart);
          EXPECT_FALSE(probe.put(5, kFirstPlace, 100.0, 0.0));
          EXPECT_FALSE(probe.put(static_cast<std::size_t>(one), first, rho, 0.0));
          EXPECT_FALSE(probe.put(static_cast<std::size_t>(other), first + apart, rho, 0.0));
          ASSERT_TRUE(probe.neighbours(1, 2, kTolerance));
          probe.linkAll();
          EXPECT_TRUE(probe.joined(1, 2));
          EXPECT_FALSE(probe.joined(0, 1));
        }
}

// Returns stand up to three quarters of a place from where they are, here in opposite directions.
TEST(SegmentLinker, PairsThatStandFurtherApartThanTheyAre) {
  constexpr double kOff = 0.745;
  Probe probe(kTolerance, kHints);
  for (int apart = 2; apart <= mostApart() + 2; ++apart)
    for (int first = 100; first < 116; ++first)
      for (const bool inwards : {false, true}) {
        SCOPED_TRACE(std::to_string(apart) + " places from " + std::to_string(first) + (inwards ? ", inwards" : ""));
        probe.begin(kTolerance, kHints);
        const double off = inwards ? kOff : -kOff;  // inwards: closer to each other than their places are
        const double distance = apart - 2.0 * off;
        const double rho = std::min(200.0, distanceFor(distance));
        if (rho < probe.nearEnd() * 1.0001) continue;
        EXPECT_FALSE(probe.put(2, kFirstPlace, 300.0, 0.0));
        EXPECT_FALSE(probe.put(0, first - 1, 300.0, 0.0));
        EXPECT_FALSE(probe.put(1, first + apart - 1, 300.0, 0.1));
        EXPECT_FALSE(probe.put(0, static_cast<std::uint32_t>(first), probe.pointAt(first + off, rho, 0.0)));
        EXPECT_FALSE(
            probe.put(1, static_cast<std::uint32_t>(first + apart), probe.pointAt(first + apart - off, rho, 0.0)));
        ASSERT_TRUE(probe.neighbours(3, 4, kTolerance));
        probe.linkAll();
        EXPECT_TRUE(probe.joined(3, 4));
      }
}

TEST(SegmentLinker, AReturnThatIsNotWhereItIsExpectedIsPutWhereItIs) {
  Probe probe(kTolerance, kHints);
  EXPECT_FALSE(probe.put(0, kFirstPlace, 300.0, 0.0));
  EXPECT_FALSE(probe.put(1, 500.0, 100.0, 0.0));
  EXPECT_FALSE(probe.put(0, kFirstPlace + 1, probe.pointAt(500.0, 100.0, 0.001)));  // column 65, seen at place 500
  EXPECT_FALSE(probe.put(0, kFirstPlace + 2, probe.pointAt(kFirstPlace + 1.0, 300.0, 0.001)));  // and back
  EXPECT_FALSE(probe.put(0, kFirstPlace + 900, probe.pointAt(501.0, 100.0, 0.0)));
  probe.linkAll();
  EXPECT_TRUE(probe.joined(1, 2));
  EXPECT_TRUE(probe.joined(1, 4));
  EXPECT_FALSE(probe.joined(0, 1));
  EXPECT_FALSE(probe.joined(0, 3));
}

// The opposite side of the turn, at the same distance from the line through the expected place.
TEST(SegmentLinker, AReturnOnTheOppositeSideIsNotExpected) {
  Probe probe(kTolerance, kHints);
  EXPECT_FALSE(probe.put(0, kFirstPlace, 300.0, 0.0));
  EXPECT_FALSE(probe.put(0, kFirstPlace + 1, probe.pointAt(kFirstPlace + 1.0 + 512.0, 50.0, 0.0)));
  EXPECT_FALSE(probe.put(1, kFirstPlace + 1, probe.pointAt(kFirstPlace + 1.0 + 512.0, 50.0, 0.001)));
  probe.linkAll();
  EXPECT_TRUE(probe.joined(1, 2));
}

TEST(SegmentLinker, TheSeam) {
  Probe probe(kTolerance, kHints);
  const int turn = kHints.steps_per_turn;
  for (int apart = 0; apart <= mostApart(); ++apart)
    for (int last = turn + 30; last < turn + 200; last += apart <= 6 ? 1 : 5)
      for (const int sign : {-1, 1}) {
        const int first = last - turn + sign * apart;
        if (first < 0 || first == static_cast<int>(kFirstPlace)) continue;
        SCOPED_TRACE("places " + std::to_string(first) + " and " + std::to_string(last));
        const double rho = apart == 0 ? 50.0 : distanceFor(apart);
        probe.begin(kTolerance, kHints);
        EXPECT_FALSE(probe.put(2, kFirstPlace, 300.0, 0.0));
        EXPECT_FALSE(probe.put(3, kFirstPlace, 300.0, 0.0));
        const std::size_t laser = static_cast<std::size_t>(last) % 3;
        // By a quarter and a half of a turn, lest the turn be mistaken.
        EXPECT_FALSE(probe.put(laser, first, rho, 0.0));
        for (const int place : {300, 600, 900}) EXPECT_FALSE(probe.put(1, place, 300.0, 0.0));
        EXPECT_FALSE(probe.put(1, last, rho, 0.0));
        ASSERT_TRUE(probe.neighbours(2, 6, kTolerance));
        probe.linkAll();
        EXPECT_TRUE(probe.joined(2, 6));
      }
}

// A turn in three strips, which begin at any fraction of each other's places.
TEST(SegmentLinker, StripsOfOneTurn) {
  Probe probe(kTolerance, kHints);
  const int turn = kHints.steps_per_turn;
  const int third = turn / 3;
  for (int apart = 0; apart <= mostApart(); ++apart)
    for (int border = 0; border < 3; ++border)
      for (const double shift : {0.0, 0.3, 0.5, 0.9}) {
        SCOPED_TRACE(std::to_string(apart) + " places apart at border " + std::to_string(border) + ", shifted by " +
                     std::to_string(shift));
        const double rho = apart == 0 ? 50.0 : distanceFor(apart);
        probe.begin(kTolerance, kHints, static_cast<std::size_t>(third));
        std::array<std::uint32_t, 2> number{};
        for (int strip = 0; strip < 3; ++strip) {
          probe.useStrip(static_cast<std::size_t>(strip));
          const double first = kFirstPlace + third * strip + shift * strip;
          const double last = kFirstPlace + third * (strip + 1) - 1;
          EXPECT_FALSE(probe.put(0, first + (apart + 1) / 2, 300.0, 0.0));
          if (strip == (border + 1) % 3) {
            number[1] = static_cast<std::uint32_t>(probe.size());
            EXPECT_FALSE(probe.put(1, first + (apart + 1) / 2, rho, 0.0));
          }
          if (strip == border) {
            number[0] = static_cast<std::uint32_t>(probe.size());
            const double end =
                border == 2 ? kFirstPlace + turn : kFirstPlace + third * (strip + 1) + shift * (strip + 1);
            EXPECT_FALSE(probe.put(2, end - apart / 2, rho, 0.0)) << last;
          }
          EXPECT_FALSE(probe.put(0, last, 300.0, 0.0));
        }
        ASSERT_TRUE(probe.neighbours(number[0], number[1], kTolerance));
        probe.linkAll();
        EXPECT_TRUE(probe.joined(number[0], number[1]));
      }
}

TEST(SegmentLinker, BeforeTheFirstReturn) {
  Probe probe(kTolerance, kHints);
  for (int place = 0; place <= 64; ++place) {
    probe.begin(kTolerance, kHints);
    EXPECT_FALSE(probe.put(0, kFirstPlace, 300.0, 0.0));
    EXPECT_FALSE(probe.put(1, kFirstPlace, probe.pointAt(place, 50.0, 0.0)));
    for (const int later : {300, 600, 900}) EXPECT_FALSE(probe.put(0, later, 300.0, 0.0));
    EXPECT_FALSE(probe.put(0, place + 1024, 50.0, 0.0));
    EXPECT_FALSE(probe.put(2, kFirstPlace, probe.pointAt(place + 1, 50.0, 0.0)));
    probe.linkAll();
    EXPECT_TRUE(probe.joined(1, 5)) << place;
    EXPECT_TRUE(probe.joined(1, 6)) << place;
  }
}

// Several turns: they lie in one layer each, but for a few returns, and are found all the same.
TEST(SegmentLinker, BeyondTheLastPlace) {
  Probe probe(kTolerance, kHints);
  std::vector<bool> loose;
  for (int place = kFirstPlace; place < 3 * 1024 + 200; ++place)
    loose.push_back(probe.put(0, place, 1.01 * probe.nearEnd(), 0.0));
  const std::size_t placed =
      static_cast<std::size_t>(std::find(loose.begin(), loose.end(), true) - loose.begin()) + kFirstPlace;
  EXPECT_EQ(placed, 1024U + 256U);
  EXPECT_LT(std::count(loose.begin(), loose.end(), true), 200);
  EXPECT_EQ(probe.strip().image.layers, 3U);
  probe.linkAll();
  for (std::uint32_t i = 0; i < probe.size(); ++i) ASSERT_TRUE(probe.joined(0, i)) << i;
}

TEST(SegmentLinker, ALooseReturnIsFoundAtOnceAndLater) {
  Probe probe(kTolerance, kHints);
  const int most = mostApart();
  const double last = distanceFor(most);
  for (int place = 100; place < 116; ++place)
    for (const int apart : {-most, -20, -3, 1, 20, most}) {
      probe.begin(kTolerance, kHints);
      EXPECT_FALSE(probe.put(2, kFirstPlace, 300.0, 0.0));
      EXPECT_FALSE(probe.put(1, place, 100.0, 0.0));
      EXPECT_TRUE(probe.put(1, place, last, 0.0)) << "there is one already";
      probe.linkAll();
      EXPECT_FALSE(probe.joined(1, 2));
      EXPECT_FALSE(probe.put(0, place + apart, last, 0.0));
      probe.linkAll();
      EXPECT_TRUE(probe.joined(2, 3)) << place << ", " << apart;
      EXPECT_FALSE(probe.joined(1, 2));
    }
}

// A laser that is so far behind the others that all is compared before it comes.
TEST(SegmentLinker, ALateReturnIsFound) {
  Probe probe(kTolerance, kHints);
  for (int place = 100; place < 116; ++place)
    for (int apart = -mostApart() + 1; apart < mostApart(); ++apart) {
      const double rho = apart == 0 ? 50.0 : distanceFor(std::abs(apart));
      probe.begin(kTolerance, kHints);
      for (int other = kFirstPlace; other < 400; ++other)
        EXPECT_FALSE(probe.put(0, other, other == place ? rho : 300.0, 0.0));
      probe.link();
      EXPECT_FALSE(probe.put(1, 400, probe.pointAt(place + apart, rho, 0.0)));
      const auto late = static_cast<std::uint32_t>(probe.size() - 1);
      probe.linkAll();
      EXPECT_TRUE(probe.joined(static_cast<std::uint32_t>(place) - kFirstPlace, late)) << place << ", " << apart;
      EXPECT_FALSE(probe.joined(static_cast<std::uint32_t>(place) - kFirstPlace + 1, late));
      // And one later still, next to the late one.
      EXPECT_FALSE(probe.put(2, 400, probe.pointAt(place + apart + 1, rho, 0.0)));
      probe.linkAll();
      EXPECT_TRUE(probe.joined(late, late + 1));
    }
}

// A look at the subclusters between a late return and its neighbour, which comes in time.
TEST(SegmentLinker, ALateReturnIsFoundByThoseAfterIt) {
  Probe probe(kTolerance, kHints);
  for (int last = 240; last < 272; ++last)
    for (int apart = 1; apart <= mostApart() - 1; ++apart) {
      const double rho = distanceFor(apart);
      probe.begin(kTolerance, kHints);
      for (int other = kFirstPlace; other < last; ++other) EXPECT_FALSE(probe.put(0, other, 300.0, 0.0));
      probe.link();
      EXPECT_FALSE(probe.put(1, static_cast<std::uint32_t>(last), probe.pointAt(last - apart, rho, 0.0)));
      const auto late = static_cast<std::uint32_t>(probe.size() - 1);
      probe.linkAll();
      EXPECT_FALSE(probe.put(0, last, rho, 0.0));
      ASSERT_TRUE(probe.neighbours(late, late + 1, kTolerance));
      probe.linkAll();
      ASSERT_TRUE(probe.joined(late, late + 1)) << last << ", " << apart;
    }
}

TEST(SegmentLinker, ALateReturnIsFoundAcrossTheSeam) {
  Probe probe(kTolerance, kHints);
  for (const int apart : {-mostApart(), -16, -1, 0, 1, 16, mostApart()}) {
    const double rho = apart == 0 ? 50.0 : distanceFor(std::abs(apart));
    probe.begin(kTolerance, kHints);
    for (int place = kFirstPlace; place < 1124; ++place)
      EXPECT_FALSE(probe.put(0, place, place == 1100 ? rho : 300.0, 0.0));
    probe.linkAll();
    EXPECT_FALSE(probe.put(1, 100, probe.pointAt(1100 - 1024 + apart, rho, 0.0)));
    EXPECT_FALSE(probe.put(1, 101, probe.pointAt(1040, 300.0, 0.0)));
    probe.linkAll();
    EXPECT_TRUE(probe.joined(1100 - kFirstPlace, static_cast<std::uint32_t>(probe.size() - 2))) << apart;
  }
}

// One return above the other, as far as neighbours can be, with lasers in between and in any order.
TEST(SegmentLinker, PairsAboveEachOther) {
  Probe probe(kTolerance, kHints);
  std::array<std::size_t, 6> laser_of{};
  for (const int order : {0, 1, 2, 3, 4, 5, 6, 7}) {
    std::iota(laser_of.begin(), laser_of.end(), std::size_t{0});
    if (order == 1) std::reverse(laser_of.begin(), laser_of.end());
    Random random(static_cast<std::uint64_t>(order));
    if (order > 1) random.shuffle(laser_of);
    for (const bool linked_before : {false, true})
      for (std::size_t ring = 0; ring < 4; ++ring)
        for (const auto& [rho, apart] : {std::pair{30.0, -2}, {30.0, 0}, {30.0, 2}, {4.5, -20}, {4.5, 0}, {4.5, 20}}) {
          SCOPED_TRACE("order " + std::to_string(order) + ", ring " + std::to_string(ring));
          probe.begin(kTolerance, kHints);
          const double across = 2.0 * rho * std::sin(std::abs(apart) * kPi / 1024.0);
          const double rise = std::sqrt(0.9999 - across * across) / rho;  // of two rings
          const auto slope = [&](std::size_t r) { return 0.07 - 0.5 * rise * static_cast<double>(r); };
          for (std::size_t r = 0; r < 6; ++r) EXPECT_FALSE(probe.put(laser_of[r], kFirstPlace, 300.0, slope(r)));
          if (linked_before) {
            for (std::size_t r = 0; r < 6; ++r) EXPECT_FALSE(probe.put(laser_of[r], 90, 300.0, slope(r)));
            probe.link();
          }
          EXPECT_FALSE(probe.put(laser_of[ring], 100, rho, slope(ring)));
          EXPECT_FALSE(probe.put(laser_of[ring + 2], 100 + apart, rho, slope(ring + 2)));
          const auto one = static_cast<std::uint32_t>(probe.size() - 2);
          ASSERT_TRUE(probe.neighbours(one, one + 1, kTolerance));
          probe.linkAll();
          EXPECT_TRUE(probe.joined(one, one + 1));
        }
  }
}

// A laser is where it was measured: here each sweeps over all elevations.
TEST(SegmentLinker, LasersThatSway) {
  Probe probe(kTolerance, kHints);
  const auto slope = [](std::size_t laser, int place) {
    return (laser == 0 ? 0.3 : -0.3) * std::sin(0.02 * static_cast<double>(place));
  };
  for (int place = kFirstPlace; place < 800; ++place)
    for (std::size_t laser = 0; laser < 2; ++laser) EXPECT_FALSE(probe.put(laser, place, 40.0, slope(laser, place)));
  probe.linkAll();
  std::size_t pairs = 0;
  for (std::uint32_t i = 0; i < probe.size(); ++i)
    for (std::uint32_t k = i + 1; k < probe.size(); ++k) {
      if (!probe.neighbours(i, k, kTolerance)) continue;
      ++pairs;
      ASSERT_TRUE(probe.joined(i, k)) << i << ", " << k;
    }
  EXPECT_GT(pairs, 1000U);
}

TEST(SegmentLinker, NothingOfTheLastRotationIsLeft) {
  Probe probe(kTolerance, kHints);
  for (const int steps : {1024, 1024, 1200, 512, 1024}) {
    probe.begin(kTolerance, hintsFor(steps, 0.02F));
    for (int i = 0; i < 500; ++i)
      for (std::size_t laser = 0; laser < 8; ++laser) EXPECT_FALSE(probe.put(laser, kFirstPlace + i, 60.0, 0.0));
    probe.linkAll();
    probe.begin(kTolerance, hintsFor(steps, 0.02F));
    for (int i = 0; i < 500; i += 50)
      for (std::size_t laser = 0; laser < 9; ++laser)
        EXPECT_FALSE(probe.put(laser, kFirstPlace + i, 60.0, 0.03 * static_cast<double>(laser)));
    probe.linkAll();
    for (std::uint32_t i = 1; i < probe.size(); ++i) EXPECT_FALSE(probe.joined(0, i)) << i;
  }
}

// What comes after too many loose returns is loose too, wherever it is, and is still compared with all that was placed.
TEST(SegmentLinker, TooManyLooseReturnsEndThePlacing) {
  Probe probe(kTolerance, kHints);
  EXPECT_FALSE(probe.put(0, kFirstPlace, 60.0, 0.0));
  EXPECT_FALSE(probe.put(0, kFirstPlace + 20, 60.0, 0.0));
  while (!probe.strip().image.isFull()) probe.put(0, kFirstPlace + 40, 60.0, 0.0);
  for (int time = 0; time < 3; ++time) {
    EXPECT_TRUE(probe.put(0, kFirstPlace + 20.4, 60.0, 0.0));  // its place is free
    const auto element = static_cast<std::uint32_t>(probe.size() - 1);
    probe.linkAll();
    EXPECT_TRUE(probe.joined(1, element));
    EXPECT_FALSE(probe.joined(0, element));
  }
}

// Two or three returns in each azimuth bin: few of them are searched alone, and no memory is taken before.
TEST(SegmentLinker, ReturnsInTakenBinsGoToAnotherLayer) {
  for (const int in_a_bin : {1, 2, 3}) {
    SCOPED_TRACE(std::to_string(in_a_bin) + " returns in a bin");
    Probe probe(0.05F, kHints);
    int unplaced = 0;
    for (int place = kFirstPlace; place < 1000; ++place)
      for (std::size_t laser = 0; laser < 3; ++laser)
        for (int i = 0; i < in_a_bin; ++i)
          unplaced += probe.put(laser, place, 0.2 + 0.049 * i, 0.5 * static_cast<double>(laser)) ? 1 : 0;
    EXPECT_LE(unplaced, 200);
    EXPECT_EQ(probe.strip().image.layers, static_cast<std::size_t>(in_a_bin));
    EXPECT_EQ(probe.strip().image.open_rows, 3 * static_cast<std::size_t>(in_a_bin));
    probe.linkAll();
    EXPECT_EQ(difference(trueClusters(probe.points(), 0.05F), probe.clusters()), "");
  }
}

// One strip has too many loose returns; what another one places must still find them.
TEST(SegmentLinker, LooseReturnsOfOneStripAreFoundByAnother) {
  Probe probe(kTolerance, kHints);
  for (const bool looked_before : {false, true}) {
    probe.begin(kTolerance, kHints);
    EXPECT_FALSE(probe.put(0, kFirstPlace, 60.0, 0.0));
    EXPECT_FALSE(probe.put(0, kFirstPlace + 40, 300.0, 0.0));
    bool is_loose = false;
    for (int i = 0; i < 5000; ++i) is_loose = probe.put(0, kFirstPlace + 40, 60.0, 0.0);
    EXPECT_TRUE(is_loose);
    const auto loose = static_cast<std::uint32_t>(probe.size() - 1);
    if (looked_before) probe.linkAll();
    probe.useStrip(1);
    const bool also_loose = probe.put(1, kFirstPlace + 41, 60.0, 0.0);
    const auto element = static_cast<std::uint32_t>(probe.size() - 1);
    probe.linkAll();
    EXPECT_TRUE(also_loose || probe.joined(loose, element)) << looked_before;  // those that are loose others find
    EXPECT_FALSE(probe.joined(0, element));
  }
}

// A laser whose returns are all near is known, but not where it is.
TEST(SegmentLinker, LasersThatAppearLateAndNear) {
  Probe probe(kTolerance, kHints);
  EXPECT_FALSE(probe.put(0, kFirstPlace, 60.0, 0.0));
  EXPECT_FALSE(probe.put(0, kFirstPlace + 1, 60.0, 0.0));
  probe.link();
  for (std::size_t laser = 1; laser < 30; ++laser) {  // few enough loose ones
    EXPECT_FALSE(probe.put(laser, kFirstPlace + 2, 0.9 * probe.nearEnd(), 0.0));
    EXPECT_FALSE(probe.put(0, kFirstPlace + 1.0 + static_cast<double>(laser), 60.0, 0.0));
    EXPECT_TRUE(probe.put(0, kFirstPlace, 60.0, 0.0));
    probe.linkAll();
    EXPECT_TRUE(probe.joined(0, static_cast<std::uint32_t>(probe.size() - 2)));
    EXPECT_TRUE(probe.joined(0, static_cast<std::uint32_t>(probe.size() - 1)));
  }
}

/// Two returns that are only just neighbours, the tolerance that makes them so, and where the strip has them.
struct CriticalPair {
  lisco::SensorHints hints;
  float tolerance = 0;
  std::array<double, 2> place{}, rho{}, slope{};  ///< places with fractions, as Probe::pointAt() takes them
};

/// Of any size, at any distance, seen under any angle that a strip may have to do with; one beside, above or behind
/// the other.
CriticalPair criticalPair(Random& random) {
  const std::array<int, 6> steps_choices{512, 513, 1000, 2047, 4096, 16384};
  CriticalPair pair;
  const int steps = random.oneOf(steps_choices);
  const double step = 2.0 * kPi / steps;
  pair.hints = hintsFor(steps, 0.1F, random.chance(0.5));
  if (random.chance(0.3)) pair.hints.jitter = static_cast<float>(random.between(0.0, 3.0));
  pair.hints.elevation_step = elevationStepFor(pair.hints, random.magnitude(1.0, 4e4));
  const double spacing = 1.0 / minRangeOf(pair.hints);  // infinitely far: no use, tried all the same
  const double near_end = random.chance(0.3) ? random.magnitude(1e-17, 1e11) : random.magnitude(1.0, 100.0);
  if (random.chance(0.3))
    for (float& axis : pair.hints.origin) axis = static_cast<float>(near_end * random.between(-0.5, 0.5));
  if (random.chance(0.3))
    for (float& slope : pair.hints.tilt) slope = static_cast<float>(random.between(-0.5, 0.5));
  const double reach = near_end * spacing;

  // One of them stands ahead; the other is reached from there.
  const double rho = near_end * (random.chance(0.7) ? random.between(1.0, 1.5) : random.magnitude(1.0, 100.0));
  const std::array<double, 5> slopes{0.0, 0.0, 0.3, -0.3, 3.0};
  const double slope = random.oneOf(slopes) * random.unit();
  const double sine = reach / rho;
  const double cosine = std::sqrt(1.0 - sine * sine);
  const double range = rho * std::sqrt(1.0 + slope * slope);
  std::array<double, 3> way{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};  // ahead, aside, up
  switch (random.below(5)) {
    case 0:  // as far aside as can be
      way = {-sine, random.chance(0.5) ? cosine : -cosine, 0.0};
      break;
    case 1: {  // as far above or below as can be
      const double angle =
          std::atan(slope) + (random.chance(0.5) ? 1.0 : -1.0) * (0.5 * kPi + std::asin(std::min(1.0, reach / range)));
      way = {std::cos(angle), 0.0, std::sin(angle)};
      break;
    }
    case 2:
      way = {random.chance(0.5) ? 1.0 : -1.0, 0.0, 0.0};
      break;
    default:
      break;
  }
  const double length = std::sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
  for (double& axis : way) axis *= reach / length;
  const double ahead = rho + way[0];
  const double where = random.between(kFirstPlace + 60.0, kFirstPlace + 120.0);
  pair.place = {where, where + std::atan2(way[1], ahead) / step};
  pair.rho = {rho, std::hypot(ahead, way[1])};
  pair.slope = {slope, (slope * rho + way[2]) / pair.rho[1]};
  if (random.chance(0.5)) {
    std::swap(pair.place[0], pair.place[1]);
    std::swap(pair.rho[0], pair.rho[1]);
    std::swap(pair.slope[0], pair.slope[1]);
  }
  pair.tolerance = static_cast<float>(reach);
  return pair;
}

// In the places where they belong or next to them, before and after the seam, late and loose.
TEST(SegmentLinker, CriticalPairs) {
  Probe probe(kTolerance, kHints);
  std::size_t pairs = 0;
  for (std::uint64_t seed = 1; seed < 1 + timesEffort(20000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    CriticalPair pair = criticalPair(random);
    const bool seam = random.chance(0.3);
    if (seam) pair.place[1] += pair.hints.steps_per_turn;
    const bool late = random.chance(0.3);
    const bool first_later = !late && random.chance(0.5);
    if (first_later) std::swap(pair.place[0], pair.place[1]);
    if (first_later) std::swap(pair.rho[0], pair.rho[1]);
    if (first_later) std::swap(pair.slope[0], pair.slope[1]);

    // The least tolerance with which they are neighbours.
    probe.begin(pair.tolerance, pair.hints);
    const std::array<Point, 2> points{probe.pointAt(pair.place[0], pair.rho[0], pair.slope[0]),
                                      probe.pointAt(pair.place[1], pair.rho[1], pair.slope[1])};
    const double apart = std::hypot(static_cast<double>(points[0].x) - static_cast<double>(points[1].x),
                                    static_cast<double>(points[0].y) - static_cast<double>(points[1].y),
                                    static_cast<double>(points[0].z) - static_cast<double>(points[1].z));
    pair.tolerance = static_cast<float>(apart * (1.0 - 3e-7));
    for (int ulp = 0; ulp < 20 && !areNeighbours(points[0], points[1], pair.tolerance); ++ulp)
      pair.tolerance = std::nextafter(pair.tolerance, 1e30F);
    if (!areNeighbours(points[0], points[1], pair.tolerance)) continue;  // they all but coincide
    const bool apart_in_strips = random.chance(0.3);
    probe.begin(pair.tolerance, pair.hints, random.chance(0.5) ? ~std::size_t{0} : random.below(600));
    if (!probe.strip().image.inUse()) continue;
    const double near_end = probe.nearEnd();
    if (std::min(pair.rho[0], pair.rho[1]) < near_end * (1.0 + 1e-6)) continue;

    // All others are far behind them.
    const double behind = 1000.0 * near_end;
    probe.put(0, kFirstPlace, behind, 0.0);
    probe.put(3, kFirstPlace, behind, 0.0);
    std::array<std::uint32_t, 2> number{};
    int loose = 0;
    for (std::size_t i = 0; i < 2; ++i) {
      if (i == 1 && apart_in_strips) probe.useStrip(1 + random.below(2));
      if (i == 1 && late) {
        for (const std::size_t laser : {0, 1, 3}) probe.put(laser, pair.place[1] + 200.0, behind, 0.0);
        probe.link();
      }
      // Its laser is where the next place is up to three quarters of one off.
      double place = std::round(pair.place[i]);
      if (random.chance(0.5)) place += pair.place[i] > place ? 1.0 : -1.0;
      if (pair.hints.jitter > 0.0F) place += static_cast<double>(random.below(5)) - 2.0;
      const auto column = static_cast<std::uint32_t>(place);
      if (random.chance(0.8)) probe.put(i + 1, place - 1.0, behind, pair.slope[i]);
      const bool full = random.chance(0.2);
      if (full) probe.put(i + 1, column, probe.pointAt(pair.place[i], behind, 0.0));
      number[i] = static_cast<std::uint32_t>(probe.size());
      loose += probe.put(i + 1, full ? column + 1 : column, points[i]) ? 1 : 0;
      if (random.chance(0.1)) probe.linkAll();
    }
    if (loose == 2) continue;  // these are for others to find
    ++pairs;
    if (random.chance(0.5)) probe.put(random.below(4), pair.place[1] + 100.0, behind, 0.0);
    if (random.chance(0.3)) probe.link();
    probe.linkAll();
    ASSERT_TRUE(probe.joined(number[0], number[1]))
        << pair.hints.steps_per_turn << " steps, tolerance " << pair.tolerance << " at " << pair.rho[0] << " and "
        << pair.rho[1] << ", places " << pair.place[0] << " and " << pair.place[1] << ", slopes " << pair.slope[0]
        << " and " << pair.slope[1] << (late ? ", late" : "") << (apart_in_strips ? ", in two strips" : "")
        << (loose > 0 ? ", loose" : "");
  }
  EXPECT_GT(pairs, timesEffort(10000));
}

/// What a sensor and its surroundings may be like.
struct Rotation {
  Scan scan{0, 0};
  lisco::SensorHints hints;
  std::vector<double> distances;  ///< horizontal, ascending
};

/// \param crowding columns that share an azimuth
Rotation randomRotation(Random& random, double kept, std::size_t crowding = 1) {
  const std::array<int, 6> steps_choices{512, 600, 720, 900, 1024, 1200};
  const std::array<double, 7> turns{1.0, 1.0, 0.4, 1.05, 1.3, 2.3, 3.4};
  const std::array<double, 5> jitters{0.0, 0.02, 0.2, 0.7, 2.0};
  const int steps = random.oneOf(steps_choices);
  const std::size_t lasers = random.chance(0.1) ? 1 : 2 + random.below(31);
  const auto columns = static_cast<std::size_t>(steps * random.oneOf(turns));
  const bool clockwise = random.chance(0.5);
  const double start = random.between(0.0, 2.0 * kPi);
  const double step = (clockwise ? -2.0 : 2.0) * kPi / steps;
  const double ring = random.between(0.005, 0.04);
  const double sway = random.chance(0.3) ? random.between(0.0, 3.0 * ring) : 0.0;
  const double jitter = random.oneOf(jitters) * std::fabs(step);
  const double lost = random.chance(0.5) ? 0.05 : 0.0;
  const double twice = random.chance(0.5) ? 0.05 : 0.0;
  std::vector<double> lag(lasers, 0.0);
  if (random.chance(0.6))
    for (std::size_t i = 0; i < lasers; ++i)
      lag[i] = random.chance(0.5) ? random.between(-60.0, 60.0) : 20.0 * static_cast<double>(i % 4);
  std::vector<std::size_t> row(lasers);
  std::iota(row.begin(), row.end(), std::size_t{0});
  if (random.chance(0.3)) std::reverse(row.begin(), row.end());
  if (random.chance(0.2)) random.shuffle(row);
  const bool appear = random.chance(0.2);  // each laser later than the one before

  Rotation rotation;
  lisco::SensorHints& hints = rotation.hints;
  hints = hintsFor(steps, static_cast<float>(ring), clockwise);
  if (random.chance(0.15)) hints.steps_per_turn = static_cast<int>(512 + random.below(1500));
  if (random.chance(0.1)) hints.clockwise = !clockwise;
  if (random.chance(0.1)) hints.elevation_step *= static_cast<float>(random.magnitude(0.2, 5.0));
  const std::array<double, 6> scales{1.0, 1.0, 1.0, 1.0, 1e-15, 1e12};
  const double scale = random.oneOf(scales);
  if (random.chance(0.3))
    for (float& axis : hints.origin) axis = static_cast<float>(scale * random.between(-20.0, 20.0));

  if (random.chance(0.3)) hints.jitter = static_cast<float>(random.between(0.0, 3.0));

  // Things of any width stand around, at any distance, on a floor.
  std::vector<double> distance(64);
  for (double& d : distance) d = random.magnitude(3.0, 80.0);
  const double roughness = random.chance(0.7) ? random.magnitude(0.001, 0.3) : 0.0;

  std::vector<std::size_t> order;
  for (std::size_t packet = 0; packet < columns; packet += 16) {
    if (random.chance(lost)) continue;
    for (int times = random.chance(twice) ? 2 : 1; times > 0; --times)
      for (std::size_t c = packet; c < std::min(columns, packet + 16); ++c) order.push_back(c);
  }
  Scan& scan = rotation.scan;
  scan = Scan(order.size(), lasers);
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t laser = 0; laser < lasers; ++laser) {
      if (!random.chance(kept) || (appear && i * lasers < row[laser] * order.size() / 2)) {
        scan.set(row[laser], i, {0, 0, 0});
        continue;
      }
      const double azimuth = start + step * (static_cast<double>(order[i] / crowding * crowding) + lag[laser]) +
                             random.between(-jitter, jitter);
      const double elevation = 0.1 - ring * static_cast<double>(laser) + sway * std::sin(3.0 * azimuth);
      const double around = azimuth - 2.0 * kPi * std::floor(azimuth / (2.0 * kPi));
      double rho = distance[std::min<std::size_t>(63, static_cast<std::size_t>(around * 64.0 / (2.0 * kPi)))];
      if (elevation < -0.01) rho = std::min(rho, -1.8 / elevation);
      rho *= 1.0 + roughness * random.unit();
      rotation.distances.push_back(rho * scale);
      scan.set(row[laser], i,
               {static_cast<float>(scale * rho * std::cos(azimuth)) + hints.origin[0],
                static_cast<float>(scale * rho * std::sin(azimuth)) + hints.origin[1],
                static_cast<float>(scale * rho * std::tan(elevation)) + hints.origin[2]});
    }
  if (random.chance(0.3))
    for (float& slope : hints.tilt) slope = static_cast<float>(random.between(-0.5, 0.5));
  std::sort(rotation.distances.begin(), rotation.distances.end());
  if (rotation.distances.empty()) rotation.distances.push_back(1.0);
  return rotation;
}

/// A tolerance with which about this part of the returns is far.
float toleranceFor(const Rotation& rotation, double far_part) {
  const auto index = static_cast<std::size_t>((1.0 - far_part) * static_cast<double>(rotation.distances.size() - 1));
  return static_cast<float>(rotation.distances[index] / std::min(1e4, minRangeOf(rotation.hints)));
}

lisco::Parameters parametersFor(Random& random, const Rotation& rotation, float tolerance) {
  constexpr std::array<std::size_t, 5> kBlocks{64, 64, 1, 16, 7};
  lisco::Parameters parameters;
  parameters.tolerance = tolerance;
  parameters.sensor = rotation.hints;
  parameters.block_columns = random.oneOf(kBlocks);
  parameters.threads = random.chance(0.4) ? 1 + random.below(4) : 1;
  return parameters;
}

constexpr std::array<double, 5> kFarParts{1.0, 0.9, 0.5, 0.5, 0.1};

/// In parts, so that they can run side by side.
class StripScans : public testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Seeds, StripScans, testing::Range<std::uint64_t>(1, 4));

TEST_P(StripScans, EqualTheEngineWithoutTheStrip) {
  lisco::ColumnClusterer clusterer;
  lisco::ColumnClusterer without;
  const std::uint64_t seeds = GetParam() * 1'000'000;
  for (std::uint64_t seed = seeds; seed < seeds + timesEffort(40); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const SimdLevel level(random.oneOf(levels()));
    const Rotation rotation = randomRotation(random, random.chance(0.5) ? 0.95 : random.between(0.1, 1.0));
    lisco::Parameters parameters = parametersFor(random, rotation, toleranceFor(rotation, random.oneOf(kFarParts)));
    clusterer.begin(parameters);
    feed(clusterer, random, rotation.scan);
    parameters.sensor.steps_per_turn = 0;
    without.begin(parameters);
    without.addColumns(rotation.scan.columns, rotation.scan.lasers,
                       [&](std::size_t laser, std::size_t column) { return rotation.scan.at(laser, column); });
    ASSERT_EQ(difference(clustersOf(without), clustersOf(clusterer)), "");
  }
}

std::string differenceFromTheOracle(lisco::ColumnClusterer& clusterer, const Scan& scan, float tolerance) {
  std::vector<Point> points;
  for (const Point& point : scan.points())
    if (isValid(point)) points.push_back(point);
  std::vector<std::uint32_t> number(scan.cells.size());  // among the valid
  std::uint32_t valid = 0;
  for (const lisco::Return& cell : scan.cells)
    number[cell.source_index] = isValid({cell.x, cell.y, cell.z}) ? valid++ : 0;
  Clustering found = clustersOf(clusterer);
  for (Cluster& cluster : found)
    for (std::uint32_t& member : cluster.members) member = number[member];
  return difference(trueClusters(points, tolerance), found);
}

// Few returns: clusters are pairs, and each of them is found by one comparison only.
TEST_P(StripScans, EqualTheOracle) {
  lisco::ColumnClusterer clusterer;
  const std::uint64_t seeds = GetParam() * 1'000'000 + 500'000;
  for (std::uint64_t seed = seeds; seed < seeds + timesEffort(60); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const SimdLevel level(random.oneOf(levels()));
    const Rotation rotation = randomRotation(random, random.between(0.01, 0.08));
    const float tolerance = toleranceFor(rotation, random.oneOf(kFarParts));
    clusterer.begin(parametersFor(random, rotation, tolerance));
    feed(clusterer, random, rotation.scan);
    ASSERT_EQ(differenceFromTheOracle(clusterer, rotation.scan, tolerance), "");
  }
}

// Several columns of one azimuth (returns of one firing, a scan in a frame that moved): bins are taken more than once.
TEST_P(StripScans, EqualTheOracleWhereBinsAreTaken) {
  lisco::ColumnClusterer clusterer;
  const std::uint64_t seeds = GetParam() * 1'000'000 + 700'000;
  constexpr std::array<std::size_t, 4> kCrowding{2, 3, 8, 40};
  for (std::uint64_t seed = seeds; seed < seeds + timesEffort(60); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const SimdLevel level(random.oneOf(levels()));
    const Rotation rotation = randomRotation(random, random.between(0.03, 0.2), random.oneOf(kCrowding));
    const float tolerance = static_cast<float>(random.between(0.3, 1.0)) * toleranceFor(rotation, 1.0);
    clusterer.begin(parametersFor(random, rotation, tolerance));
    feed(clusterer, random, rotation.scan);
    ASSERT_EQ(differenceFromTheOracle(clusterer, rotation.scan, tolerance), "");
  }
}

TEST(StripScans, WhatIsFarNeedsNoVoxels) {
  constexpr float kWidth = 0.05F;
  Probe probe(kWidth, kHints);
  for (const bool clockwise : {false, true})
    for (const int block : {1, 16, 64})
      for (const int lag : {0, 3}) {
        SCOPED_TRACE((clockwise ? "clockwise, blocks of " : "counter-clockwise, blocks of ") + std::to_string(block));
        lisco::SensorHints hints = kHints;
        hints.clockwise = clockwise;
        probe.begin(kWidth, hints);
        Random random(5);
        for (int column = 128; column < 1152; column += block)
          for (std::size_t laser = 0; laser < 4; ++laser) {
            std::vector<Point> points;
            for (int i = 0; i < block; ++i)
              points.push_back(random.chance(0.2)
                                   ? Point{0, 0, 0}
                                   : probe.pointAt(column + i - lag * static_cast<int>(laser),
                                                   0.19 + random.between(0.0, random.chance(0.1) ? 0.1 : 0.02),
                                                   0.3 - 0.2 * static_cast<double>(laser)));
            EXPECT_EQ(probe.putRow(laser, static_cast<std::uint32_t>(column), points), 0U);
          }
        probe.linkAll();
        const Clustering right = trueClusters(probe.points(), kWidth);
        EXPECT_GT(right.size(), 3U);
        EXPECT_EQ(difference(right, probe.clusters()), "");
      }
}

/// Pairs whose returns lie on both sides of a distance, or a tolerance from it, by a few ulps.
Scan pairsAround(Random& random, double distance, double tolerance) {
  constexpr std::size_t kPairs = 40;
  Scan scan(512, 3);
  const auto close = [&random] { return 1.0 + (random.chance(0.5) ? 1e-7 : 3e-5) * random.between(-2.0, 2.0); };
  for (std::size_t pair = 0; pair < kPairs; ++pair) {
    const std::size_t column = pair * 12;
    const std::array<double, 4> bases{0.0, 0.0, -1.0, 1.0};
    const double near = (distance + random.oneOf(bases) * tolerance) * close();
    const double apart = tolerance * close();
    const std::array<double, 3> slopes{0.0, 0.1, -2.0};
    const double z = distance * random.oneOf(slopes);
    const std::array<double, 3> radials{apart, -apart, random.between(-apart, apart)};
    const double radial = random.oneOf(radials);
    const double rest = std::sqrt(std::max(0.0, apart * apart - radial * radial));
    const double turn = random.between(0.0, 2.0 * kPi);
    const double azimuth = 2.0 * kPi * static_cast<double>(column) / 512.0;
    const auto set = [&](std::size_t laser, std::size_t c, double ahead, double left, double up) {
      scan.set(laser, c,
               {static_cast<float>(ahead * std::cos(azimuth) - left * std::sin(azimuth)),
                static_cast<float>(ahead * std::sin(azimuth) + left * std::cos(azimuth)), static_cast<float>(up)});
    };
    set(random.below(3), column, near, 0.0, z);
    set(random.below(3), column + 1 + random.below(2), near + radial, rest * std::cos(turn), z + rest * std::sin(turn));
  }
  return scan;
}

TEST(StripScans, PairsAtTheNearEndAndTheFarEnd) {
  lisco::ColumnClusterer clusterer;
  for (std::uint64_t seed = 1; seed < 1 + timesEffort(300); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const std::array<float, 4> steps{0.001F, 0.01F, 0.1F, 1.0F};
    Setting setting{"strip", {}};
    setting.parameters.sensor = hintsFor(512, random.oneOf(steps));
    setting.parameters.expected_returns = 100;
    const bool at_far_end = random.chance(0.3);
    const std::array<double, 6> tolerances{0.3, 1.0, 7e-5, 1e-17, 1e9, 2e13};
    const std::array<double, 3> huge{1e13, 5e13, 1e14};
    const double tolerance = at_far_end ? random.oneOf(huge) : random.oneOf(tolerances);
    const double near_end = minRangeOf(setting.parameters.sensor);
    const double distance = at_far_end ? 1e15 : tolerance * (near_end < 1e6 ? near_end : 3.0);
    const Scan scan = pairsAround(random, distance, tolerance);
    const auto rounded = static_cast<float>(tolerance);
    ASSERT_EQ(difference(trueClusters(scan.points(), rounded), cluster(clusterer, scan, rounded, setting)), "");
  }
}

}  // namespace
}  // namespace lisco_test
