// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "io/cloud_file.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <set>

#include <boost/algorithm/string/predicate.hpp>

#include "io/output_file.h"
#include "io/point_geometry.h"
#include "io/scan_file.h"

namespace lisco_apps {
namespace {

/// Whether a file is a table beside scans, as lisco_simulate's poses.csv: a .csv with names of columns, the first of
/// which is not x, as that of points would be.
bool isTable(const fs::path& file) {
  if (!boost::iequals(file.extension().string(), ".csv")) return false;
  const int first = std::tolower(std::ifstream(file).peek());
  return std::isalpha(first) != 0 && first != 'x';
}

}  // namespace

std::vector<fs::path> cloudFilesIn(const fs::path& folder) {
  std::vector<fs::path> files;
  try {
    const std::set<std::string> results = ownFilesIn(folder, kClusterProgram);
    for (const auto& entry : fs::directory_iterator(folder)) {
      const std::string name = entry.path().filename().string();
      if (results.count(name) > 0) continue;
      if (entry.is_regular_file() && isCloudFile(entry.path()) && !isTable(entry.path())) files.push_back(entry.path());
    }
  } catch (const fs::filesystem_error& error) {
    fail(folder, "cannot be read: " + error.code().message());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<fs::path> expandInputs(const std::vector<std::string>& inputs, std::vector<std::string>& failures) {
  std::vector<fs::path> files;
  for (const fs::path input : inputs) {
    std::error_code error;
    if (!fs::is_directory(input, error)) {
      files.push_back(input);
      continue;
    }
    try {
      const std::vector<fs::path> found = cloudFilesIn(input);
      if (found.empty()) fail(input, "holds no scans");
      files.insert(files.end(), found.begin(), found.end());
    } catch (const std::runtime_error& unreadable) {
      failures.emplace_back(unreadable.what());
    }
  }
  return files;
}

std::vector<std::string> namesOf(const std::vector<fs::path>& files) {
  std::vector<std::string> names;
  std::set<std::string> taken;
  for (const fs::path& file : files) {
    std::string stem = file.stem().string();
    // Names of other folders, and of the page beside the results.
    if (stem.empty() || stem == "." || stem == ".." || stem == "view.html") stem = "scan";
    names.push_back(stem);
    for (int number = 2; !taken.insert(names.back()).second; ++number)
      names.back() = stem + "-" + std::to_string(number);
  }
  return names;
}

pcl::Indices returnsAbove(const Cloud& cloud, float ground_z) {
  pcl::Indices indices;
  indices.reserve(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (isReturn(cloud[i]) && cloud[i].z >= ground_z) indices.push_back(static_cast<pcl::index_t>(i));
  return indices;
}

}  // namespace lisco_apps
