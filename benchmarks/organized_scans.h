// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "compare/comparison.h"
#include "ground_heights.h"
#include "io/options.h"
#include "io/scan_file.h"
#include "lisco/return.h"

namespace lisco_benchmarks {

/// The inputs of programs that read organized scans: SCAN-OR-FOLDER... --tolerance --ground-z.
struct OrganizedScans {
  std::vector<std::string> inputs, ground;
  std::string tolerance_text;
  std::vector<double> tolerances;  ///< metres

  void addTo(boost::program_options::options_description& shown, const char* tolerance) {
    namespace po = boost::program_options;
    shown.add_options()("tolerance", po::value(&tolerance_text)->default_value(tolerance), "metres")(
        "ground-z", po::value(&ground), "M, or NAME=M for the scan of this name: leave out what is lower, metres");
  }

  void check() {
    if (inputs.empty()) throw std::runtime_error("no input; see --help");
    for (const std::string& item : lisco_apps::itemsOf(tolerance_text))
      tolerances.push_back(lisco_apps::toleranceOf(item));
  }

  /// Calls visit(name, scan) for each scan, without its ground.
  /// \throws std::runtime_error for one that cannot be read or is not organized
  template <typename Visit>
  void forEach(Visit&& visit) const {
    std::vector<std::string> failures;
    const auto files = lisco_apps::expandInputs(inputs, failures);
    if (!failures.empty()) throw std::runtime_error(failures.front());
    const auto heights = lisco_apps::groundHeights(ground);
    for (const auto& file : files) {
      const std::string name = file.stem().string();
      const lisco_apps::Cloud::Ptr cloud = lisco_apps::readScan(file).cloud;
      if (cloud->height < 2) throw std::runtime_error(file.string() + ": is not organized");
      visit(name, lisco_apps::prepareScan(*cloud, {}, lisco_apps::returnsAbove(*cloud, heights.of(name)), false));
    }
  }
};

/// The cells of a cloud, column by column: laser l of column s at s * height + l, with their numbers in the cloud.
inline std::vector<lisco::Return> columnsOf(const lisco_apps::ComparedCloud& cloud) {
  std::vector<lisco::Return> cells;
  cells.reserve(cloud.size());
  for (std::size_t column = 0; column < cloud.width; ++column)
    for (std::size_t row = 0; row < cloud.height; ++row) {
      const std::size_t i = row * cloud.width + column;
      cells.push_back({cloud[i].x, cloud[i].y, cloud[i].z, static_cast<std::uint32_t>(i)});
    }
  return cells;
}

}  // namespace lisco_benchmarks
