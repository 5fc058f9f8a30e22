// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// The cells around one return of a scan, the paper's neighbour mask and the true neighbours (its figures 1 and 2), for
// mask.gp.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "io/point_geometry.h"
#include "organized_scans.h"
#include "reference/paper_lisco.h"

namespace {

using namespace lisco_apps;

constexpr double kDegree = kPi / 180;

/// The neighbours of a return among all others.
std::vector<std::size_t> neighboursOf(const ComparedCloud& cloud, std::size_t p, double tolerance) {
  std::vector<std::size_t> neighbours;
  for (std::size_t q = 0; q < cloud.size(); ++q)
    if (q != p && isReturn(cloud[q]) &&
        static_cast<double>((cloud[p].getVector3fMap() - cloud[q].getVector3fMap()).norm()) < tolerance)
      neighbours.push_back(q);
  return neighbours;
}

/// The return to be shown: of those at a range of about `range`, in the middle half of the columns, the one with most
/// neighbours.
std::size_t chooseReturn(const ComparedCloud& cloud, double tolerance, double range) {
  std::size_t best = 0;
  std::size_t most = 0;
  std::size_t looked_at = 0;
  for (std::size_t p = 0; p < cloud.size(); ++p) {
    const std::size_t column = p % cloud.width;
    if (!isReturn(cloud[p]) || column < cloud.width / 4 || column > cloud.width * 3 / 4) continue;
    if (std::fabs(rangeOf(cloud[p]) - range) > 0.1 * range || ++looked_at % 8 != 0) continue;
    const std::size_t count = neighboursOf(cloud, p, tolerance).size();
    if (count > most) best = p;
    most = std::max(most, count);
  }
  return best;
}

}  // namespace

int main(int argc, char** argv) {
  return runProgram("mask_cells", [&] {
    boost::program_options::options_description shown(
        "Usage: mask_cells SCAN [options]\n\n"
        "Prints what surrounds one return of an organized scan, a line per cell with a return: what it is (0 the "
        "return\n"
        "itself, 1 a neighbour within the paper's mask, 2 a neighbour outside, 3 another return), steps and lasers "
        "from\n"
        "the return, degrees of azimuth and of elevation from it; and two lines of comment with the mask and the "
        "counts.\n\n"
        "Options");
    lisco_benchmarks::OrganizedScans scans;
    double range = 10;
    scans.addTo(shown, "0.4");
    shown.add_options()("range", numberOption("M", "--range", range), "of the return, metres (default 10)");
    boost::program_options::variables_map given;
    if (!readCommandLine(argc, argv, "mask_cells", shown, &scans.inputs, given)) return 0;
    scans.check();
    scans.forEach([&](const std::string& name, const ComparedScan& scan) {
      const ComparedCloud& cloud = *scan.cloud;
      const double tolerance = scans.tolerances.front();
      const std::size_t p = chooseReturn(cloud, tolerance, range);
      const auto mask = lisco_reference::getNeighborMask(rangeOf(cloud[p]), tolerance, nominalSensor(cloud));
      const std::vector<std::size_t> neighbours = neighboursOf(cloud, p, tolerance);
      const auto stepsTo = [&](std::size_t q) {
        return static_cast<long>(q % cloud.width) - static_cast<long>(p % cloud.width);
      };
      const auto lasersTo = [&](std::size_t q) {
        return static_cast<long>(q / cloud.width) - static_cast<long>(p / cloud.width);
      };
      const auto in_mask = [&](std::size_t q) {
        return std::abs(stepsTo(q)) <= static_cast<long>(mask.sigma) &&
               std::abs(lasersTo(q)) <= static_cast<long>(mask.lambda);
      };
      const auto found = std::count_if(neighbours.begin(), neighbours.end(), in_mask);
      std::printf("# scan %s tolerance %g range %.2f sigma %zu lambda %zu\n# neighbours %zu outside %ld\n",
                  name.c_str(), tolerance, rangeOf(cloud[p]), mask.sigma, mask.lambda, neighbours.size(),
                  static_cast<long>(neighbours.size()) - static_cast<long>(found));
      for (std::size_t q = 0; q < cloud.size(); ++q) {
        if (!isReturn(cloud[q])) continue;
        const bool is_neighbour = std::binary_search(neighbours.begin(), neighbours.end(), q);
        const int what = q == p ? 0 : is_neighbour ? (in_mask(q) ? 1 : 2) : 3;
        const double azimuth = std::remainder(azimuthOf(cloud[q]) - azimuthOf(cloud[p]), 2 * kPi) / kDegree;
        const double elevation = (elevationOf(cloud[q]) - elevationOf(cloud[p])) / kDegree;
        std::printf("%d %ld %ld %.4f %.4f\n", what, stepsTo(q), lasersTo(q), azimuth, elevation);
      }
    });
    return 0;
  });
}
