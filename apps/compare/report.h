// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <string>
#include <vector>

#include "compare/comparison.h"

namespace lisco_apps {

/// Version, compiler, processor and settings: what a figure means nothing without.
/// \param threads the most that anything of it uses
std::string describeRun(const CompareSettings& settings, unsigned threads = 1);

/// The tables for people: one scan's heading, one tolerance's rivals, and what all of it comes to.
std::string headingOf(const InputResult& input, const CompareSettings& settings);
std::string tableOf(const CaseResult& result);
/// Empty if there is but one case.
std::string summaryOf(const std::vector<InputResult>& inputs, const CompareSettings& settings);

/// What the files for machines have near their beginning, by which they are known.
inline constexpr const char* kCsvSignature = "input,rows,columns,returns,ground_z,tolerance";
inline constexpr const char* kJsonSignature = "\"program\": \"lisco_compare\"";

/// One row per scan, tolerance and rival.
std::string csvOf(const std::vector<InputResult>& inputs, const CompareSettings& settings);
/// All of it, times of every run included.
/// \param failures inputs that could not be read, and why
std::string jsonOf(const std::vector<InputResult>& inputs, const CompareSettings& settings,
                   const std::vector<std::string>& failures);

}  // namespace lisco_apps
