// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "shapes.h"

#include <algorithm>
#include <limits>

namespace lisco_test {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

float nudged(float value, unsigned how) {
  switch (how % 4) {
    case 1:
      return std::nextafter(value, kInfinity);
    case 2:
      return std::nextafter(value, -kInfinity);
    default:
      return value;
  }
}

}  // namespace

float toleranceFrom(Input& input, float unit) {
  const unsigned how = input.byte();
  switch (how % 16) {
    case 1:
    case 2:
      return nudged(unit, how);
    case 3:
      return -unit;
    case 4:
      return unit * (1.0F + static_cast<float>(how >> 4) / 16.0F);
    case 5:
      return unit * static_cast<float>(std::sqrt(2.0));
    case 6:
      return unit * 0.01F * static_cast<float>(how >> 4);
    case 7:
      return input.rawFloat();
    default:
      return unit;
  }
}

void Shape::read(Input& input, float unit, std::size_t lasers, std::size_t max_columns, std::size_t steps,
                 const lisco::SensorHints& hints) {
  constexpr std::array<int, 32> kColumnSteps{0,  0,  0,  0,  1,  1,  1,  1,  1,  2,  2,  3,   4,   5,   8,  13,
                                             14, 15, 16, 17, 31, 32, 33, 47, 48, 63, 64, 128, 255, 509, -1, -2};
  constexpr std::array<double, 12> kOffsets{0, 0, 0, 0, 0.25, -0.5, 0.74, -0.76, 1, -3, 17, 256};
  const double step = 2 * kPi / static_cast<double>(steps);
  resize(lasers, kMaxColumns);
  const double start = static_cast<double>(input.byte()) * (kPi / 128);
  std::size_t column = 0;
  while (input.left() >= 4 && points_.size() < kMaxPoints) {
    const unsigned where = input.byte();
    const unsigned how = input.byte();
    const unsigned range = input.byte();
    const unsigned height = input.byte();
    const std::size_t laser = where % 8 % lasers;
    const std::int64_t next = static_cast<std::int64_t>(column) + kColumnSteps[where / 8];
    column = static_cast<std::size_t>(std::clamp<std::int64_t>(next, 0, static_cast<std::int64_t>(max_columns) - 1));
    if (cells_[laser * stride_ + column] != kEmpty) continue;
    Point point{};
    const auto along = [unit](unsigned number) { return (static_cast<float>(number) - 128.0F) * unit / 2.0F; };
    if (how % 16 < kOffsets.size()) {
      const auto wide = static_cast<double>(unit);
      double rho = wide * (range < 128 ? range * 0.25 : std::exp2((range - 128) / 8.0));
      rho *= 1 + (static_cast<double>(how / 16) - 8) / 4096;
      const double turned = step * (static_cast<double>(column) + kOffsets[how % 16]);
      const double azimuth = start + (hints.clockwise ? -turned : turned);
      const double level = static_cast<double>(height % 32) - 16;
      const double up = height < 128 ? level * 0.25 * wide : rho * level / 16;
      point = {static_cast<float>(rho * std::cos(azimuth)) + hints.origin[0],
               static_cast<float>(rho * std::sin(azimuth)) + hints.origin[1], static_cast<float>(up) + hints.origin[2]};
    } else if (how % 16 == 12) {
      point = points_.empty() ? Point{unit, unit, 0} : points_[height / 8 % points_.size()];
      float Point::*const axis = std::array{&Point::x, &Point::y, &Point::z}[range % 3];
      point.*axis = nudged(point.*axis + (height % 2 == 0 ? unit : -unit), height / 2);
    } else if (how % 16 == 13) {
      point = {along(range), along(height), static_cast<float>(how / 16) * unit / 4.0F};
    } else if (how % 16 == 14) {
      point = points_.empty() ? Point{} : points_[range % points_.size()];
      point.z += static_cast<float>(height % 16) * unit / 4.0F;
    } else {
      const std::array<Point, 8> some{{{0, 0, 0},
                                       {kNan, 1, 1},
                                       {1, 1, kInfinity},
                                       {1, -kInfinity, 0},
                                       {-0.0F, 0, -0.0F},
                                       {3e38F, along(range), 3e38F},
                                       {1e-40F, 0, along(range)},
                                       {}}};
      point = some[height % 8];
      if (height % 8 == 7) point = {input.rawFloat(), input.rawFloat(), input.rawFloat()};
    }
    put(point, laser, column);
  }
}

