// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "stream/labelled_pcd.h"

#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "io/output_file.h"
#include "io/text.h"
#include "lisco/version.h"

namespace lisco_apps {
namespace {

/// First words of every file of this program.
constexpr const char* kSignature = "# made by lisco_stream ";
constexpr const char* kPrefix = "rotation_";
constexpr const char* kEnding = ".pcd";

}  // namespace

LabelledClouds::LabelledClouds(fs::path folder, bool has_ground) : folder_(std::move(folder)), has_ground_(has_ground) {
  std::error_code error;
  if (fs::exists(folder_, error) && !fs::is_directory(folder_, error))
    fail(folder_, "cannot be written: it is no folder");
  checkMayWriteInto(folder_, "lisco_stream", {});
  try {
    fs::create_directories(folder_);
    const std::vector<fs::path> clouds = filesIn(folder_, kPrefix, kEnding);
    for (const fs::path& cloud : clouds) checkMayWrite(cloud, kSignature);
    for (const fs::path& cloud : clouds) fs::remove(cloud);
  } catch (const fs::filesystem_error& failure) {
    fail(failure.path1(), "cannot be written: " + failure.code().message());
  }
}

void LabelledClouds::write(const Turn& turn) const {
  static_assert(sizeof(Cell) == 16, "cells are written as they are");
  const std::size_t columns = turn.columns();
  std::vector<PcdField> fields{{"x", 'F', 4}, {"y", 'F', 4}, {"z", 'F', 4}, {"intensity", 'F', 4}, {"label", 'U', 4}};
  if (has_ground_) fields.push_back({"ground", 'U', 1});
  std::string content = pcdHeader(std::string(kSignature) + LISCO_VERSION, fields, columns, turn.lasers);
  const std::size_t bytes = sizeof(Cell) + sizeof(std::uint32_t) + (has_ground_ ? 1 : 0);  // of a point
  std::size_t at = content.size();
  content.resize(at + turn.cells.size() * bytes);
  for (std::size_t laser = 0; laser < turn.lasers; ++laser)
    for (std::size_t column = 0; column < columns; ++column, at += bytes) {
      const std::size_t cell = column * turn.lasers + laser;
      std::memcpy(&content[at], &turn.cells[cell], sizeof(Cell));
      std::memcpy(&content[at + sizeof(Cell)], &turn.labels[cell], sizeof(std::uint32_t));
      if (has_ground_) content[at + bytes - 1] = turn.isGround(cell) ? 1 : 0;
    }
  const auto number = static_cast<unsigned long long>(turn.number);
  writeOwnFile(folder_ / formatted("%s%06llu%s", kPrefix, number, kEnding), content, kSignature);
}

}  // namespace lisco_apps
