// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

namespace lisco_apps {

inline constexpr double kPi = 3.14159265358979323846;

}  // namespace lisco_apps
