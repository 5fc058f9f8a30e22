// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "cloud_file.h"

#include <unistd.h>
#ifdef __linux__
#include <sys/mman.h>
#endif

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include <pcl/PCLPointCloud2.h>
#include <pcl/console/print.h>
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

constexpr std::array<std::string_view, 4> kEndings{".pcd", ".ply", ".bin", ".csv"};

std::string readWhole(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::string content{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (!stream) fail(file, "cannot be read");
  return content;
}

/// What a file holds now, as a file that nobody else writes to. PCL maps files into memory: one that becomes shorter meanwhile
/// would end the program.
class Snapshot {
 public:
  explicit Snapshot(const fs::path& file) {
#ifdef __linux__
    std::ifstream original(file, std::ios::binary);
    descriptor_ = memfd_create("lisco", MFD_CLOEXEC);
    std::vector<char> some(std::size_t{1} << 20);
    while (descriptor_ >= 0 &&
           (original.read(some.data(), static_cast<std::streamsize>(some.size())) || original.gcount() > 0))
      for (std::streamsize written = 0; written < original.gcount();) {
        const ssize_t more =
            write(descriptor_, some.data() + written, static_cast<std::size_t>(original.gcount() - written));
        if (more < 0) throw std::bad_alloc();
        written += more;
      }
    if (descriptor_ >= 0) path_ = "/proc/self/fd/" + std::to_string(descriptor_);
#endif
    if (!fs::exists(path_)) path_ = file;
  }
  ~Snapshot() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  Snapshot(const Snapshot&) = delete;
  Snapshot& operator=(const Snapshot&) = delete;

  const fs::path& path() const {
    return path_;
  }

 private:
  int descriptor_ = -1;
  fs::path path_;
};

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
  if (field->offset + size > blob.point_step) fail(file, "holds less data than its header says");
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
    if (field.name != "label" || field.datatype != pcl::PCLPointField::UINT32 ||
        field.offset + sizeof(std::uint32_t) > blob.point_step)
      continue;
    labels.resize(static_cast<std::size_t>(blob.width) * blob.height);
    for (std::size_t i = 0; i < labels.size(); ++i)
      std::memcpy(&labels[i], blob.data.data() + i * blob.point_step + field.offset, sizeof(std::uint32_t));
  }
  return labels;
}

/// The words of a line.
std::vector<std::string> wordsOf(const std::string& line) {
  std::istringstream stream(line);
  return {std::istream_iterator<std::string>(stream), std::istream_iterator<std::string>()};
}

/// A count as headers have it; NaN if it is none.
double countOf(const std::vector<std::string>& words, std::size_t at) {
  double count = std::numeric_limits<double>::quiet_NaN();
  if (at < words.size() && words[at].find_first_not_of("0123456789") == std::string::npos)
    count = std::strtod(words[at].c_str(), nullptr);
  return count;
}

/// How many values a line of a PCD file holds.
std::size_t valuesIn(std::string_view line) {
  constexpr std::string_view kBetween = " \t\r";
  std::size_t count = 0;
  while (true) {
    line.remove_prefix(std::min(line.find_first_not_of(kBetween), line.size()));
    if (line.empty()) return count;
    const std::string_view value = line.substr(0, line.find_first_of(kBetween));
    line.remove_prefix(value.size());
    count += value.find_first_not_of("\v\f") != std::string_view::npos ? 1 : 0;
  }
}

constexpr int kMostHeaderLines = 1000;

