// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <vector>

#include "io/cloud_file.h"

namespace lisco_apps {

/// Stagger of a rotating scan: the number of columns by which each row has to be moved right so that all returns of a
/// column lie at one azimuth. Measured on the returns; the lasers of a column may differ by up to 12 degrees.
std::vector<int> rowShiftsOf(const Cloud& cloud);

}  // namespace lisco_apps
