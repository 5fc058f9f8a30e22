// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <algorithm>
#include <cctype>
#include <fstream>

#include <pcl/io/ply_io.h>

#include "io/formats.h"

namespace lisco_apps {
namespace {

/// Checks a PLY file before PCL reads it: PCL 1.13's reader allocates all the memory that a wrong header promises, and
/// aborts at a list in a vertex, at leading blanks, and if there are more vertices than cells.
void checkHeader(const fs::path& file, const fs::path& content) {
  std::ifstream stream(content, std::ios::binary);
  const auto file_size = static_cast<double>(fs::file_size(content));
  double columns = 0, rows = 0, vertices = 0;
  int column_lines = 0, row_lines = 0;  // once each or not at all, before the elements
  bool in_vertex = false;
  bool any_element = false;
  std::string line;
  for (int i = 0; i < kMaxHeaderLines && std::getline(stream, line); ++i) {
    const std::vector<std::string> words = wordsOf(line);
    if (words.empty()) continue;
    if (std::isspace(static_cast<unsigned char>(line.front())) != 0) break;
    if (words[0] == "end_header") {
      if (column_lines != row_lines || column_lines > 1) break;
      if (!(std::max({columns, rows, columns * rows}) <= file_size)) break;
      if (column_lines > 0 && !(vertices <= columns * rows)) break;
      return;
    }
    if (words[0] == "element") in_vertex = words.size() > 1 && words[1] == "vertex";
    any_element = any_element || words[0] == "element";
    if (words[0] == "element" && in_vertex) vertices = headerCount(words, 2);
    if (words[0] == "property" && in_vertex && words.size() != 3) break;
    if (words[0] == "element" && !(headerCount(words, 2) <= file_size)) break;  // each needs a byte at least
    if (words[0] != "obj_info" || words.size() < 3) continue;
    if (any_element && (words[1] == "num_cols" || words[1] == "num_rows")) break;
    if (words[1] == "num_cols") columns = headerCount(words, 2);
    if (words[1] == "num_rows") rows = headerCount(words, 2);
    column_lines += words[1] == "num_cols" ? 1 : 0;
    row_lines += words[1] == "num_rows" ? 1 : 0;
  }
  fail(file, "is damaged, truncated or no ply file");
}

}  // namespace

Cloud::Ptr readPly(const fs::path& file, const ReadOptions& /*options*/, ReadExtras& extras) {
  pcl::PLYReader reader;
  return readByPcl(reader, file, "ply", checkHeader, extras);
}

}  // namespace lisco_apps