void Shape::readRecording(Input& input, float unit, std::size_t lasers, std::size_t steps,
                          const lisco::SensorHints& hints) {
  enum class Layout { kOrganized, kFirings, kRings, kShuffled };
  constexpr std::array<Layout, 4> kLayouts{Layout::kOrganized, Layout::kFirings, Layout::kRings, Layout::kShuffled};
  constexpr std::array<std::size_t, 8> kSteps{0, 0, 1, 1, 2, 3, 17, 64};
  constexpr std::size_t kTurns = 3;
  constexpr std::size_t kWide = 512;
  struct Firing {
    std::size_t laser, column;
    Point point;
  };
  static std::vector<Firing> firings;
  firings.clear();
  const unsigned flags = input.byte();
  const Layout layout = kLayouts[flags % 4];
  const bool is_dual = (flags & 4U) != 0;
  const bool is_moving = (flags & 8U) != 0;
  const bool has_gaps = (flags & 16U) != 0;
  // A multiple of UTM coordinates: of four times these, floats are a unit or two apart.
  const double map = (flags & 32U) == 0 ? 0.0 : (flags & 64U) == 0 ? 1.0 : 4.0;
  const unsigned order = input.byte();
  const auto wide = static_cast<double>(unit);
  std::size_t firing = 0;
  while (input.left() >= 3 && firings.size() < kMaxPoints) {
    const unsigned where = input.byte();
    const unsigned range = input.byte();
    const unsigned how = input.byte();
    const std::size_t laser = where % 8 % lasers;
    firing += where / 64 == 3 ? steps : kSteps[where / 8 % 8];  // the same direction a turn later
    firing = std::min(firing, kTurns * steps - 1);
    double rho = wide * (range < 128 ? range * 0.25 : std::exp2((range - 128) / 8.0));
    rho *= 1 + (static_cast<double>(how / 16) - 8) / 4096;
    const double offset = (static_cast<double>(how % 4) - 1) * 0.25;
    const double turned = 2 * kPi * (static_cast<double>(firing) + offset) / static_cast<double>(steps);
    const double azimuth = hints.clockwise ? -turned : turned;
    const double slope = 0.25 - 0.0625 * static_cast<double>(laser);
    const double moved = is_moving ? wide * static_cast<double>(firing) / 64 : 0;
    firings.push_back(
        {laser,
         is_dual ? 2 * firing + how / 4 % 2 : firing,
         {static_cast<float>(rho * std::cos(azimuth) + moved + map * 5e5 * wide),
          static_cast<float>(rho * std::sin(azimuth) + map * 5.4e6 * wide), static_cast<float>(rho * slope)}});
  }
  if (layout == Layout::kOrganized) {
    resize(lasers, std::max(kTurns * steps * (is_dual ? 2 : 1), kMaxColumns));
    for (const Firing& one : firings) put(one.point, one.laser, one.column);
    return;
  }
  const auto before = [&](const Firing& a, const Firing& b) {
    const auto shuffled = [&](const Firing& one) { return (one.column * 8 + one.laser) * (2 * order + 1) % 257; };
    return layout == Layout::kFirings ? a.column < b.column
           : layout == Layout::kRings ? a.laser < b.laser
                                      : shuffled(a) < shuffled(b);
  };
  std::stable_sort(firings.begin(), firings.end(), before);
  resize(1, kMaxColumns);
  const std::size_t spacing = has_gaps ? kWide / kMaxPoints : 1;
  for (std::size_t i = 0; i < firings.size(); ++i) put(firings[i].point, 0, spacing * i);
}

