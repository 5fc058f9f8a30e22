// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <pcl/console/print.h>
#include <pcl/io/lisco_point_cloud2.h>
#include <pcl/point_types.h>
#include <pcl/segmentation/lisco_cluster_writer.h>

#include "lisco/return.h"
#include "pcl/firings.h"

namespace {

/// Calls visit with a value of the type that a field's number stands for. The first eight are those of sensor_msgs; the
/// others are PCL's, some of them only of its later versions. \return the result of visit; fallback for other numbers
template <typename Visit, typename Result>
Result withType(std::uint8_t datatype, Visit&& visit, Result fallback) {
  if (datatype == 1) return visit(std::int8_t{});
  if (datatype == 2) return visit(std::uint8_t{});
  if (datatype == 3) return visit(std::int16_t{});
  if (datatype == 4) return visit(std::uint16_t{});
  if (datatype == 5) return visit(std::int32_t{});
  if (datatype == 6) return visit(std::uint32_t{});
  if (datatype == 7) return visit(float{});
  if (datatype == 8) return visit(double{});
  if (datatype == 9) return visit(std::int64_t{});
  if (datatype == 10) return visit(std::uint64_t{});
  if (datatype == 11) return visit(std::uint8_t{});  // bool
  return fallback;
}

constexpr std::uint8_t kFloat32 = 7;
constexpr std::uint8_t kFloat64 = 8;
constexpr auto kMaxPoints = static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max());  // of the engine, too

/// Throws the error of a message, a sentence from its parts.
template <typename... Parts>
[[noreturn]] void reject(const Parts&... parts) {
  std::ostringstream sentence;
  (sentence << ... << parts);
  throw std::invalid_argument(sentence.str());
}

/// Bytes of a number; 0: no such type.
std::size_t sizeOf(std::uint8_t datatype) {
  return withType(
      datatype, [](auto type) { return sizeof(type); }, std::size_t{0});
}

double readNumber(const std::uint8_t* point, const pcl::PCLPointField& field) {
  const std::uint8_t* const from = point + field.offset;
  if (field.datatype == kFloat32) {  // the most frequent type
    float number;
    std::memcpy(&number, from, sizeof(number));
    return static_cast<double>(number);
  }
  return withType(
      field.datatype,
      [from](auto number) {
        std::memcpy(&number, from, sizeof(number));
        return static_cast<double>(number);
      },
      0.0);
}

template <typename Number>
Number limited(double value) {
  using Limits = std::numeric_limits<Number>;
  if constexpr (std::is_floating_point_v<Number>) {
    if (std::fabs(value) > static_cast<double>(Limits::max()))
      return value < 0 ? -Limits::infinity() : Limits::infinity();
  } else {
    if (std::isnan(value)) return 0;
    if (value <= static_cast<double>(Limits::lowest())) return Limits::lowest();
    if (value >= static_cast<double>(Limits::max())) return Limits::max();
  }
  return static_cast<Number>(value);
}

void writeNumber(double value, std::uint8_t* point, const pcl::PCLPointField& field) {
  withType(
      field.datatype,
      [&](auto number) {
        number = limited<decltype(number)>(value);
        std::memcpy(point + field.offset, &number, sizeof(number));
        return true;
      },
      false);
}

/// Colour is one number of four bytes: float or integer, named rgb or rgba.
bool isColor(const pcl::PCLPointField& field) {
  return (field.name == "rgb" || field.name == "rgba") && field.count == 1 && sizeOf(field.datatype) == 4;
}

bool isLittleEndian() {
  const std::uint16_t one = 1;
  std::uint8_t first = 0;
  std::memcpy(&first, &one, 1);
  return first == 1;
}

}  // namespace

/// The message that is read, and the cells of its points.
class pcl::detail::LiscoMessageReader::State {
 public:
  // These throw std::invalid_argument if the message is not valid.
  State(const PCLPointCloud2& message, const std::vector<PCLPointField>& fields) : message_(message) {
    checkLayout();
    if (points_ == 0) return;
    selectFields(fields);
    arrange();
  }

