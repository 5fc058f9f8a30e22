// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "io/scan_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <new>
#include <string_view>
#include <utility>

#include <boost/algorithm/string/case_conv.hpp>

#include <pcl/common/io.h>
#include <pcl/io/lisco_point_cloud2.h>

#include "core/sorted_element.h"
#include "io/formats.h"
#include "io/point_geometry.h"

namespace lisco_apps {
namespace {

struct Format {
  std::string_view ending;
  Cloud::Ptr (*read)(const fs::path& file, const ReadOptions& options, ReadExtras& extras);
};
constexpr std::array<Format, 5> kFormats{
    {{".pcd", readPcd}, {".ply", readPly}, {".bin", readFloatBin}, {".npy", readNpy}, {".csv", readAuthorsCsv}}};

std::string endingOf(const fs::path& file) {
  return boost::to_lower_copy(file.extension().string());
}

/// \return nullptr if the ending is none of these
const Format* formatOf(const std::string& ending) {
  const auto* const found =
      std::find_if(kFormats.begin(), kFormats.end(), [&](const Format& format) { return format.ending == ending; });
  return found == kFormats.end() ? nullptr : found;
}

Cloud::Ptr readFile(const fs::path& file, const ReadOptions& options, ReadExtras& extras) {
  std::error_code error;
  if (!fs::exists(file, error)) fail(file, error ? "cannot be read: " + error.message() : "does not exist");
  if (!fs::is_regular_file(file, error)) fail(file, "is no file");
  if (!std::ifstream(file)) fail(file, "cannot be read");
  const std::string ending = endingOf(file);
  const Format* const format = formatOf(ending);
  if (format == nullptr)
    fail(file, "has an unknown ending (known: pcd, ply, bin, npy, csv; recordings: pcap, pcapng, cap, db3, mcap, bag)");
  if (fs::file_size(file, error) == 0) fail(file, "is empty");
  try {
    return format->read(file, options, extras);
  } catch (const std::bad_alloc&) {
    fail(file, "is too large for this machine's memory");
  }
}

/// The field `label` (uint32) per point, as simulated and annotated scans have it; empty if there is none.
std::vector<std::uint32_t> labelsIn(const pcl::PCLPointCloud2& fields) {
  std::vector<std::uint32_t> labels;
  for (const pcl::PCLPointField& field : fields.fields) {
    if (field.name != "label" || field.datatype != pcl::PCLPointField::UINT32 ||
        field.offset + sizeof(std::uint32_t) > fields.point_step)
      continue;
    labels.resize(static_cast<std::size_t>(fields.width) * fields.height);
    for (std::size_t i = 0; i < labels.size(); ++i)
      std::memcpy(&labels[i], fields.data.data() + i * fields.point_step + field.offset, sizeof(std::uint32_t));
  }
  return labels;
}

}  // namespace

Scan readScan(const fs::path& file, const ReadOptions& options) {
  ReadExtras extras;
  Scan scan;
  scan.cloud = readFile(file, options, extras);
  scan.object_of = labelsIn(extras.fields);
  scan.fields = std::move(extras.fields);
  scan.note = std::move(extras.note);
  if (scan.cloud->height == 1 && !extras.rings.empty())
    arrangeByAzimuth(extras.rings, scan);
  else if (scan.cloud->height == 1)
    arrange(extras.message, scan);
  return scan;
}

bool isCloudFile(const fs::path& file) {
  return formatOf(endingOf(file)) != nullptr;
}

std::vector<std::uint32_t> Scan::objectsOfClustered() const {
  if (!arranged || object_of.empty()) return object_of;
  std::vector<std::uint32_t> objects(point_of_cell.size(), 0);
  for (std::size_t cell = 0; cell < objects.size(); ++cell)
    if (point_of_cell[cell] != pcl::UNAVAILABLE)
      objects[cell] = object_of[static_cast<std::size_t>(point_of_cell[cell])];
  return objects;
}

void Scan::toInputOrder(std::vector<pcl::PointIndices>& clusters) const {
  if (arranged) pcl::mapLiscoClusters(point_of_cell, clusters);
}

void arrange(const pcl::PCLPointCloud2& message, Scan& scan) {
  if (message.height != 1 || pcl::getFieldIndex(message, "ring") < 0) return;
  auto arranged = std::make_shared<Cloud>();
  pcl::Indices point_of_cell;
  if (!pcl::organizeLiscoCloud(message, *arranged, point_of_cell) || arranged->height < 2) return;
  arranged->sensor_origin_ = scan.cloud->sensor_origin_;
  arranged->sensor_orientation_ = scan.cloud->sensor_orientation_;
  scan.arranged = arranged;
  scan.point_of_cell = std::move(point_of_cell);
  scan.note += formatted("%sarranged by ring in %u rows x %u columns", scan.note.empty() ? "" : ", ", arranged->height,
                         arranged->width);
}

void arrangeByAzimuth(const std::vector<std::uint16_t>& rings, Scan& scan) {
  const Cloud& cloud = *scan.cloud;
  const std::size_t rows = rings.empty() ? 0 : std::size_t{rings.back()} + 1;
  if (rows < 2) return;
  // The step from point to point, and the way of the sensor.
  std::vector<double> steps;
  for (std::size_t i = 1; i < rings.size(); ++i)
    if (rings[i] == rings[i - 1] && isReturn(cloud[i]) && isReturn(cloud[i - 1]))
      steps.push_back(std::remainder(azimuthOf(cloud[i]) - azimuthOf(cloud[i - 1]), 2 * kPi));
  if (steps.empty()) return;
  const double step = lisco::sortedElement(steps, steps.size() / 2);
  constexpr double kMinStep = 2 * kPi / 36000;
  if (!(std::fabs(step) >= kMinStep)) return;
  const double per_radian = std::round(2 * kPi / std::fabs(step)) / (2 * kPi);
  const double way = step > 0 ? 1 : -1;

  constexpr std::size_t kNone = ~std::size_t{0};
  std::vector<std::size_t> column_of_point(rings.size(), kNone);
  std::size_t columns = 0;
  std::size_t returns = 0;
  for (std::size_t i = 0, next = 0; i < rings.size(); ++i) {
    if (i > 0 && rings[i] != rings[i - 1]) next = 0;
    if (!isReturn(cloud[i])) continue;
    double azimuth = way * azimuthOf(cloud[i]);
    if (azimuth < 0) azimuth += 2 * kPi;
    column_of_point[i] = std::max(next, static_cast<std::size_t>(azimuth * per_radian));
    next = column_of_point[i] + 1;
    columns = std::max(columns, next);
    ++returns;
  }
  constexpr std::size_t kMaxCellsPerPoint = 4;
  if (columns * rows > kMaxCellsPerPoint * returns) return;

  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  auto arranged = std::make_shared<Cloud>(static_cast<std::uint32_t>(columns), static_cast<std::uint32_t>(rows),
                                          pcl::PointXYZ(kNan, kNan, kNan));
  arranged->header = cloud.header;
  arranged->is_dense = false;
  arranged->sensor_origin_ = cloud.sensor_origin_;
  arranged->sensor_orientation_ = cloud.sensor_orientation_;
  scan.point_of_cell.assign(arranged->size(), pcl::UNAVAILABLE);
  for (std::size_t i = 0; i < rings.size(); ++i) {
    if (column_of_point[i] == kNone) continue;
    const std::size_t cell = rings[i] * columns + column_of_point[i];
    (*arranged)[cell] = cloud[i];
    scan.point_of_cell[cell] = static_cast<pcl::index_t>(i);
  }
  scan.arranged = std::move(arranged);
  scan.note += formatted("%sarranged in %zu rows x %zu columns by the order of its azimuths",
                         scan.note.empty() ? "" : ", ", rows, columns);
}

}  // namespace lisco_apps
