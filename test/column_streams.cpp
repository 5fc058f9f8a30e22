// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "column_streams.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>

#include "oracle.h"

namespace lisco_test {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Positions of columns, of which those without their own are counted from the last one given.
class PositionsByRate {
 public:
  explicit PositionsByRate(const lisco::EndlessParameters& parameters) : per_turn_(parameters.columns_per_turn) {}

  double give(double position) {
    has_begun_ = true;
    given_ = position;
    columns_ = 0;
    return position;
  }
  double next() {
    if (!has_begun_) return give(0.0);
    return given_ + ++columns_ / per_turn_;
  }

 private:
  double per_turn_;
  double given_ = 0;
  double columns_ = 0;  ///< since the last position given
  bool has_begun_ = false;
};

/// Polar coordinates of a return as seen from the sensor.
struct Polar {
  double rho, azimuth;
};

Polar polarOf(const lisco::EndlessParameters& parameters, const lisco::Return& cell) {
  const double east = static_cast<double>(cell.x) - static_cast<double>(parameters.origin[0]);
  const double north = static_cast<double>(cell.y) - static_cast<double>(parameters.origin[1]);
  return {std::hypot(east, north), std::atan2(north, east)};
}

double azimuthOf(const lisco::EndlessParameters& parameters, double position) {
  return parameters.start_azimuth + (parameters.clockwise ? -2 : 2) * kPi * (position - std::floor(position));
}

bool isReturnAt(const lisco::Return& cell) {
  return isValid({cell.x, cell.y, cell.z});
}

lisco::Return noReturn(Random& random) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const std::array<lisco::Return, 5> kinds{
      {{kNan, kNan, kNan, 0}, {0, 0, 0, 0}, {-0.0F, 0, -0.0F, 0}, {1, 2, kInfinity, 0}, {kNan, 1, 0, 0}}};
  return random.oneOf(kinds);
}

/// Adds returns that make a stream hard, in strengths that are chosen once.
class Spoiler {
 public:
  Spoiler(Random& random, ColumnStream& stream) : random_(random), stream_(stream) {
    emptied_ = random.chance(0.3) ? 0.3 * random.unit() : 0.0;
    lost_ = random.chance(0.3) ? 0.3 * random.unit() : 0.0;
    added_ = random.chance(0.7) ? random.magnitude(0.05, 1.5) : 0.0;
    for (double& weight : weights_) weight = random.chance(0.5) ? random.unit() : 0.0;
  }

  void spoil() {
    for (std::size_t column = 0; column < stream_.columns.size(); ++column) {
      std::vector<lisco::Return>& cells = stream_.columns[column].cells;
      if (random_.chance(emptied_)) cells.clear();
      for (lisco::Return& cell : cells)
        if (random_.chance(lost_)) cell = noReturn(random_);
      for (int more = 0; more < kMaxAdded && random_.chance(added_ / (1 + added_)); ++more)
        cells.insert(cells.begin() + static_cast<std::ptrdiff_t>(random_.below(cells.size() + 1)), another(column));
    }
  }

 private:
  static constexpr int kMaxAdded = 40;

  lisco::Return another(std::size_t column) {
    double sum = 0;
    for (const double weight : weights_) sum += weight;
    double left = random_.between(0, sum);
    std::size_t kind = 0;
    while (kind + 1 < weights_.size() && left >= weights_[kind]) left -= weights_[kind++];
    const auto eps = static_cast<double>(stream_.parameters.tolerance);
    const std::array<double, 4> closeness{1e-7, 1e-7, 1e-6, 1e-3};
    switch (kind) {
      case 0:  // a repetition
        return earlier(column);
      case 1: {  // a neighbour, or nearly
        lisco::Return cell = earlier(column);
        std::array<double, 3> way{random_.between(-1, 1), random_.between(-1, 1), random_.between(-1, 1)};
        if (random_.chance(0.5)) way = {random_.between(-0.1, 0.1), 0, 1};
        const double length = std::sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
        if (!(length > 0)) return cell;
        const double factor = eps * (1 + random_.oneOf(closeness) * random_.between(-1, 1)) / length;
        cell.x += static_cast<float>(way[0] * factor);
        cell.y += static_cast<float>(way[1] * factor);
        cell.z += static_cast<float>(way[2] * factor);
        return cell;
      }
      case 2:
        return seenBy(column,
                      random_.chance(0.5) ? random_.between(0, 1.2 * eps) : random_.magnitude(kSmallestRange, eps));
      case 3:
        return seenBy(column, random_.chance(0.5) ? random_.magnitude(1, 100) : random_.magnitude(100, kLargestRange));
      default:
        return noReturn(random_);
    }
  }

