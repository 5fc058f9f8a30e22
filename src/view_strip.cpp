// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "lisco/view_strip.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace lisco {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// A return stands at most this many places from where its azimuth is; half a place is the least possible.
constexpr float kDeviation = 0.75F;
constexpr float kAngleRounding = 1e-4F;  // radians, on elevations; far more than their rounding
constexpr float kFarEnd = 1e15F;         // what is further away is not far but elsewhere: its squares may overflow
// With more loose returns than this, no more are placed: each loose one is searched for again whenever somebody asks.
constexpr std::size_t kFewLoose = 4096;
constexpr std::size_t kPlacedPerLoose = 32;
constexpr std::size_t kFewestSteps = 512;  // so that all places are less than two turns, and the seam is one
constexpr std::size_t kMostSteps = 16384;

// From where on returns are far: where about this many of a flat surface's lie in a square of the tolerance's size.
constexpr double kReturnsPerSquare = 12.0;

/// Sixteen lanes as four registers, for any processor.
using Floats = float __attribute__((vector_size(16)));
using Ints = std::int32_t __attribute__((vector_size(16)));
constexpr std::size_t kRegisters = 4;

template <typename Register, typename Value>
inline Register load(const Value* from) {
  Register lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}
inline Floats all(float value) {
  return Floats{value, value, value, value};
}

inline bool any(const Ints& mask) {
  std::uint64_t halves[2];
  std::memcpy(halves, &mask, sizeof halves);
  return (halves[0] | halves[1]) != 0;
}

/// An upper bound on asin (ratio), 0 <= ratio < 1.
inline float asinBound(float ratio) {
  return (ratio + 0.5708F * ratio * ratio * ratio) * 1.00001F;
}

}  // namespace

void ViewStrip::prepare(const Tolerance& tolerance, const ViewHints& hints) {
  tolerance_ = tolerance;
  origin_ = hints.origin;
  started_ = false;
  linked_ = 0;
  end_ = 0;
  placed_ = 0;
  full_ = false;
  loose_.clear();
  late_.clear();
  const auto steps = static_cast<std::size_t>(hints.steps_per_turn);
  const double step = 2 * kPi / static_cast<double>(std::max<std::size_t>(steps, 1));
  const double spacing = std::sqrt(kReturnsPerSquare * step * static_cast<double>(hints.elevation_step));
  const double near_end = tolerance.reach() / spacing;
  const bool useful =
      steps >= kFewestSteps && steps <= kMostSteps && tolerance.joinsAnything() && spacing > 1e-5 && spacing < 0.5 &&
      near_end > 1e-18 && near_end < 1e15 && near_end < static_cast<double>(hints.far_distance) &&
      asinBound(static_cast<float>(spacing)) / static_cast<float>(step) + 3 < static_cast<float>(kMostReach);
  if (!useful) {
    steps_ = 0;
    return;
  }
  near_end_ = static_cast<float>(near_end);
  reach_ = static_cast<float>(tolerance.reach()) * 1.00001F;
  // Distances are rounded, and so are these sums.
  far_enough_ = near_end_ * 1.00001F + reach_;
  not_too_far_ = kFarEnd * 0.9999F - reach_;
  direction_ = hints.clockwise ? -1.0F : 1.0F;
  if (steps != steps_) {
    steps_ = steps;
    radians_per_place_ = static_cast<float>(step);
    const std::size_t places = steps + 4 * kMargin;
    stride_ = (places + kMargin + 2 * kLanes) / kLanes * kLanes;
    cosine_.resize(places);
    sine_.resize(places);
    for (std::size_t place = 0; place < places; ++place) {
      cosine_[place] = static_cast<float>(std::cos(step * static_cast<double>(place)));
      sine_[place] = static_cast<float>(std::sin(step * static_cast<double>(place)));
    }
    lasers_.clear();
  }
  const std::size_t lasers = lasers_.size();
  lasers_.clear();
  addLasers(lasers);
  std::fill_n(rho_.begin(), lasers * stride_, kNan);
}

void ViewStrip::addLasers(std::size_t lasers) {
  if (lasers <= lasers_.size()) return;
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  lasers_.resize(lasers, {kInfinity, -kInfinity, kNowhere, 0});
  above_.assign(lasers, 0);
  below_.assign(lasers, 0);
  elevations_changed_ = true;  // there are more of them
  const std::size_t size = lasers * stride_ + kLanes;
  if (rho_.size() < size) {
    rho_.resize(size, kNan);
    for (auto* coordinate : {&x_, &y_, &z_}) coordinate->resize(size);
    element_.resize(size);
  }
}

