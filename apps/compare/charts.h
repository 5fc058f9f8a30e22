// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "compare/comparison.h"

namespace lisco_apps {

/// The file names of the charts that drawCharts draws.
std::vector<std::string> chartsOf(const std::vector<std::string>& input_names, const CompareSettings& settings);

/// Draws time over tolerance for each scan; of several scans also its mean, and time over the number of returns for each
/// tolerance.
void drawCharts(const std::vector<InputResult>& inputs, const CompareSettings& settings,
                const std::filesystem::path& folder);

}  // namespace lisco_apps
