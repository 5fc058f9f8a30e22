// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "io/cloud_file.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <new>
#include <set>

#include <boost/algorithm/string/case_conv.hpp>

#include "io/formats.h"
#include "io/output_file.h"
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
  if (ending == ".pcap" || ending == ".pcapng") fail(file, "is a capture of packets: give it to lisco_stream");
  const Format* const format = formatOf(ending);
  if (format == nullptr)
    fail(file, "has an unknown ending (known: pcd, ply, bin, npy, csv; recordings: pcap, pcapng, db3, mcap, bag)");
  if (fs::file_size(file, error) == 0) fail(file, "is empty");
  try {
    return format->read(file, options, extras);
  } catch (const std::bad_alloc&) {
    fail(file, "is too large for this machine's memory");
  }
}

}  // namespace

Cloud::Ptr readCloudFile(const fs::path& file, Labels* object_of) {
  ReadExtras extras;
  Cloud::Ptr cloud = readFile(file, {}, extras);
  if (object_of != nullptr) *object_of = labelsIn(extras.fields);
  return cloud;
}

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

std::vector<fs::path> cloudFilesIn(const fs::path& folder) {
  std::vector<fs::path> files;
  try {
    const bool has_results = fs::exists(folder / kResultMarker);
    for (const auto& entry : fs::directory_iterator(folder)) {
      const std::string name = entry.path().filename().string();
      if (has_results && (name == "labels.pcd" || name == "clusters.csv")) continue;
      if (entry.is_regular_file() && isCloudFile(entry.path())) files.push_back(entry.path());
    }
  } catch (const fs::filesystem_error& error) {
    fail(folder, "cannot be read: " + error.code().message());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<fs::path> expandInputs(const std::vector<std::string>& inputs, std::vector<std::string>& failures) {
  std::vector<fs::path> files;
  for (const fs::path input : inputs) {
    std::error_code error;
    if (!fs::is_directory(input, error)) {
      files.push_back(input);
      continue;
    }
    try {
      const std::vector<fs::path> found = cloudFilesIn(input);
      if (found.empty()) fail(input, "holds no scans");
      files.insert(files.end(), found.begin(), found.end());
    } catch (const std::runtime_error& unreadable) {
      failures.emplace_back(unreadable.what());
    }
  }
  return files;
}

std::vector<std::string> namesOf(const std::vector<fs::path>& files) {
  std::vector<std::string> names;
  std::set<std::string> taken;
  for (const fs::path& file : files) {
    const std::string stem = file.stem().string();
    names.push_back(stem);
    for (int number = 2; !taken.insert(names.back()).second; ++number)
      names.back() = stem + "-" + std::to_string(number);
  }
  return names;
}

pcl::Indices returnsAbove(const Cloud& cloud, float ground_z) {
  pcl::Indices indices;
  indices.reserve(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i)
    if (isReturn(cloud[i]) && cloud[i].z >= ground_z) indices.push_back(static_cast<pcl::index_t>(i));
  return indices;
}

}  // namespace lisco_apps
