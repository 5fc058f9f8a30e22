// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>

namespace lisco_apps {

/// The header of an organized binary PCD.
/// \param comment first line, begins with '#'
/// \param fields names, such as "x y z label"; each field is one value of four bytes
/// \param types one letter per field, such as "F F F U"
inline std::string pcdHeader(const std::string& comment, const std::string& fields, const std::string& types,
                             std::size_t columns, std::size_t rows) {
  const auto per_field = [&](char value) {
    std::string line = types;
    std::replace_if(
        line.begin(), line.end(), [](char c) { return c != ' '; }, value);
    return line;
  };
  return comment + "\n# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " +
         per_field('4') + "\nTYPE " + types + "\nCOUNT " + per_field('1') + "\nWIDTH " + std::to_string(columns) +
         "\nHEIGHT " + std::to_string(rows) + "\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + std::to_string(columns * rows) +
         "\nDATA binary\n";
}

}  // namespace lisco_apps
