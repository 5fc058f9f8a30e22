// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Far returns: the range image and its linker alone on pairs made by hand, and within the engine on whole rotations.
#include "core/far/segment_linker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/disjoint_sets.h"
#include "core/far/far_range.h"
#include "core/far/image_circle.h"
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
constexpr std::uint32_t kFirstBin = 64;  // the first return's

// Large arrays are rounded up to pages, those of larger elements to fewer elements.
TEST(Sector, GrowsAllItsArrays) {
  lisco::Sector sector;
  constexpr std::size_t kMost = 1'200'000;
  for (std::size_t segments = 0; segments < kMost; segments += lisco::RangeImage::kSector) {
    sector.reserveRow(segments);
    const std::size_t least = segments + lisco::RangeImage::kSector + lisco::Sector::kMaxLanes;
    for (const auto* bound :
         {&sector.nearest, &sector.farthest, &sector.lowest, &sector.highest, &sector.first, &sector.last})
      ASSERT_GE(bound->size(), least);
    for (const auto* elements : {&sector.root, &sector.place}) ASSERT_GE(elements->size(), least);
    ASSERT_GE(sector.count.size(), least);
  }
}

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

  /// \param columns that each image expects
  void begin(float tolerance, const lisco::SensorHints& hints, std::size_t columns = ~std::size_t{0}) {
    hints_ = hints;
    tolerance_ = lisco::Tolerance(tolerance);
    lasers_ = 0;
    points_.clear();
    for (FarPart& part : parts_) part.prepare(tolerance_, hints, columns);
    part_ = &parts_.front();
  }

  /// Makes the following calls of put() and link() act on another part.
  void usePart(std::size_t number) { part_ = &parts_.at(number); }

  /// The point that a laser sees at a bin, which may have a fraction, and at a horizontal distance.
  Point pointAt(double bin, double rho, double slope) const {
    const double turned = 2.0 * kPi * (bin - kFirstBin) / hints_.steps_per_turn;
    const double azimuth = 0.3 + (hints_.clockwise ? -turned : turned);
    return {static_cast<float>(rho * std::cos(azimuth)) + hints_.origin[0],
            static_cast<float>(rho * std::sin(azimuth)) + hints_.origin[1],
            static_cast<float>(rho * slope) + hints_.origin[2]};
  }

  /// \return whether it is unplaced
  bool put(std::size_t laser, std::uint32_t column, const Point& point) {
    const std::uint32_t i = column % lisco::RingBlock::kColumns;
    std::fill_n(block_.x, lisco::RingBlock::kMargin + lisco::RingBlock::kColumns, kNan);
    block_.x[lisco::RingBlock::kMargin + i] = point.x;
    block_.y[lisco::RingBlock::kMargin + i] = point.y;
    block_.z[lisco::RingBlock::kMargin + i] = point.z;
    return putBlock(laser, column - i, lisco::RingBlock::kColumns) != 0;
  }
  bool put(std::size_t laser, double bin, double rho, double slope) {
    return put(laser, static_cast<std::uint32_t>(std::lround(bin)), pointAt(bin, rho, slope));
  }

  /// Puts consecutive returns of a laser, each a run of its own.
  /// \return those that are unplaced
  std::uint64_t putBlock(std::size_t laser, std::uint32_t first_column, const std::vector<Point>& points) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      block_.x[lisco::RingBlock::kMargin + i] = points[i].x;
      block_.y[lisco::RingBlock::kMargin + i] = points[i].y;
      block_.z[lisco::RingBlock::kMargin + i] = points[i].z;
    }
    return putBlock(laser, first_column, points.size());
  }

  void link() { part_->linker.link(part_->image, subclusters_); }
  /// As many parts of sectors as are left, but no more than a number.
  void linkParts(std::size_t most) {
    part_->linker.schedule(part_->image);
    for (; most > 0 && part_->linker.partsLeft(part_->image) > 0; --most)
      part_->linker.linkPart(part_->image, subclusters_);
  }
  void linkAll() {
    bool full = false;
    for (FarPart& part : parts_) part.linker.linkRest(part.image, subclusters_);
    lisco::ImageCircle images;
    images.assign(parts_.size(), [&](std::size_t i) -> const lisco::RangeImage& { return parts_[i].image; });
    struct Overlap {
      std::size_t a, b;
      double ahead;
    };
    std::vector<Overlap> overlaps;
    const auto addOverlaps = [&](std::size_t a, std::size_t b) {
      lisco::SegmentLinker::forEachOverlap(parts_[a].image, parts_[b].image, [&](double ahead) {
        overlaps.push_back({a, b, ahead});
      });
    };
    images.forEachPair(addOverlaps);
    for (std::size_t i = 0; i < parts_.size(); ++i) addOverlaps(i, i);
    for (FarPart& part : parts_) parts_[0].image.mergeRows(part.image);
    parts_[0].image.sortLasers();
    for (FarPart& part : parts_) {
      part.image.shareRows(parts_[0].image);
      part.image.updateElevations();
    }
    for (std::size_t i = 0; i < overlaps.size(); ++i) {
      const auto& [a, b, ahead] = overlaps[i];
      const std::size_t linker = i % parts_.size();
      parts_[linker].linker.linkOverlap(parts_[a].image, parts_[b].image, ahead, linker == a, subclusters_);
    }
    for (FarPart& part : parts_) {
      for (const lisco::RangeImage::Unplaced& unplaced : part.image.unplaced)
        images.forEachAround(unplaced, [&](std::size_t i) {
          lisco::SegmentLinker::linkUnplaced(parts_[i].image, unplaced, subclusters_);
        });
      full = full || part.image.isFull();
    }
    if (full)
      for (FarPart& part : parts_) part.image.stopPlacing();
  }
  bool joined(std::uint32_t a, std::uint32_t b) { return subclusters_.find(a) == subclusters_.find(b); }
  bool neighbours(std::size_t a, std::size_t b, float tolerance) const {
    return areNeighbours(points_[a], points_[b], tolerance);
  }
  std::size_t size() const { return points_.size(); }
  const std::vector<Point>& points() const { return points_; }
  const FarPart& part() const { return *part_; }
  double minRange() const { return static_cast<double>(part_->image.range.min_range); }

  Clustering clusters() {
    std::map<std::uint32_t, Cluster> by_root;
    for (std::uint32_t i = 0; i < points_.size(); ++i) by_root[subclusters_.find(i)].members.push_back(i);
    Clustering clusters;
    for (auto& [root, cluster] : by_root) clusters.push_back({cluster.members, cluster.members.size()});
    return inOrder(std::move(clusters));
  }

 private:
  std::uint64_t putBlock(std::size_t laser, std::uint32_t first_column, std::size_t columns) {
    lisco::measure(block_, columns, tolerance_.squared(), part_->image.range, info_);
    for (std::size_t i = 0; i < columns; ++i) {
      if ((info_.returns >> i & 1U) == 0) continue;
      const auto element = static_cast<std::uint32_t>(points_.size());
      points_.push_back({block_.x[lisco::RingBlock::kMargin + i], block_.y[lisco::RingBlock::kMargin + i],
                         block_.z[lisco::RingBlock::kMargin + i]});
      subclusters_.grow(element + 1);
      subclusters_.create(element);
      info_.run[i] = element;
    }
    lasers_ = std::max(lasers_, laser + 1);
    part_->image.addLasers(lasers_);
    if (info_.far == 0) return 0;
    return part_->image.place(block_, info_, laser, first_column);
  }

  std::array<FarPart, 3> parts_;
  FarPart* part_ = &parts_.front();  ///< in use
  lisco::SensorHints hints_;
  lisco::Tolerance tolerance_;
  lisco::DisjointSets subclusters_;
  std::size_t lasers_ = 0;
  lisco::RingBlock block_{};
  lisco::RingBlockInfo info_{};
  std::vector<Point> points_;
};

