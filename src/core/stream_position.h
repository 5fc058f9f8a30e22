// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cmath>
#include <cstdint>

namespace lisco {

/// Positions of an endless stream in fixed point, so that rounding does not grow with the number of turns: a tick is
/// 2^-22 turn (1.5e-6 rad), and 1e12 turns fit. Columns are rounded down and reach ends up.
using Ticks = std::int64_t;

inline constexpr Ticks kTicksPerTurn = Ticks{1} << 22;
inline constexpr std::int64_t kPanesPerTurn = 8;  ///< panes are eighths of a turn
inline constexpr Ticks kTicksPerPane = kTicksPerTurn / kPanesPerTurn;

/// The tick that a position lies in. Exact: the product only changes the exponent.
/// \param position turns, at most 2^40 in magnitude
inline Ticks ticksOf(double position) {
  return static_cast<Ticks>(std::floor(position * static_cast<double>(kTicksPerTurn)));
}

/// Number of the eighth of a turn that a tick lies in, rounded down.
inline std::int64_t paneOf(Ticks ticks) {
  return (ticks - (ticks % kTicksPerPane + kTicksPerPane) % kTicksPerPane) / kTicksPerPane;
}

/// The eighth of its turn that a pane is, 0..kPanesPerTurn-1.
inline std::int64_t paneInTurn(std::int64_t pane) {
  return (pane % kPanesPerTurn + kPanesPerTurn) % kPanesPerTurn;
}

/// The position of a tick, turns; the next larger one that a double can represent.
inline double positionOf(Ticks ticks) {
  auto rounded = static_cast<double>(ticks);
  if (static_cast<Ticks>(rounded) < ticks) rounded = std::nextafter(rounded, INFINITY);
  return rounded / static_cast<double>(kTicksPerTurn);
}

}  // namespace lisco
