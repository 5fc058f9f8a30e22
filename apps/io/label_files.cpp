// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "io/label_files.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include <pcl/PCLPointCloud2.h>

#include "io/input_fields.h"
#include "io/little_endian.h"

namespace lisco_apps {
namespace {

constexpr std::uint32_t kOtherGround = 49;  ///< a class of SemanticKITTI

/// Makes way for a field that is added: fields of this name become `input_NAME`, numbered if there is such a one.
/// \param inputs number of fields that are the input's
void renameInputFields(const std::string& name, std::size_t inputs, std::vector<pcl::PCLPointField>& fields) {
  const auto begin = fields.begin();
  const auto end = begin + static_cast<std::ptrdiff_t>(inputs);
  const auto find = [&](const std::string& wanted) {
    return std::find_if(begin, end, [&](const pcl::PCLPointField& field) { return field.name == wanted; });
  };
  for (auto field = find(name); field != end; field = find(name)) {
    std::string other = "input_" + name;
    for (int number = 2; find(other) != end; ++number) other = "input_" + name + std::to_string(number);
    field->name = other;
  }
}

}  // namespace

void writeLabelledPcd(const ClusteredScan& scan, const fs::path& file) {
  std::vector<NewField> added{{"label", pcl::PCLPointField::UINT32}};
  if (scan.isGroundKnown()) added.push_back({"ground", pcl::PCLPointField::UINT8});
  pcl::PCLPointCloud2 output = inputFieldsOf(scan, added);
  const std::size_t inputs = output.fields.size() - added.size();
  for (const char* const name : {"label", "ground"}) renameInputFields(name, inputs, output.fields);
  setField(output.fields[inputs], labelsOf(scan.clusters, scan.cloud->size()), output);
  if (scan.isGroundKnown()) setField(output.fields[inputs + 1], groundOf(scan), output);
  writePcd(output, scan, file);
}

void writeSemanticKitti(const ClusteredScan& scan, const fs::path& file) {
  std::vector<std::uint32_t> labels = labelsOf(scan.clusters, scan.cloud->size());
  for (std::uint32_t& label : labels) label <<= 16;
  for (const auto index : scan.returns.ground) labels[static_cast<std::size_t>(index)] = kOtherGround;
  writeValues(file, "", labels);
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
  writeValues(file, header + description, labelsOf(scan.clusters, cloud.size()));
}

}  // namespace lisco_apps
