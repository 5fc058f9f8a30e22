// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "labelled_pcd.h"

#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "lisco/version.h"
#include "output_file.h"

namespace lisco_apps {
namespace {

namespace fs = std::filesystem;

/// By what a file of this program is known.
constexpr const char* kSignature = "# made by lisco_stream ";
constexpr const char* kPrefix = "rotation_";
constexpr const char* kEnding = ".pcd";

std::vector<fs::path> cloudsIn(const fs::path& folder) {
  std::vector<fs::path> clouds;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.rfind(kPrefix, 0) == 0 && entry.path().extension() == kEnding) clouds.push_back(entry.path());
  }
  return clouds;
}

}  // namespace

LabelledClouds::LabelledClouds(fs::path folder) : folder_(std::move(folder)) {
  std::error_code error;
  if (fs::exists(folder_, error) && !fs::is_directory(folder_, error))
    throw std::runtime_error(folder_.string() + ": cannot be written: it is no folder");
  checkMayWriteInto(folder_, {});
  try {
    fs::create_directories(folder_);
    const std::vector<fs::path> clouds = cloudsIn(folder_);
    for (const fs::path& cloud : clouds) checkMayWrite(cloud, kSignature);
    for (const fs::path& cloud : clouds) fs::remove(cloud);
  } catch (const fs::filesystem_error& failure) {
    throw std::runtime_error(failure.path1().string() + ": cannot be written: " + failure.code().message());
  }
}

void LabelledClouds::write(const Turn& turn) const {
  static_assert(sizeof(Cell) == 16, "cells are written as they are");
  const std::size_t columns = turn.columns();
  std::string content = std::string(kSignature) + LISCO_VERSION + "\n# .PCD v0.7 - Point Cloud Data file format\n" +
                        "VERSION 0.7\nFIELDS x y z intensity label\nSIZE 4 4 4 4 4\nTYPE F F F F U\n" +
                        "COUNT 1 1 1 1 1\nWIDTH " + std::to_string(columns) + "\nHEIGHT " +
                        std::to_string(turn.lasers) + "\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " +
                        std::to_string(turn.cells.size()) + "\nDATA binary\n";
  constexpr std::size_t kBytes = sizeof(Cell) + sizeof(std::uint32_t);
  std::size_t at = content.size();
  content.resize(at + turn.cells.size() * kBytes);
  for (std::size_t laser = 0; laser < turn.lasers; ++laser)
    for (std::size_t column = 0; column < columns; ++column, at += kBytes) {
      const std::size_t cell = column * turn.lasers + laser;
      std::memcpy(&content[at], &turn.cells[cell], sizeof(Cell));
      std::memcpy(&content[at + sizeof(Cell)], &turn.labels[cell], sizeof(std::uint32_t));
    }
  char name[48];
  std::snprintf(name, sizeof name, "%s%06llu%s", kPrefix, static_cast<unsigned long long>(turn.number), kEnding);
  writeOwnFile(folder_ / name, content, kSignature);
}

}  // namespace lisco_apps
