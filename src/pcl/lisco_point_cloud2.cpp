// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <type_traits>
#include <utility>

#include <pcl/console/print.h>
#include <pcl/io/lisco_point_cloud2.h>
#include <pcl/point_types.h>
#include <pcl/segmentation/extract_clusters.h>  // comparePointClusters
#include <pcl/impl/instantiate.hpp>

#include "lisco/return.h"

namespace {

/// Calls visit with a value of the type that a field's number stands for. The first eight are those of sensor_msgs; the
/// others are PCL's, some of them only of its later versions. \return whatever visit does, or fallback if it is none
template <typename Visit, typename Result>
Result withType(std::uint8_t datatype, Visit&& visit, Result fallback) {
  switch (datatype) {
    case 1:
      return visit(std::int8_t{});
    case 2:
      return visit(std::uint8_t{});
    case 3:
      return visit(std::int16_t{});
    case 4:
      return visit(std::uint16_t{});
    case 5:
      return visit(std::int32_t{});
    case 6:
      return visit(std::uint32_t{});
    case 7:
      return visit(float{});
    case 8:
      return visit(double{});
    case 9:
      return visit(std::int64_t{});
    case 10:
      return visit(std::uint64_t{});
    case 11:
      return visit(std::uint8_t{});  // bool
    default:
      return fallback;
  }
}

constexpr std::uint8_t kFloat32 = 7;
constexpr std::uint8_t kFloat64 = 8;

/// Bytes of a number; 0: no such type.
std::size_t sizeOf(std::uint8_t datatype) {
  return withType(
      datatype, [](auto type) { return sizeof(type); }, std::size_t{0});
}

double readNumber(const std::uint8_t* from, std::uint8_t datatype) {
  if (datatype == kFloat32) {  // nearly all are
    float number;
    std::memcpy(&number, from, sizeof(number));
    return static_cast<double>(number);
  }
  return withType(
      datatype,
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

void writeNumber(double value, std::uint8_t* to, std::uint8_t datatype) {
  withType(
      datatype,
      [&](auto number) {
        number = limited<decltype(number)>(value);
        std::memcpy(to, &number, sizeof(number));
        return true;
      },
      false);
}

/// Color is one number of four bytes, whatever its name and type say.
bool isColor(const pcl::detail::LiscoField& field) {
  return (field.name == "rgb" || field.name == "rgba") && field.count == 1 && sizeOf(field.datatype) == 4;
}

bool isLittleEndian() {
  const std::uint16_t one = 1;
  std::uint8_t first = 0;
  std::memcpy(&first, &one, 1);
  return first == 1;
}

/// Points in the order in which a sensor measured them.
struct Firings {
  std::vector<std::uint32_t> column_of_point;
  std::uint32_t columns = 0;
};

/// Cuts points into columns: what lies within most of a firing's duration is one. Several of one row in one firing get
/// columns side by side, so that no two points have the same row and column.
/// \param keys when each point was measured, or at which azimuth; finite
/// \param least_step what differs by less was measured at once
/// \return no columns, if no row has two points that differ
Firings cutFirings(const std::vector<double>& keys, const std::vector<std::uint32_t>& row_of_point, std::size_t rows,
                   double least_step) {
  std::vector<std::uint32_t> order(keys.size());
  std::iota(order.begin(), order.end(), 0U);
  if (!std::is_sorted(keys.begin(), keys.end()))
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return std::pair(keys[a], a) < std::pair(keys[b], b); });

  // From one firing to the next: what one ring's points differ by, if most firings return. Some do not.
  std::vector<double> last(rows, std::numeric_limits<double>::quiet_NaN());
  std::vector<double> steps;
  steps.reserve(keys.size());
  for (const std::uint32_t point : order) {
    double& before = last[row_of_point[point]];
    if (keys[point] - before > least_step) steps.push_back(keys[point] - before);
    before = keys[point];
  }
  Firings firings;
  if (steps.empty()) return firings;
  const auto quarter = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 4);
  std::nth_element(steps.begin(), quarter, steps.end());
  constexpr double kMost = 0.75;  // the lasers of one column fire within so much of the time to the next column
  const double duration = kMost * *quarter;