  /// A cell of this column or one of those before it.
  lisco::Return earlier(std::size_t column) {
    const std::size_t back = random_.chance(0.5) ? random_.below(3) : random_.below(stream_.columns.size());
    const std::vector<lisco::Return>& cells = stream_.columns[column - std::min(back, column)].cells;
    return cells.empty() ? noReturn(random_) : random_.oneOf(cells);
  }

  lisco::Return seenBy(std::size_t column, double range) {
    const lisco::EndlessParameters& parameters = stream_.parameters;
    const double azimuth =
        azimuthOf(parameters, stream_.columns[column].position) + 0.99 * parameters.stagger * random_.between(-1, 1);
    const double height = random_.chance(0.5) ? 0.0 : range * random_.between(-0.5, 0.5);
    return {static_cast<float>(static_cast<double>(parameters.origin[0]) + range * std::cos(azimuth)),
            static_cast<float>(static_cast<double>(parameters.origin[1]) + range * std::sin(azimuth)),
            static_cast<float>(height), 0};
  }

  Random& random_;
  ColumnStream& stream_;
  double emptied_ = 0, lost_ = 0, added_ = 0;
  std::array<double, 5> weights_{};
};

void turnColumn(const lisco::EndlessParameters& parameters, StreamColumn& column, double position) {
  const double angle = azimuthOf(parameters, position) - azimuthOf(parameters, column.position);
  column.position = position;
  for (lisco::Return& cell : column.cells) {
    if (!isReturnAt(cell)) continue;
    const Polar polar = polarOf(parameters, cell);
    cell.x =
        static_cast<float>(static_cast<double>(parameters.origin[0]) + polar.rho * std::cos(polar.azimuth + angle));
    cell.y =
        static_cast<float>(static_cast<double>(parameters.origin[1]) + polar.rho * std::sin(polar.azimuth + angle));
  }
}

/// Starts the stream at position 0 and, if chosen, continues it by the number of columns of a turn.
void goByRate(Random& random, ColumnStream& stream) {
  lisco::EndlessParameters& parameters = stream.parameters;
  std::vector<StreamColumn>& columns = stream.columns;
  const double first = columns.front().position;
  const double turns = columns.back().position - first;
  parameters.start_azimuth = azimuthOf(parameters, first);
  parameters.columns_per_turn = turns > 0.1 ? static_cast<double>(columns.size()) / turns : 50.0;
  const double by_rate = random.chance(0.5) ? 1.0 : random.unit();
  for (StreamColumn& column : columns) column.position -= first;
  PositionsByRate positions(parameters);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    stream.is_by_rate[i] = random.chance(by_rate);
    const double before = i > 0 ? columns[i - 1].position : 0.0;
    if (stream.is_by_rate[i])
      turnColumn(parameters, columns[i], positions.next());
    else
      turnColumn(parameters, columns[i], positions.give(std::max(before, columns[i].position)));
  }
}

/// Empties the cells where the engine and the definition may rightly differ: the engine takes the stagger for up to
/// 0.002 radians larger, and the reach end jumps where the distance is the tolerance.
void emptyUndecidedCells(ColumnStream& stream) {
  constexpr double kMaxExtraStagger = 0.0025;  // radians
  constexpr double kRoundingOfStagger = 1e-6;
  constexpr double kRoundingOfRange = 1e-5;  // relative
  const lisco::EndlessParameters& parameters = stream.parameters;
  const auto eps = static_cast<double>(parameters.tolerance);
  for (StreamColumn& column : stream.columns)
    for (lisco::Return& cell : column.cells) {
      if (!isReturnAt(cell)) continue;
      const Polar polar = polarOf(parameters, cell);
      const double off = std::fabs(std::remainder(polar.azimuth - azimuthOf(parameters, column.position), 2 * kPi)) -
                         parameters.stagger;
      if ((off > -kRoundingOfStagger && off < kMaxExtraStagger) || std::fabs(polar.rho - eps) < kRoundingOfRange * eps)
        cell.x = cell.y = cell.z = std::numeric_limits<float>::quiet_NaN();
    }
}

/// The first column at or beyond a position.
std::size_t columnAt(const EndlessStream& stream, double position) {
  std::size_t column = 0;
  while (column < stream.columns.size() && stream.columns[column].position < position) ++column;
  return column;
}

}  // namespace

