// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// How many neighbours the paper's mask (Algorithm 2, taken literally) misses on real scans, why, and how many points
// bear another label for it. Prints a row per scan and tolerance.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <pcl/search/kdtree.h>

#include "compare/comparison.h"
#include "ground_heights.h"
#include "io/options.h"
#include "io/scan_file.h"
#include "io/stagger.h"

namespace {

using namespace lisco_apps;

/// Pairs of neighbours, and those that the mask does not show.
struct Pairs {
  std::size_t all = 0;
  std::size_t lasers = 0;   ///< missed: more than lambda lasers apart
  std::size_t horizon = 0;  ///< missed: more than sigma steps apart, but not if sigma came from the horizontal distance
  std::size_t columns = 0;  ///< missed: more steps apart even so; columns are no azimuths
};

Pairs pairsOf(const ComparedScan& scan, double tolerance, const lisco_reference::NominalSensor& sensor) {
  const ComparedCloud& cloud = *scan.cloud;
  const std::size_t steps = cloud.width;
  pcl::search::KdTree<ComparedPoint> tree(false);
  tree.setInputCloud(scan.cloud, scan.returns);
  const auto farther = [&cloud](std::size_t a, std::size_t b) {
    const float range_a = cloud[a].getVector3fMap().squaredNorm();
    const float range_b = cloud[b].getVector3fMap().squaredNorm();
    return range_a != range_b ? range_a > range_b : a > b;
  };
  Pairs pairs;
  pcl::Indices near;
  std::vector<float> squared;
  for (const auto index : *scan.returns) {
    const auto p = static_cast<std::size_t>(index);
    const double horizontal = std::hypot(static_cast<double>(cloud[p].x), static_cast<double>(cloud[p].y));
    const double distance = std::hypot(horizontal, static_cast<double>(cloud[p].z));
    const auto mask = lisco_reference::getNeighborMask(distance, tolerance, sensor);
    const auto wide_mask = lisco_reference::getNeighborMask(horizontal, tolerance, sensor);
    tree.radiusSearch(cloud[p], tolerance, near, squared);
    for (const auto other : near) {
      const auto q = static_cast<std::size_t>(other);
      const std::size_t p_step = p % steps;
      const std::size_t q_step = q % steps;
      // Each pair once, by its later point. Within one step both look for each other: by the nearer one, which sees
      // further.
      if (q_step > p_step || (q_step == p_step && (farther(p, q) || p == q))) continue;
      ++pairs.all;
      const std::size_t apart = std::min(p_step - q_step, steps - (p_step - q_step));
      const std::size_t rows = std::max(p / steps, q / steps) - std::min(p / steps, q / steps);
      if (rows > mask.lambda)
        ++pairs.lasers;
      else if (apart > mask.sigma)
        ++(apart > wide_mask.sigma ? pairs.columns : pairs.horizon);
    }
  }
  return pairs;
}

/// The scan with its rows moved so that a column is one direction, as its driver might do it.
Cloud::Ptr destaggered(const Cloud& cloud) {
  auto straight = std::make_shared<Cloud>(cloud);
  const std::vector<int> shifts = rowShiftsOf(cloud);
  const auto columns = static_cast<int>(cloud.width);
  for (int row = 0; row < static_cast<int>(cloud.height); ++row)
    for (int column = 0; column < columns; ++column)
      straight->at(((column + shifts[static_cast<std::size_t>(row)]) % columns + columns) % columns, row) =
          cloud.at(column, row);
  return straight;
}

int run(const std::vector<std::string>& inputs, const PerInput<float>& ground, const std::vector<double>& tolerances) {
  CompareSettings settings;
  settings.runs = 0;
  for (Baseline& baseline : allBaselines())
    if (baseline.key == "paper") settings.baselines.push_back(std::move(baseline));
  std::vector<std::string> failures;
  const auto files = expandInputs(inputs, failures);
  std::printf(
      "scan,returns,tolerance,clusters,mislabelled,mislabelled_destaggered,pairs,missed_lasers,missed_horizon,missed_"
      "columns\n");
  for (const auto& file : files) {
    const std::string name = file.stem().string();
    try {
      const Cloud::Ptr cloud = readScan(file).cloud;
      if (cloud->height < 2) throw std::runtime_error(file.string() + ": is not organized");
      const ComparedScan scan = prepareScan(*cloud, {}, returnsAbove(*cloud, ground.of(name)), false);
      const Cloud::Ptr straightened = destaggered(*cloud);
      const ComparedScan straight = prepareScan(*straightened, {}, returnsAbove(*straightened, ground.of(name)), false);
      for (const double tolerance : tolerances) {
        const auto compared = [&](const ComparedScan& one) {
          return compareAt(one, tolerance, settings, [](const std::string&, double) {});
        };
        const CaseResult as_read = compared(scan);
        const Pairs pairs = pairsOf(scan, tolerance, nominalSensor(*scan.cloud));
        std::printf("%s,%zu,%g,%zu,%zu,%zu,%zu,%zu,%zu,%zu\n", name.c_str(), scan.returns->size(), tolerance,
                    as_read.clusters, as_read.baselines.front().difference.mislabelled,
                    compared(straight).baselines.front().difference.mislabelled, pairs.all, pairs.lasers, pairs.horizon,
                    pairs.columns);
        std::fflush(stdout);
      }
    } catch (const std::exception& error) {
      failures.emplace_back(error.what());
    }
  }
  for (const std::string& failure : failures) std::fprintf(stderr, "literal_mask: %s\n", failure.c_str());
  return failures.empty() ? 0 : 2;
}

}  // namespace

int main(int argc, char** argv) {
  namespace po = boost::program_options;
  return lisco_apps::runProgram("literal_mask", [&] {
    po::options_description options("Usage: literal_mask SCAN-OR-FOLDER... [options]");
    std::vector<std::string> inputs, ground;
    std::string tolerances;
    options.add_options()("ground-z", po::value(&ground),
                          "M, or NAME=M for the scan of this name: leave out what is lower, metres")(
        "tolerance", po::value(&tolerances)->default_value("0.1,0.3,0.4,0.7,1"), "metres");
    po::variables_map given;
    if (!readCommandLine(argc, argv, "literal_mask", options, &inputs, given)) return 0;
    if (inputs.empty()) throw std::runtime_error("no input; see --help");
    std::vector<double> values;
    for (const std::string& item : itemsOf(tolerances)) values.push_back(numberOf(item, "--tolerance"));
    return run(inputs, groundHeights(ground), values);
  });
}