constexpr float kTolerance = 1.0F;
// Makes returns far from the least range on; the tolerance spans about 45 bins there.
const lisco::SensorHints kHints = hintsFor(1024, 0.5F);

/// The distance at which returns so many bins apart are just neighbours.
double distanceFor(double bins) {
  return 0.9999 * static_cast<double>(kTolerance) / (2.0 * std::sin(bins * kPi / kHints.steps_per_turn));
}

/// The number of bins that the tolerance spans at the least far range.
int reachInBins() {
  int bins = 0;
  while (distanceFor(bins + 1) > 1.0001 * minRangeOf(kHints)) ++bins;
  return bins;
}

TEST(SegmentLinker, ToleranceSpansManyBins) {
  EXPECT_GT(reachInBins(), 30);
  EXPECT_LT(reachInBins(), 48);
}

// Of many images those whose bins come near enough, each pair once: short ones around the turn, long ones that overlap.
TEST(ImageCircle, FindsImagesInReach) {
  constexpr double kBins = 1024;       // of a turn
  constexpr double kMask = 48;         // bins
  constexpr double kMostBetween = 60;  // bins: a mask, and some for rounding
  std::size_t pairs = 0;
  for (std::uint64_t seed = 1; seed < 1 + timesEffort(200); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const lisco::SensorHints hints = hintsFor(static_cast<int>(kBins), 0.5F, random.chance(0.5));
    const std::size_t longest = random.chance(0.5) ? 60 : 1500;
    std::vector<lisco::RangeImage> images(1 + random.below(40));
    for (lisco::RangeImage& image : images) {
      image.prepare(lisco::Tolerance(1.0F), hints, 1024);
      image.started = true;
      image.placed = random.chance(0.1) ? 0 : 1;
      image.start_azimuth = random.between(-4, 4);
      image.end = 1 + random.below(longest);
    }
    /// Bins from an image's last one on to an azimuth, in the sense of rotation; below 0 within the image.
    const auto behind = [&](const lisco::RangeImage& image, double azimuth) {
      const double turns = static_cast<double>(image.direction) * (azimuth - image.start_azimuth) / (2 * kPi);
      return (turns - std::floor(turns)) * kBins - static_cast<double>(image.end);
    };
    std::set<std::pair<std::size_t, std::size_t>> found;
    lisco::ImageCircle circle;
    circle.assign(images.size(), [&](std::size_t i) -> const lisco::RangeImage& { return images[i]; });
    circle.forEachPair([&](std::size_t a, std::size_t b) {
      ASSERT_GT(a, b);
      ASSERT_TRUE(found.emplace(a, b).second) << "visited again";
    });
    pairs += found.size();
    for (std::size_t a = 0; a < images.size(); ++a)
      for (std::size_t b = 0; b < a; ++b) {
        const double apart =
            std::min(behind(images[a], images[b].start_azimuth), behind(images[b], images[a].start_azimuth));
        const bool are_used = images[a].placed > 0 && images[b].placed > 0;
        const bool is_found = found.count({a, b}) > 0;
        ASSERT_TRUE(is_found || !are_used || apart >= kMask) << a << " and " << b;
        ASSERT_TRUE(!is_found || (are_used && apart < kMostBetween)) << a << " and " << b;
      }
    for (int i = 0; i < 20; ++i) {
      const double azimuth = random.between(-kPi, kPi);
      std::set<std::size_t> around;
      circle.forEachAround(
          {static_cast<float>(10 * std::cos(azimuth)), static_cast<float>(10 * std::sin(azimuth)), 0, 0},
          [&](std::size_t image) { ASSERT_TRUE(around.insert(image).second); });
      for (std::size_t image = 0; image < images.size(); ++image) {
        const double after = behind(images[image], azimuth);
        const double before = kBins - (after + static_cast<double>(images[image].end));
        const double apart = std::min(before, after);
        const bool is_found = around.count(image) > 0;
        const bool is_used = images[image].placed > 0;
        ASSERT_TRUE(is_found || !is_used || apart >= kMask) << image;
        ASSERT_TRUE(!is_found || (is_used && apart < kMostBetween)) << image;
      }
    }
  }
  EXPECT_GT(pairs, 1000U);
}

