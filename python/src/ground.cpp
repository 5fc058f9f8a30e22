// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <pybind11/numpy.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lisco/label_ground.h"
#include "module.h"
#include "points.h"

namespace lisco_python {

namespace {

/// 1 for each point on the ground, else 0: lasers, columns.
py::array_t<std::uint8_t> ground(const py::array& x, const py::array& y, const py::array& z, float sensor_height,
                                 float max_slope) {
  const Points points(x, y, z);
  lisco::LabelGroundParameters parameters;
  parameters.sensor_height = sensor_height;
  parameters.max_slope = max_slope;
  parameters.lasers = std::max<std::size_t>(1, points.lasers());
  py::array_t<std::uint8_t> found({x.shape(0), x.shape(1)});
  std::uint8_t* const to = found.mutable_data();
  const py::gil_scoped_release release;
  std::vector<float> xyz;
  xyz.reserve(3 * points.lasers() * points.columns());
  for (std::size_t laser = 0; laser < points.lasers(); ++laser)
    for (std::size_t column = 0; column < points.columns(); ++column) {
      const lisco::Return cell = points.at(laser, column);
      xyz.insert(xyz.end(), {cell.x, cell.y, cell.z});
    }
  lisco::labelGround(xyz.data(), points.lasers() * points.columns(), 3 * sizeof(float), parameters, to);
  return found;
}

}  // namespace

void defineGround(py::module_& module) {
  module.def("ground", &ground, py::arg("x"), py::arg("y"), py::arg("z"), py::arg("sensor_height"),
             py::arg("max_slope"));
}

}  // namespace lisco_python
