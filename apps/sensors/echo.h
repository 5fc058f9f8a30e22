// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "sensors/decoder.h"

namespace lisco_apps {

/// A return of a laser and firing, as measured.
struct Echo {
  std::uint32_t distance = 0;  ///< in the sensor's units, 0: none
  float intensity = 0;
  std::uint32_t strength = 0;  ///< decides which is the strongest
  std::size_t number = 0;      ///< in the order in which the sensor sends them
};

inline constexpr std::size_t kMaxEchoes = 3;

/// The returns of one laser and firing, in the order in which the sensor sends them.
class Echoes {
 public:
  void clear() { size_ = 0; }

  /// Adds a return or none; none for one at the distance of another before it: sensors repeat a single return.
  void add(const Echo& echo) {
    const auto end = echoes_.begin() + static_cast<std::ptrdiff_t>(size_);
    const bool is_copy =
        std::any_of(echoes_.begin(), end, [&](const Echo& before) { return before.distance == echo.distance; });
    echoes_[size_++] = is_copy ? Echo() : echo;
  }

  /// Leaves only the chosen one, of equal ones the first; or all.
  void choose(ReturnChoice choice) {
    if (size_ < 2 || choice == ReturnChoice::kBoth) return;
    for (std::size_t i = 1; i < size_; ++i) {
      if (echoes_[i].distance == 0) continue;
      const bool is_better = choice == ReturnChoice::kStrongest ? echoes_[i].strength > echoes_[0].strength
                                                                : echoes_[i].distance > echoes_[0].distance;
      if (is_better || echoes_[0].distance == 0) echoes_[0] = echoes_[i];
    }
    size_ = 1;
  }

  std::size_t size() const { return size_; }
  /// May be none.
  const Echo& operator[](std::size_t i) const { return echoes_[i]; }

 private:
  std::array<Echo, kMaxEchoes> echoes_;
  std::size_t size_ = 0;
};

}  // namespace lisco_apps