void ViewStrip::horizontalDistances(const Row& row, float* rho) const {
  for (std::size_t i = 0; i < row.count; ++i) {
    const float x = row.x[i] - origin_[0];
    const float y = row.y[i] - origin_[1];
    rho[i] = std::sqrt(x * x + y * y);
  }
}

std::uint64_t ViewStrip::place(const Row& row, const float* rho) {
  if (row.laser >= lasers_.size()) {
    const std::size_t before = lasers_.size();
    addLasers(row.laser + 1);
    std::fill_n(rho_.begin() + static_cast<std::ptrdiff_t>(before * stride_), (lasers_.size() - before) * stride_,
                kNan);
  }
  Laser& laser = lasers_[row.laser];
  std::uint64_t loose = 0;
  const auto places = static_cast<std::int64_t>(cosine_.size());
  const float deviation = std::sin(kDeviation * radians_per_place_);
  for (std::size_t i = 0; i < row.count; ++i) {
    if (!isFar(rho[i])) continue;
    const Loose one{row.x[i], row.y[i], row.z[i], row.element[i]};
    if (full_) {
      loose |= std::uint64_t{1} << i;
      loose_.push_back(one);
      continue;
    }
    const float x = row.x[i] - origin_[0];
    const float y = row.y[i] - origin_[1];
    if (!started_) {
      started_ = true;
      const float start = std::atan2(y, x) - direction_ * static_cast<float>(kMargin) * radians_per_place_;
      start_cosine_ = std::cos(start);
      start_sine_ = std::sin(start);
      first_column_ = row.column[i];
    }
    const Seen seen = seenFromStart(x, y);
    std::int64_t place = laser.next_place == kNowhere
                             ? static_cast<std::int64_t>(kMargin) + row.column[i] - std::int64_t{first_column_}
                             : laser.next_place + row.column[i] - std::int64_t{laser.next_column};
    const bool expected =
        laser.next_place != kNowhere && place >= 0 && place < places &&
        std::fabs(seen.u * sine_[static_cast<std::size_t>(place)] -
                  seen.v * cosine_[static_cast<std::size_t>(place)]) <= rho[i] * deviation &&
        seen.u * cosine_[static_cast<std::size_t>(place)] + seen.v * sine_[static_cast<std::size_t>(place)] > 0;
    if (!expected) {
      const auto turn = static_cast<std::int64_t>(steps_);
      const std::int64_t measured = placeOf(seen);
      place = measured + turn * std::llround(static_cast<double>(place - measured) / static_cast<double>(turn));
    }
    laser.next_place = place + 1;
    laser.next_column = row.column[i] + 1;
    const float slope = (row.z[i] - origin_[2]) / rho[i];
    if (slope < laser.lowest || slope > laser.highest) {
      constexpr float kWidening = 1e-3F;  // so that bounds settle soon
      laser.lowest = std::min(laser.lowest, slope - kWidening * (1 + std::fabs(slope)));
      laser.highest = std::max(laser.highest, slope + kWidening * (1 + std::fabs(slope)));
      elevations_changed_ = true;
    }
    if (place < 0 || place >= places ||
        rho_[at(row.laser, static_cast<std::size_t>(place))] == rho_[at(row.laser, static_cast<std::size_t>(place))]) {
      loose |= std::uint64_t{1} << i;
      loose_.push_back(one);
      full_ = loose_.size() > kFewLoose + placed_ / kPlacedPerLoose;
      continue;
    }
    const auto here = static_cast<std::size_t>(place);
    const std::size_t cell = at(row.laser, here);
    rho_[cell] = rho[i];
    x_[cell] = row.x[i];
    y_[cell] = row.y[i];
    z_[cell] = row.z[i];
    element_[cell] = row.element[i];
    ++placed_;
    end_ = std::max(end_, here + 1);
    if (here < linked_) late_.push_back(one);
  }
  return loose;
}

bool ViewStrip::isFar(float rho) const {
  return rho >= near_end_ && rho < kFarEnd;
}

ViewStrip::Seen ViewStrip::seenFromStart(float x, float y) const {
  return {x * start_cosine_ + y * start_sine_, direction_ * (y * start_cosine_ - x * start_sine_)};
}

/// The place of its azimuth, within half a turn of place 0.
std::int64_t ViewStrip::placeOf(const Seen& seen) const {
  return std::llround(static_cast<double>(std::atan2(seen.v, seen.u)) / static_cast<double>(radians_per_place_));
}

