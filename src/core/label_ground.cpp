// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "lisco/label_ground.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "core/pi.h"
#include "lisco/ground_filter.h"

namespace lisco {
namespace {

void check(const void* points, std::size_t count, std::size_t stride, const LabelGroundParameters& parameters,
           const std::uint8_t* ground) {
  if (stride < 3 * sizeof(float))
    throw std::invalid_argument("lisco::labelGround: the stride must be 12 bytes or more");
  if (count >= std::size_t{1} << 31)
    throw std::invalid_argument("lisco::labelGround: the number of points must be below 2^31");
  if (parameters.lasers == 0 || count % parameters.lasers != 0)
    throw std::invalid_argument("lisco::labelGround: the number of points must be a multiple of the lasers");
  if (count > 0 && (points == nullptr || ground == nullptr))
    throw std::invalid_argument("lisco::labelGround: points and ground must not be null");
}

/// The returns among points, sorted into columns of the same azimuth and rows of about the same elevation.
class AzimuthColumns {
 public:
  template <typename PointAt>
  AzimuthColumns(std::size_t count, const std::array<float, 3>& origin, const PointAt& point_at) {
    std::vector<std::uint16_t> bin_of(count);
    std::vector<std::uint32_t> sizes(kBins, 0);  // of the bins
    for (std::size_t i = 0; i < count; ++i) {
      const Return point = point_at(i);
      if (!isReturn(point.x, point.y, point.z)) {
        bin_of[i] = kBins;
        continue;
      }
      const double azimuth = std::atan2(static_cast<double>(point.y) - static_cast<double>(origin[1]),
                                        static_cast<double>(point.x) - static_cast<double>(origin[0]));
      const double part = (azimuth + kPi) / (2.0 * kPi) * static_cast<double>(kBins);
      bin_of[i] = static_cast<std::uint16_t>(std::clamp(part, 0.0, static_cast<double>(kBins - 1)));
      ++sizes[bin_of[i]];
    }
    const unsigned shift = widen(sizes);
    std::vector<std::uint32_t> ends(1, 0);
    std::size_t taken = 0;
    for (const std::uint32_t size : sizes) {
      ends.push_back(ends.back() + size);
      taken += size > 0 ? 1 : 0;
    }
    const std::size_t returns = ends.back();
    // Columns are about as long as bins are on average, so that few cells stay empty.
    rows_ = std::max<std::size_t>(16, 3 * returns / (2 * std::max<std::size_t>(taken, 1)) + 1);
    points_.resize(returns);
    std::vector<std::uint32_t> next(ends.begin(), ends.end() - 1);
    for (std::size_t i = 0; i < count; ++i)
      if (bin_of[i] < kBins) points_[next[bin_of[i] >> shift]++] = static_cast<std::uint32_t>(i);
    std::vector<float> slopes(count);  // of the rays
    std::vector<float> sorted;
    for (const std::uint32_t i : points_) {
      const Return point = point_at(i);
      slopes[i] = (point.z - origin[2]) / std::max(std::hypot(point.x - origin[0], point.y - origin[1]), 1e-6F);
      sorted.push_back(slopes[i]);
    }
    std::sort(sorted.begin(), sorted.end());
    std::vector<float> lowest(rows_);  // slope of a row's rays
    for (std::size_t row = 0; row < rows_ && returns > 0; ++row) lowest[row] = sorted[row * returns / rows_];
    for (std::size_t bin = 0; bin < sizes.size(); ++bin) {
      const auto begin = points_.begin() + ends[bin], end = points_.begin() + ends[bin + 1];
      std::sort(begin, end, [&](std::uint32_t a, std::uint32_t b) {
        return slopes[a] != slopes[b] ? slopes[a] < slopes[b] : a < b;
      });
      const auto size = static_cast<std::size_t>(end - begin);
      // A bin of many points makes several columns, each of them with rays of all elevations.
      const std::size_t columns = (size + rows_ - 1) / rows_;
      for (std::size_t column = 0; column < columns; ++column) {
        cells_.resize(cells_.size() + rows_, kNone);
        std::size_t* const cells = &cells_[cells_.size() - rows_];
        std::size_t free = 0;
        std::size_t left = (size - column + columns - 1) / columns;
        for (std::size_t i = column; i < size; i += columns) {
          const float slope = slopes[begin[static_cast<std::ptrdiff_t>(i)]];
          const auto row =
              static_cast<std::size_t>(std::upper_bound(lowest.begin() + 1, lowest.end(), slope) - lowest.begin() - 1);
          free = std::min(std::max(free, row), rows_ - left--);
          cells[free++] = begin[static_cast<std::ptrdiff_t>(i)];
        }
      }
    }
  }