  firings.column_of_point.resize(keys.size());
  std::vector<std::uint32_t> next_column(rows, 0);
  std::uint32_t first_column = 0;
  double start = keys[order.front()];
  for (const std::uint32_t point : order) {
    if (keys[point] - start >= duration) {
      first_column = firings.columns;
      start = keys[point];
    }
    std::uint32_t& column = next_column[row_of_point[point]];
    column = std::max(column, first_column);
    firings.column_of_point[point] = column++;
    firings.columns = std::max(firings.columns, column);
  }
  return firings;
}

}  // namespace

bool pcl::detail::LiscoMessageReader::open(const PCLPointCloud2& message, const std::vector<LiscoField>& fields,
                                           const char* caller) {
  message_ = &message;
  copies_.clear();
  cells_.clear();
  points_ = width_ = height_ = 0;
  if (message.width == 0 || message.height == 0) {
    if (message.data.empty()) return (true);
    PCL_ERROR("[%s] The message has %zu bytes of data but no points (%zu x %zu).\n", caller, message.data.size(),
              static_cast<std::size_t>(message.width), static_cast<std::size_t>(message.height));
    return (false);
  }
  if (!checkLayout(caller)) return (false);

  for (const auto& [name, field] : {std::pair("x", &x_), {"y", &y_}, {"z", &z_}}) {
    bool is_there = false;
    if (!findField(name, caller, *field, is_there)) return (false);
    if (!is_there) {
      PCL_ERROR("[%s] The message has no field '%s'.\n", caller, name);
      return (false);
    }
    if (field->count != 1 || (field->datatype != kFloat32 && field->datatype != kFloat64)) {
      PCL_ERROR("[%s] Field '%s' must be one FLOAT32 or FLOAT64.\n", caller, name);
      return (false);
    }
  }
  for (const LiscoField& to : fields) {
    LiscoField from;
    bool is_there = false;
    if (!findField(to.name, caller, from, is_there)) return (false);
    if (!is_there && isColor(to) && !findField(to.name == "rgb" ? "rgba" : "rgb", caller, from, is_there))
      return (false);
    if (!is_there) continue;
    const bool is_same_type =
        (from.datatype == to.datatype && from.count == to.count) || (isColor(from) && isColor(to));
    if (is_same_type || (from.count == 1 && to.count == 1 && !isColor(to))) copies_.push_back({from, to, is_same_type});
  }
  return (arrange(caller));
}

bool pcl::detail::LiscoMessageReader::checkLayout(const char* caller) {
  const PCLPointCloud2& message = *message_;
  if ((message.is_bigendian == 0) != isLittleEndian()) {
    PCL_ERROR("[%s] The message's byte order (is_bigendian = %d) is not this machine's.\n", caller,
              static_cast<int>(message.is_bigendian));
    return (false);
  }
  const std::size_t width = message.width;
  const std::size_t height = message.height;
  constexpr auto kMostPoints =
      static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max());  // of the engine, too
  if (width > kMostPoints / height) {
    PCL_ERROR("[%s] The message has %zu x %zu points, more than pcl::index_t can number.\n", caller, width, height);
    return (false);
  }
  const std::size_t point_step = message.point_step;
  const std::size_t row_step = message.row_step;
  const std::size_t bytes = message.data.size();
  if (point_step == 0 || width > bytes / point_step ||
      (height > 1 && row_step != 0 && height - 1 > (bytes - width * point_step) / row_step)) {
    PCL_ERROR("[%s] %zu x %zu points of %zu bytes, in rows of %zu bytes, are not what %zu bytes of data hold.\n",
              caller, width, height, point_step, row_step, bytes);
    return (false);
  }
  if (height > 1 && row_step < width * point_step) {
    PCL_ERROR("[%s] Rows of %zu points of %zu bytes do not fit into a row_step of %zu.\n", caller, width, point_step,
              row_step);
    return (false);
  }
  points_ = width * height;
  return (true);
}

