// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <pybind11/numpy.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

#include "lisco/cluster_order.h"
#include "lisco/column_clusterer.h"
#include "module.h"
#include "points.h"

namespace lisco_python {

namespace {

/// One rotation, column by column. Calls from several threads wait for each other.
class Columns {
 public:
  Columns(float tolerance, std::size_t min_size, std::size_t max_size) : min_size_(min_size), max_size_(max_size) {
    parameters_.tolerance = tolerance;
    parameters_.expected_returns = 0;
    begin();
  }

  void begin() {
    const py::gil_scoped_release release;
    const std::lock_guard<std::mutex> lock(mutex_);
    parameters_.expected_returns = std::max(parameters_.expected_returns, clusterer_.returnCount());
    clusterer_.begin(parameters_);
    lasers_ = columns_ = 0;
  }

  /// Adds the columns of an array of lasers and columns.
  void add(const py::array& x, const py::array& y, const py::array& z) {
    const Points points(x, y, z);
    const py::gil_scoped_release release;
    const std::lock_guard<std::mutex> lock(mutex_);
    if (points.columns() == 0) return;
    if (columns_ > 0 && points.lasers() != lasers_)
      throw std::invalid_argument("a column of " + std::to_string(points.lasers()) + " points follows columns of " +
                                  std::to_string(lasers_) + "; begin() starts a rotation of another size");
    if (points.lasers() > 0 && columns_ + points.columns() > kMaxCells / points.lasers())
      throw std::invalid_argument("a rotation has fewer than 2^31 points; begin() starts the next one");
    lasers_ = points.lasers();
    const auto numbered_cells = [&](std::size_t laser, std::size_t first, std::size_t count,
                                    const lisco::CellSource::Destination& to) {
      points(laser, first, count, to);
      for (std::size_t i = 0; i < count; ++i)
        to.source_index[i] = static_cast<std::uint32_t>((columns_ + first + i) * lasers_ + laser);
    };
    clusterer_.addColumns(points.columns(), lasers_, numbered_cells);
    columns_ += points.columns();
  }

  /// Labels of the columns so far: lasers, columns.
  py::array_t<std::int32_t> labels() {
    std::unique_lock<std::mutex> lock(mutex_, std::defer_lock);
    {
      const py::gil_scoped_release release;
      lock.lock();
    }
    py::array_t<std::int32_t> labels({lasers_, columns_});
    std::int32_t* const to = labels.mutable_data();
    const py::gil_scoped_release release;
    order();
    std::fill_n(to, lasers_ * columns_, lisco::ClusterOrder::kNoCluster);
    clusterer_.forEachRun([&](const std::uint32_t* cells, std::size_t count, std::uint32_t subcluster) {
      const std::int32_t label = order_.labelOf(subcluster);
      for (std::size_t i = 0; i < count; ++i) to[cells[i] % lasers_ * columns_ + cells[i] / lasers_] = label;
    });
    return labels;
  }

  std::size_t clusterCount() {
    const py::gil_scoped_release release;
    const std::lock_guard<std::mutex> lock(mutex_);
    order();
    return order_.count();
  }

  std::size_t columnCount() {
    const py::gil_scoped_release release;
    const std::lock_guard<std::mutex> lock(mutex_);
    return columns_;
  }

 private:
  static constexpr std::size_t kMaxCells = std::numeric_limits<std::int32_t>::max();

  void order() {
    clusterer_.update();
    order_.assign(clusterer_, min_size_, max_size_);
  }

  std::mutex mutex_;
  std::size_t min_size_, max_size_;
  lisco::Parameters parameters_;
  lisco::ColumnClusterer clusterer_;
  lisco::ClusterOrder order_;
  std::size_t lasers_ = 0, columns_ = 0;
};

}  // namespace

void defineColumns(py::module_& module) {
  py::class_<Columns>(module, "Columns")
      .def(py::init<float, std::size_t, std::size_t>(), py::arg("tolerance"), py::arg("min_size"), py::arg("max_size"))
      .def("begin", &Columns::begin)
      .def("add", &Columns::add, py::arg("x"), py::arg("y"), py::arg("z"))
      .def("labels", &Columns::labels)
      .def_property_readonly("cluster_count", &Columns::clusterCount)
      .def_property_readonly("column_count", &Columns::columnCount);
}

}  // namespace lisco_python
