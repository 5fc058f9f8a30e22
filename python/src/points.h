// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <pybind11/numpy.h>

#include <array>
#include <cstddef>
#include <cstring>
#include <stdexcept>

#include "lisco/strided_points.h"

namespace lisco_python {

namespace py = pybind11;

/// Three arrays of one shape (lasers, columns) in place: x, y and z, each of floats or doubles at any address and
/// strides. Doubles are rounded to floats as they are read. Holds no reference: the arrays must live on.
class Points {
 public:
  Points(const py::array& x, const py::array& y, const py::array& z) : axes_{axisOf(x), axisOf(y), axisOf(z)} {
    if (x.ndim() != 2 || y.ndim() != 2 || z.ndim() != 2) throw std::invalid_argument("x, y and z must have two axes");
    for (const py::ssize_t axis : {0, 1})
      if (x.shape(axis) != y.shape(axis) || x.shape(axis) != z.shape(axis))
        throw std::invalid_argument("x, y and z must have the same shape");
    lasers_ = static_cast<std::size_t>(x.shape(0));
    columns_ = static_cast<std::size_t>(x.shape(1));
    const char* const data = axes_[0].data;
    is_interleaved_ = true;
    for (std::size_t i = 0; i < axes_.size(); ++i)
      is_interleaved_ = is_interleaved_ && !axes_[i].is_double && axes_[i].data == data + i * sizeof(float) &&
                        axes_[i].laser_stride == axes_[0].laser_stride &&
                        axes_[i].column_stride == axes_[0].column_stride;
  }

  std::size_t lasers() const { return lasers_; }
  std::size_t columns() const { return columns_; }

  /// As lisco::CellSource has it; sets no source indices.
  void operator()(std::size_t laser, std::size_t first, std::size_t count,
                  const lisco::CellSource::Destination& to) const {
    if (is_interleaved_) return readInterleaved(laser, first, count, to);
    read(axes_[0], laser, first, count, to.x);
    read(axes_[1], laser, first, count, to.y);
    read(axes_[2], laser, first, count, to.z);
  }

  lisco::Return at(std::size_t laser, std::size_t column) const {
    lisco::Return cell{};
    (*this)(laser, column, 1, {&cell.x, &cell.y, &cell.z, nullptr});
    return cell;
  }

 private:
  struct Axis {
    const char* data;
    py::ssize_t laser_stride, column_stride;  ///< bytes
    bool is_double;
  };

  static Axis axisOf(const py::array& values) {
    const bool is_double = py::isinstance<py::array_t<double>>(values);
    if (!is_double && !py::isinstance<py::array_t<float>>(values))
      throw std::invalid_argument("x, y and z must be arrays of float32 or float64");
    if (values.ndim() != 2) throw std::invalid_argument("x, y and z must have two axes");
    return {static_cast<const char*>(values.data()), values.strides(0), values.strides(1), is_double};
  }

  static void read(const Axis& axis, std::size_t laser, std::size_t first, std::size_t count, float* to) {
    const char* const from = axis.data + static_cast<py::ssize_t>(laser) * axis.laser_stride +
                             static_cast<py::ssize_t>(first) * axis.column_stride;
    if (axis.is_double)
      gather<double>(from, axis.column_stride, count, to);
    else
      gather<float>(from, axis.column_stride, count, to);
  }

  template <typename Value>
  static void gather(const char* from, py::ssize_t stride, std::size_t count, float* to) {
    for (std::size_t i = 0; i < count; ++i, from += stride) {
      Value value;
      std::memcpy(&value, from, sizeof value);
      to[i] = static_cast<float>(value);
    }
  }

  /// x, y and z are floats side by side, as in most arrays: read in one pass.
  void readInterleaved(std::size_t laser, std::size_t first, std::size_t count,
                       const lisco::CellSource::Destination& to) const {
    const char* const row = axes_[0].data + static_cast<py::ssize_t>(laser) * axes_[0].laser_stride;
    lisco::StridedPoints::sideBySide(row, axes_[0].column_stride).read(first, count, to);
  }

  std::array<Axis, 3> axes_;
  bool is_interleaved_ = false;
  std::size_t lasers_ = 0, columns_ = 0;
};

}  // namespace lisco_python
