// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "recordings/point_cloud2.h"

#include <limits>
#include <utility>

#include <pcl/console/print.h>
#include <pcl/io/lisco_point_cloud2.h>

#include "recordings/message_fields.h"

namespace lisco_apps {

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
  return cloud;
}

Scan scanOf(const pcl::PCLPointCloud2& message) {
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);  // errors are reported once, by the caller
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
  if (message.is_bigendian == 0 && message.row_step == message.point_step * message.width) scan.fields = message;
  if (is_same || arranged->height < 2) return scan;
  scan.note = formatted("arranged by ring in %u rows x %u columns", arranged->height, arranged->width);
  scan.arranged = std::move(arranged);
  scan.point_of_cell = std::move(point_of_cell);
  return scan;
}

}  // namespace lisco_apps
