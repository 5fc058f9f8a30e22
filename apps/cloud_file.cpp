// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "cloud_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include <pcl/PCLPointCloud2.h>
#include <pcl/console/print.h>
#include <pcl/io/ifs_io.h>
#include <pcl/io/obj_io.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>

#include "lisco/return.h"
#include "output_file.h"

namespace lisco_apps {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& file, const std::string& what) {
  throw std::runtime_error(file.string() + ": " + what);
}

std::string endingOf(const fs::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending;
}

constexpr std::array<std::string_view, 6> kEndings{".pcd", ".ply", ".obj", ".ifs", ".bin", ".csv"};

std::string readWhole(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string content{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (!stream) fail(file, "cannot be read");
  return content;
}

/// Reads one coordinate field, float or double.
void copyField(const pcl::PCLPointCloud2& blob, const fs::path& file, const char* name, float pcl::PointXYZ::*member,
               Cloud& cloud) {
  const auto field = std::find_if(blob.fields.begin(), blob.fields.end(),
                                  [name](const pcl::PCLPointField& f) { return f.name == name; });
  if (field == blob.fields.end()) fail(file, std::string("has no field '") + name + "'");
  const bool is_float = field->datatype == pcl::PCLPointField::FLOAT32;
  if (!is_float && field->datatype != pcl::PCLPointField::FLOAT64)
    fail(file, std::string("field '") + name + "' is neither float nor double");
  const std::size_t size = is_float ? sizeof(float) : sizeof(double);
  if (field->offset + size > blob.point_step || blob.data.size() / blob.point_step < cloud.size())
    fail(file, "holds less data than its header says");
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const std::uint8_t* const value = blob.data.data() + i * blob.point_step + field->offset;
    if (is_float) {
      std::memcpy(&(cloud[i].*member), value, sizeof(float));
    } else {
      double wide;
      std::memcpy(&wide, value, sizeof wide);
      cloud[i].*member = static_cast<float>(wide);
    }
  }
}

/// Reads the field `label`, if there is one.
std::vector<std::uint32_t> labelsIn(const pcl::PCLPointCloud2& blob) {
  std::vector<std::uint32_t> labels;
  for (const pcl::PCLPointField& field : blob.fields) {
    if (field.name != "label" || field.datatype != pcl::PCLPointField::UINT32) continue;
    labels.resize(static_cast<std::size_t>(blob.width) * blob.height);
    for (std::size_t i = 0; i < labels.size(); ++i)
      std::memcpy(&labels[i], blob.data.data() + i * blob.point_step + field.offset, sizeof(std::uint32_t));
  }
  return labels;
}

/// Looks at a PCD file's header before PCL does: PCL 1.13's reader crashes without one, and asks for all the memory
/// that a wrong one promises.
void checkPcdHeader(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  constexpr int kMostLines = 1000;
  bool fields = false;
  double width = 0;
  double height = 1;
  std::string line;
  for (int i = 0; i < kMostLines && std::getline(stream, line); ++i) {
    std::istringstream words(line);
    std::string key, value;
    words >> key >> value;
    fields = fields || key == "FIELDS" || key == "COLUMNS";
    if (key == "WIDTH") width = std::strtod(value.c_str(), nullptr);
    if (key == "HEIGHT") height = std::strtod(value.c_str(), nullptr);
    if (key != "DATA") continue;
    // A point takes a byte at least; compressed, a few hundred may share one.
    const double most = static_cast<double>(fs::file_size(file)) * (value == "binary_compressed" ? 300 : 1);
    if (fields && width * height > most) fail(file, "is truncated: it holds fewer points than its header says");
    if (fields) return;
    break;
  }
  fail(file, "is no pcd file: it has no header");
}

Cloud::Ptr readByPcl(const fs::path& file, const std::string& ending, std::vector<std::uint32_t>* object_of) {
  // PCL's readers print what they think; this program says it once, in its own words.
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  if (ending == ".pcd") checkPcdHeader(file);
  pcl::PCLPointCloud2 blob;
  auto cloud = std::make_shared<Cloud>();
  Eigen::Vector4f origin = Eigen::Vector4f::Zero();
  Eigen::Quaternionf orientation = Eigen::Quaternionf::Identity();
  int status = -1;
  try {
    if (ending == ".pcd") {
      int version;
      status = pcl::PCDReader().read(file.string(), blob, origin, orientation, version);
    } else if (ending == ".ply") {
      int version;
      status = pcl::PLYReader().read(file.string(), blob, origin, orientation, version);
    } else if (ending == ".obj") {
      status = pcl::OBJReader().read(file.string(), blob);
    } else {
      status = pcl::io::loadIFSFile(file.string(), blob);
    }
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    status = -1;
  }
  if (status < 0) fail(file, "is damaged, truncated or no " + ending.substr(1) + " file");
  if (blob.point_step == 0) fail(file, "has no fields");

  cloud->width = blob.width;
  cloud->height = blob.height;
  cloud->points.resize(static_cast<std::size_t>(blob.width) * blob.height);
  cloud->is_dense = blob.is_dense != 0;
  cloud->sensor_origin_ = origin;
  cloud->sensor_orientation_ = orientation;
  copyField(blob, file, "x", &pcl::PointXYZ::x, *cloud);
  copyField(blob, file, "y", &pcl::PointXYZ::y, *cloud);
  copyField(blob, file, "z", &pcl::PointXYZ::z, *cloud);
  if (object_of != nullptr) *object_of = labelsIn(blob);
  return cloud;
}

