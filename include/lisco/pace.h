// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <cstddef>

namespace lisco {

/// How much work each column is to do, so that all do about as much, though some parts of a scene take several times what
/// others do. Work comes as parts, of which nobody knows beforehand what they take: what is left, if it takes what
/// parts usually do, is to be done in so many columns.
class Pace {
 public:
  /// Starts a rotation. What parts took in those before counts less and less.
  void begin() {
    parts_ = 1 + parts_ / 2;
    work_ = kFirstGuess + work_ / 2;
    per_column_ = credit_ = 0;
  }
  /// So many parts are left from now on.
  void plan(std::size_t parts) {
    per_column_ = static_cast<double>(parts) * (work_ / parts_) / kSpreadOver;
    credit_ = std::min(credit_, 0.0);
  }
  void addColumns(std::size_t columns) { credit_ += per_column_ * static_cast<double>(columns); }
  /// Whether one more part is to be done now.
  bool isBehind() const { return credit_ > 0; }
  /// A part took so much work, in any unit.
  void spend(std::size_t work) {
    credit_ -= static_cast<double>(work);
    work_ += static_cast<double>(work);
    ++parts_;
  }

 private:
  static constexpr double kSpreadOver = 192;  // columns; with more, it is more even, but more is left at the end
  static constexpr double kFirstGuess = 64;
  double parts_ = 0;
  double work_ = 0;  ///< that those parts took
  double per_column_ = 0;
  double credit_ = 0;
};

}  // namespace lisco