  Indices& cells() { return cells_; }
  std::size_t width() const { return width_; }
  std::size_t height() const { return height_; }
  void copyPoint(index_t index, std::uint8_t* point) const;

 private:
  /// From a field of the message to one of the point.
  struct Copy {
    PCLPointField from, to;
    bool is_same_type;
  };

  void checkLayout();
  void selectFields(const std::vector<PCLPointField>& fields);
  void arrange();
  std::optional<PCLPointField> findField(const std::string& name) const;
  std::optional<PCLPointField> findNumber(const std::string& name) const;
  bool arrangeByRings(const PCLPointField& ring, const PCLPointField* time);
  bool rowsAreFirings(const PCLPointField& ring) const;
  const std::uint8_t* pointAt(std::size_t index) const;

  const PCLPointCloud2& message_;
  std::size_t points_ = 0;
  PCLPointField x_, y_, z_;
  std::vector<Copy> copies_;
  Indices cells_;
  std::size_t width_ = 0, height_ = 0;
};

pcl::detail::LiscoMessageReader::LiscoMessageReader() = default;
pcl::detail::LiscoMessageReader::~LiscoMessageReader() = default;

bool pcl::detail::LiscoMessageReader::open(const PCLPointCloud2& message, const std::vector<PCLPointField>& fields,
                                           const char* caller, Indices& cells) {
  try {
    state_ = std::make_unique<State>(message, fields);
  } catch (const std::invalid_argument& error) {
    PCL_ERROR("[%s] %s\n", caller, error.what());
    return (false);
  }
  cells.swap(state_->cells());
  return (true);
}

std::uint32_t pcl::detail::LiscoMessageReader::width() const {
  return (static_cast<std::uint32_t>(state_->width()));
}
std::uint32_t pcl::detail::LiscoMessageReader::height() const {
  return (static_cast<std::uint32_t>(state_->height()));
}
void pcl::detail::LiscoMessageReader::copyPoint(index_t index, std::uint8_t* point) const {
  state_->copyPoint(index, point);
}

void pcl::detail::LiscoMessageReader::State::checkLayout() {
  const std::size_t width = message_.width;
  const std::size_t height = message_.height;
  const std::size_t point_step = message_.point_step;
  const std::size_t row_step = message_.row_step;
  const std::size_t bytes = message_.data.size();
  if (width == 0 || height == 0) {
    if (bytes > 0) reject("The message has ", bytes, " bytes of data but no points (", width, " x ", height, ").");
    return;
  }
  if ((message_.is_bigendian == 0) != isLittleEndian())
    reject("The message's byte order (is_bigendian = ", +message_.is_bigendian, ") is not this machine's.");
  if (width > kMaxPoints / height)
    reject("The message has ", width, " x ", height, " points, more than pcl::index_t can number.");
  if (point_step == 0 || width > bytes / point_step ||
      (height > 1 && row_step != 0 && height - 1 > (bytes - width * point_step) / row_step))
    reject(width, " x ", height, " points of ", point_step, " bytes, in rows of ", row_step, " bytes, are not what ",
           bytes, " bytes of data hold.");
  if (height > 1 && row_step < width * point_step)
    reject("Rows of ", width, " points of ", point_step, " bytes do not fit into a row_step of ", row_step, ".");
  points_ = width * height;
}

void pcl::detail::LiscoMessageReader::State::selectFields(const std::vector<PCLPointField>& fields) {
  for (const auto& [name, field] : {std::pair("x", &x_), {"y", &y_}, {"z", &z_}}) {
    const auto found = findField(name);
    if (!found) reject("The message has no field '", name, "'.");
    if (found->count != 1 || (found->datatype != kFloat32 && found->datatype != kFloat64))
      reject("Field '", name, "' must be one FLOAT32 or FLOAT64.");
    *field = *found;
  }
  for (const PCLPointField& to : fields) {
    auto from = findField(to.name);
    if (!from && isColor(to)) from = findField(to.name == "rgb" ? "rgba" : "rgb");
    if (!from) continue;
    const bool is_same_type =
        (from->datatype == to.datatype && from->count == to.count) || (isColor(*from) && isColor(to));
    if (is_same_type || (from->count == 1 && to.count == 1 && !isColor(to)))
      copies_.push_back({*from, to, is_same_type});
  }
}

