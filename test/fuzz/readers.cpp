// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include "bodies.h"
#include "io/scan_file.h"
#include "scratch_file.h"

namespace lisco_test {

void fuzzReaders(const std::uint8_t* data, std::size_t size) {
  static const std::array<ScratchFile, 4> files{ScratchFile(".pcd"), ScratchFile(".ply"), ScratchFile(".bin"),
                                                ScratchFile(".csv")};
  if (size == 0) return;
  const std::filesystem::path& file = files[data[0] % files.size()].holding(data + 1, size - 1);
  try {
    const lisco_apps::Scan scan = lisco_apps::readScan(file);
    const lisco_apps::Cloud::Ptr& cloud = scan.cloud;
    const std::vector<std::uint32_t>& labels = scan.object_of;
    hold(cloud->size() == std::size_t{cloud->width} * cloud->height, "the size of a cloud");
    hold(labels.empty() || labels.size() == cloud->size(), "the number of labels");
    hold(std::count_if(cloud->begin(), cloud->end(), [](const pcl::PointXYZ& p) { return p.x < p.y; }) >= 0, "memory");
  } catch (const std::runtime_error& refusal) {
    const std::string what = refusal.what();
    hold(what.compare(0, file.string().size(), file.string()) == 0, "a refusal that does not name the file");
    hold(what.find('\n') == std::string::npos, "a refusal of several lines");
  }
}

}  // namespace lisco_test
