// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "compare/baselines.h"
#include "compare/difference.h"
#include "compare/timing.h"
#include "io/cloud_file.h"
#include "io/scan_options.h"

namespace lisco_apps {

/// Settings of a comparison.
struct CompareSettings {
  std::vector<Baseline> baselines;      ///< in the order of the tables
  std::vector<std::string> must_agree;  ///< keys of those that must find the reference's clusters
  std::vector<double> tolerances;       ///< metres
  unsigned min_size = 10;
  std::size_t runs = 20;    ///< of each baseline, 0: compare the clusters only
  double max_seconds = 10;  ///< a baseline whose runs would take longer gets fewer, at least 3
  bool unorganized = false;
  bool locate = true;  ///< differences; false: only how much differs

  bool mustAgree(const Baseline& baseline) const;
};

/// The result of one baseline on one problem.
struct BaselineResult {
  const Baseline* baseline = nullptr;
  std::string failure;  ///< why it has no clusters; empty on success
  std::size_t clusters = 0;
  Difference difference;
  std::optional<Times> times;  ///< none if not timed
};

/// One scan at one tolerance.
struct CaseResult {
  double tolerance = 0;
  std::size_t clusters = 0;            ///< of the reference
  std::optional<ObjectScore> objects;  ///< their score against the true objects, if known
  std::vector<BaselineResult> baselines;

  const BaselineResult* find(const std::string& key) const;
  /// Speed-up over the reference (of medians), if both were timed.
  std::optional<double> ratio(const BaselineResult& result) const;
  /// Speed-up of the cold runs.
  std::optional<double> coldRatio(const BaselineResult& result) const;
};

/// One scan.
struct InputResult {
  std::string name, file;
  std::size_t rows = 0, columns = 0;
  std::size_t returns = 0;   ///< clustered
  GroundChoice ground;       ///< as asked for
  std::size_t left_out = 0;  ///< returns, as ground
  std::vector<CaseResult> cases;
};

/// A scan as prepared for the baselines.
struct ComparedScan {
  ComparedCloud::Ptr cloud;              ///< NaN at returns that are left out
  pcl::IndicesPtr returns;               ///< the rest
  std::vector<std::uint32_t> object_of;  ///< true object per point, empty if unknown
};

/// \param clustered the returns to cluster, in the cloud's order
/// \param unorganized whether to keep the returns only, in the order of the file
/// \throws std::runtime_error if there are no returns
ComparedScan prepareScan(const Cloud& cloud, std::vector<std::uint32_t> object_of, const pcl::Indices& clustered,
                         bool unorganized);

/// Runs all baselines on one scan at one tolerance: compares their clusters with the reference's, then times them in
/// turn. Baselines that must agree and do not are not timed. If one run is wanted and it is long (kMaxShort), the run
/// whose clusters are compared is the one.
/// \param progress called with the current step and the share of it that is done
/// \param report called with the clusters of each baseline
CaseResult compareAt(
    const ComparedScan& scan, double tolerance, const CompareSettings& settings,
    const std::function<void(const std::string& what, double share)>& progress,
    const std::function<void(const Baseline&, const Clusters&)>& report = [](const Baseline&, const Clusters&) {});

}  // namespace lisco_apps
