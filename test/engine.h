// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "lisco/column_clusterer.h"
#include "lisco/window_clusterer.h"
#include "oracle.h"
#include "random.h"
#include "scans.h"

namespace lisco_test {

/// One way of running the engine; all give the same result.
struct Setting {
  std::string name;
  lisco::Parameters parameters;  ///< without the tolerance
};

/// Blocks of 1, 3, 16 and 64 columns; without a range image, and with few and many bins; a displaced sensor; threads
/// (small scans use one).
const std::vector<Setting>& allSettings();

/// A few of these, run at every level of vector instructions.
const std::vector<Setting>& settingsForEachLevel();

/// The count times n, if LISCO_TEST_EFFORT=n is in the environment.
std::uint64_t timesEffort(std::uint64_t count);

lisco::SensorHints hintsFor(int steps, float elevation_step, bool clockwise = false);

/// Adds the scan's columns in portions, with a query now and then.
void feed(lisco::ColumnClusterer& clusterer, Random& random, const Scan& scan);

/// The levels of vector instructions.
const std::vector<std::string>& levels();

/// Uses one of the levels while it lives, then the best again.
class SimdLevel {
 public:
  explicit SimdLevel(const std::string& name);
  ~SimdLevel();
  SimdLevel(const SimdLevel&) = delete;
  SimdLevel& operator=(const SimdLevel&) = delete;
};

/// The clusters of all columns added so far, in order. Calls update().
Clustering clustersOf(lisco::ColumnClusterer& clusterer);

/// The clusters of the last window, in order.
Clustering clustersOf(lisco::WindowClusterer& clusterer);

/// The laser, column, number of returns and subcluster of each run that a clusterer visits by place.
template <typename Clusterer>
std::vector<std::array<std::size_t, 4>> placesOf(Clusterer& clusterer) {
  std::vector<std::array<std::size_t, 4>> places;
  clusterer.forEachRun([&](std::uint32_t laser, std::uint32_t column, std::size_t count, std::uint32_t subcluster) {
    places.push_back({laser, column, count, subcluster});
  });
  return places;
}

/// Clusters the scan with one setting.
Clustering cluster(lisco::ColumnClusterer& clusterer, const Scan& scan, float tolerance, const Setting& setting);

/// Compares the clusters of every setting, and of some settings at each level of vector instructions, with the oracle
/// and the verifier.
/// \return whether all are right; otherwise test failures have been added
bool expectExact(lisco::ColumnClusterer& clusterer, const Scan& scan, float tolerance);

}  // namespace lisco_test
