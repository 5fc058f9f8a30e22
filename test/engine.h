// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <string>
#include <vector>

#include "lisco/column_clusterer.h"
#include "oracle.h"
#include "scans.h"

namespace lisco_test {

/// One way of running the engine; none may change the result.
struct Setting {
  std::string name;
  lisco::Parameters parameters;  ///< without the tolerance
};

/// Both masks, blocks of 1, 3 and 16 columns, patches that close early and late, the finest and the coarsest
/// hints, a sensor elsewhere, and a table of cells that is far too small.
const std::vector<Setting>& allSettings();

/// The clusters of all columns added so far, in order. Calls update().
Clustering clustersOf(lisco::ColumnClusterer& clusterer);

/// Clusters the scan with one setting.
Clustering cluster(lisco::ColumnClusterer& clusterer, const Scan& scan, float tolerance, const Setting& setting);

/// Holds every setting's outcome against the oracle's and against the verifier.
/// \return whether all were right; otherwise test failures have been added
bool expectExact(lisco::ColumnClusterer& clusterer, const Scan& scan, float tolerance);

}  // namespace lisco_test
