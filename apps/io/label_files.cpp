// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "io/label_files.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include <pcl/common/io.h>
#include <pcl/conversions.h>
#include <pcl/io/pcd_io.h>

#include "io/formats.h"
#include "io/little_endian.h"

namespace lisco_apps {
namespace {

std::uint32_t bytesOf(const pcl::PCLPointField& field) {
  return static_cast<std::uint32_t>(pcl::getFieldSize(field.datatype)) * std::max(field.count, 1U);
}

bool hasField(const std::vector<pcl::PCLPointField>& fields, const std::string& name) {
  return std::any_of(fields.begin(), fields.end(), [&](const auto& field) { return field.name == name; });
}

/// All fields of the input without padding, and a field `label` of zeros at the end.
pcl::PCLPointCloud2 withLabelField(const pcl::PCLPointCloud2& input) {
  pcl::PCLPointCloud2 output;
  std::vector<pcl::PCLPointField> kept;  // of the input
  for (const pcl::PCLPointField& field : input.fields)
    if (field.name != "_" && field.offset + bytesOf(field) <= input.point_step) kept.push_back(field);
  for (pcl::PCLPointField field : kept) {
    if (field.name == "label") {
      field.name = "input_label";
      for (int number = 2; hasField(kept, field.name); ++number) field.name = "input_label" + std::to_string(number);
    }
    field.offset = output.point_step;
    field.count = std::max(field.count, 1U);
    output.point_step += bytesOf(field);
    output.fields.push_back(field);
  }
  addField(output, "label", pcl::PCLPointField::UINT32);
  output.is_dense = input.is_dense;
  allocate(output, input.width, input.height);
  const std::size_t points = static_cast<std::size_t>(input.width) * input.height;
  for (std::size_t field = 0; field < kept.size(); ++field)
    for (std::size_t i = 0; i < points; ++i)
      std::memcpy(&output.data[i * output.point_step + output.fields[field].offset],
                  &input.data[i * input.point_step + kept[field].offset], bytesOf(kept[field]));
  return output;
}

template <typename Value>
void writeBytes(const fs::path& file, const std::string& header, const std::vector<Value>& values) {
  std::ofstream stream(file, std::ios::binary);
  stream << header;
  stream.write(reinterpret_cast<const char*>(values.data()),
               static_cast<std::streamsize>(values.size() * sizeof values[0]));
  stream.close();
  if (!stream) fail(file, "cannot be written");
}

}  // namespace

void writeLabelledPcd(const ClusteredScan& scan, const fs::path& file) {
  pcl::PCLPointCloud2 coordinates;
  if (scan.fields.fields.empty()) pcl::toPCLPointCloud2(*scan.cloud, coordinates);
  pcl::PCLPointCloud2 output = withLabelField(scan.fields.fields.empty() ? coordinates : scan.fields);
  const std::vector<std::uint32_t> labels = labelsOf(scan.clusters, scan.cloud->size());
  for (std::size_t i = 0; i < labels.size(); ++i)
    std::memcpy(&output.data[i * output.point_step + output.fields.back().offset], &labels[i], sizeof labels[i]);
  // PCL's writer would append bytes up to a whole page.
  const std::string header =
      pcl::PCDWriter().generateHeaderBinary(output, scan.cloud->sensor_origin_, scan.cloud->sensor_orientation_);
  writeBytes(file, header + "DATA binary\n", output.data);
}

void writeSemanticKitti(const ClusteredScan& scan, const fs::path& file) {
  std::vector<std::uint32_t> labels = labelsOf(scan.clusters, scan.cloud->size());
  for (std::uint32_t& label : labels) label <<= 16;
  writeBytes(file, "", labels);
}

void writeNpy(const ClusteredScan& scan, const fs::path& file) {
  const Cloud& cloud = *scan.cloud;
  const std::string shape =
      cloud.height > 1 ? formatted("(%u, %u)", cloud.height, cloud.width) : formatted("(%zu,)", cloud.size());
  std::string description = "{'descr': '<u4', 'fortran_order': False, 'shape': " + shape + ", }";
  // The data begin at a multiple of 64 bytes.
  const std::size_t before = 10;
  description.resize((before + description.size() + 1 + 63) / 64 * 64 - before - 1, ' ');
  description += '\n';
  std::string header("\x93NUMPY\x01\x00", 8);
  putNumber(header, static_cast<std::uint16_t>(description.size()));
  writeBytes(file, header + description, labelsOf(scan.clusters, cloud.size()));
}

}  // namespace lisco_apps
