// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// Clouds of little-endian floats without a header, a fixed number of them a point, x y z first: KITTI has 4 (x y z
// intensity, laser by laser), nuScenes 5 (x y z intensity ring, firing by firing), others more.
#include <cstring>

#include "io/float_table.h"
#include "io/formats.h"

namespace lisco_apps {

Cloud::Ptr readFloatBin(const fs::path& file, const ReadOptions& options, ReadExtras& extras) {
  const std::string content = wholeContentOf(file);
  const auto fits = [&](std::size_t fields) { return content.size() % (fields * sizeof(float)) == 0; };
  if (options.bin_fields != 0 && !fits(options.bin_fields))
    fail(file, formatted("is no cloud of %u floats a point: its size, %zu bytes, is no multiple of %zu",
                         options.bin_fields, content.size(), options.bin_fields * sizeof(float)));
  FloatTable table;
  table.values.resize(content.size() / sizeof(float));
  if (!table.values.empty()) std::memcpy(table.values.data(), content.data(), table.values.size() * sizeof(float));
  table.fields = options.bin_fields;
  if (table.fields == 0) {
    std::vector<std::size_t> candidates;
    for (std::size_t fields = kMinFields; fields <= kMaxFields; ++fields)
      if (fits(fields)) candidates.push_back(fields);
    if (candidates.empty())
      fail(file, formatted("is no cloud of floats: its size, %zu bytes, is no multiple of 12, 16, 20, ... or 64",
                           content.size()));
    table.fields = plausibleFields(table.values, candidates);
    if (table.fields == 0)
      fail(file, formatted("is no cloud of floats: with no number of fields from %zu to %zu are its points plausible",
                           kMinFields, kMaxFields));
  }
  return cloudOf(table, options.bin_fields == 0, extras);
}

}  // namespace lisco_apps