TEST(RangeImage, IsInUseOnlyWithUsableHints) {
  FarPart part;
  const auto inUse = [&part](float tolerance, const lisco::SensorHints& hints) {
    part.prepare(lisco::Tolerance(tolerance), hints);
    return part.image.inUse();
  };
  EXPECT_FALSE(part.image.inUse());
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
  const auto min_range = static_cast<float>(minRangeOf(kHints));
  for (const float distance : {0.999F * min_range, 0.0F, -1.0F, kNan}) {
    hints.far_distance = distance;
    EXPECT_FALSE(inUse(1.0F, hints)) << distance;
  }
  hints.far_distance = 1.001F * min_range;
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

// The bounds hold in spite of rounding.
TEST(RangeImage, InteriorReturnsHaveOnlyFarNeighbours) {
  FarPart part;
  for (const int steps : {512, 1024, 2000, 16384})
    for (const float elevation_step : {1e-4F, 0.001F, 0.01F, 0.1F, 1.0F})
      for (const float tolerance : {1e-16F, 0.1F, 1.0F, 1e10F}) {
        lisco::SensorHints hints = hintsFor(steps, elevation_step);
        hints.origin = {1.0F, 2.0F, 3.0F};
        part.prepare(lisco::Tolerance(tolerance), hints);
        if (!part.image.inUse()) continue;
        SCOPED_TRACE(std::to_string(steps) + " steps, " + std::to_string(elevation_step) + ", tolerance " +
                     testing::PrintToString(tolerance));
        const lisco::FarRange& range = part.image.range;
        EXPECT_EQ(range.origin, hints.origin);
        EXPECT_GE(range.min_range, 2.49F * tolerance);
        EXPECT_GE(static_cast<double>(range.min_range) * std::sin(48.0 * 2.0 * kPi / steps),
                  0.999 * static_cast<double>(tolerance));
        EXPECT_GE(range.interior_min, 1.000005F * range.min_range + tolerance);
        EXPECT_LE(range.interior_min, 1.0001F * (range.min_range + tolerance));
        EXPECT_LE(range.interior_max, 0.99995F * range.max_range - tolerance);
        EXPECT_LE(range.max_range, 1e15F);
      }
  part.prepare(lisco::Tolerance(1.0F), lisco::SensorHints());
  EXPECT_FALSE(part.image.inUse());
  lisco::RingBlock block{};
  lisco::RingBlockInfo info{};
  for (std::size_t i = 0; i < lisco::RingBlock::kColumns; ++i)
    block.x[lisco::RingBlock::kMargin + i] = static_cast<float>(std::pow(10.0, static_cast<double>(i % 39)));
  lisco::measure(block, lisco::RingBlock::kColumns, 1.0F, part.image.range, info);
  EXPECT_EQ(info.far, 0U) << "far without a range image";
}

// Two returns that are just neighbours, with every number of bins between them, at every bin of a sector.
TEST(SegmentLinker, JoinsPairsAcrossBins) {
  Probe probe(kTolerance, kHints);
  for (int apart = 0; apart <= reachInBins(); ++apart)
    for (int first = 100; first < 116; ++first)
      for (const auto& [one, other] : {std::pair{0, 0}, {0, 1}, {1, 0}, {0, 3}, {3, 0}})
        for (const bool clockwise : {false, true}) {
          if (apart == 0 && one == other) continue;
          SCOPED_TRACE(std::to_string(apart) + " bins from " + std::to_string(first) + ", lasers " +
                       std::to_string(one) + " and " + std::to_string(other));
          lisco::SensorHints hints = kHints;
          hints.clockwise = clockwise;
          probe.begin(kTolerance, hints);
          const double rho = apart == 0 ? 50.0 : distanceFor(apart);
          EXPECT_FALSE(probe.put(5, kFirstBin, 100.0, 0.0));
          EXPECT_FALSE(probe.put(static_cast<std::size_t>(one), first, rho, 0.0));
          EXPECT_FALSE(probe.put(static_cast<std::size_t>(other), first + apart, rho, 0.0));
          ASSERT_TRUE(probe.neighbours(1, 2, kTolerance));
          probe.linkAll();
          EXPECT_TRUE(probe.joined(1, 2));
          EXPECT_FALSE(probe.joined(0, 1));
        }
}

// A return's azimuth deviates by up to three quarters of a bin from its bin's, here in opposite directions.
TEST(SegmentLinker, JoinsPairsThatDeviateFromTheirBins) {
  constexpr double kOff = 0.745;
  Probe probe(kTolerance, kHints);
  for (int apart = 2; apart <= reachInBins() + 2; ++apart)
    for (int first = 100; first < 116; ++first)
      for (const bool inwards : {false, true}) {
        SCOPED_TRACE(std::to_string(apart) + " bins from " + std::to_string(first) + (inwards ? ", inwards" : ""));
        probe.begin(kTolerance, kHints);
        const double off = inwards ? kOff : -kOff;  // inwards: closer to each other than their bins are
        const double distance = apart - 2.0 * off;
        const double rho = std::min(200.0, distanceFor(distance));
        if (rho < probe.minRange() * 1.0001) continue;
        EXPECT_FALSE(probe.put(2, kFirstBin, 300.0, 0.0));
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

TEST(SegmentLinker, PlacesUnexpectedReturnsByTheirAzimuth) {
  Probe probe(kTolerance, kHints);
  EXPECT_FALSE(probe.put(0, kFirstBin, 300.0, 0.0));
  EXPECT_FALSE(probe.put(1, 500.0, 100.0, 0.0));
  EXPECT_FALSE(probe.put(0, kFirstBin + 1, probe.pointAt(500.0, 100.0, 0.001)));  // column 65, seen at bin 500
  EXPECT_FALSE(probe.put(0, kFirstBin + 2, probe.pointAt(kFirstBin + 1.0, 300.0, 0.001)));  // and back
  EXPECT_FALSE(probe.put(0, kFirstBin + 900, probe.pointAt(501.0, 100.0, 0.0)));
  probe.linkAll();
  EXPECT_TRUE(probe.joined(1, 2));
  EXPECT_TRUE(probe.joined(1, 4));
  EXPECT_FALSE(probe.joined(0, 1));
  EXPECT_FALSE(probe.joined(0, 3));
}

// At the same distance from the line through the expected bin.
TEST(SegmentLinker, PlacesReturnsOnTheOppositeSideByTheirAzimuth) {
  Probe probe(kTolerance, kHints);
  EXPECT_FALSE(probe.put(0, kFirstBin, 300.0, 0.0));
  EXPECT_FALSE(probe.put(0, kFirstBin + 1, probe.pointAt(kFirstBin + 1.0 + 512.0, 50.0, 0.0)));
  EXPECT_FALSE(probe.put(1, kFirstBin + 1, probe.pointAt(kFirstBin + 1.0 + 512.0, 50.0, 0.001)));
  probe.linkAll();
  EXPECT_TRUE(probe.joined(1, 2));
}

TEST(SegmentLinker, JoinsAcrossTheSeam) {
  Probe probe(kTolerance, kHints);
  const int turn = kHints.steps_per_turn;
  for (int apart = 0; apart <= reachInBins(); ++apart)
    for (int last = turn + 30; last < turn + 200; last += apart <= 6 ? 1 : 5)
      for (const int sign : {-1, 1}) {
        const int first = last - turn + sign * apart;
        if (first < 0 || first == static_cast<int>(kFirstBin)) continue;
        SCOPED_TRACE("bins " + std::to_string(first) + " and " + std::to_string(last));
        const double rho = apart == 0 ? 50.0 : distanceFor(apart);
        probe.begin(kTolerance, kHints);
        EXPECT_FALSE(probe.put(2, kFirstBin, 300.0, 0.0));
        EXPECT_FALSE(probe.put(3, kFirstBin, 300.0, 0.0));
        const std::size_t laser = static_cast<std::size_t>(last) % 3;
        // More returns every quarter of a turn fix the turn in which the last one lies.
        EXPECT_FALSE(probe.put(laser, first, rho, 0.0));
        for (const int bin : {300, 600, 900}) EXPECT_FALSE(probe.put(1, bin, 300.0, 0.0));
        EXPECT_FALSE(probe.put(1, last, rho, 0.0));
        ASSERT_TRUE(probe.neighbours(2, 6, kTolerance));
        probe.linkAll();
        EXPECT_TRUE(probe.joined(2, 6));
      }
}

// A turn in three images, whose bins are shifted by any fraction.
TEST(SegmentLinker, JoinsAcrossImagesOfOneTurn) {
  Probe probe(kTolerance, kHints);
  const int turn = kHints.steps_per_turn;
  const int third = turn / 3;
  for (int apart = 0; apart <= reachInBins(); ++apart)
    for (int border = 0; border < 3; ++border)
      for (const double shift : {0.0, 0.3, 0.5, 0.9}) {
        SCOPED_TRACE(std::to_string(apart) + " bins apart at border " + std::to_string(border) + ", shifted by " +
                     std::to_string(shift));
        const double rho = apart == 0 ? 50.0 : distanceFor(apart);
        probe.begin(kTolerance, kHints, static_cast<std::size_t>(third));
        std::array<std::uint32_t, 2> number{};
        for (int part = 0; part < 3; ++part) {
          probe.usePart(static_cast<std::size_t>(part));
          const double first = kFirstBin + third * part + shift * part;
          const double last = kFirstBin + third * (part + 1) - 1;
          EXPECT_FALSE(probe.put(0, first + (apart + 1) / 2, 300.0, 0.0));
          if (part == (border + 1) % 3) {
            number[1] = static_cast<std::uint32_t>(probe.size());
            EXPECT_FALSE(probe.put(1, first + (apart + 1) / 2, rho, 0.0));
          }
          if (part == border) {
            number[0] = static_cast<std::uint32_t>(probe.size());
            const double end = border == 2 ? kFirstBin + turn : kFirstBin + third * (part + 1) + shift * (part + 1);
            EXPECT_FALSE(probe.put(2, end - apart / 2, rho, 0.0)) << last;
          }
          EXPECT_FALSE(probe.put(0, last, 300.0, 0.0));
        }
        ASSERT_TRUE(probe.neighbours(number[0], number[1], kTolerance));
        probe.linkAll();
        EXPECT_TRUE(probe.joined(number[0], number[1]));
      }
}

TEST(SegmentLinker, PlacesReturnsBeforeTheFirst) {
  Probe probe(kTolerance, kHints);
  for (int bin = 0; bin <= 64; ++bin) {
    probe.begin(kTolerance, kHints);
    EXPECT_FALSE(probe.put(0, kFirstBin, 300.0, 0.0));
    EXPECT_FALSE(probe.put(1, kFirstBin, probe.pointAt(bin, 50.0, 0.0)));
    for (const int later : {300, 600, 900}) EXPECT_FALSE(probe.put(0, later, 300.0, 0.0));
    EXPECT_FALSE(probe.put(0, bin + 1024, 50.0, 0.0));
    EXPECT_FALSE(probe.put(2, kFirstBin, probe.pointAt(bin + 1, 50.0, 0.0)));
    probe.linkAll();
    EXPECT_TRUE(probe.joined(1, 5)) << bin;
    EXPECT_TRUE(probe.joined(1, 6)) << bin;
  }
}

// Returns of several turns: each turn has its layer, and few returns are unplaced.
TEST(SegmentLinker, JoinsReturnsBeyondTheLastBin) {
  Probe probe(kTolerance, kHints);
  std::vector<bool> unplaced;
  for (int bin = kFirstBin; bin < 3 * 1024 + 200; ++bin)
    unplaced.push_back(probe.put(0, bin, 1.01 * probe.minRange(), 0.0));
  const std::size_t placed =
      static_cast<std::size_t>(std::find(unplaced.begin(), unplaced.end(), true) - unplaced.begin()) + kFirstBin;
  EXPECT_EQ(placed, 1024U + 256U);
  EXPECT_LT(std::count(unplaced.begin(), unplaced.end(), true), 200);
  EXPECT_EQ(probe.part().image.layers, 3U);
  probe.linkAll();
  for (std::uint32_t i = 0; i < probe.size(); ++i) ASSERT_TRUE(probe.joined(0, i)) << i;
}

TEST(SegmentLinker, JoinsUnplacedReturnsAtOnceAndLater) {
  Probe probe(kTolerance, kHints);
  const int most = reachInBins();
  const double last = distanceFor(most);
  for (int bin = 100; bin < 116; ++bin)
    for (const int apart : {-most, -20, -3, 1, 20, most}) {
      probe.begin(kTolerance, kHints);
      EXPECT_FALSE(probe.put(2, kFirstBin, 300.0, 0.0));
      EXPECT_FALSE(probe.put(1, bin, 100.0, 0.0));
      EXPECT_TRUE(probe.put(1, bin, last, 0.0)) << "its bin is taken";
      probe.linkAll();
      EXPECT_FALSE(probe.joined(1, 2));
      EXPECT_FALSE(probe.put(0, bin + apart, last, 0.0));
      probe.linkAll();
      EXPECT_TRUE(probe.joined(2, 3)) << bin << ", " << apart;
      EXPECT_FALSE(probe.joined(1, 2));
    }
}

// A laser so late that all bins are linked before its returns come.
TEST(SegmentLinker, JoinsLateReturns) {
  Probe probe(kTolerance, kHints);
  for (int bin = 100; bin < 116; ++bin)
    for (int apart = -reachInBins() + 1; apart < reachInBins(); ++apart) {
      const double rho = apart == 0 ? 50.0 : distanceFor(std::abs(apart));
      probe.begin(kTolerance, kHints);
      for (int other = kFirstBin; other < 400; ++other)
        EXPECT_FALSE(probe.put(0, other, other == bin ? rho : 300.0, 0.0));
      probe.link();
      EXPECT_FALSE(probe.put(1, 400, probe.pointAt(bin + apart, rho, 0.0)));
      const auto late = static_cast<std::uint32_t>(probe.size() - 1);
      probe.linkAll();
      EXPECT_TRUE(probe.joined(static_cast<std::uint32_t>(bin) - kFirstBin, late)) << bin << ", " << apart;
      EXPECT_FALSE(probe.joined(static_cast<std::uint32_t>(bin) - kFirstBin + 1, late));
      // Another return, later still, next to the late one.
      EXPECT_FALSE(probe.put(2, 400, probe.pointAt(bin + apart + 1, rho, 0.0)));
      probe.linkAll();
      EXPECT_TRUE(probe.joined(late, late + 1));
    }
}

// Linked between a late return and its neighbour, which comes in time.
TEST(SegmentLinker, JoinsReturnsThatFollowALateOne) {
  Probe probe(kTolerance, kHints);
  for (int last = 240; last < 272; ++last)
    for (int apart = 1; apart <= reachInBins() - 1; ++apart) {
      const double rho = distanceFor(apart);
      probe.begin(kTolerance, kHints);
      for (int other = kFirstBin; other < last; ++other) EXPECT_FALSE(probe.put(0, other, 300.0, 0.0));
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

TEST(SegmentLinker, JoinsLateReturnsAcrossTheSeam) {
  Probe probe(kTolerance, kHints);
  for (const int apart : {-reachInBins(), -16, -1, 0, 1, 16, reachInBins()}) {
    const double rho = apart == 0 ? 50.0 : distanceFor(std::abs(apart));
    probe.begin(kTolerance, kHints);
    for (int bin = kFirstBin; bin < 1124; ++bin) EXPECT_FALSE(probe.put(0, bin, bin == 1100 ? rho : 300.0, 0.0));
    probe.linkAll();
    EXPECT_FALSE(probe.put(1, 100, probe.pointAt(1100 - 1024 + apart, rho, 0.0)));
    EXPECT_FALSE(probe.put(1, 101, probe.pointAt(1040, 300.0, 0.0)));
    probe.linkAll();
    EXPECT_TRUE(probe.joined(1100 - kFirstBin, static_cast<std::uint32_t>(probe.size() - 2))) << apart;
  }
}

// Pairs one above the other, as far apart as neighbours can be, with lasers in between and in any order.
TEST(SegmentLinker, JoinsPairsAboveEachOther) {
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
          for (std::size_t r = 0; r < 6; ++r) EXPECT_FALSE(probe.put(laser_of[r], kFirstBin, 300.0, slope(r)));
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

// In map coordinates, a bin must be wider than the step from one coordinate to the next.
TEST(FarRange, BeginsWhereBinsAreWiderThanTheResolutionOfCoordinates) {
  constexpr float kPowerOfTwo = 524288.0F;
  const auto minRangeAt = [](float x) {
    lisco::SensorHints hints = hintsFor(1024, 0.01F);
    hints.origin = {x, 0.0F, 0.0F};
    return static_cast<double>(lisco::farRangeFor(lisco::Tolerance(0.1F), hints).min_range);
  };
  EXPECT_NEAR(minRangeAt(std::nextafter(kPowerOfTwo, 0.0F)), 0.03125 * 1024 / (2 * kPi), 0.01);
  EXPECT_NEAR(minRangeAt(kPowerOfTwo), 0.0625 * 1024 / (2 * kPi), 0.01);
}

/// Ranks of lasers by elevation, from the highest one down, in an order that is neither.
std::vector<std::size_t> mixedRanks(std::size_t lasers) {
  std::vector<std::size_t> ranks;
  for (std::size_t laser = 0; laser < lasers; ++laser) ranks.push_back((laser % 2) * ((lasers + 1) / 2) + laser / 2);
  return ranks;
}

double slopeAt(double rank) {
  return 0.1 - 0.02 * rank;
}

// Rows move with their returns. Lasers that come later are put between the others; the next rotation keeps the order.
TEST(RangeImage, SortsLasersByElevation) {
  constexpr std::size_t kLasers = 12;
  constexpr double kRho = 30.0;
  const std::vector<std::size_t> ranks = mixedRanks(kLasers);
  Probe probe(kTolerance, kHints);
  const auto isLate = [&](std::size_t laser) { return ranks[laser] == 3 || ranks[laser] == 8; };
  const auto put = [&](bool late) {
    for (std::size_t laser = 0; laser < kLasers; ++laser)
      for (const std::uint32_t bin : {kFirstBin, kFirstBin + 1})
        if (isLate(laser) == late) {
          EXPECT_FALSE(probe.put(laser, bin, kRho, slopeAt(static_cast<double>(ranks[laser]))));
        }
    probe.link();
  };
  const auto expectSorted = [&](std::size_t seen) {
    const lisco::RangeImage& image = probe.part().image;
    std::vector<double> slopes;
    for (std::size_t rank = 0; rank < seen; ++rank) {
      const std::size_t laser = image.ranks.laserAt(rank);
      ASSERT_EQ(image.firstRowOf(laser), rank * image.layers);
      slopes.push_back(slopeAt(static_cast<double>(ranks[laser])));
      EXPECT_NEAR(static_cast<double>(image.at(image.firstRowOf(laser), kFirstBin).z()[0]), kRho * slopes.back(), 1e-4);
    }
    EXPECT_TRUE(std::is_sorted(slopes.rbegin(), slopes.rend()));
  };
  put(false);
  expectSorted(kLasers - 2);
  put(true);
  expectSorted(kLasers);
  probe.linkAll();
  EXPECT_EQ(difference(trueClusters(probe.points(), kTolerance), probe.clusters()), "");

  const std::size_t reordered = probe.part().image.times_reordered;
  probe.begin(kTolerance, kHints);
  put(false);
  put(true);
  expectSorted(kLasers);
  EXPECT_EQ(probe.part().image.times_reordered, reordered);
}

TEST(RangeImage, KeepsTheOrderOfSortedLasers) {
  for (const double step : {1.0, -1.0})
    for (const bool are_two_exchanged : {false, true}) {
      std::vector<std::size_t> ranks(16);
      std::iota(ranks.begin(), ranks.end(), std::size_t{0});
      if (are_two_exchanged) std::swap(ranks[5], ranks[6]);
      Probe probe(kTolerance, kHints);
      for (std::size_t laser = 0; laser < ranks.size(); ++laser)
        EXPECT_FALSE(probe.put(laser, kFirstBin, 30.0, step * slopeAt(static_cast<double>(ranks[laser]))));
      probe.link();
      EXPECT_EQ(probe.part().image.times_reordered, 0U);
    }
}

// Each image has sorted the lasers that it has seen, which are not the same.
TEST(SegmentLinker, JoinsAcrossImagesWhoseLasersAreInAnotherOrder) {
  constexpr std::size_t kLasers = 12;
  const std::vector<std::size_t> ranks = mixedRanks(kLasers);
  Probe probe(kTolerance, kHints);
  for (std::size_t part = 0; part < 2; ++part) {
    probe.usePart(part);
    for (std::size_t laser = 0; laser < kLasers; ++laser)
      for (std::size_t i = 0; i < 64; ++i) {
        if (laser % 3 == part) continue;
        const auto bin = static_cast<double>(kFirstBin + 64 * part + i);
        EXPECT_FALSE(probe.put(laser, bin, 30.0, slopeAt(static_cast<double>(ranks[laser]))));
      }
    probe.link();
  }
  const auto rankOf = [&](std::size_t part, std::size_t laser) {
    probe.usePart(part);
    return probe.part().image.ranks.rankOf(laser);
  };
  EXPECT_NE(rankOf(0, 4), rankOf(1, 4));
  probe.linkAll();
  EXPECT_EQ(difference(trueClusters(probe.points(), kTolerance), probe.clusters()), "");
  for (const std::size_t part : {0U, 1U})
    for (std::size_t laser = 0; laser < kLasers; ++laser) EXPECT_EQ(rankOf(part, laser), ranks[laser]);
}

// Lasers appear, and change their order, while sectors are linked in parts, with one or two returns in a bin.
TEST(SegmentLinker, JoinsWhileLasersAreSorted) {
  Probe probe(kTolerance, kHints);
  std::size_t reordered = 0;
  for (std::uint64_t seed = 1; seed <= timesEffort(100); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    probe.begin(kTolerance, kHints);
    std::vector<std::size_t> ranks(4 + random.below(20));
    std::iota(ranks.begin(), ranks.end(), std::size_t{0});
    random.shuffle(ranks);
    std::vector<std::uint32_t> first_bin;
    for (std::size_t i = 0; i < ranks.size(); ++i)
      first_bin.push_back(random.chance(0.5) ? 0 : static_cast<std::uint32_t>(random.below(300)));
    const double kept = random.between(0.01, 0.06);
    const int most_in_bin = random.chance(0.3) ? 2 : 1;
    for (std::uint32_t bin = kFirstBin; bin < 400; ++bin) {
      for (std::size_t laser = 0; laser < ranks.size(); ++laser)
        for (int i = 0; i < most_in_bin; ++i)
          if (bin >= first_bin[laser] && random.chance(kept))
            probe.put(laser, bin, random.between(29.0, 31.0), slopeAt(static_cast<double>(ranks[laser])));
      if (random.chance(0.03)) probe.link();
      if (random.chance(0.2)) probe.linkParts(random.below(300));
    }
    probe.linkAll();
    ASSERT_EQ(difference(trueClusters(probe.points(), kTolerance), probe.clusters()), "");
    reordered = probe.part().image.times_reordered;
  }
  EXPECT_GT(reordered, 100U);
}

// The masks of unsorted lasers span as many rows as those of sorted ones.
TEST(SegmentLinker, UnsortedLasersTakeTheWorkOfSortedOnes) {
  constexpr std::size_t kLasers = 32;
  const auto workOf = [](const std::vector<std::size_t>& ranks) {
    Probe probe(0.2F, hintsFor(1024, 0.02F));
    for (int bin = kFirstBin; bin < 300; ++bin)
      for (std::size_t laser = 0; laser < kLasers; ++laser)
        EXPECT_FALSE(probe.put(laser, bin, 40.0, slopeAt(static_cast<double>(ranks[laser]))));
    probe.linkAll();
    return probe.part().linker.workDone();
  };
  std::vector<std::size_t> sorted(kLasers);
  std::iota(sorted.begin(), sorted.end(), std::size_t{0});
  EXPECT_EQ(workOf(mixedRanks(kLasers)), workOf(sorted));
}

// Each laser sweeps over all elevations.
TEST(SegmentLinker, JoinsReturnsOfSwayingLasers) {
  Probe probe(kTolerance, kHints);
  const auto slope = [](std::size_t laser, int bin) {
    return (laser == 0 ? 0.3 : -0.3) * std::sin(0.02 * static_cast<double>(bin));
  };
  for (int bin = kFirstBin; bin < 800; ++bin)
    for (std::size_t laser = 0; laser < 2; ++laser) EXPECT_FALSE(probe.put(laser, bin, 40.0, slope(laser, bin)));
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

TEST(SegmentLinker, BeginForgetsTheLastRotation) {
  Probe probe(kTolerance, kHints);
  for (const int steps : {1024, 1024, 1200, 512, 1024}) {
    probe.begin(kTolerance, hintsFor(steps, 0.02F));
    for (int i = 0; i < 500; ++i)
      for (std::size_t laser = 0; laser < 8; ++laser) EXPECT_FALSE(probe.put(laser, kFirstBin + i, 60.0, 0.0));
    probe.linkAll();
    probe.begin(kTolerance, hintsFor(steps, 0.02F));
    for (int i = 0; i < 500; i += 50)
      for (std::size_t laser = 0; laser < 9; ++laser)
        EXPECT_FALSE(probe.put(laser, kFirstBin + i, 60.0, 0.03 * static_cast<double>(laser)));
    probe.linkAll();
    for (std::uint32_t i = 1; i < probe.size(); ++i) EXPECT_FALSE(probe.joined(0, i)) << i;
  }
}

// Once placing has ended, all returns are unplaced, and are still linked with the placed ones.
TEST(SegmentLinker, TooManyUnplacedReturnsEndThePlacing) {
  Probe probe(kTolerance, kHints);
  EXPECT_FALSE(probe.put(0, kFirstBin, 60.0, 0.0));
  EXPECT_FALSE(probe.put(0, kFirstBin + 20, 60.0, 0.0));
  while (!probe.part().image.isFull()) probe.put(0, kFirstBin + 40, 60.0, 0.0);
  for (int time = 0; time < 3; ++time) {
    EXPECT_TRUE(probe.put(0, kFirstBin + 20.4, 60.0, 0.0));  // its bin is free
    const auto element = static_cast<std::uint32_t>(probe.size() - 1);
    probe.linkAll();
    EXPECT_TRUE(probe.joined(1, element));
    EXPECT_FALSE(probe.joined(0, element));
  }
}

// Two or three returns in each azimuth bin: few are unplaced, and only rows that hold returns have memory.
TEST(SegmentLinker, PutsReturnsOfTakenBinsIntoAnotherLayer) {
  for (const int in_a_bin : {1, 2, 3}) {
    SCOPED_TRACE(std::to_string(in_a_bin) + " returns in a bin");
    Probe probe(0.05F, kHints);
    int unplaced = 0;
    for (int bin = kFirstBin; bin < 1000; ++bin)
      for (std::size_t laser = 0; laser < 3; ++laser)
        for (int i = 0; i < in_a_bin; ++i)
          unplaced += probe.put(laser, bin, 0.2 + 0.049 * i, 0.5 * static_cast<double>(laser)) ? 1 : 0;
    EXPECT_LE(unplaced, 200);
    EXPECT_EQ(probe.part().image.layers, static_cast<std::size_t>(in_a_bin));
    EXPECT_EQ(probe.part().image.cells.rowsWithMemory(), 3 * static_cast<std::size_t>(in_a_bin));
    probe.linkAll();
    EXPECT_EQ(difference(trueClusters(probe.points(), 0.05F), probe.clusters()), "");
  }
}

// A first or second row for one laser makes room for those of all; a third one for a few more.
TEST(RangeImage, TakesMemoryForRowsOfALayerAtOnce) {
  constexpr std::size_t kLasers = 64;
  lisco::RangeImage image;
  image.prepare(lisco::Tolerance(0.05F), kHints, 1024);
  image.addLasers(kLasers);
  const std::size_t one_layer = image.cells.bytes();
  image.addLayer();
  image.openRow(image.firstRowOf(7) + 1);
  const std::size_t two_layers = image.cells.bytes();
  EXPECT_GE(two_layers, 2 * one_layer);
  EXPECT_LE(two_layers, 5 * one_layer / 2);
  for (std::size_t laser = 0; laser < kLasers; ++laser)
    if (laser != 7) image.openRow(image.firstRowOf(laser) + 1);
  EXPECT_EQ(image.cells.bytes(), two_layers);
  image.addLayer();
  image.openRow(image.firstRowOf(7) + 2);
  EXPECT_GT(image.cells.bytes(), two_layers);
  EXPECT_LE(image.cells.bytes(), 5 * two_layers / 4);
}

// With room for all columns, rows stay in place when more are expected; without, they move. Their bins are free.
TEST(RangeImage, ExpectsMoreColumns) {
  constexpr std::size_t kAll = 1024;
  constexpr std::size_t kFirst = 128;
  for (const bool has_room : {true, false}) {
    lisco::RangeImage image;
    for (int rotation = 0; rotation < 2; ++rotation) {
      image.prepare(lisco::Tolerance(0.05F), kHints, kFirst, has_room ? kAll : 0);
      EXPECT_EQ(image.hasMemoryFor(2, kAll, kHints), rotation == 1);
      image.addLasers(2);
      image.openRow(1);
      const float* const row = image.at(1, 0).x();
      const std::size_t first_bins = image.bins;
      image.at(1, 5).x()[0] = 3.0F;
      image.end = 6;
      image.expectColumns(kAll);
      EXPECT_EQ(image.at(1, 0).x() == row, has_room);
      EXPECT_EQ(image.bins, first_bins + kAll - kFirst);
      const auto margin = static_cast<std::int64_t>(lisco::RangeImage::kMargin);
      for (std::int64_t bin = -margin; bin < static_cast<std::int64_t>(image.bins) + margin; ++bin) {
        if (bin == 5)
          EXPECT_EQ(*image.at(1, bin).x(), 3.0F);
        else
          ASSERT_TRUE(std::isnan(*image.at(1, bin).x())) << bin;
      }
      for (std::int64_t bin = 0; bin < static_cast<std::int64_t>(image.bins); ++bin)
        *image.at(1, bin).x() = 1.0F;  // for the next rotation to find
    }
  }
}

TEST(RangeImage, GivesBackTheMemoryOfColumnsNotExpected) {
  lisco::RangeImage image;
  image.prepare(lisco::Tolerance(0.05F), kHints, 128, 1024);
  image.addLasers(3);
  EXPECT_TRUE(image.hasMemoryFor(3, 1024, kHints));
  image.shrinkMemory();
  EXPECT_FALSE(image.hasMemoryFor(3, 1024, kHints));
  EXPECT_TRUE(image.hasMemoryFor(3, 128, kHints));
}

// One image is full of unplaced returns; returns placed in another image are linked with them.
TEST(SegmentLinker, JoinsUnplacedReturnsOfAnotherImage) {
  Probe probe(kTolerance, kHints);
  for (const bool linked_before : {false, true}) {
    probe.begin(kTolerance, kHints);
    EXPECT_FALSE(probe.put(0, kFirstBin, 60.0, 0.0));
    EXPECT_FALSE(probe.put(0, kFirstBin + 40, 300.0, 0.0));
    bool is_unplaced = false;
    for (int i = 0; i < 5000; ++i) is_unplaced = probe.put(0, kFirstBin + 40, 60.0, 0.0);
    EXPECT_TRUE(is_unplaced);
    const auto unplaced = static_cast<std::uint32_t>(probe.size() - 1);
    if (linked_before) probe.linkAll();
    probe.usePart(1);
    const bool also_unplaced = probe.put(1, kFirstBin + 41, 60.0, 0.0);
    const auto element = static_cast<std::uint32_t>(probe.size() - 1);
    probe.linkAll();
    // Two unplaced returns are linked by the voxels.
    EXPECT_TRUE(also_unplaced || probe.joined(unplaced, element)) << linked_before;
    EXPECT_FALSE(probe.joined(0, element));
  }
}

// Lasers whose returns are all near have no elevation yet.
TEST(SegmentLinker, AcceptsLasersThatAppearLateAndNear) {
  Probe probe(kTolerance, kHints);
  EXPECT_FALSE(probe.put(0, kFirstBin, 60.0, 0.0));
  EXPECT_FALSE(probe.put(0, kFirstBin + 1, 60.0, 0.0));
  probe.link();
  for (std::size_t laser = 1; laser < 30; ++laser) {  // few enough to keep placing
    EXPECT_FALSE(probe.put(laser, kFirstBin + 2, 0.9 * probe.minRange(), 0.0));
    EXPECT_FALSE(probe.put(0, kFirstBin + 1.0 + static_cast<double>(laser), 60.0, 0.0));
    EXPECT_TRUE(probe.put(0, kFirstBin, 60.0, 0.0));
    probe.linkAll();
    EXPECT_TRUE(probe.joined(0, static_cast<std::uint32_t>(probe.size() - 2)));
    EXPECT_TRUE(probe.joined(0, static_cast<std::uint32_t>(probe.size() - 1)));
  }
}

/// Two returns that are just neighbours, the tolerance that makes them so, and their bins.
struct CriticalPair {
  lisco::SensorHints hints;
  float tolerance = 0;
  std::array<double, 2> bin{}, rho{}, slope{};  ///< bins with fractions, as Probe::pointAt() takes them
};

/// A pair of any size, distance and direction: one beside, above or behind the other.
CriticalPair criticalPair(Random& random) {
  const std::array<int, 6> steps_choices{512, 513, 1000, 2047, 4096, 16384};
  CriticalPair pair;
  const int steps = random.oneOf(steps_choices);
  const double step = 2.0 * kPi / steps;
  pair.hints = hintsFor(steps, 0.1F, random.chance(0.5));
  if (random.chance(0.3)) pair.hints.jitter = static_cast<float>(random.between(0.0, 3.0));
  pair.hints.elevation_step = elevationStepFor(pair.hints, random.magnitude(1.0, 4e4));
  const double spacing = 1.0 / minRangeOf(pair.hints);  // infinite if the image is not used
  const double min_range = random.chance(0.3) ? random.magnitude(1e-17, 1e11) : random.magnitude(1.0, 100.0);
  if (random.chance(0.3))
    for (float& axis : pair.hints.origin) axis = static_cast<float>(min_range * random.between(-0.5, 0.5));
  if (random.chance(0.3))
    for (float& slope : pair.hints.tilt) slope = static_cast<float>(random.between(-0.5, 0.5));
  const double reach = min_range * spacing;

  // The first one lies ahead, the second a step from it.
  const double rho = min_range * (random.chance(0.7) ? random.between(1.0, 1.5) : random.magnitude(1.0, 100.0));
  const std::array<double, 5> slopes{0.0, 0.0, 0.3, -0.3, 3.0};
  const double slope = random.oneOf(slopes) * random.unit();
  const double sine = reach / rho;
  const double cosine = std::sqrt(1.0 - sine * sine);
  const double range = rho * std::sqrt(1.0 + slope * slope);
  std::array<double, 3> way{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};  // ahead, aside, up
  switch (random.below(5)) {
    case 0:  // as far aside as possible
      way = {-sine, random.chance(0.5) ? cosine : -cosine, 0.0};
      break;
    case 1: {  // as far above or below as possible
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
  const double where = random.between(kFirstBin + 60.0, kFirstBin + 120.0);
  pair.bin = {where, where + std::atan2(way[1], ahead) / step};
  pair.rho = {rho, std::hypot(ahead, way[1])};
  pair.slope = {slope, (slope * rho + way[2]) / pair.rho[1]};
  if (random.chance(0.5)) {
    std::swap(pair.bin[0], pair.bin[1]);
    std::swap(pair.rho[0], pair.rho[1]);
    std::swap(pair.slope[0], pair.slope[1]);
  }
  pair.tolerance = static_cast<float>(reach);
  return pair;
}

// Placed in their bins or in adjacent ones, before and after the seam, late and unplaced.
TEST(SegmentLinker, JoinsCriticalPairs) {
  Probe probe(kTolerance, kHints);
  std::size_t pairs = 0;
  for (std::uint64_t seed = 1; seed < 1 + timesEffort(20000); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    CriticalPair pair = criticalPair(random);
    const bool seam = random.chance(0.3);
    if (seam) pair.bin[1] += pair.hints.steps_per_turn;
    const bool late = random.chance(0.3);
    const bool first_later = !late && random.chance(0.5);
    if (first_later) std::swap(pair.bin[0], pair.bin[1]);
    if (first_later) std::swap(pair.rho[0], pair.rho[1]);
    if (first_later) std::swap(pair.slope[0], pair.slope[1]);

    // The least tolerance that makes them neighbours.
    probe.begin(pair.tolerance, pair.hints);
    const std::array<Point, 2> points{probe.pointAt(pair.bin[0], pair.rho[0], pair.slope[0]),
                                      probe.pointAt(pair.bin[1], pair.rho[1], pair.slope[1])};
    const double apart = std::hypot(static_cast<double>(points[0].x) - static_cast<double>(points[1].x),
                                    static_cast<double>(points[0].y) - static_cast<double>(points[1].y),
                                    static_cast<double>(points[0].z) - static_cast<double>(points[1].z));
    pair.tolerance = static_cast<float>(apart * (1.0 - 3e-7));
    for (int ulp = 0; ulp < 20 && !areNeighbours(points[0], points[1], pair.tolerance); ++ulp)
      pair.tolerance = std::nextafter(pair.tolerance, 1e30F);
    if (!areNeighbours(points[0], points[1], pair.tolerance)) continue;  // they nearly coincide
    const bool apart_in_images = random.chance(0.3);
    probe.begin(pair.tolerance, pair.hints, random.chance(0.5) ? ~std::size_t{0} : random.below(600));
    if (!probe.part().image.inUse()) continue;
    const double min_range = probe.minRange();
    if (std::min(pair.rho[0], pair.rho[1]) < min_range * (1.0 + 1e-6)) continue;

    // All other returns are far behind them.
    const double behind = 1000.0 * min_range;
    probe.put(0, kFirstBin, behind, 0.0);
    probe.put(3, kFirstBin, behind, 0.0);
    std::array<std::uint32_t, 2> number{};
    int unplaced = 0;
    for (std::size_t i = 0; i < 2; ++i) {
      if (i == 1 && apart_in_images) probe.usePart(1 + random.below(2));
      if (i == 1 && late) {
        for (const std::size_t laser : {0, 1, 3}) probe.put(laser, pair.bin[1] + 200.0, behind, 0.0);
        probe.link();
      }
      // Its laser is in the adjacent bin, up to three quarters of a bin off, or more if azimuths jitter.
      double bin = std::round(pair.bin[i]);
      if (random.chance(0.5)) bin += pair.bin[i] > bin ? 1.0 : -1.0;
      if (pair.hints.jitter > 0.0F) bin += static_cast<double>(random.below(5)) - 2.0;
      const auto column = static_cast<std::uint32_t>(bin);
      if (random.chance(0.8)) probe.put(i + 1, bin - 1.0, behind, pair.slope[i]);
      const bool full = random.chance(0.2);
      if (full) probe.put(i + 1, column, probe.pointAt(pair.bin[i], behind, 0.0));
      number[i] = static_cast<std::uint32_t>(probe.size());
      unplaced += probe.put(i + 1, full ? column + 1 : column, points[i]) ? 1 : 0;
      if (random.chance(0.1)) probe.linkAll();
    }
    if (unplaced == 2) continue;  // linked by the voxels
    ++pairs;
    if (random.chance(0.5)) probe.put(random.below(4), pair.bin[1] + 100.0, behind, 0.0);
    if (random.chance(0.3)) probe.link();
    probe.linkAll();
    ASSERT_TRUE(probe.joined(number[0], number[1]))
        << pair.hints.steps_per_turn << " steps, tolerance " << pair.tolerance << " at " << pair.rho[0] << " and "
        << pair.rho[1] << ", bins " << pair.bin[0] << " and " << pair.bin[1] << ", slopes " << pair.slope[0] << " and "
        << pair.slope[1] << (late ? ", late" : "") << (apart_in_images ? ", in two images" : "")
        << (unplaced > 0 ? ", unplaced" : "");
  }
  EXPECT_GT(pairs, timesEffort(10000));
}

/// A simulated sensor and its surroundings.
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
  const bool appear = random.chance(0.2);  // each laser starts later than the one before

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

  // Objects of any width at any distance, on a floor.
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

/// A tolerance that makes about this part of the returns far.
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

/// In parts that run side by side.
class RangeImageScans : public testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Seeds, RangeImageScans, testing::Range<std::uint64_t>(1, 4));

TEST_P(RangeImageScans, EqualTheEngineWithoutHints) {
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

// Few returns: clusters are pairs, each joined by one comparison only.
TEST_P(RangeImageScans, EqualTheOracle) {
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

// Several columns of one azimuth, as of two returns per firing or motion-compensated scans: bins are taken repeatedly.
TEST_P(RangeImageScans, EqualTheOracleWithTakenBins) {
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

TEST(RangeImageScans, FarReturnsNeedNoVoxels) {
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
            EXPECT_EQ(probe.putBlock(laser, static_cast<std::uint32_t>(column), points), 0U);
          }
        probe.linkAll();
        const Clustering right = trueClusters(probe.points(), kWidth);
        EXPECT_GT(right.size(), 3U);
        EXPECT_EQ(difference(right, probe.clusters()), "");
      }
}

/// Pairs that lie within a few ulps on either side of a distance, or of a tolerance from it.
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

TEST(RangeImageScans, EqualTheOracleAtMinRangeAndMaxRange) {
  lisco::ColumnClusterer clusterer;
  for (std::uint64_t seed = 1; seed < 1 + timesEffort(300); ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const std::array<float, 4> steps{0.001F, 0.01F, 0.1F, 1.0F};
    Setting setting{"range image", {}};
    setting.parameters.sensor = hintsFor(512, random.oneOf(steps));
    setting.parameters.expected_returns = 100;
    const bool at_max_range = random.chance(0.3);
    const std::array<double, 6> tolerances{0.3, 1.0, 7e-5, 1e-17, 1e9, 2e13};
    const std::array<double, 3> huge{1e13, 5e13, 1e14};
    const double tolerance = at_max_range ? random.oneOf(huge) : random.oneOf(tolerances);
    const double min_range = minRangeOf(setting.parameters.sensor);
    const double distance = at_max_range ? 1e15 : tolerance * (min_range < 1e6 ? min_range : 3.0);
    const Scan scan = pairsAround(random, distance, tolerance);
    const auto rounded = static_cast<float>(tolerance);
    ASSERT_EQ(difference(trueClusters(scan.points(), rounded), cluster(clusterer, scan, rounded, setting)), "");
  }
}

}  // namespace
}  // namespace lisco_test
