// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include "lisco/export.h"

#include <string>
#include <vector>

namespace lisco {

/// The vector instructions in use, as Highway names them: "AVX3" is AVX-512. Chosen when the program runs; every
/// level gives the same clusters.
LISCO_EXPORT std::string simdLevel();

/// The levels that this processor has, the best first.
LISCO_EXPORT std::vector<std::string> simdLevels();

/// Uses one of simdLevels () from now on, or the best again if the name is empty. For tests and benchmarks: not
/// while another thread clusters. \return false if there is no such level
LISCO_EXPORT bool useSimdLevel(const std::string& name);

}  // namespace lisco