void ViewStrip::updateElevations() {
  if (!elevations_changed_) return;
  elevations_changed_ = false;
  const std::size_t lasers = lasers_.size();
  // Lasers are taken from top to bottom; if they come the other way round, elevations are turned over.
  float first = 0;
  float last = 0;
  bool any_seen = false;
  for (const Laser& laser : lasers_) {
    if (laser.lowest > laser.highest) continue;
    if (!any_seen) first = laser.lowest + laser.highest;
    any_seen = true;
    last = laser.lowest + laser.highest;
  }
  upside_down_ = last > first;
  lowest_above_.resize(lasers);
  highest_below_.resize(lasers);
  lowest_.resize(lasers);
  highest_.resize(lasers);
  for (std::size_t i = 0; i < lasers; ++i) {
    const bool seen = lasers_[i].lowest <= lasers_[i].highest;
    const float lowest = seen ? std::atan(lasers_[i].lowest) : 10.0F;
    const float highest = seen ? std::atan(lasers_[i].highest) : -10.0F;
    lowest_[i] = seen && upside_down_ ? -highest : lowest;
    highest_[i] = seen && upside_down_ ? -lowest : highest;
  }
  float bound = 10.0F;
  for (std::size_t i = 0; i < lasers; ++i) lowest_above_[i] = bound = std::min(bound, lowest_[i]);
  bound = -10.0F;
  for (std::size_t i = lasers; i-- > 0;) highest_below_[i] = bound = std::max(bound, highest_[i]);
}

void ViewStrip::link(Merge merge, void* context) {
  if (!started_) return;
  updateElevations();
  std::int64_t front = std::numeric_limits<std::int64_t>::max();
  std::uint32_t column = 0;
  for (const Laser& laser : lasers_)
    if (laser.next_place != kNowhere) column = std::max(column, laser.next_column);
  for (const Laser& laser : lasers_)
    if (laser.next_place != kNowhere) front = std::min(front, laser.next_place + (column - laser.next_column));
  front = std::clamp<std::int64_t>(front, 0, static_cast<std::int64_t>(cosine_.size()));
  const std::size_t complete = static_cast<std::size_t>(front) / kLanes * kLanes;
  if (complete > linked_) {
    linkPlaces(linked_, complete, merge, context);
    linked_ = complete;
  }
}

void ViewStrip::linkAll(Merge merge, void* context) {
  if (!started_) return;
  link(merge, context);
  linkPlaces(linked_, end_, merge, context);
  for (const Loose& late : late_) search(late, merge, context);
  late_.clear();
  for (const Loose& loose : loose_) search(loose, merge, context);
  if (full_) loose_.clear();  // nothing comes after them
}

void ViewStrip::linkPlaces(std::size_t begin, std::size_t end, Merge merge, void* context) {
  for (std::size_t place = begin; place < end; place += kLanes)
    for (std::size_t laser = 0; laser < lasers_.size(); ++laser)
      if (lasers_[laser].next_place != kNowhere) linkGroup(laser, place, merge, context);
}

