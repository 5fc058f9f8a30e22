// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <cstring>

#include "io/formats.h"

namespace lisco_apps {

Cloud::Ptr readKittiBin(const fs::path& file, Labels* /*object_of*/) {
  const std::string content = wholeContentOf(file);
  constexpr std::size_t kBytesPerPoint = 4 * sizeof(float);
  if (content.size() % kBytesPerPoint != 0)
    fail(file, "is no KITTI scan: its size, " + std::to_string(content.size()) + " bytes, is no multiple of 16");
  auto cloud = std::make_shared<Cloud>();
  cloud->resize(content.size() / kBytesPerPoint);
  for (std::size_t i = 0; i < cloud->size(); ++i)
    std::memcpy((*cloud)[i].data, content.data() + i * kBytesPerPoint, 3 * sizeof(float));
  return cloud;
}

}  // namespace lisco_apps