bool pcl::detail::LiscoMessageReader::findField(const std::string& name, const char* caller, LiscoField& field,
                                                bool& is_there) const {
  const auto found = std::find_if(message_->fields.begin(), message_->fields.end(),
                                  [&](const PCLPointField& candidate) { return (candidate.name == name); });
  is_there = found != message_->fields.end();
  if (!is_there) return (true);
  field = {name, found->offset, found->datatype, std::max<std::size_t>(1, found->count)};  // some drivers write 0
  const std::size_t size = sizeOf(field.datatype);
  if (size == 0) {
    PCL_ERROR("[%s] Field '%s' is of the unknown type %d.\n", caller, name.c_str(), static_cast<int>(field.datatype));
    return (false);
  }
  const std::size_t point_step = message_->point_step;
  if (field.offset > point_step || field.count > (point_step - field.offset) / size) {
    PCL_ERROR("[%s] Field '%s' (%zu bytes at offset %zu) reaches beyond a point_step of %zu.\n", caller, name.c_str(),
              size * field.count, field.offset, point_step);
    return (false);
  }
  return (true);
}

bool pcl::detail::LiscoMessageReader::arrange(const char* caller) {
  LiscoField ring;
  bool has_ring = false;
  for (const char* const name : {"ring", "channel"})
    if (!has_ring && !findField(name, caller, ring, has_ring)) return (false);
  if (has_ring && ring.count != 1) {
    PCL_ERROR("[%s] Field '%s' has %zu elements.\n", caller, ring.name.c_str(), ring.count);
    return (false);
  }
  if (has_ring && message_->height == 1) {
    std::vector<double> keys;
    for (const char* const name : {"time", "t", "timestamp", "time_stamp"}) {
      LiscoField time;
      bool has_time = false;
      if (!findField(name, caller, time, has_time)) return (false);
      if (!has_time) continue;
      if (time.count != 1) {
        PCL_ERROR("[%s] Field '%s' has %zu elements.\n", caller, name, time.count);
        return (false);
      }
      keys.resize(points_);
      for (std::size_t point = 0; point < points_; ++point)
        keys[point] = readNumber(pointAt(point) + time.offset, time.datatype);
      if (arrangeByRings(ring, keys)) return (true);
    }
    keys.clear();
    if (arrangeByRings(ring, keys)) return (true);
  }

  // As it is.
  cells_.resize(points_);
  width_ = message_->width;
  height_ = message_->height;
  if (has_ring && height_ > 1 && width_ > 1 && rowsAreFirings(ring)) {
    std::swap(width_, height_);
    for (std::size_t cell = 0; cell < points_; ++cell)
      cells_[cell] = static_cast<index_t>(cell % width_ * height_ + cell / width_);
  } else {
    std::iota(cells_.begin(), cells_.end(), index_t{0});
  }
  return (true);
}