/// \return the field of this name, which lies within the points and is of a known type; nullopt if there is none
std::optional<pcl::PCLPointField> pcl::detail::LiscoMessageReader::State::findField(const std::string& name) const {
  for (PCLPointField field : message_.fields) {
    if (field.name != name) continue;
    if (field.count == 0) field.count = 1;  // as some drivers write it
    const std::size_t size = sizeOf(field.datatype);
    if (size == 0) reject("Field '", name, "' is of the unknown type ", +field.datatype, ".");
    const std::size_t point_step = message_.point_step;
    if (field.offset > point_step || field.count > (point_step - field.offset) / size)
      reject("Field '", name, "' (", size * field.count, " bytes at offset ", field.offset,
             ") reaches beyond a point_step of ", point_step, ".");
    return (field);
  }
  return (std::nullopt);
}

/// The same for a field that must have one element.
std::optional<pcl::PCLPointField> pcl::detail::LiscoMessageReader::State::findNumber(const std::string& name) const {
  auto field = findField(name);
  if (field && field->count != 1) reject("Field '", name, "' has ", field->count, " elements.");
  return (field);
}

void pcl::detail::LiscoMessageReader::State::arrange() {
  auto ring = findNumber("ring");
  if (!ring) ring = findNumber("channel");
  if (ring && message_.height == 1) {
    for (const char* const name : {"time", "t", "timestamp", "time_stamp"})
      if (const auto time = findNumber(name); time && arrangeByRings(*ring, &*time)) return;
    if (arrangeByRings(*ring, nullptr)) return;
  }

  // As it is.
  cells_.resize(points_);
  width_ = message_.width;
  height_ = message_.height;
  if (ring && height_ > 1 && width_ > 1 && rowsAreFirings(*ring)) {
    std::swap(width_, height_);
    for (std::size_t cell = 0; cell < points_; ++cell)
      cells_[cell] = static_cast<index_t>(cell % width_ * height_ + cell / width_);
  } else {
    std::iota(cells_.begin(), cells_.end(), index_t{0});
  }
}

/// \param time the field by which points are ordered; nullptr: by their azimuths
/// \return false if the rings and times give no arrangement: a value is out of range, no time differs from another, or
/// most cells would be empty
bool pcl::detail::LiscoMessageReader::State::arrangeByRings(const PCLPointField& ring, const PCLPointField* time) {
  constexpr std::size_t kMaxRings = 65536;
  constexpr std::uint32_t kNone = ~std::uint32_t{0};
  constexpr double kMinAzimuthStep = 2e-4;  // radians: less than any sensor's, more than rounding of coordinates

  Indices returns;
  std::vector<std::uint32_t> rows;
  std::vector<double> keys;
  returns.reserve(points_);
  rows.reserve(points_);
  keys.reserve(points_);
  std::vector<std::uint32_t> row_of_ring(kMaxRings, kNone);
  for (std::size_t point = 0; point < points_; ++point) {
    const std::uint8_t* const bytes = pointAt(point);
    const auto x = limited<float>(readNumber(bytes, x_));
    const auto y = limited<float>(readNumber(bytes, y_));
    const auto z = limited<float>(readNumber(bytes, z_));
    if (!lisco::isReturn(x, y, z)) continue;
    const double number = readNumber(bytes, ring);
    const double key = time ? readNumber(bytes, *time) : static_cast<double>(std::atan2(y, x));
    if (!(number >= 0 && number < static_cast<double>(kMaxRings)) || !std::isfinite(key)) return (false);
    returns.push_back(static_cast<index_t>(point));
    rows.push_back(static_cast<std::uint32_t>(number));
    keys.push_back(key);
    row_of_ring[rows.back()] = 0;
  }
  if (returns.empty()) return (false);
  std::uint32_t height = 0;
  for (std::uint32_t& row : row_of_ring)
    if (row != kNone) row = height++;
  for (std::uint32_t& row : rows) row = row_of_ring[row];

  const Firings firings = cutFirings(keys, rows, height, time ? 0.0 : kMinAzimuthStep);
  constexpr std::size_t kMaxCellsPerPoint = 16;
  constexpr std::size_t kMaxCellsOfFewPoints = 65536;
  const std::size_t max_cells = std::min(std::max(kMaxCellsPerPoint * points_, kMaxCellsOfFewPoints), kMaxPoints);
  if (firings.columns == 0 || firings.columns > max_cells / height) return (false);
  width_ = firings.columns;
  height_ = height;
  cells_.assign(width_ * height_, UNAVAILABLE);
  for (std::size_t i = 0; i < returns.size(); ++i) cells_[rows[i] * width_ + firings.column_of_point[i]] = returns[i];
  return (true);
}

