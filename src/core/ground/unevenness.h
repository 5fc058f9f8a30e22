// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <cstdint>

namespace lisco::ground {

/// How uneven the ground is, from the changes of its slope along the columns, metres per metre: 0.02 in the mean on
/// streets, 0.04 and more on fields and hills.
class Unevenness {
 public:
  static constexpr float kUnit = 65536.0F;  ///< of the sums of changes: integers, so that their order does not matter

  /// \param changes sum of the changes of slope that a block shows, in 1 / kUnit
  /// \param count of these changes; a block without any has no effect
  void add(std::int32_t changes, std::int32_t count) {
    if (count == 0) return;
    sum_ = kKept * sum_ + static_cast<float>(changes) / kUnit;
    count_ = kKept * count_ + static_cast<float>(count);
  }
  /// 0 on streets to 1 on fields.
  float value() const { return std::clamp((sum_ / count_ - kEven) / (kUneven - kEven), 0.0F, 1.0F); }

 private:
  // Least loss of objects and of ground in the tables of benchmarks/suite.sh ground ground_real.
  static constexpr float kEven = 0.038F, kUneven = 0.046F;  // metres per metre, mean changes of slope
  static constexpr float kKept = 63.0F / 64.0F;             // of the blocks before, by each
  static constexpr float kEvenAtFirst = 16.0F;              // changes of 0 before the first block

  float sum_ = 0.0F, count_ = kEvenAtFirst;
};

}  // namespace lisco::ground
