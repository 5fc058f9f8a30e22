// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "recordings/cloud_columns.h"

#include <array>
#include <cmath>

#include "io/point_geometry.h"
#include "recordings/bytes.h"
#include "recordings/point_cloud2.h"

namespace lisco_apps {

PacketSource::Arrival RawMessages::next(Packet& packet) {
  Message message;
  if (!reader_->next(message)) {
    error_ = reader_->error();
    return Arrival::kEnd;
  }
  packet = {message.data, message.size, message.time_ns / 1000};
  ++packets_;
  return Arrival::kPacket;
}

CloudColumns::CloudColumns(std::function<Scan(const Packet&)> read)
    : Decoder("cloud", {}, 180 * kPi / 180), read_(std::move(read)) {}

CloudColumns::CloudColumns(const Topic& topic)
    : CloudColumns([topic](const Packet& packet) {
        return scanOf(pointCloud2In({0, 1000 * packet.time_us, packet.data, packet.size}, topic));
      }) {}

void CloudColumns::estimateSensor(const Cloud& cloud) {
  const std::array<float, 3> declared = declaredOriginOf(cloud);
  const auto cell_at = [&cloud](std::size_t row, std::size_t column) {
    const pcl::PointXYZ& point = cloud[row * cloud.width + column];
    return lisco::Return{point.x, point.y, point.z, 0};
  };
  sensor_ = lisco::estimateSensor(cloud.width, cloud.height, declared, lisco::CellSource(cell_at), sensor_);
  place_ = sensor_.steps_per_turn != 0 ? SensorPlace{sensor_.origin, sensor_.tilt, declared}
                                       : SensorPlace{declared, {}, declared};
}

Decoder::Kind CloudColumns::decode(const Packet& packet, const Visitor& visit) {
  constexpr double kHourUs = 3600e6;
  Scan scan;
  try {
    scan = read_(packet);
  } catch (const Broken& why) {
    ++counts_.foreign;
    if (++malformed_ == 1)
      first_malformed_ = formatted("at %lld.%06lld: ", static_cast<long long>(packet.time_us / 1000000),
                                   static_cast<long long>(packet.time_us % 1000000)) +
                         why.what();
    return Kind::kForeign;
  }
  const Cloud& cloud = *scan.clustered();
  if (cloud.height < 2) {
    ++without_rows_;
    ++counts_.foreign;
    return Kind::kForeign;
  }
  ++counts_.data;
  frame_ = scan.cloud->header.frame_id;
  estimateSensor(cloud);
  const bool has_other_rows = !cells_.empty() && cells_.size() != cloud.height;
  cells_.resize(cloud.height);
  for (std::size_t column = 0; column < cloud.width; ++column) {
    double x = 0;
    double y = 0;
    for (std::size_t row = 0; row < cloud.height; ++row) {
      const pcl::PointXYZ& point = cloud[row * cloud.width + column];
      const bool is_return = isReturn(point);
      cells_[row] = is_return ? Cell{point.x, point.y, point.z, 0} : kNoCell;
      if (!is_return) continue;
      const double azimuth = azimuthOf(pcl::PointXYZ(point.x - place_.origin[0], point.y - place_.origin[1], 0));
      x += std::cos(azimuth);
      y += std::sin(azimuth);
    }
    if (x != 0 || y != 0) azimuth_ = std::fmod(360 - std::atan2(y, x) * 180 / kPi, 360.);
    ++counts_.columns;
    visit({cells_, azimuth_, std::fmod(static_cast<double>(packet.time_us), kHourUs), has_other_rows && column == 0,
           column == 0});
  }
  return Kind::kData;
}

std::vector<std::string> CloudColumns::leftOut() const {
  std::vector<std::string> lines;
  const auto count = [](std::uint64_t clouds) {
    return formatted("%llu cloud%s left out: ", static_cast<unsigned long long>(clouds), clouds == 1 ? "" : "s");
  };
  if (malformed_ > 0) lines.push_back(count(malformed_) + "malformed, the first " + first_malformed_);
  if (without_rows_ > 0)
    lines.push_back(count(without_rows_) + "neither rows nor a field 'ring'; lisco_cluster takes any cloud");
  return lines;
}

}  // namespace lisco_apps
