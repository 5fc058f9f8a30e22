// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>

#include <pcl/io/pcd_io.h>
#include <boost/algorithm/string/join.hpp>

#include "io/formats.h"

namespace lisco_apps {
namespace {

constexpr double kMaxPointBytes = 1e6;
constexpr std::size_t kViewpointValues = 7;  ///< a position and a quaternion
constexpr double kMaxCompression = 300;      ///< points, or bytes of data, that a byte of compressed data may hold

/// The number of values in a line of ASCII data.
std::size_t valuesIn(std::string_view line) {
  constexpr std::string_view kBetween = " \t\r";
  std::size_t count = 0;
  while (true) {
    line.remove_prefix(std::min(line.find_first_not_of(kBetween), line.size()));
    if (line.empty()) return count;
    const std::string_view value = line.substr(0, line.find_first_of(kBetween));
    line.remove_prefix(value.size());
    count += value.find_first_not_of("\v\f") != std::string_view::npos ? 1 : 0;
  }
}

bool isFiniteFloat(const std::string& word) {
  char* end = nullptr;
  return std::isfinite(std::strtof(word.c_str(), &end)) && *end == '\0';
}

/// Checks a PCD file before PCL reads it: PCL 1.13's reader crashes without a header, allocates all the memory that a
/// wrong one promises, leaves a viewpoint that is no number to chance, and reads beyond lines and compressed data that
/// are too short.
void checkHeader(const fs::path& file, const fs::path& content) {
  std::ifstream stream(content, std::ios::binary);
  const auto file_size = static_cast<double>(fs::file_size(content));
  constexpr std::array<std::string_view, 11> kKeys{"VERSION", "FIELDS", "COLUMNS",   "SIZE",   "TYPE", "COUNT",
                                                   "WIDTH",   "HEIGHT", "VIEWPOINT", "POINTS", "DATA"};
  std::map<std::string, std::vector<std::string>> header;  // values by key; each key may occur once
  std::string line;
  for (int i = 0; i < kMaxHeaderLines && header.count("DATA") == 0 && std::getline(stream, line); ++i) {
    const std::vector<std::string> words = wordsOf(line);
    if (words.empty() || words.front()[0] == '#') continue;
    if (std::find(kKeys.begin(), kKeys.end(), words.front()) == kKeys.end() ||
        line.find_first_of("\v\f") != std::string::npos)
      break;
    const std::string key = words.front() == "COLUMNS" ? "FIELDS" : words.front();
    if (!header.insert({key, {words.begin() + 1, words.end()}}).second) break;
  }
  const bool is_header = header.count("DATA") != 0;
  if (!is_header && !header.empty()) fail(file, "is damaged or truncated: its header breaks off");
  const std::vector<std::string>& names = header["FIELDS"];
  if (!is_header || names.empty()) fail(file, "is no pcd file: it has no header");
  const std::string data = boost::join(header["DATA"], " ");
  if (data != "ascii" && data != "binary" && data != "binary_compressed")
    fail(file, "is damaged: its header does not say how its data are written");
  const std::vector<std::string>& sizes = header["SIZE"];
  const std::vector<std::string>& types = header["TYPE"];
  std::vector<std::string>& counts = header["COUNT"];
  if (counts.empty()) counts.assign(names.size(), "1");
  if (sizes.size() != names.size() || types.size() != names.size() || counts.size() != names.size())
    fail(file, "is damaged: its header does not describe each of its fields");
  const std::vector<std::string>& viewpoint = header["VIEWPOINT"];
  if (!viewpoint.empty() &&
      (viewpoint.size() != kViewpointValues || !std::all_of(viewpoint.begin(), viewpoint.end(), isFiniteFloat)))
    fail(file, "is damaged: its header has a VIEWPOINT that is not seven numbers");
  const auto number = [&](const char* key, double otherwise) {
    return header.count(key) != 0 ? headerCount(header[key], 0) : otherwise;
  };
  const double width = number("WIDTH", 0);
  const double height = number("HEIGHT", 1);
  const double points = number("POINTS", 0);
  double values_of_point = 0;
  double stored = 0;  // bytes of a point; compressed files leave out the padding
  const bool is_compressed = data == "binary_compressed";
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double size = headerCount(sizes, i);
    const double count = headerCount(counts, i);
    if (!(size == 1 || size == 2 || size == 4 || size == 8) || !(count >= 1 && count <= kMaxPointBytes) ||
        types[i].size() != 1 || (types[i] != "F" && types[i] != "U" && types[i] != "I") ||
        (types[i] == "F" && size < 4))
      fail(file, "is damaged: its header describes a field '" + names[i] + "' of no known kind");
    if (!is_compressed || names[i] != "_") stored += size * count;
    values_of_point += count;
  }
  if (!(stored <= kMaxPointBytes)) fail(file, "is damaged: its header describes points of no sensible size");
  const double max_points = file_size * (is_compressed ? kMaxCompression : 1);  // each needs a byte at least
  if (!(width * height <= max_points) || !(points <= max_points))
    fail(file, "is truncated: it holds fewer points than its header says");
  if (data == "ascii") {
    while (std::getline(stream, line))
      if (const std::size_t values = valuesIn(line); values != 0 && static_cast<double>(values) < values_of_point)
        fail(file, "is truncated: a line of it holds fewer values than a point has");
    return;
  }
  if (!is_compressed && static_cast<double>(stream.tellg()) + stored * width * height > file_size)
    fail(file, "is truncated: it holds fewer points than its header says");
  std::uint32_t compressed[2]{};  // bytes compressed and decompressed
  if (is_compressed &&
      (!stream.read(reinterpret_cast<char*>(compressed), sizeof compressed) ||
       static_cast<double>(stream.tellg()) + compressed[0] > file_size || compressed[1] < stored * width * height ||
       compressed[1] > kMaxCompression * (compressed[0] + 1.0)))
    fail(file, "is truncated: it holds fewer points than its header says");
}

}  // namespace

Cloud::Ptr readPcd(const fs::path& file, const ReadOptions& /*options*/, ReadExtras& extras) {
  pcl::PCDReader reader;
  return readByPcl(reader, file, "pcd", checkHeader, extras);
}

}  // namespace lisco_apps
