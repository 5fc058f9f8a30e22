// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// What getH and merge cost the paper's algorithm (its section IV and claim 2): counted, not timed.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "organized_scans.h"
#include "reference/paper_lisco.h"

namespace {

using namespace lisco_apps;
using lisco_reference::PaperLisco;

/// A scan that merges subclusters of equal sizes only, the worst case of claim 2.
struct Comb {
  std::vector<lisco::Return> matrix;  ///< step by step
  std::size_t lasers = 0, returns = 0;
  lisco_reference::NominalSensor sensor{};
  float tolerance = 0.1F;  ///< metres
};

/// 2^levels horizontal rows of returns, just too far apart, that grow side by side. Then, in a step per level, one
/// return between each pair of neighbouring groups joins them: first pairs of rows, then pairs of pairs.
Comb makeComb(unsigned levels) {
  constexpr double kRange = 1000;    // metres
  constexpr double kStep = 0.5;      // tolerances, from column to column
  constexpr double kLaser = 0.75;    // tolerances, from laser to laser: rows are two lasers apart
  constexpr std::size_t kSteps = 4;  // before the first that joins
  Comb comb;
  const std::size_t rows = std::size_t{1} << levels;
  comb.lasers = 2 * rows - 1;
  comb.sensor = {kStep * static_cast<double>(comb.tolerance) / kRange,
                 kLaser * static_cast<double>(comb.tolerance) / kRange};
  for (std::size_t step = 0; step < kSteps + levels; ++step)
    for (std::size_t laser = 0; laser < comb.lasers; ++laser) {
      bool is_return = laser % 2 == 0;
      if (!is_return && step >= kSteps) {
        const std::size_t group = std::size_t{2} << (step - kSteps);  // rows of the groups that are made, as lasers / 2
        is_return = (laser + 1) % (2 * group) == group;
      }
      const double azimuth = static_cast<double>(step) * comb.sensor.delta_alpha;
      const double elevation =
          (static_cast<double>(laser) - static_cast<double>(comb.lasers) / 2) * comb.sensor.delta_theta;
      const auto nan = std::numeric_limits<double>::quiet_NaN();
      const double range = is_return ? kRange : nan;
      comb.matrix.push_back({static_cast<float>(range * std::cos(elevation) * std::cos(azimuth)),
                             static_cast<float>(range * std::cos(elevation) * std::sin(azimuth)),
                             static_cast<float>(range * std::sin(elevation)),
                             static_cast<std::uint32_t>(comb.matrix.size())});
      comb.returns += is_return ? 1 : 0;
    }
  return comb;
}

void print(const std::string& name, std::size_t returns, double tolerance, const PaperLisco::Work& work) {
  const auto n = static_cast<double>(returns);
  std::printf("%s,%zu,%g,%zu,%zu,%zu,%.6f\n", name.c_str(), returns, tolerance, work.pairs, work.merges,
              work.relabelled, static_cast<double>(work.relabelled) / (n * std::log2(n)));
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  return runProgram("merge_cost", [&] {
    boost::program_options::options_description shown(
        "Usage: merge_cost SCAN-OR-FOLDER... [options]\n\n"
        "Counts what the paper's algorithm does on scans, and on combs, its worst case: pairs of points whose heads "
        "it\n"
        "compares (getH), subclusters it merges, points it gives another head, the latter over n log2 n. CSV.\n\n"
        "Options");
    lisco_benchmarks::OrganizedScans scans;
    scans.addTo(shown, "0.1,0.4,1");
    boost::program_options::variables_map given;
    if (!readCommandLine(argc, argv, "merge_cost", shown, &scans.inputs, given)) return 0;
    scans.check();
    std::printf("scan,returns,tolerance,pairs,merges,relabelled,over_n_log_n\n");
    PaperLisco paper;
    scans.forEach([&](const std::string& name, const ComparedScan& scan) {
      const std::vector<lisco::Return> matrix = lisco_benchmarks::columnsOf(*scan.cloud);
      for (const double tolerance : scans.tolerances) {
        paper.cluster(matrix, scan.cloud->height, nominalSensor(*scan.cloud), static_cast<float>(tolerance));
        print(name, scan.returns->size(), tolerance, paper.work());
      }
    });
    for (unsigned levels = 4; levels <= 12; levels += 2) {
      const Comb comb = makeComb(levels);
      paper.cluster(comb.matrix, comb.lasers, comb.sensor, comb.tolerance);
      print(formatted("comb_%u", 1U << levels), comb.returns, static_cast<double>(comb.tolerance), paper.work());
    }
    return 0;
  });
}
