// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <unistd.h>
#ifdef __linux__
#include <sys/mman.h>
#endif

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <new>
#include <sstream>

#include <pcl/PCLPointCloud2.h>
#include <pcl/common/io.h>
#include <pcl/console/print.h>
#include <pcl/io/file_io.h>

#include "io/formats.h"

namespace lisco_apps {
namespace {

constexpr std::size_t kCopyBytes = std::size_t{1} << 20;  // copied at a time

/// A private copy of a file. PCL maps files into memory: if the original were truncated meanwhile, reading it would end
/// the program. Without memfd_create the original itself.
class Snapshot {
 public:
  explicit Snapshot(const fs::path& file) {
#ifdef __linux__
    std::ifstream original(file, std::ios::binary);
    descriptor_ = memfd_create("lisco", MFD_CLOEXEC);
    std::vector<char> buffer(kCopyBytes);
    while (descriptor_ >= 0 &&
           (original.read(buffer.data(), static_cast<std::streamsize>(buffer.size())) || original.gcount() > 0))
      for (std::streamsize written = 0; written < original.gcount();) {
        const ssize_t more =
            write(descriptor_, buffer.data() + written, static_cast<std::size_t>(original.gcount() - written));
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

/// Copies one coordinate field, float or double, into the cloud.
void copyField(const pcl::PCLPointCloud2& blob, const fs::path& file, std::size_t axis, Cloud& cloud) {
  const std::string name(1, "xyz"[axis]);
  const auto field =
      std::find_if(blob.fields.begin(), blob.fields.end(), [&](const pcl::PCLPointField& f) { return f.name == name; });
  if (field == blob.fields.end()) fail(file, "has no field '" + name + "'");
  const bool is_float = field->datatype == pcl::PCLPointField::FLOAT32;
  if (!is_float && field->datatype != pcl::PCLPointField::FLOAT64)
    fail(file, "field '" + name + "' is neither float nor double");
  const std::size_t size = is_float ? sizeof(float) : sizeof(double);
  if (field->offset + size > blob.point_step) fail(file, "holds less data than its header says");
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const std::uint8_t* const value = blob.data.data() + i * blob.point_step + field->offset;
    if (is_float) {
      std::memcpy(&cloud[i].data[axis], value, sizeof(float));
    } else {
      double wide;
      std::memcpy(&wide, value, sizeof wide);
      cloud[i].data[axis] = static_cast<float>(wide);
    }
  }
}

}  // namespace

void addField(pcl::PCLPointCloud2& cloud, const std::string& name, std::uint8_t datatype) {
  pcl::PCLPointField field;
  field.name = name;
  field.offset = cloud.point_step;
  field.datatype = datatype;
  field.count = 1;
  cloud.fields.push_back(field);
  cloud.point_step += static_cast<std::uint32_t>(pcl::getFieldSize(datatype));
}

void allocate(pcl::PCLPointCloud2& cloud, std::uint32_t width, std::uint32_t height) {
  cloud.width = width;
  cloud.height = height;
  cloud.row_step = cloud.point_step * width;
  cloud.data.resize(std::size_t{cloud.point_step} * width * height);
}

pcl::PCLPointCloud2 messageOf(const Cloud& cloud, const std::vector<std::uint16_t>& rings) {
  pcl::PCLPointCloud2 message;
  for (const char* const name : {"x", "y", "z"}) addField(message, name, pcl::PCLPointField::FLOAT32);
  addField(message, "ring", pcl::PCLPointField::UINT16);
  allocate(message, static_cast<std::uint32_t>(cloud.size()), 1);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    std::uint8_t* const point = message.data.data() + i * message.point_step;
    std::memcpy(point, cloud[i].data, 3 * sizeof(float));
    std::memcpy(point + 3 * sizeof(float), &rings[i], sizeof(std::uint16_t));
  }
  return message;
}

std::vector<std::string> wordsOf(const std::string& line) {
  std::istringstream stream(line);
  return {std::istream_iterator<std::string>(stream), std::istream_iterator<std::string>()};
}

double headerCount(const std::vector<std::string>& words, std::size_t at) {
  if (at >= words.size() || words[at].find_first_not_of("0123456789") != std::string::npos)
    return std::numeric_limits<double>::quiet_NaN();
  return std::strtod(words[at].c_str(), nullptr);
}

Cloud::Ptr readByPcl(pcl::FileReader& reader, const fs::path& file, const std::string& format,
                     void (*check_header)(const fs::path& file, const fs::path& content), ReadExtras& extras) {
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);  // errors are reported once, by the caller
  const Snapshot content(file);
  check_header(file, content.path());
  pcl::PCLPointCloud2 blob;
  Eigen::Vector4f origin = Eigen::Vector4f::Zero();
  Eigen::Quaternionf orientation = Eigen::Quaternionf::Identity();
  int status = -1;
  int version;
  try {
    status = reader.read(content.path().string(), blob, origin, orientation, version);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception&) {
    status = -1;
  }
  if (status < 0) fail(file, "is damaged, truncated or no " + format + " file");
  if (blob.point_step == 0) fail(file, "has no fields");
  if (blob.data.size() / blob.point_step < static_cast<std::size_t>(blob.width) * blob.height)
    fail(file, "holds less data than its header says");

  auto cloud = std::make_shared<Cloud>();
  cloud->width = blob.width;
  cloud->height = blob.height;
  cloud->points.resize(static_cast<std::size_t>(blob.width) * blob.height);
  cloud->is_dense = blob.is_dense != 0;
  cloud->sensor_origin_ = origin;
  cloud->sensor_orientation_ = orientation;
  for (std::size_t axis = 0; axis < 3; ++axis) copyField(blob, file, axis, *cloud);
  if (blob.height == 1 && pcl::getFieldIndex(blob, "ring") >= 0) extras.message = blob;
  extras.fields = std::move(blob);
  return cloud;
}

}  // namespace lisco_apps
