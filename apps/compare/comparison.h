// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "compare/difference.h"
#include "compare/rivals.h"
#include "compare/timing.h"
#include "io/cloud_file.h"

namespace lisco_apps {

/// What is to be compared.
struct CompareSettings {
  std::vector<Rival> rivals;            ///< in the order of the tables
  std::vector<std::string> must_agree;  ///< keys of those whose clusters have to be the reference's
  std::vector<double> tolerances;       ///< metres
  unsigned min_size = 10;
  std::size_t runs = 20;    ///< of each rival, 0: only compare the clusters
  double max_seconds = 10;  ///< a rival whose runs take longer gets fewer (but 3)
  bool unorganized = false;

  bool mustAgree(const Rival& rival) const;
};

/// What one rival did with one problem.
struct RivalResult {
  const Rival* rival = nullptr;
  std::string failure;  ///< why it could not do it; empty if it could
  std::size_t clusters = 0;
  Difference difference;
  std::optional<Times> times;  ///< none if it was not timed
};

/// One scan at one tolerance.
struct CaseResult {
  double tolerance = 0;
  std::size_t clusters = 0;            ///< of the reference
  std::optional<ObjectScore> objects;  ///< how these clusters cover the true objects, if they are known
  std::vector<RivalResult> rivals;

  const RivalResult* find(const std::string& key) const;
  /// How many times as fast as the reference a rival is (medians), if both were timed.
  std::optional<double> ratio(const RivalResult& result) const;
  /// The same of the cold runs.
  std::optional<double> coldRatio(const RivalResult& result) const;
};

/// One scan.
struct InputResult {
  std::string name, file;
  std::size_t rows = 0, columns = 0;
  std::size_t returns = 0;  ///< that were clustered
  float ground_z = -std::numeric_limits<float>::infinity();
  std::vector<CaseResult> cases;
};

/// A scan as the rivals get it.
struct ComparedScan {
  RivalCloud::Ptr cloud;                 ///< the ground, below ground_z, replaced by NaN
  pcl::IndicesPtr returns;               ///< what is left
  std::vector<std::uint32_t> object_of;  ///< true object per point, empty if unknown
};

/// \param unorganized whether to keep only the returns, in the file's order
/// \throws std::runtime_error if there are no returns
ComparedScan prepareScan(const Cloud& cloud, std::vector<std::uint32_t> object_of, float ground_z, bool unorganized);

/// Runs all rivals on one scan at one tolerance: first compares their clusters with those of PCL with KdTree (false),
/// then times them in turn, but for those that must agree and do not.
/// \param progress called with what is being done and the share of it that is done
CaseResult compareAt(const ComparedScan& scan, double tolerance, const CompareSettings& settings,
                     const std::function<void(const std::string& what, double share)>& progress);

}  // namespace lisco_apps