/// \param keys of all points: times; empty: azimuths
/// \return whether these rings and keys made a sensible arrangement
bool pcl::detail::LiscoMessageReader::arrangeByRings(const LiscoField& ring, std::vector<double>& keys) {
  constexpr std::size_t kMostRings = 65536;
  constexpr std::uint32_t kNone = ~std::uint32_t{0};
  constexpr double kLeastAzimuthStep = 2e-4;  // radians: less than any sensor's, more than rounding of coordinates
  const bool by_azimuth = keys.empty();

  Indices returns;
  std::vector<std::uint32_t> rows;
  std::vector<double> keys_of_returns;
  returns.reserve(points_);
  rows.reserve(points_);
  keys_of_returns.reserve(points_);
  std::vector<std::uint32_t> row_of_ring(kMostRings, kNone);
  for (std::size_t point = 0; point < points_; ++point) {
    const std::uint8_t* const bytes = pointAt(point);
    const auto x = limited<float>(readNumber(bytes + x_.offset, x_.datatype));
    const auto y = limited<float>(readNumber(bytes + y_.offset, y_.datatype));
    const auto z = limited<float>(readNumber(bytes + z_.offset, z_.datatype));
    if (!lisco::isReturn(x, y, z)) continue;
    const double number = readNumber(bytes + ring.offset, ring.datatype);
    const double key = by_azimuth ? static_cast<double>(std::atan2(y, x)) : keys[point];
    if (!(number >= 0 && number < static_cast<double>(kMostRings)) || !std::isfinite(key)) return (false);
    returns.push_back(static_cast<index_t>(point));
    rows.push_back(static_cast<std::uint32_t>(number));
    keys_of_returns.push_back(key);
    row_of_ring[rows.back()] = 0;
  }
  if (returns.empty()) return (false);
  std::uint32_t height = 0;
  for (std::uint32_t& row : row_of_ring)
    if (row != kNone) row = height++;
  for (std::uint32_t& row : rows) row = row_of_ring[row];

  const Firings firings = cutFirings(keys_of_returns, rows, height, by_azimuth ? kLeastAzimuthStep : 0.0);
  constexpr std::size_t kMostCellsPerPoint = 16;
  const std::size_t most_cells = std::min(std::max(kMostCellsPerPoint * points_, std::size_t{65536}),
                                          static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()));
  if (firings.columns == 0 || firings.columns > most_cells / height) return (false);
  width_ = firings.columns;
  height_ = height;
  cells_.assign(width_ * height_, UNAVAILABLE);
  for (std::size_t i = 0; i < returns.size(); ++i) cells_[rows[i] * width_ + firings.column_of_point[i]] = returns[i];
  return (true);
}

/// Whether ring numbers change along the rows and not from row to row.
bool pcl::detail::LiscoMessageReader::rowsAreFirings(const LiscoField& ring) const {
  const std::size_t width = message_->width;
  const auto ring_at = [&](std::size_t point) { return (readNumber(pointAt(point) + ring.offset, ring.datatype)); };
  std::size_t same_along_rows = 0;
  std::size_t same_along_columns = 0;
  for (std::size_t point = 0; point + width < points_; ++point) {
    const double number = ring_at(point);
    if (point % width + 1 < width && number == ring_at(point + 1)) ++same_along_rows;
    if (number == ring_at(point + width)) ++same_along_columns;
  }
  return (same_along_columns > same_along_rows);
}

const std::uint8_t* pcl::detail::LiscoMessageReader::pointAt(std::size_t index) const {
  const std::size_t width = message_->width;
  if (message_->height == 1) return (message_->data.data() + index * message_->point_step);
  return (message_->data.data() + index / width * message_->row_step + index % width * message_->point_step);
}

void pcl::detail::LiscoMessageReader::copyPoint(index_t index, std::uint8_t* point) const {
  const std::uint8_t* const bytes = pointAt(static_cast<std::size_t>(index));
  for (const Copy& copy : copies_)
    if (copy.is_same_type)
      std::memcpy(point + copy.to.offset, bytes + copy.from.offset, sizeOf(copy.to.datatype) * copy.to.count);
    else
      writeNumber(readNumber(bytes + copy.from.offset, copy.from.datatype), point + copy.to.offset, copy.to.datatype);
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
      clusters[cluster_of_point[point]].indices.push_back(static_cast<index_t>(point));  // there is room
  // What extract () does: clusters by their first points, then PCL's own call.
  std::sort(clusters.begin(), clusters.end(),
            [](const PointIndices& a, const PointIndices& b) { return (a.indices < b.indices); });
  std::sort(clusters.rbegin(), clusters.rend(), comparePointClusters);
  return (true);
}
