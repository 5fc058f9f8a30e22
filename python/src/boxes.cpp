// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <unordered_map>
#include <vector>

#include "lisco/cluster_features.h"
#include "module.h"
#include "points.h"

namespace lisco_python {

namespace {

/// An element of the array of boxes.
struct Box {
  std::int64_t label, size;
  std::array<double, 3> centroid;
  std::array<float, 3> min, max;
  std::array<double, 3> center;
  double length, width, height, yaw, nearest_range, density;
};

/// The returns of a label: x, y, z, x, y, z, ...
struct Members {
  std::int64_t label;
  std::vector<float> xyz;
};

/// The returns of each label of 0 or more, in the order of the labels.
std::vector<Members> membersOf(const Points& points, const std::int64_t* labels) {
  constexpr std::size_t kBlock = 64;
  std::array<float, kBlock> x, y, z;
  std::vector<Members> clusters;
  std::unordered_map<std::int64_t, std::size_t> place;
  for (std::size_t laser = 0; laser < points.lasers(); ++laser)
    for (std::size_t first = 0; first < points.columns(); first += kBlock) {
      const std::size_t count = std::min(kBlock, points.columns() - first);
      points(laser, first, count, {x.data(), y.data(), z.data(), nullptr});
      for (std::size_t i = 0; i < count; ++i) {
        const std::int64_t label = labels[laser * points.columns() + first + i];
        if (label < 0 || !lisco::isReturn(x[i], y[i], z[i])) continue;
        const auto [at, is_new] = place.try_emplace(label, clusters.size());
        if (is_new) clusters.push_back({label, {}});
        std::vector<float>& xyz = clusters[at->second].xyz;
        xyz.insert(xyz.end(), {x[i], y[i], z[i]});
      }
    }
  std::sort(clusters.begin(), clusters.end(), [](const Members& a, const Members& b) { return a.label < b.label; });
  return clusters;
}

Box boxOf(const Members& members, const std::array<float, 3>& origin) {
  const lisco::ClusterFeatures of =
      lisco::clusterFeatures(members.xyz.data(), members.xyz.size() / 3, 3 * sizeof(float), origin);
  return {members.label,    static_cast<std::int64_t>(of.size),
          of.centroid,      of.min,
          of.max,           of.box.center,
          of.box.length,    of.box.width,
          of.box.height,    of.box.yaw,
          of.nearest_range, of.density};
}

/// A box for each label of 0 or more.
py::array_t<Box> boxes(const py::array& x, const py::array& y, const py::array& z,
                       const py::array_t<std::int64_t, py::array::c_style>& labels, std::array<float, 3> origin) {
  const Points points(x, y, z);
  if (static_cast<std::size_t>(labels.size()) != points.lasers() * points.columns())
    throw std::invalid_argument("labels must be as many as points");
  std::vector<Box> found;
  {
    const std::int64_t* const label_of = labels.data();
    const py::gil_scoped_release release;
    for (const Members& members : membersOf(points, label_of)) found.push_back(boxOf(members, origin));
  }
  return py::array_t<Box>(static_cast<py::ssize_t>(found.size()), found.data());
}

}  // namespace

void defineBoxes(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(Box, label, size, centroid, min, max, center, length, width, height, yaw, nearest_range,
                       density);
  module.def("boxes", &boxes, py::arg("x"), py::arg("y"), py::arg("z"), py::arg("labels"), py::arg("origin"));
  module.attr("BOX") = py::dtype::of<Box>();
}

}  // namespace lisco_python
