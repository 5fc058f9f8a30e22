// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

// Included first by the public headers: an older standard is reported once, instead of at every use of the newer one.
#if __cplusplus < 201703L
#error "Lisco needs C++17: compile with -std=c++17 or newer (CMake: set (CMAKE_CXX_STANDARD 17))"
#include <lisco/needs_cxx17>  // does not exist, which ends the compilation here
#endif
