// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// The module `lisco._view`: the page of the programs. Separate, since it needs more libraries than the engine.
#include <pybind11/numpy.h>

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "points.h"
#include "view/page.h"
#include "view/rows.h"
#include "view/scan_encoder.h"

namespace lisco_python {
namespace {

template <typename Value>
using Values = py::array_t<Value, py::array::c_style>;

/// A vector of an array's elements: one for each point, or none.
template <typename Value>
std::vector<Value> vectorOf(const Values<Value>& values, std::size_t points) {
  const auto size = static_cast<std::size_t>(values.size());
  if (size != 0 && size != points) throw std::invalid_argument("arrays must have an element for each point");
  return {values.data(), values.data() + size};
}

/// Clusters 1, 2, ... from an array (clusters, 9) of size, centre (x, y, z), length, width, height, yaw, nearest range.
std::vector<lisco_apps::ViewCluster> clustersOf(const Values<double>& boxes) {
  if (boxes.ndim() != 2 || boxes.shape(1) != 9) throw std::invalid_argument("boxes must have nine numbers each");
  std::vector<lisco_apps::ViewCluster> clusters;
  for (py::ssize_t i = 0; i < boxes.shape(0); ++i) {
    const double* const of = boxes.data(i, 0);
    clusters.push_back({static_cast<std::size_t>(of[0]), {of[1], of[2], of[3]}, of[4], of[5], of[6], of[7], of[8]});
  }
  return clusters;
}

/// \param labels 0 = in no cluster, otherwise the cluster's number from 1
std::string page(const py::array& x, const py::array& y, const py::array& z, const Values<std::uint32_t>& labels,
                 const Values<double>& boxes, const Values<std::uint8_t>& is_ground, const Values<float>& intensity,
                 bool seen_by_camera, double tolerance, const std::string& name) {
  const Points points(x, y, z);
  const std::size_t count = points.lasers() * points.columns();
  lisco_apps::ViewScan scan;
  scan.name = name;
  scan.is_ground = vectorOf(is_ground, count);
  scan.intensity = vectorOf(intensity, count);
  scan.ring = lisco_apps::rowsOf(points.columns(), points.lasers());
  scan.seen_by_camera = seen_by_camera;
  scan.labellings.push_back({"clusters", tolerance, vectorOf(labels, count), clustersOf(boxes)});
  if (scan.labellings.front().labels.size() != count) throw std::invalid_argument("labels must be as many as points");
  const py::gil_scoped_release release;
  scan.points.reserve(count);
  for (std::size_t laser = 0; laser < points.lasers(); ++laser)
    for (std::size_t column = 0; column < points.columns(); ++column) {
      const lisco::Return point = points.at(laser, column);
      scan.points.push_back({point.x, point.y, point.z});
    }
  return lisco_apps::viewPage(name, {lisco_apps::encodeViewScan(scan)});
}

}  // namespace

PYBIND11_MODULE(_view, module) {
  module.doc() = "The page that the programs write. Expects arguments that the package has checked.";
  module.attr("SIGNATURE") = lisco_apps::kViewSignature;
  module.def("page", &page, py::arg("x"), py::arg("y"), py::arg("z"), py::arg("labels"), py::arg("boxes"),
             py::arg("is_ground"), py::arg("intensity"), py::arg("seen_by_camera"), py::arg("tolerance"),
             py::arg("name"));
}

}  // namespace lisco_python
