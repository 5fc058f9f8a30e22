// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lisco/column_clusterer.h"
#include "lisco/window_clusterer.h"
#include "oracle.h"
#include "random.h"
#include "scans.h"

namespace lisco_test {

/// One way of running the engine; none may change the result.
struct Setting {
  std::string name;
  lisco::Parameters parameters;  ///< without the tolerance
};

/// Blocks of 1, 3, 16 and 64 columns; no strip, and strips of few and of many places; a sensor elsewhere; some
/// threads (of which small scans need only one).
const std::vector<Setting>& allSettings();

/// A few of these, which are tried with every level of vector instructions.
const std::vector<Setting>& settingsForEachLevel();

/// So many, or more for a longer hunt: LISCO_TEST_EFFORT=n in the environment tries n times as many.
std::uint64_t timesEffort(std::uint64_t count);

lisco::SensorHints hintsFor(int steps, float elevation_step, bool clockwise = false);

/// Adds the scan's columns in portions, with a look at the subclusters now and then.
void feed(lisco::ColumnClusterer& clusterer, Random& random, const Scan& scan);

/// The levels of vector instructions.
const std::vector<std::string>& levels();

/// One of the levels, as long as this lives; then the best again.
class SimdLevel {
 public:
  explicit SimdLevel(const std::string& name);
  ~SimdLevel();
  SimdLevel(const SimdLevel&) = delete;
  SimdLevel& operator=(const SimdLevel&) = delete;
};

/// The clusters of all columns added so far, in order. Calls update().
Clustering clustersOf(lisco::ColumnClusterer& clusterer);

/// Those of the last window, in order.
Clustering clustersOf(lisco::WindowClusterer& clusterer);

/// Clusters the scan with one setting.
Clustering cluster(lisco::ColumnClusterer& clusterer, const Scan& scan, float tolerance, const Setting& setting);

/// Holds every setting's outcome, and those of some at each level of vector instructions, against the oracle's and
/// against the verifier.
/// \return whether all were right; otherwise test failures have been added
bool expectExact(lisco::ColumnClusterer& clusterer, const Scan& scan, float tolerance);

}  // namespace lisco_test