/// Compares sixteen neighbouring places of a laser with the places before them, of lasers above and below too, and with
/// the same places of the lasers below. Near the end of the turn also with the places around its beginning.
void ViewStrip::linkGroup(std::size_t laser, std::size_t place, Merge merge, void* context) {
  const std::size_t own = at(laser, place);
  Floats rho[kRegisters];
  Floats x[kRegisters];
  Floats y[kRegisters];
  Floats z[kRegisters];
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Floats nearest_lanes = all(kInfinity);
  Floats farthest_lanes = all(0.0F);
  for (std::size_t i = 0; i < kRegisters; ++i) {  // comparisons with NaN, an empty place, are false
    rho[i] = load<Floats>(&rho_[own + 4 * i]);
    nearest_lanes = rho[i] < nearest_lanes ? rho[i] : nearest_lanes;
    farthest_lanes = rho[i] > farthest_lanes ? rho[i] : farthest_lanes;
  }
  const float nearest =
      std::min(std::min(nearest_lanes[0], nearest_lanes[1]), std::min(nearest_lanes[2], nearest_lanes[3]));
  const float farthest =
      std::max(std::max(farthest_lanes[0], farthest_lanes[1]), std::max(farthest_lanes[2], farthest_lanes[3]));
  if (nearest == kInfinity) return;
  for (std::size_t i = 0; i < kRegisters; ++i) {
    x[i] = load<Floats>(&x_[own + 4 * i]);
    y[i] = load<Floats>(&y_[own + 4 * i]);
    z[i] = load<Floats>(&z_[own + 4 * i]);
  }
  std::uint32_t* const own_element = &element_[own];
  const Floats reach = all(reach_ + 1e-6F * farthest);
  const Floats squared_tolerance = all(tolerance_.squared());
  const auto compare = [&](std::size_t cell) {
    Ints hit[kRegisters];
    Ints some{};
    for (std::size_t i = 0; i < kRegisters; ++i) {
      const Floats apart = load<Floats>(&rho_[cell + 4 * i]) - rho[i];
      hit[i] =
          (apart < reach) & (-apart < reach) & (load<Ints>(&element_[cell + 4 * i]) != load<Ints>(&own_element[4 * i]));
      some |= hit[i];
    }
    if (!any(some)) return;
    for (std::size_t i = 0; i < kRegisters; ++i) {
      const Floats dx = load<Floats>(&x_[cell + 4 * i]) - x[i];
      const Floats dy = load<Floats>(&y_[cell + 4 * i]) - y[i];
      const Floats dz = load<Floats>(&z_[cell + 4 * i]) - z[i];
      hit[i] &= ((dx * dx + dy * dy) + dz * dz) < squared_tolerance;  // squaredDistance, four times
      if (!any(hit[i])) continue;
      for (std::size_t lane = 0; lane < 4; ++lane)
        if (hit[i][lane] != 0)
          element_[cell + 4 * i + lane] = own_element[4 * i + lane] =
              merge(context, own_element[4 * i + lane], element_[cell + 4 * i + lane]);
    }
  };

  const float angle = asinBound(reach_ / nearest);
  const int before = std::min(kMostReach, static_cast<int>(angle / radians_per_place_ + (2 * kDeviation + 0.02F)));
  const float top = highest_[laser] + angle + kAngleRounding;
  const float bottom = lowest_[laser] - angle - kAngleRounding;
  const int last_laser = static_cast<int>(lasers_.size()) - 1;
  const int me = static_cast<int>(laser);
  int first = me - std::min(me, above_[laser]);
  while (first > 0 && lowest_above_[static_cast<std::size_t>(first) - 1] <= top) --first;
  while (first < me && lowest_above_[static_cast<std::size_t>(first)] > top) ++first;
  int last = std::min(last_laser, me + below_[laser]);
  while (last < last_laser && highest_below_[static_cast<std::size_t>(last) + 1] >= bottom) ++last;
  while (last > me && highest_below_[static_cast<std::size_t>(last)] < bottom) --last;
  above_[laser] = me - first;
  below_[laser] = last - me;

  for (int other = me + 1; other <= last; ++other) compare(own + static_cast<std::size_t>(other - me) * stride_);
  for (int other = first; other <= last; ++other) {
    const std::size_t same = at(static_cast<std::size_t>(other), place);
    for (int k = 1; k <= before; ++k) compare(same - static_cast<std::size_t>(k));
  }
  if (place + kLanes + static_cast<std::size_t>(before) <= steps_) return;
  // The seam: what lies a turn before.
  for (int other = first; other <= last; ++other)
    for (int k = -before; k <= before; ++k) {
      const std::int64_t around = static_cast<std::int64_t>(place) - static_cast<std::int64_t>(steps_) + k;
      if (around > -static_cast<std::int64_t>(kLanes))
        compare(static_cast<std::size_t>(static_cast<std::int64_t>(at(static_cast<std::size_t>(other), 0)) + around));
    }
}

/// Compares one return with all places that may hold its neighbours.
void ViewStrip::search(const Loose& loose, Merge merge, void* context) {
  const float x = loose.x - origin_[0];
  const float y = loose.y - origin_[1];
  const float rho = std::sqrt(x * x + y * y);
  const auto turn = static_cast<std::int64_t>(steps_);
  const std::int64_t measured = placeOf(seenFromStart(x, y)) % turn;
  const std::int64_t middle = measured < 0 ? measured + turn : measured;
  const float angle = asinBound(reach_ / rho);
  const auto before = static_cast<std::int64_t>(angle / radians_per_place_ + (kDeviation + 1.0F));
  const float slope = std::atan((loose.z - origin_[2]) / rho);
  const float elevation = upside_down_ ? -slope : slope;
  const float squared_tolerance = tolerance_.squared();
  for (std::size_t laser = 0; laser < lasers_.size(); ++laser) {
    if (lowest_[laser] > elevation + angle + kAngleRounding || highest_[laser] < elevation - angle - kAngleRounding)
      continue;
    for (const std::int64_t center : {middle - turn, middle, middle + turn}) {
      const std::int64_t from = std::max<std::int64_t>(0, center - before);
      const std::int64_t to = std::min(static_cast<std::int64_t>(end_) - 1, center + before);
      for (std::int64_t place = from; place <= to; ++place) {
        const std::size_t cell = at(laser, static_cast<std::size_t>(place));
        if (!(rho_[cell] >= 0)) continue;
        if (squaredDistance(x_[cell] - loose.x, y_[cell] - loose.y, z_[cell] - loose.z) < squared_tolerance)
          merge(context, loose.element, element_[cell]);
      }
    }
  }
}

}  // namespace lisco
