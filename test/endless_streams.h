// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <optional>
#include <vector>

#include "lisco/endless_clusterer.h"
#include "random.h"

namespace lisco_test {

/// A column of an endless stream.
struct StreamColumn {
  double position;
  std::vector<lisco::Return> cells;
};

struct EndlessStream {
  lisco::EndlessParameters parameters;
  std::vector<StreamColumn> columns;
};

/// A sensor among walls, pillars and moving objects, some of them nearer than the tolerance, for up to four turns.
/// \param first_position of the stream; default: a small one
/// \param parameters of the stream; nullptr: random ones
EndlessStream randomEndlessStream(Random& random, std::optional<double> first_position = std::nullopt,
                                  const lisco::EndlessParameters* parameters = nullptr);

/// Pairs of returns of which the second comes as late as a neighbour of the first can.
EndlessStream latestNeighbours(Random& random, double first_position);

/// Multiplies all coordinates.
void scale(EndlessStream& stream, double factor);

/// A delivered cluster, or an expected one.
struct Delivery {
  std::vector<std::uint32_t> members;  ///< source indices, ascending
  bool cut, continued;
  double first_position, last_position, reach_end;
  std::size_t column;  ///< that delivered it; the number of columns if finish () did

  bool operator<(const Delivery& other) const { return members < other.members; }
};
std::ostream& operator<<(std::ostream& out, const Delivery& delivery);

/// The delivery of a cluster at a column.
Delivery deliveryOf(const lisco::EndlessCluster& cluster, std::size_t column);

/// The deliveries that doc/streaming.md defines, return by return.
struct EndlessTruth {
  std::vector<Delivery> deliveries;  ///< ordered by their members
  std::size_t outliers = 0;
};
EndlessTruth endlessTruth(const EndlessStream& stream);

/// The engine's deliveries, ordered by their members.
std::vector<Delivery> deliveriesOf(lisco::EndlessClusterer& clusterer, const EndlessStream& stream);

/// Fails the test where the engine's deliveries differ from the expected ones, or came too late.
void expectSame(const EndlessStream& stream, const std::vector<Delivery>& expected,
                const std::vector<Delivery>& actual);

}  // namespace lisco_test
