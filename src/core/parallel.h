// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <type_traits>

namespace lisco {

/// Bytes between what different threads write, so that they exchange no cache lines: two, as processors fetch pairs.
constexpr std::size_t kSeparate = 128;

/// One thread for each core.
std::size_t allThreads();

/// Calls work (context, i) for each i below `parts`, each in a thread of its own, and returns when all have. If there
/// are fewer cores, or fewer threads start, one calls several i in ascending order, so that i = 0 waits for no other:
/// FarTrial relies on it.
void inParallel(std::size_t parts, void (*work)(void* context, std::size_t part), void* context);

template <typename Work>
void inParallel(std::size_t parts, Work&& work) {
  inParallel(
      parts, [](void* context, std::size_t part) { (*static_cast<std::remove_reference_t<Work>*>(context))(part); },
      &work);
}

}  // namespace lisco
