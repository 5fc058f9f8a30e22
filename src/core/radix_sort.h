// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>

namespace lisco {

/// Sorts items by some of their bits; those of the same bits keep their order.
/// \param scratch memory for as many items
/// \param count number of items, below 2^32
/// \param low_bit the lowest of the bits that are compared
/// \param bits how many they are, at most 64 - low_bit
void radixSort(std::uint64_t* items, std::uint64_t* scratch, std::size_t count, unsigned low_bit, unsigned bits);

}  // namespace lisco
