// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// NumPy's arrays: a magic, a version, the length of a header, the header (a Python dictionary of descr, fortran_order
// and shape), and the values. Clouds are N x 3 or more (x y z first), or rows x columns x 3 or more.
#include <cstring>
#include <regex>

#include <boost/endian/conversion.hpp>

#include "io/float_table.h"
#include "io/formats.h"

namespace lisco_apps {
namespace {

constexpr std::string_view kMagic = "\x93NUMPY";

struct Array {
  char order = '<';         ///< of bytes: '<' little-endian, '>' big-endian
  std::size_t bytes = 4;    ///< of a value
  bool is_fortran = false;  ///< the first index runs fastest
  std::vector<std::size_t> shape;
  std::size_t data_at = 0;
};

std::string valueOf(const std::string& header, const std::string& key, const std::string& pattern) {
  std::smatch found;
  return std::regex_search(header, found, std::regex("['\"]" + key + "['\"]\\s*:\\s*" + pattern)) ? found[1].str()
                                                                                                  : std::string();
}

Array headerOf(const fs::path& file, const std::string& content) {
  constexpr std::size_t kMaxHeader = 2048;
  if (content.size() < 12 || content.compare(0, kMagic.size(), kMagic) != 0) fail(file, "is no npy file");
  const auto* const bytes = reinterpret_cast<const unsigned char*>(content.data());
  const unsigned version = bytes[6];
  if (version < 1 || version > 3) fail(file, "is a npy file of an unknown version");
  const std::size_t start = version == 1 ? 10 : 12;
  const std::size_t length =
      version == 1 ? boost::endian::load_little_u16(bytes + 8) : boost::endian::load_little_u32(bytes + 8);
  if (length > kMaxHeader || length > content.size() - start)
    fail(file, "is truncated or damaged: its header breaks off");
  const std::string header = content.substr(start, length);

  Array array;
  array.data_at = start + length;
  const std::string type = valueOf(header, "descr", "['\"]([<>|=][a-zA-Z][0-9]{1,3})['\"]");
  if (type != "<f4" && type != "<f8" && type != ">f4" && type != ">f8")
    fail(file, "holds values that are neither float32 nor float64" + (type.empty() ? "" : " (" + type + ")"));
  array.order = type[0];
  array.bytes = type[2] == '4' ? sizeof(float) : sizeof(double);
  const std::string fortran = valueOf(header, "fortran_order", "(True|False)");
  if (fortran.empty()) fail(file, "is a damaged npy file: its header says no fortran_order");
  array.is_fortran = fortran == "True";
  const std::string shape = valueOf(header, "shape", "\\(([0-9, ]*)\\)");
  const std::regex number("[0-9]{1,9}");
  for (std::sregex_iterator at(shape.begin(), shape.end(), number), end; at != end; ++at)
    array.shape.push_back(static_cast<std::size_t>(std::stoul(at->str())));
  return array;
}

template <typename Value>
float valueAt(const unsigned char* from, char order) {
  using boost::endian::endian_load;
  return static_cast<float>(order == '<' ? endian_load<Value, sizeof(Value), boost::endian::order::little>(from)
                                         : endian_load<Value, sizeof(Value), boost::endian::order::big>(from));
}

}  // namespace

Cloud::Ptr readNpy(const fs::path& file, const ReadOptions& /*options*/, ReadExtras& extras) {
  const std::string content = wholeContentOf(file);
  const Array array = headerOf(file, content);
  std::string shape;
  std::size_t values = 1;
  for (const std::size_t size : array.shape) {
    shape += (shape.empty() ? "" : " x ") + std::to_string(size);
    if (size != 0 && values > content.size() / size) fail(file, "is truncated: it holds fewer values than " + shape);
    values *= size;
  }
  const bool is_organized = array.shape.size() == 3;
  if ((array.shape.size() != 2 && !is_organized) || array.shape.back() < kMinFields)
    fail(file, "is an array of " + (shape.empty() ? "one value" : shape) +
                   "; a cloud is N x 3 or more, or rows x columns x 3 or more");
  if (values > (content.size() - array.data_at) / array.bytes)
    fail(file, "is truncated: it holds fewer values than " + shape);
  if (values == 0) fail(file, "holds no points");

  FloatTable table;
  table.fields = array.shape.back();
  table.values.resize(values);
  const std::size_t points = values / table.fields;
  const std::size_t columns = is_organized ? array.shape[1] : 1;
  const std::size_t rows = points / columns;
  const auto* const data = reinterpret_cast<const unsigned char*>(content.data()) + array.data_at;
  for (std::size_t i = 0; i < values; ++i) {
    const std::size_t field = i % table.fields;
    const std::size_t column = i / table.fields % columns;
    const std::size_t row = i / table.fields / columns;
    const std::size_t at = array.is_fortran ? row + rows * (column + columns * field) : i;
    table.values[i] = array.bytes == sizeof(float) ? valueAt<float>(data + at * array.bytes, array.order)
                                                   : valueAt<double>(data + at * array.bytes, array.order);
  }
  const Cloud::Ptr cloud = cloudOf(table, false, extras);
  if (!is_organized || rows == 1) return cloud;
  cloud->width = static_cast<std::uint32_t>(columns);
  cloud->height = static_cast<std::uint32_t>(rows);
  pcl::PCLPointCloud2 fields = std::move(extras.fields);
  fields.width = cloud->width;
  fields.height = cloud->height;
  fields.row_step = fields.point_step * fields.width;
  extras = {};
  extras.fields = std::move(fields);
  return cloud;
}

}  // namespace lisco_apps
