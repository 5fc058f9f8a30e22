// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <string>
#include <vector>

#include "compare/comparison.h"
#include "io/text.h"

namespace lisco_apps {

/// Version, compiler, processor and settings.
/// \param threads the highest number that is used
std::string describeRun(const CompareSettings& settings, unsigned threads = 1);

/// The printed tables: the heading of a scan, the baselines at one tolerance, and the summary.
std::string headingOf(const InputResult& input, const CompareSettings& settings);
std::string tableOf(const CaseResult& result);
/// Empty if there is only one case.
std::string summaryOf(const std::vector<InputResult>& inputs, const CompareSettings& settings);

/// Signatures of the CSV and JSON files, see writeOwnFile ().
inline constexpr const char* kCsvSignature = "input,rows,columns,returns,ground_z,tolerance";
inline constexpr const char* kJsonSignature = "\"program\": \"lisco_compare\"";

/// One row per scan, tolerance and baseline.
std::string csvOf(const std::vector<InputResult>& inputs, const CompareSettings& settings);
/// All results, with the times of every run.
/// \param failures inputs that could not be read, and why
std::string jsonTextOf(const std::vector<InputResult>& inputs, const CompareSettings& settings,
                       const std::vector<std::string>& failures);

/// The file names of the charts that drawCharts draws.
std::vector<std::string> chartsOf(const std::vector<std::string>& input_names, const CompareSettings& settings);

/// Draws time over tolerance for each scan; of several scans also its mean, and time over the number of returns for
/// each tolerance.
void drawCharts(const std::vector<InputResult>& inputs, const CompareSettings& settings, const fs::path& folder);

}  // namespace lisco_apps
