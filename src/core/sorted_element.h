// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <cstddef>

namespace lisco {

/// The element that would be at a place if the values were sorted. Reorders the values. At size / 2 it is the median;
/// of an even number of values, the upper one.
/// \param place below the number of values
template <typename Values>
auto sortedElement(Values& values, std::size_t place) {
  const auto element = values.begin() + static_cast<std::ptrdiff_t>(place);
  std::nth_element(values.begin(), element, values.end());
  return *element;
}

}  // namespace lisco
