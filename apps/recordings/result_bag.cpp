// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "recordings/result_bag.h"

#include <algorithm>
#include <cmath>

#include "io/little_endian.h"
#include "recordings/cdr_text.h"
#include "recordings/message_definitions.h"

namespace lisco_apps {
namespace {

constexpr std::size_t kPoints = 0, kBoxes = 1;  // channels

std::string pointsOf(const LabelledScan& scan) {
  constexpr std::uint8_t kFloat32 = 7, kUint32 = 6, kUint8 = 2;  // of sensor_msgs/PointField
  const bool has_ground = !scan.ground.empty();
  const std::uint32_t step = has_ground ? 17 : 16;  // bytes
  CdrText message;
  message.header(scan.time_ns, scan.frame);
  message.number(static_cast<std::uint32_t>(scan.rows));
  message.number(static_cast<std::uint32_t>(scan.columns));
  message.number(std::uint32_t{has_ground ? 5U : 4U});
  const auto field = [&](const char* name, std::uint32_t offset, std::uint8_t type) {
    message.text(name);
    message.number(offset);
    message.number(type);
    message.number(std::uint32_t{1});
  };
  field("x", 0, kFloat32);
  field("y", 4, kFloat32);
  field("z", 8, kFloat32);
  field("label", 12, kUint32);
  if (has_ground) field("ground", 16, kUint8);
  message.number(std::uint8_t{0});  // little-endian
  message.number(step);
  message.number(static_cast<std::uint32_t>(step * scan.columns));
  message.number(static_cast<std::uint32_t>(step * scan.points.size()));
  for (std::size_t i = 0; i < scan.points.size(); ++i) {
    for (const float value : scan.points[i]) putNumber(message.bytes(), value);
    putNumber(message.bytes(), scan.labels[i]);
    if (has_ground) putNumber(message.bytes(), scan.ground[i]);
  }
  message.number(std::uint8_t{0});  // may hold NaN
  return message.done();
}

/// A colour of a cluster, far from those of the next ones: hues by the golden ratio.
std::array<float, 3> colorOf(std::uint32_t id) {
  const float hue = 6 * static_cast<float>((id * 0.618033988749895) -
                                           static_cast<double>(static_cast<std::uint64_t>(id * 0.618033988749895)));
  const auto channel = [hue](float shift) {
    float k = hue + shift;
    if (k >= 6) k -= 6;
    const float rise = k < 1 ? k : k < 3 ? 1 : k < 4 ? 4 - k : 0;
    return 0.25F + 0.75F * rise;
  };
  return {channel(2), channel(0), channel(4)};
}

void putMarker(CdrText& message, const LabelledScan& scan, std::int32_t id, std::int32_t action,
               const LabelledScan::Box& marked) {
  constexpr std::int32_t kCube = 1;
  message.header(scan.time_ns, scan.frame);
  message.text("clusters");
  message.number(id);
  message.number(kCube);
  message.number(action);
  const lisco::OrientedBox& box = marked.box;
  for (const double value : box.center) message.number(value);
  for (const double value : {0., 0., std::sin(box.yaw / 2), std::cos(box.yaw / 2)})
    message.number(value);           // quaternion
  constexpr double kMinEdge = 0.01;  // metres: a flat cluster is shown, too
  for (const double edge : {box.length, box.width, box.height}) message.number(std::max(kMinEdge, edge));
  for (const float value : colorOf(marked.id)) message.number(value);
  message.number(0.4F);              // opacity
  message.time(0);                   // lives until it is replaced
  message.number(std::uint8_t{0});   // frame_locked
  message.number(std::uint32_t{0});  // points
  message.number(std::uint32_t{0});  // colors
  message.text("");                  // texture_resource
  message.header(0, "");             // texture
  message.text("");
  message.number(std::uint32_t{0});
  message.number(std::uint32_t{0});  // uv_coordinates
  message.text("");                  // text
  message.text("");                  // mesh_resource
  message.text("");                  // mesh_file
  message.number(std::uint32_t{0});
  message.number(std::uint8_t{0});  // mesh_use_embedded_materials
}

std::string boxesOf(const LabelledScan& scan) {
  constexpr std::int32_t kAdd = 0, kDeleteAll = 3;
  CdrText message;
  message.number(static_cast<std::uint32_t>(scan.boxes.size() + 1));
  putMarker(message, scan, 0, kDeleteAll, {});
  for (const LabelledScan::Box& box : scan.boxes)
    putMarker(message, scan, static_cast<std::int32_t>(box.id), kAdd, box);
  return message.done();
}

}  // namespace

ResultBag::ResultBag(const fs::path& file, const std::string& program)
    : writer_(file, program,
              {{"/lisco/points", "sensor_msgs/msg/PointCloud2", kPointCloud2Definition},
               {"/lisco/boxes", "visualization_msgs/msg/MarkerArray", kMarkerArrayDefinition}}) {}

void ResultBag::write(const LabelledScan& scan) {
  writer_.write(kPoints, scan.time_ns, pointsOf(scan));
  writer_.write(kBoxes, scan.time_ns, boxesOf(scan));
}

}  // namespace lisco_apps
