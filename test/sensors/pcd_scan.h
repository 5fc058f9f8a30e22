// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "sensors/decoder.h"

namespace lisco_test {

/// x, y, z and intensity, row by row.
struct Scan {
  std::size_t width = 0, height = 0;
  std::vector<lisco_apps::Cell> cells;
};

inline Scan readPcd(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  Scan scan;
  for (std::string key; key != "DATA" && stream >> key;) {
    if (key == "WIDTH") stream >> scan.width;
    if (key == "HEIGHT") stream >> scan.height;
  }
  std::string rest;
  std::getline(stream, rest);
  scan.cells.resize(scan.width * scan.height);
  stream.read(reinterpret_cast<char*>(scan.cells.data()),
              static_cast<std::streamsize>(scan.cells.size() * sizeof(lisco_apps::Cell)));
  EXPECT_TRUE(stream.good()) << file;
  return scan;
}

}  // namespace lisco_test
