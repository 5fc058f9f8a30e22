// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "io/input_fields.h"

#include <algorithm>
#include <cstddef>

#include <pcl/common/io.h>
#include <pcl/conversions.h>
#include <pcl/io/pcd_io.h>

#include "io/formats.h"
#include "io/text.h"

namespace lisco_apps {
namespace {

std::size_t bytesOf(const pcl::PCLPointField& field) {
  return static_cast<std::size_t>(pcl::getFieldSize(field.datatype)) * std::max(field.count, 1U);
}

}  // namespace

pcl::PCLPointCloud2 inputFieldsOf(const ClusteredScan& scan, const std::vector<NewField>& added) {
  pcl::PCLPointCloud2 coordinates;
  if (scan.fields.fields.empty()) pcl::toPCLPointCloud2(*scan.cloud, coordinates);
  const pcl::PCLPointCloud2& input = scan.fields.fields.empty() ? coordinates : scan.fields;
  pcl::PCLPointCloud2 output;
  std::vector<pcl::PCLPointField> kept;  // of the input
  for (const pcl::PCLPointField& field : input.fields)
    if (field.name != "_" && field.offset + bytesOf(field) <= input.point_step) kept.push_back(field);
  for (pcl::PCLPointField field : kept) {
    field.offset = output.point_step;
    field.count = std::max(field.count, 1U);
    output.point_step += static_cast<std::uint32_t>(bytesOf(field));
    output.fields.push_back(field);
  }
  for (const NewField& field : added) addField(output, field.name, field.datatype);
  output.is_dense = input.is_dense;
  allocate(output, input.width, input.height);
  const std::size_t points = static_cast<std::size_t>(input.width) * input.height;
  for (std::size_t field = 0; field < kept.size(); ++field)
    for (std::size_t i = 0; i < points; ++i)
      std::memcpy(&output.data[i * output.point_step + output.fields[field].offset],
                  &input.data[i * input.point_step + kept[field].offset], bytesOf(kept[field]));
  return output;
}

void writePcd(const pcl::PCLPointCloud2& points, const ClusteredScan& scan, const fs::path& file) {
  // PCL's writer would append bytes up to a whole page, and writes six digits of the viewpoint.
  const Eigen::Vector4f& origin = scan.cloud->sensor_origin_;
  const Eigen::Quaternionf& turn = scan.cloud->sensor_orientation_;
  std::string header = pcl::PCDWriter().generateHeaderBinary(points, origin, turn);
  const std::size_t begin = header.find("VIEWPOINT ");
  const auto wide = [](float value) { return static_cast<double>(value); };
  header.replace(begin, header.find('\n', begin) - begin,
                 formatted("VIEWPOINT %.9g %.9g %.9g %.9g %.9g %.9g %.9g", wide(origin[0]), wide(origin[1]),
                           wide(origin[2]), wide(turn.w()), wide(turn.x()), wide(turn.y()), wide(turn.z())));
  writeValues(file, header + "DATA binary\n", points.data);
}

}  // namespace lisco_apps
