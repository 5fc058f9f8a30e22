// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include <pcl/PCLPointCloud2.h>

#include "io/clusters.h"
#include "io/text.h"

namespace lisco_apps {

/// A field of one value.
struct NewField {
  std::string name;
  std::uint8_t datatype;  ///< of pcl::PCLPointField
};

/// The points of a scan with all fields of its input, or x y z if it has no others, without padding.
/// \param added fields of zeros, behind them
pcl::PCLPointCloud2 inputFieldsOf(const ClusteredScan& scan, const std::vector<NewField>& added = {});

/// Sets a field to a value for each point, of the field's type.
template <typename Value>
void setField(const pcl::PCLPointField& field, const std::vector<Value>& values, pcl::PCLPointCloud2& cloud) {
  for (std::size_t i = 0; i < values.size(); ++i)
    std::memcpy(&cloud.data[i * cloud.point_step + field.offset], &values[i], sizeof values[i]);
}

/// Writes points without padding as a binary PCD, with the sensor's place of the scan that they are of.
/// \throws std::runtime_error with one line if the file cannot be written
void writePcd(const pcl::PCLPointCloud2& points, const ClusteredScan& scan, const fs::path& file);

/// Writes a file of a header and values. \throws std::runtime_error with one line if it cannot be written
template <typename Value>
void writeValues(const fs::path& file, const std::string& header, const std::vector<Value>& values) {
  std::ofstream stream(file, std::ios::binary);
  stream << header;
  stream.write(reinterpret_cast<const char*>(values.data()),
               static_cast<std::streamsize>(values.size() * sizeof values[0]));
  stream.close();
  if (!stream) fail(file, "cannot be written");
}

}  // namespace lisco_apps