/// Whether ring numbers change along the rows rather than from row to row.
bool pcl::detail::LiscoMessageReader::State::rowsAreFirings(const PCLPointField& ring) const {
  const std::size_t width = message_.width;
  const auto ring_at = [&](std::size_t point) { return (readNumber(pointAt(point), ring)); };
  std::size_t same_along_rows = 0;
  std::size_t same_along_columns = 0;
  for (std::size_t point = 0; point + width < points_; ++point) {
    const double number = ring_at(point);
    if (point % width + 1 < width && number == ring_at(point + 1)) ++same_along_rows;
    if (number == ring_at(point + width)) ++same_along_columns;
  }
  return (same_along_columns > same_along_rows);
}

const std::uint8_t* pcl::detail::LiscoMessageReader::State::pointAt(std::size_t index) const {
  const std::size_t width = message_.width;
  if (message_.height == 1) return (message_.data.data() + index * message_.point_step);
  return (message_.data.data() + index / width * message_.row_step + index % width * message_.point_step);
}

void pcl::detail::LiscoMessageReader::State::copyPoint(index_t index, std::uint8_t* point) const {
  const std::uint8_t* const bytes = pointAt(static_cast<std::size_t>(index));
  for (const Copy& copy : copies_)
    if (copy.is_same_type)
      std::memcpy(point + copy.to.offset, bytes + copy.from.offset, sizeOf(copy.to.datatype) * copy.to.count);
    else
      writeNumber(readNumber(bytes, copy.from), point, copy.to);
}

bool pcl::mapLiscoClusters(const Indices& point_of_cell, std::vector<PointIndices>& clusters) {
  const auto fail = [&](index_t index, const char* what) {
    PCL_ERROR("[pcl::mapLiscoClusters] Index %lld is %s.\n", static_cast<long long>(index), what);
    clusters.clear();
    return (false);
  };
  index_t points = 0;
  for (const auto& point : point_of_cell)
    if (point != UNAVAILABLE) points = std::max(points, static_cast<index_t>(point + 1));
  constexpr std::size_t kNone = ~std::size_t{0};
  std::vector<std::size_t> cluster_of_point(static_cast<std::size_t>(points), kNone);
  for (std::size_t number = 0; number < clusters.size(); ++number) {
    for (const auto& index : clusters[number].indices) {
      const auto cell = static_cast<std::size_t>(index);
      if (index < 0 || cell >= point_of_cell.size() || point_of_cell[cell] == UNAVAILABLE)
        return (fail(index, "not one of a cell with a point"));
      auto& cluster = cluster_of_point[static_cast<std::size_t>(point_of_cell[cell])];
      if (cluster != kNone) return (fail(index, "in two clusters, or twice in one"));
      cluster = number;
    }
    clusters[number].indices.clear();
  }
  for (std::size_t point = 0; point < cluster_of_point.size(); ++point)
    if (cluster_of_point[point] != kNone)
      clusters[cluster_of_point[point]].indices.push_back(static_cast<index_t>(point));
  // The order of extract (): clusters by their first points, then PCL's own sort.
  std::sort(clusters.begin(), clusters.end(),
            [](const PointIndices& a, const PointIndices& b) { return (a.indices < b.indices); });
  detail::sortLiscoClusters(clusters);
  return (true);
}