/// Looks at a PCD file's header before PCL does: PCL 1.13's reader crashes without one, asks for all the memory that a
/// wrong one promises, and reads beyond lines and compressed data that are too short.
void checkPcdHeader(const fs::path& file, const Snapshot& content) {
  std::ifstream stream(content.path(), std::ios::binary);
  const auto file_size = static_cast<double>(fs::file_size(content.path()));
  std::vector<std::string> names, sizes, types, counts;
  double width = 0, height = 1, points = 0;
  constexpr std::array<std::string_view, 11> kKeys{"VERSION", "FIELDS", "COLUMNS",   "SIZE",   "TYPE", "COUNT",
                                                   "WIDTH",   "HEIGHT", "VIEWPOINT", "POINTS", "DATA"};
  std::set<std::string> seen;  // of these; each comes once
  std::string line;
  bool is_header = false;
  std::vector<std::string> words;
  for (int i = 0; i < kMostHeaderLines && !is_header && std::getline(stream, line); ++i) {
    words = wordsOf(line);
    if (words.empty() || words.front()[0] == '#') continue;
    const std::string key = words.front();
    if (std::find(kKeys.begin(), kKeys.end(), key) == kKeys.end() || !seen.insert(key).second ||
        line.find_first_of("\v\f") != std::string::npos)
      break;
    const auto values = [&] { return std::vector<std::string>(words.begin() + 1, words.end()); };
    if (key == "FIELDS" || key == "COLUMNS") names = values();
    if (key == "SIZE") sizes = values();
    if (key == "TYPE") types = values();
    if (key == "COUNT") counts = values();
    if (key == "WIDTH") width = countOf(words, 1);
    if (key == "HEIGHT") height = countOf(words, 1);
    if (key == "POINTS") points = countOf(words, 1);
    is_header = key == "DATA";
  }
  if (!is_header && !seen.empty()) fail(file, "is damaged or truncated: its header breaks off");
  if (!is_header || names.empty()) fail(file, "is no pcd file: it has no header");
  if (words.size() != 2 || (words[1] != "ascii" && words[1] != "binary" && words[1] != "binary_compressed"))
    fail(file, "is damaged: its header does not say how its data are written");
  if (counts.empty()) counts.assign(names.size(), "1");
  if (sizes.size() != names.size() || types.size() != names.size() || counts.size() != names.size())
    fail(file, "is damaged: its header does not describe each of its fields");
  double values_of_point = 0;
  double stored = 0;  // bytes of a point, compressed ones without the padding
  const bool is_compressed = words[1] == "binary_compressed";
  constexpr double kMostBytes = 1e6;  // of a point
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double size = countOf(sizes, i);
    const double count = countOf(counts, i);
    if (!(size == 1 || size == 2 || size == 4 || size == 8) || !(count >= 1 && count <= kMostBytes) ||
        types[i].size() != 1 || (types[i] != "F" && types[i] != "U" && types[i] != "I") ||
        (types[i] == "F" && size < 4))
      fail(file, "is damaged: its header describes a field '" + names[i] + "' of no known kind");
    if (!is_compressed || names[i] != "_") stored += size * count;
    values_of_point += count;
  }
  if (!(stored <= kMostBytes)) fail(file, "is damaged: its header describes points of no sensible size");
  // A point takes a byte at least; compressed, a few hundred may share one.
  const double most = file_size * (is_compressed ? 300 : 1);
  if (!(width * height <= most) || !(points <= most))
    fail(file, "is truncated: it holds fewer points than its header says");
  if (words[1] == "ascii") {
    while (std::getline(stream, line))
      if (const std::size_t values = valuesIn(line); values != 0 && static_cast<double>(values) < values_of_point)
        fail(file, "is truncated: a line of it holds fewer values than a point has");
    return;
  }
  if (!is_compressed && static_cast<double>(stream.tellg()) + stored * width * height > file_size)
    fail(file, "is truncated: it holds fewer points than its header says");
  std::uint32_t compressed[2]{};  // its size, and what it becomes
  if (is_compressed && (!stream.read(reinterpret_cast<char*>(compressed), sizeof compressed) ||
                        static_cast<double>(stream.tellg()) + compressed[0] > file_size ||
                        compressed[1] < stored * width * height || compressed[1] > 300.0 * compressed[0] + 300))
    fail(file, "is truncated: it holds fewer points than its header says");
}