void Shape::resize(std::size_t lasers, std::size_t columns) {
  cells_.assign(lasers * columns, kEmpty);
  points_.clear();
  places_.clear();
  lasers_ = lasers;
  columns_ = 1;
  stride_ = columns;
}

bool Shape::put(const Point& point, std::size_t laser, std::size_t column) {
  std::uint8_t& cell = cells_[laser * stride_ + column];
  if (cell != kEmpty) return false;
  cell = static_cast<std::uint8_t>(points_.size());
  points_.push_back(point);
  places_.push_back({laser, column});
  columns_ = std::max(columns_, column + 1);
  return true;
}

const std::vector<Point>& Shape::pointsIn(std::size_t first, std::size_t end) {
  some_ = points_;
  for (std::size_t i = 0; i < some_.size(); ++i)
    if (places_[i].column < first || places_[i].column >= end) some_[i] = {0, 0, 0};
  return some_;
}

EndlessStream endlessStreamFrom(Input& input) {
  EndlessStream stream;
  lisco::EndlessParameters& parameters = stream.parameters;
  constexpr std::array<double, 8> kStarts{0, -3, 1000.5, 0.125, 1e9, 3.4e10 + 0.125, 999999990000, -1e12};
  constexpr std::array<double, 8> kColumnsPerTurn{8, 12, 16, 20, 32, 32, 64, 128};
  constexpr std::array<double, 16> kSteps{0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 2, 3, 4, 16, 40, 200};
  // Distances from the sensor never equal the tolerance, where the reach of a return jumps.
  parameters.tolerance = 0.125F * static_cast<float>(1 + input.below(16));
  parameters.stagger = lisco::EndlessParameters::kMaxStagger * static_cast<double>(input.byte()) / 256;
  const unsigned flags = input.byte();
  parameters.clockwise = (flags & 1U) != 0;
  parameters.start_azimuth = (flags & 2U) != 0 ? 1.0 : 0.0;
  if ((flags & 4U) != 0) parameters.origin = {3.0F, -2.0F, 1.0F};
  parameters.block_columns = std::array<std::size_t, 4>{1, 2, 5, 16}[flags / 8 % 4];
  double position = kStarts[flags / 32 % 8];
  const double per_turn = input.oneOf(kColumnsPerTurn);
  std::uint32_t number = 0;
  constexpr std::size_t kMaxPoints = 64;
  while (input.left() >= 3 && number < kMaxPoints) {
    const unsigned where = input.byte();
    const unsigned range = input.byte();
    const unsigned how = input.byte();
    const double step = kSteps[where / 16] / per_turn;
    if (stream.columns.empty() || step > 0 || (where & 8U) != 0) {
      position += step;
      stream.columns.push_back({position, {}});
    }
    StreamColumn& column = stream.columns.back();
    while (column.cells.size() < (where & 3U)) column.cells.push_back(lisco::kNoReturn);
    const double rho = 0.03125 + 0.125 * static_cast<double>(range % 64);
    const double offset = how % 8 == 7 ? parameters.stagger + 0.05 + 0.1 * static_cast<double>(how / 8)
                                       : parameters.stagger * (static_cast<double>(how % 8) - 3) / 4;
    const double azimuth =
        parameters.start_azimuth + (parameters.clockwise ? -2 : 2) * kPi * (position - std::floor(position)) + offset;
    column.cells.push_back({static_cast<float>(static_cast<double>(parameters.origin[0]) + rho * std::cos(azimuth)),
                            static_cast<float>(static_cast<double>(parameters.origin[1]) + rho * std::sin(azimuth)),
                            0.125F * static_cast<float>(range / 64 * (how / 64)), number});
    ++number;
  }
  return stream;
}

}  // namespace lisco_test
