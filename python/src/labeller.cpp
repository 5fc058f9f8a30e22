// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <pybind11/numpy.h>

#include <cstdint>
#include <mutex>

#include "lisco/label_clusters.h"
#include "module.h"
#include "points.h"

namespace lisco_python {

namespace {

/// Labels scan after scan. Calls from several threads wait for each other.
class Labeller {
 public:
  py::array_t<std::int32_t> label(const py::array& x, const py::array& y, const py::array& z, float tolerance,
                                  std::size_t min_size, std::size_t max_size, std::size_t threads) {
    const Points points(x, y, z);
    lisco::LabelParameters parameters;
    parameters.tolerance = tolerance;
    parameters.min_size = min_size;
    parameters.max_size = max_size;
    parameters.threads = threads;
    parameters.lasers = points.lasers() == 0 ? 1 : points.lasers();
    py::array_t<std::int32_t> labels({x.shape(0), x.shape(1)});
    std::int32_t* const to = labels.mutable_data();
    const py::gil_scoped_release release;
    const std::lock_guard<std::mutex> lock(mutex_);
    labeller_.label(points.lasers() * points.columns(), points, parameters, to);
    return labels;
  }

 private:
  std::mutex mutex_;
  lisco::ClusterLabeller labeller_;
};

}  // namespace

void defineLabeller(py::module_& module) {
  py::class_<Labeller>(module, "Labeller")
      .def(py::init<>())
      .def("label", &Labeller::label, py::arg("x"), py::arg("y"), py::arg("z"), py::arg("tolerance"),
           py::arg("min_size"), py::arg("max_size"), py::arg("threads"));
}

}  // namespace lisco_python
