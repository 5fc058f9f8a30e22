// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/ground/block.h"
#include "core/ground/direction.h"

namespace lisco::ground {

/// A line that a column's ground may follow, in the sensor's frame.
struct ColumnLine {
  float height;  ///< beneath the sensor, metres
  float slope;   ///< metres per metre
  float weight;
  float rho;  ///< where it begins, metres
  Direction direction;
};

inline constexpr float kTable = 0.5F;  ///< metres; most height of the sensor above a table, or a low floor

/// Weight of a line's height beneath the sensor, which is less sure where it begins far away.
inline float sureWeight(const ColumnLine& line) {
  constexpr float kSureReach = 9.0F;  // metres
  const float reach = line.rho / kSureReach, squared = reach * reach;
  return line.weight * std::min(1.0F, 2.0F / (1.0F + squared * squared));
}

inline constexpr std::size_t kMaxLines = 64;

/// A height that lines agree with: the mean of those near it, and their weight.
struct AgreedHeight {
  float height, weight;
};
/// The lowest height whose support, the weight of the lines within the window, is at least `enough` of the greatest
/// support. Without lines, of no weight.
/// \param size at most kMaxLines
/// \param window metres, within which heights agree
AgreedHeight lowestAgreed(const ColumnLine* lines, std::size_t size, float window, float enough);

/// Finds the line of a column's ground: the lowest that enough lines through its lowest returns agree with.
class ColumnLineFinder {
 public:
  struct Setting {
    float highest;                ///< of the lines beneath the sensor, metres
    float max_slope;              ///< metres per metre
    std::array<float, 3> origin;  ///< of the sensor, metres
  };
  /// A column's near returns, by laser.
  struct Returns {
    std::vector<float> rho, height;           ///< metres
    std::vector<float> x, y;                  ///< metres from the sensor; at last, the directions towards the returns
    std::vector<std::uint64_t> lowest;        ///< as in Cell
    std::vector<std::uint32_t> bins, levels;  ///< see distanceBin, levelOf
  };

  /// Allocates only if there are more lasers than ever before.
  void begin(const Setting& setting, std::size_t lasers);

  /// \param columns those that the block was measured from, `first` its first one
  /// \param line receives the line, if the column shows ground clearly
  /// \return whether it does
  bool find(const Block& block, const Columns& columns, std::size_t first, std::size_t column, ColumnLine& line);

 private:
  Setting setting_{};
  Returns returns_;
};

}  // namespace lisco::ground
