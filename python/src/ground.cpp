// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <pybind11/numpy.h>

#include <cstdint>

#include "lisco/ground_filter.h"
#include "module.h"
#include "points.h"

namespace lisco_python {

namespace {

/// 1 for each point on the ground, else 0: lasers, columns.
py::array_t<std::uint8_t> ground(const py::array& x, const py::array& y, const py::array& z, float sensor_height,
                                 float max_slope) {
  const Points points(x, y, z);
  lisco::GroundParameters parameters;
  parameters.sensor_height = sensor_height;
  parameters.max_slope = max_slope;
  py::array_t<std::uint8_t> found({x.shape(0), x.shape(1)});
  std::uint8_t* const to = found.mutable_data();
  const py::gil_scoped_release release;
  const auto numbered_cells = [&](std::size_t laser, std::size_t first, std::size_t count,
                                  const lisco::CellSource::Destination& destination) {
    points(laser, first, count, destination);
    for (std::size_t i = 0; i < count; ++i) destination.source_index[i] = 0;
  };
  parameters.sensor = lisco::estimateSensor(points.columns(), points.lasers(), {}, lisco::CellSource(numbered_cells));
  lisco::GroundFilter().filter(parameters, points.columns(), points.lasers(), numbered_cells, to);
  return found;
}

}  // namespace

void defineGround(py::module_& module) {
  module.def("ground", &ground, py::arg("x"), py::arg("y"), py::arg("z"), py::arg("sensor_height"),
             py::arg("max_slope"));
}

}  // namespace lisco_python