/// Looks at a PLY file's header before PCL does, which asks for all the memory that a wrong one promises,
/// and aborts at a list in a vertex, or if there are more vertices than cells.
void checkPlyHeader(const fs::path& file, const Snapshot& content) {
  std::ifstream stream(content.path(), std::ios::binary);
  const auto file_size = static_cast<double>(fs::file_size(content.path()));
  double columns = 0, rows = 0, vertices = 0;
  int column_lines = 0, row_lines = 0;  // both or none, once each, before any element
  bool in_vertex = false;
  bool any_element = false;
  std::string line;
  for (int i = 0; i < kMostHeaderLines && std::getline(stream, line); ++i) {
    const std::vector<std::string> words = wordsOf(line);
    if (words.empty()) continue;
    if (std::isspace(static_cast<unsigned char>(line.front())) != 0) break;  // PCL aborts at some
    if (words[0] == "end_header") {
      if (column_lines != row_lines || column_lines > 1) break;
      if (!(std::max({columns, rows, columns * rows}) <= file_size)) break;
      if (column_lines > 0 && !(vertices <= columns * rows)) break;
      return;
    }
    if (words[0] == "element") in_vertex = words.size() > 1 && words[1] == "vertex";
    any_element = any_element || words[0] == "element";
    if (words[0] == "element" && in_vertex) vertices = countOf(words, 2);
    if (words[0] == "property" && in_vertex && words.size() != 3) break;
    // Each takes a byte at least.
    if (words[0] == "element" && !(countOf(words, 2) <= file_size)) break;
    if (words[0] != "obj_info" || words.size() < 3) continue;
    if (any_element && (words[1] == "num_cols" || words[1] == "num_rows")) break;
    if (words[1] == "num_cols") columns = countOf(words, 2);
    if (words[1] == "num_rows") rows = countOf(words, 2);
    column_lines += words[1] == "num_cols" ? 1 : 0;
    row_lines += words[1] == "num_rows" ? 1 : 0;
  }
  fail(file, "is damaged, truncated or no ply file");
}

Cloud::Ptr readByPcl(const fs::path& file, const std::string& ending, std::vector<std::uint32_t>* object_of) {
  // PCL's readers print what they think; this program says it once, in its own words.
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  const Snapshot content(file);
  if (ending == ".pcd") checkPcdHeader(file, content);
  if (ending == ".ply") checkPlyHeader(file, content);
  pcl::PCLPointCloud2 blob;
  auto cloud = std::make_shared<Cloud>();
  Eigen::Vector4f origin = Eigen::Vector4f::Zero();
  Eigen::Quaternionf orientation = Eigen::Quaternionf::Identity();
  int status = -1;
  try {
    int version;
    status = ending == ".pcd" ? pcl::PCDReader().read(content.path().string(), blob, origin, orientation, version)
                              : pcl::PLYReader().read(content.path().string(), blob, origin, orientation, version);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    status = -1;
  }
  if (status < 0) fail(file, "is damaged, truncated or no " + ending.substr(1) + " file");
  if (blob.point_step == 0) fail(file, "has no fields");
  if (blob.data.size() / blob.point_step < static_cast<std::size_t>(blob.width) * blob.height)
    fail(file, "holds less data than its header says");

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
    fail(file,
         "line 1 is not 'lasers,steps,0', with which the paper authors' .csv begins; no other .csv is read, make it a "
         ".pcd");
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
  if (!fs::exists(file, error)) fail(file, error ? "cannot be read: " + error.message() : "does not exist");
  if (!fs::is_regular_file(file, error)) fail(file, "is no file");
  if (!std::ifstream(file)) fail(file, "cannot be read");
  const std::string ending = endingOf(file);
  if (ending == ".pcap" || ending == ".pcapng") fail(file, "is a capture of packets: give it to lisco_stream");
  if (std::find(kEndings.begin(), kEndings.end(), ending) == kEndings.end())
    fail(file, "has an unknown ending (known: pcd, ply, bin, csv)");
  if (fs::file_size(file, error) == 0) fail(file, "is empty");
  if (ending == ".bin") return readKittiBin(file);
  if (ending == ".csv") return readAuthorsCsv(file);
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
