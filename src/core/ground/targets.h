// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// For files whose vectors have the eight columns of a block, to be included before Highway: they are compiled without
// AVX-512, whose masks take longer than AVX2's (the VLS-128's ground takes 10 % longer, benchmarks/ground_real.cpp).
#pragma once

#undef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (LISCO_DISABLED_TARGETS | HWY_AVX3)
