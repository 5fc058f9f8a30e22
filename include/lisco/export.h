// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

/// Exported by a shared library; all else in it is hidden. A static library exports nothing: a library that links it
/// does not offer it to others, who may use another version.
#if defined(LISCO_STATIC)
#define LISCO_EXPORT
#else
#define LISCO_EXPORT __attribute__((visibility("default")))
#endif
/// Not exported, though nested in a class that is.
#define LISCO_HIDDEN __attribute__((visibility("hidden")))