  std::size_t rows() const { return rows_; }
  std::size_t columns() const { return cells_.size() / rows_; }

  static constexpr std::size_t kNone = ~std::size_t{0};
  /// The number of the point in a cell, or kNone.
  std::size_t pointAt(std::size_t row, std::size_t column) const { return cells_[column * rows_ + row]; }

 private:
  static constexpr std::size_t kBins = 2048;      ///< of azimuth, before widen ()
  static constexpr std::size_t kWidestBins = 64;  ///< of a turn

  /// Joins pairs of bins until most of those with returns are followed by one: a bin narrower than the sensor's step
  /// would be empty beside a bin of a whole column. \return how often
  static unsigned widen(std::vector<std::uint32_t>& sizes) {
    unsigned shift = 0;
    for (; sizes.size() > kWidestBins; ++shift) {
      std::size_t taken = 0;
      std::size_t followed = 0;
      for (std::size_t bin = 0; bin < sizes.size(); ++bin) {
        if (sizes[bin] == 0) continue;
        ++taken;
        followed += sizes[(bin + 1) % sizes.size()] > 0 ? 1 : 0;
      }
      if (4 * followed >= 3 * taken) break;
      for (std::size_t bin = 0; bin < sizes.size() / 2; ++bin) sizes[bin] = sizes[2 * bin] + sizes[2 * bin + 1];
      sizes.resize(sizes.size() / 2);
    }
    return shift;
  }

  std::size_t rows_ = 0;
  std::vector<std::uint32_t> points_;  // bin by bin
  std::vector<std::size_t> cells_;     // column by column, from the lowest ray up
};

}  // namespace

void labelGround(const void* points, std::size_t count, std::size_t stride, const LabelGroundParameters& parameters,
                 std::uint8_t* ground) {
  check(points, count, stride, parameters, ground);
  const auto* const bytes = static_cast<const unsigned char*>(points);
  const auto point_at = [=](std::size_t point) {
    float xyz[3];
    std::memcpy(xyz, bytes + point * stride, sizeof xyz);
    return Return{xyz[0], xyz[1], xyz[2], static_cast<std::uint32_t>(point)};
  };
  GroundParameters filter_parameters;
  filter_parameters.sensor_height = parameters.sensor_height;
  filter_parameters.max_slope = parameters.max_slope;
  GroundFilter filter;
  filter.begin(filter_parameters, 0);  // rejects bad parameters, even without points
  if (count == 0) return;

  const std::size_t width = count / parameters.lasers;
  const auto cell_at = [=](std::size_t laser, std::size_t column) { return point_at(laser * width + column); };
  SensorHints& sensor = filter_parameters.sensor;
  if (parameters.lasers > 1) sensor = estimateSensor(width, parameters.lasers, parameters.origin, CellSource(cell_at));
  if (sensor.steps_per_turn != 0) {
    filter.filterScan(filter_parameters, width, parameters.lasers, cell_at, ground);
    return;
  }
  std::fill_n(ground, count, std::uint8_t{0});
  const AzimuthColumns sorted(count, parameters.origin, point_at);
  const auto sorted_cell_at = [&](std::size_t row, std::size_t column) {
    const std::size_t point = sorted.pointAt(row, column);
    return point == AzimuthColumns::kNone ? kNoReturn : point_at(point);
  };
  sensor = SensorHints();
  sensor.origin = parameters.origin;
  std::vector<std::uint8_t> decisions(sorted.rows() * sorted.columns());
  filter.filterScan(filter_parameters, sorted.columns(), sorted.rows(), sorted_cell_at, decisions.data());
  for (std::size_t row = 0; row < sorted.rows(); ++row)
    for (std::size_t column = 0; column < sorted.columns(); ++column)
      if (const std::size_t point = sorted.pointAt(row, column); point != AzimuthColumns::kNone)
        ground[point] = decisions[row * sorted.columns() + column];
}

}  // namespace lisco
