// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

// Included first by the public headers: an older standard is reported once, instead of at every use of the newer one.
#if __cplusplus < 201703L
#error "Lisco needs C++17: compile with -std=c++17 or newer (CMake: set (CMAKE_CXX_STANDARD 17))"
#include <lisco/needs_cxx17>  // does not exist, which ends the compilation here
#endif

/// Exported by a shared library; all else in it is hidden. A static library exports nothing: a library that links it
/// does not offer it to others, who may use another version.
#if defined(LISCO_STATIC)
#define LISCO_EXPORT
#define LISCO_HIDDEN
#else
#define LISCO_EXPORT __attribute__((visibility("default")))
/// Not exported, though nested in a class that is.
#define LISCO_HIDDEN __attribute__((visibility("hidden")))
#endif