std::size_t ColumnStream::cellCount() const {
  std::size_t count = 0;
  for (const StreamColumn& column : columns) count += column.cells.size();
  return count;
}

ColumnStream randomColumnStream(Random& random) {
  ColumnStream stream;
  static_cast<EndlessStream&>(stream) = randomEndlessStream(random);
  if (stream.columns.empty()) stream.columns.push_back({0.0, {}});
  stream.is_by_rate.assign(stream.columns.size(), false);
  if (random.chance(0.3)) {
    goByRate(random, stream);
  } else if (random.chance(0.3)) {
    const double turns = std::floor(random.magnitude(1, kLargestPosition - 2000));
    for (StreamColumn& column : stream.columns) column.position += turns;
  }
  Spoiler(random, stream).spoil();
  emptyUndecidedCells(stream);
  std::uint32_t number = 0;
  for (StreamColumn& column : stream.columns)
    for (lisco::Return& cell : column.cells) cell.source_index = number++;
  return stream;
}

ColumnStream partOf(const ColumnStream& stream, std::size_t first, std::size_t end, double turns_earlier) {
  ColumnStream part;
  part.parameters = stream.parameters;
  part.columns.assign(stream.columns.begin() + static_cast<std::ptrdiff_t>(first),
                      stream.columns.begin() + static_cast<std::ptrdiff_t>(end));
  part.is_by_rate.assign(stream.is_by_rate.begin() + static_cast<std::ptrdiff_t>(first),
                         stream.is_by_rate.begin() + static_cast<std::ptrdiff_t>(end));
  PositionsByRate positions(part.parameters);
  for (std::size_t i = 0; i < part.columns.size(); ++i) {
    double& position = part.columns[i].position;
    position -= turns_earlier;
    if (i == 0 && position != 0) part.is_by_rate[0] = false;
    if (i > 0 && part.is_by_rate[i])
      position = positions.next();
    else
      position = positions.give(i > 0 ? std::max(position, part.columns[i - 1].position) : position);
  }
  return part;
}

std::string wrongDeliveries(const EndlessStream& stream, const std::vector<Delivery>& truth,
                            std::vector<Delivery> actual, const std::vector<std::size_t>& updates, bool finished) {
  constexpr double kEarly = 1e-6;  // turns: rounding
  constexpr double kLate = 1e-3;   // turns: the most by which the engine's reach ends are later
  const std::size_t columns = stream.columns.size();
  std::sort(actual.begin(), actual.end());
  std::ostringstream wrong;
  auto found = actual.begin();
  for (const Delivery& right : truth) {
    if (found != actual.end() && *found < right) break;  // none is equal
    std::size_t last = columnAt(stream, right.reach_end + kLate) + stream.parameters.block_columns - 1;
    for (const std::size_t update : updates)
      if (stream.columns[update].position >= right.reach_end + kLate) last = std::min(last, update);
    if (right.cut) last = right.column;
    if (found == actual.end() || right < *found) {
      if (finished || last < columns) {
        wrong << "not delivered: " << right;
        return wrong.str();
      }
      continue;
    }
    std::size_t first = right.cut ? right.column : columnAt(stream, right.reach_end - kEarly);
    first = std::min(first, columns);
    // With its reach end rounded up, the cluster is still open when the eighth that cuts it begins.
    const bool may_be_cut = right.cut || (right.column < columns && found->column == right.column &&
                                          stream.columns[right.column].position < right.reach_end + kLate);
    if ((found->cut && !may_be_cut) || (right.cut && !found->cut) || found->continued != right.continued ||
        found->first_position != right.first_position || found->last_position != right.last_position ||
        found->column < first || found->column > std::min(last, columns)) {
      wrong << "expected: " << right << " between columns " << first << " and " << last << "; delivered: " << *found;
      return wrong.str();
    }
    ++found;
  }
  if (found != actual.end()) wrong << "delivered, but not a cluster: " << *found;
  return wrong.str();
}

std::vector<Point> pointsOf(const EndlessStream& stream, std::size_t first, std::size_t end) {
  std::vector<Point> points;
  for (std::size_t column = 0; column < stream.columns.size(); ++column)
    for (const lisco::Return& cell : stream.columns[column].cells)
      points.push_back(column >= first && column < end ? Point{cell.x, cell.y, cell.z} : Point{0, 0, 0});
  return points;
}

}  // namespace lisco_test