Cloud::Ptr readKittiBin(const fs::path& file) {
  const std::string content = readWhole(file);
  constexpr std::size_t kBytesPerPoint = 4 * sizeof(float);
  if (content.size() % kBytesPerPoint != 0)
    fail(file, "is no KITTI scan: its size, " + std::to_string(content.size()) + " bytes, is no multiple of 16");
  auto cloud = std::make_shared<Cloud>();
  cloud->resize(content.size() / kBytesPerPoint);
  for (std::size_t i = 0; i < cloud->size(); ++i)
    std::memcpy((*cloud)[i].data, content.data() + i * kBytesPerPoint, 3 * sizeof(float));
  return cloud;
}

/// The line's three comma-separated numbers.
bool parseThree(std::string_view line, std::array<double, 3>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t comma = line.find(',');
    if ((comma == std::string_view::npos) != (i + 1 == values.size())) return false;
    std::string_view item = line.substr(0, comma);
    while (!item.empty() && item.front() == ' ') item.remove_prefix(1);
    while (!item.empty() && (item.back() == ' ' || item.back() == '\r')) item.remove_suffix(1);
    if (!item.empty() && item.front() == '+') item.remove_prefix(1);
    const auto result = std::from_chars(item.data(), item.data() + item.size(), values[i]);
    if (result.ec != std::errc() || result.ptr != item.data() + item.size()) return false;
    if (comma != std::string_view::npos) line.remove_prefix(comma + 1);
  }
  return true;
}

/// The format of the paper's authors: a line `lasers,steps,0`, then `distance,theta,alpha` per cell, step by step,
/// laser by laser within a step. Distance in metres, 0 for no return; theta, the elevation, and alpha, the azimuth
/// clockwise from +y, in radians: x = d cos(theta) sin(alpha), y = d cos(theta) cos(alpha), z = d sin(theta).
Cloud::Ptr readAuthorsCsv(const fs::path& file) {
  const std::string content = readWhole(file);
  std::string_view rest = content;
  std::size_t line_number = 0;
  const auto next_line = [&] {
    const std::size_t end = rest.find('\n');
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    ++line_number;
    return line;
  };

  std::array<double, 3> values{};
  constexpr double kMost = 1e6;
  const bool header = parseThree(next_line(), values);
  if (!header || values[0] < 1 || values[1] < 1 || values[0] > kMost || values[1] > kMost ||
      values[0] != std::floor(values[0]) || values[1] != std::floor(values[1]) || values[2] != 0)
    fail(file, "line 1 is not 'lasers,steps,0'");
  const auto lasers = static_cast<std::size_t>(values[0]);
  const auto steps = static_cast<std::size_t>(values[1]);
  if (lasers * steps > content.size()) fail(file, "holds fewer cells than its first line says");

  auto cloud = std::make_shared<Cloud>();
  cloud->resize(lasers * steps);
  cloud->width = static_cast<std::uint32_t>(steps);
  cloud->height = static_cast<std::uint32_t>(lasers);
  cloud->is_dense = false;
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t step = 0; step < steps; ++step)
    for (std::size_t laser = 0; laser < lasers; ++laser) {
      if (rest.empty())
        fail(file, "ends at line " + std::to_string(line_number) + ", its first line promises " +
                       std::to_string(lasers * steps) + " cells");
      if (!parseThree(next_line(), values))
        fail(file, "line " + std::to_string(line_number) + " is not 'distance,theta,alpha'");
      const double horizontal = values[0] * std::cos(values[1]);
      (*cloud)[laser * steps + step] = values[0] > 0
                                           ? pcl::PointXYZ(static_cast<float>(horizontal * std::sin(values[2])),
                                                           static_cast<float>(horizontal * std::cos(values[2])),
                                                           static_cast<float>(values[0] * std::sin(values[1])))
                                           : pcl::PointXYZ(kNan, kNan, kNan);
    }
  if (rest.find_first_not_of(" \r\n") != std::string_view::npos)
    fail(file, "goes on after the " + std::to_string(lasers * steps) + " cells its first line promises");
  return cloud;
}

}  // namespace

Cloud::Ptr readCloudFile(const fs::path& file, std::vector<std::uint32_t>* object_of) {
  if (object_of != nullptr) object_of->clear();
  std::error_code error;
  if (!fs::exists(file, error)) fail(file, "does not exist");
  if (!fs::is_regular_file(file, error)) fail(file, "is no file");
  if (!std::ifstream(file)) fail(file, "cannot be read");
  const std::string ending = endingOf(file);
  if (ending == ".bin") return readKittiBin(file);
  if (ending == ".csv") return readAuthorsCsv(file);
  if (std::find(kEndings.begin(), kEndings.end(), ending) == kEndings.end())
    fail(file, "has an unknown ending (known: pcd, ply, obj, ifs, bin, csv)");
  try {
    return readByPcl(file, ending, object_of);
  } catch (const std::bad_alloc&) {
    fail(file, "is too large for this machine's memory");
  }
}

std::vector<fs::path> cloudFilesIn(const fs::path& folder) {
  std::vector<fs::path> files;
  try {
    // What these programs have written into a folder is no scan of it.
    const bool results = fs::exists(folder / kResultMarker);
    for (const auto& entry : fs::directory_iterator(folder)) {
      const std::string name = entry.path().filename().string();
      if (results && (name == "labels.pcd" || name == "clusters.csv")) continue;
      if (entry.is_regular_file() &&
          std::find(kEndings.begin(), kEndings.end(), endingOf(entry.path())) != kEndings.end())
        files.push_back(entry.path());
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
    if (lisco::isReturn(cloud[i].x, cloud[i].y, cloud[i].z) && cloud[i].z >= ground_z)
      indices.push_back(static_cast<pcl::index_t>(i));
  return indices;
}

}  // namespace lisco_apps
