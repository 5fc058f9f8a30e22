// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "recordings/point_cloud2.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <pcl/common/io.h>
#include <pcl/console/print.h>
#include <pcl/io/lisco_point_cloud2.h>

#include "recordings/message_fields.h"

namespace lisco_apps {
namespace {

/// Makes a big-endian cloud little-endian. Leaves it as it is if its rows overlap or are empty, or if its fields
/// overlap or are not within its points.
void turnBytes(pcl::PCLPointCloud2& cloud) {
  const std::size_t row_bytes = std::size_t{cloud.width} * cloud.point_step;
  if (row_bytes == 0 || (cloud.height > 1 && cloud.row_step < row_bytes)) return;
  std::vector<bool> is_turned(std::min<std::size_t>(cloud.point_step, cloud.data.size()), false);
  for (const pcl::PCLPointField& field : cloud.fields) {
    const auto size = static_cast<std::size_t>(pcl::getFieldSize(field.datatype)),
               count = std::max<std::size_t>(field.count, 1);
    if (size == 0 || field.offset > is_turned.size() || count > (is_turned.size() - field.offset) / size) return;
    for (std::size_t i = field.offset; i < field.offset + size * count; ++i) {
      if (is_turned[i]) return;
      is_turned[i] = true;
    }
  }
  for (std::size_t row = 0; row < cloud.height; ++row) {
    const std::size_t row_at = row * cloud.row_step;
    if (row_at > cloud.data.size() || row_bytes > cloud.data.size() - row_at) break;
    for (std::size_t point = 0; point < cloud.width; ++point)
      for (const pcl::PCLPointField& field : cloud.fields) {
        const auto size = static_cast<std::size_t>(pcl::getFieldSize(field.datatype)),
                   count = std::max<std::size_t>(field.count, 1);
        auto at = cloud.data.begin() + static_cast<std::ptrdiff_t>(row_at + point * cloud.point_step + field.offset);
        for (std::size_t i = 0; i < count; ++i, at += static_cast<std::ptrdiff_t>(size))
          std::reverse(at, at + static_cast<std::ptrdiff_t>(size));
      }
  }
  cloud.is_bigendian = 0;
}

/// Says what the library, which refuses such a cloud, would tell on stderr.
void refuseWithoutCoordinates(const pcl::PCLPointCloud2& cloud) {
  constexpr std::uint8_t kFloat32 = 7, kFloat64 = 8;
  if (cloud.data.empty()) return;
  for (const std::string name : {"x", "y", "z"}) {
    const auto field = std::find_if(cloud.fields.begin(), cloud.fields.end(),
                                    [&](const pcl::PCLPointField& f) { return f.name == name; });
    if (field == cloud.fields.end()) throw Broken("a cloud without a field '" + name + "'");
    if (field->datatype != kFloat32 && field->datatype != kFloat64)
      throw Broken("a cloud whose field '" + name + "' is neither FLOAT32 nor FLOAT64");
  }
}

/// A message that describes itself rightly, without bytes behind its rows.
pcl::PCLPointCloud2 withoutPadding(const pcl::PCLPointCloud2& message) {
  const std::uint32_t row_bytes = message.width * message.point_step;
  if (row_bytes == 0 || message.row_step == row_bytes) return message;
  pcl::PCLPointCloud2 cloud = message;
  cloud.row_step = row_bytes;
  cloud.data.resize(std::size_t{row_bytes} * message.height);
  for (std::size_t row = 0; row < message.height; ++row)
    std::memcpy(&cloud.data[row * row_bytes], &message.data[row * message.row_step], row_bytes);
  return cloud;
}

}  // namespace

pcl::PCLPointCloud2 pointCloud2In(const Message& message, const Topic& topic) {
  constexpr std::uint32_t kMaxFields = 1000;
  MessageFields fields(message, topic.serialization);
  pcl::PCLPointCloud2 cloud;
  const MessageFields::Header header = fields.header();
  cloud.header.stamp = static_cast<std::uint64_t>(header.stamp_ns / 1000);
  cloud.header.frame_id = header.frame;
  cloud.height = fields.number<std::uint32_t>();
  cloud.width = fields.number<std::uint32_t>();
  const auto count = fields.number<std::uint32_t>();
  if (count > kMaxFields) throw Broken("a cloud of too many fields");
  cloud.fields.resize(count);
  for (pcl::PCLPointField& field : cloud.fields) {
    field.name = fields.text();
    field.offset = fields.number<std::uint32_t>();
    field.datatype = fields.number<std::uint8_t>();
    field.count = fields.number<std::uint32_t>();
  }
  cloud.is_bigendian = fields.number<std::uint8_t>();
  cloud.point_step = fields.number<std::uint32_t>();
  cloud.row_step = fields.number<std::uint32_t>();
  const MessageFields::Span data = fields.array();
  cloud.data.assign(data.data, data.data + data.size);
  cloud.is_dense = fields.number<std::uint8_t>();
  if (cloud.is_bigendian != 0) turnBytes(cloud);
  return cloud;
}

Scan scanOf(const pcl::PCLPointCloud2& message) {
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);  // errors are reported once, by the caller
  refuseWithoutCoordinates(message);
  auto arranged = std::make_shared<Cloud>();
  Scan scan;
  scan.cloud = std::make_shared<Cloud>();
  pcl::Indices point_of_cell;
  if (!pcl::organizeLiscoCloud(message, *arranged, point_of_cell))
    throw Broken("a cloud that describes itself wrongly");
  // The points in the message's order: those that the arrangement leaves out are no returns.
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  scan.cloud->header = message.header;
  scan.cloud->points.assign(std::size_t{message.width} * message.height, pcl::PointXYZ(kNan, kNan, kNan));
  scan.cloud->width = message.width;
  scan.cloud->height = message.height;
  scan.cloud->is_dense = false;
  bool is_same = arranged->width == message.width && arranged->height == message.height;
  for (std::size_t cell = 0; cell < point_of_cell.size(); ++cell) {
    if (point_of_cell[cell] == pcl::UNAVAILABLE) continue;
    (*scan.cloud)[static_cast<std::size_t>(point_of_cell[cell])] = (*arranged)[cell];
    is_same = is_same && static_cast<std::size_t>(point_of_cell[cell]) == cell;
  }
  scan.fields = withoutPadding(message);
  if (scan.cloud->empty())  // of any number of empty rows
    scan.cloud->width = scan.cloud->height = scan.fields.width = scan.fields.height = 0;
  if (is_same || arranged->height < 2) return scan;
  scan.note = formatted("arranged by ring in %u rows x %u columns", arranged->height, arranged->width);
  scan.arranged = std::move(arranged);
  scan.point_of_cell = std::move(point_of_cell);
  return scan;
}

}  // namespace lisco_apps
