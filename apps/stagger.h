// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <vector>

#include "cloud_file.h"

namespace lisco_apps {

/// By how many columns each row of a rotating scan has to be moved right, so that what was seen in one direction stands
/// in one column although the lasers of a column look in different ones (by up to 12 degrees).
std::vector<int> staggerOf(const Cloud& cloud);

}  // namespace lisco_apps
