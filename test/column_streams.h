// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "endless_streams.h"
#include "oracle.h"
#include "random.h"

namespace lisco_test {

/// Ranges (metres) and positions (turns) of the streams: all positions that the engine takes, and ranges whose squares
/// overflow and underflow a float.
constexpr double kSmallestRange = 1e-30;
constexpr double kLargestRange = 1e30;
constexpr double kLargestPosition = 1e12;

/// A stream whose cells are numbered in the order of their columns.
struct ColumnStream : EndlessStream {
  /// By column: its position is 1 / columns_per_turn after the one before, or 0 if it is the first one.
  std::vector<bool> is_by_rate;

  std::size_t cellCount() const;
};

/// A random endless stream with, in any strength: columns of any number of cells, or none; cells that are NaN, infinite
/// or (0, 0, 0); returns on or beside the sensor's axis, and as far as squares reach; points that come twice; partners
/// of earlier points at about eps, or at eps (1 +- 1e-7); positions up to a billion, or by the number of columns of a
/// turn. Rounding decides neither whether a return is an outlier nor its reach end.
ColumnStream randomColumnStream(Random& random);

/// The columns first..end-1 as a stream whose cells keep their numbers, begun some turns earlier.
ColumnStream partOf(const ColumnStream& stream, std::size_t first, std::size_t end, double turns_earlier = 0);

/// Describes the first delivery that doc/streaming.md does not allow; empty if there is none.
/// \param truth the defined deliveries of the whole stream
/// \param updates numbers of the columns after which update () was called, ascending
/// \param finished whether finish () was called; if not, clusters that may still grow are not delivered
///
/// Reach ends of the actual deliveries are ignored: the PCL face does not give them.
std::string wrongDeliveries(const EndlessStream& stream, const std::vector<Delivery>& truth,
                            std::vector<Delivery> actual, const std::vector<std::size_t>& updates, bool finished);

/// Points by number of the cell, as the oracle takes them; cells of other columns than first..end-1 are no returns.
std::vector<Point> pointsOf(const EndlessStream& stream, std::size_t first, std::size_t end);

}  // namespace lisco_test
