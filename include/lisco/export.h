// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

/// What a shared library gives its users; all else in it is hidden. A static library gives nothing on: what links
/// it shall not offer it to others, perhaps in another version.
#if defined(LISCO_STATIC)
#define LISCO_EXPORT
#else
#define LISCO_EXPORT __attribute__((visibility("default")))
#endif
