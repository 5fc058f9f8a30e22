// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "lisco/endless_clusterer.h"
#include "module.h"
#include "points.h"

namespace lisco_python {

namespace {

/// A cluster with copies of its returns.
struct Cluster {
  std::vector<float> points;  ///< x, y, z of each return
  std::vector<std::int64_t> columns;
  std::vector<std::int32_t> lasers;
  double first_position, last_position;
  bool is_cut, is_continued;
};

/// The latest columns, whose returns clusters may hold.
class History {
 public:
  struct Column {
    std::uint32_t first_index = 0;  ///< source index of its first cell; wraps around
    std::int64_t number = 0;
    double position = 0;
    std::vector<lisco::Return> cells;
  };

  /// Appends a column of so many cells, which the caller fills.
  Column& add(std::size_t lasers, double position) {
    if (spare_.empty()) spare_.emplace_back();
    columns_.push_back(std::move(spare_.back()));
    spare_.pop_back();
    Column& column = columns_.back();
    column.first_index = next_index_;
    column.number = next_number_++;
    column.position = position;
    column.cells.resize(lasers);
    next_index_ += static_cast<std::uint32_t>(lasers);
    return column;
  }

  /// Takes back the column that was added last.
  void takeBack() {
    next_index_ = columns_.back().first_index;
    --next_number_;
    spare_.push_back(std::move(columns_.back()));
    columns_.pop_back();
  }

  /// Forgets the columns whose returns have all been delivered: a turn and a half before the last column that the
  /// clusterer has surely read.
  void forget() {
    constexpr double kHeldTurns = 1.5;
    if (columns_.size() <= kMaxUnread) return;
    const double read = columns_[columns_.size() - 1 - kMaxUnread].position;
    while (columns_.size() > kMaxUnread && columns_.front().position < read - kHeldTurns) {
      spare_.push_back(std::move(columns_.front()));
      columns_.pop_front();
    }
  }

  void clear() {
    while (!columns_.empty()) {
      spare_.push_back(std::move(columns_.front()));
      columns_.pop_front();
    }
  }

  /// The column of a source index.
  const Column& of(std::uint32_t index) const {
    const std::uint32_t base = columns_.front().first_index;  // differences are correct across the wrap-around
    const auto after =
        std::upper_bound(columns_.begin(), columns_.end(), index - base,
                         [base](std::uint32_t wanted, const Column& c) { return wanted < c.first_index - base; });
    return *std::prev(after);
  }

  std::size_t size() const { return columns_.size(); }

 private:
  static constexpr std::size_t kMaxUnread = 64;  ///< columns of a block

  std::deque<Column> columns_;
  std::vector<Column> spare_;
  std::uint32_t next_index_ = 0;
  std::int64_t next_number_ = 0;
};

/// A stream without end. Calls from several threads wait for each other.
class Endless {
 public:
  Endless(float tolerance, std::size_t min_size, std::size_t max_size, double columns_per_turn, bool clockwise,
          double start_azimuth, std::array<float, 3> origin, double stagger) {
    lisco::EndlessParameters parameters;
    parameters.tolerance = tolerance;
    parameters.min_size = min_size;
    parameters.max_size = max_size;
    parameters.columns_per_turn = columns_per_turn;
    parameters.clockwise = clockwise;
    parameters.start_azimuth = start_azimuth;
    parameters.origin = origin;
    parameters.stagger = stagger;
    clusterer_.begin(parameters, [this](const lisco::EndlessCluster& cluster) { deliver(cluster); });
  }

  Endless(const Endless&) = delete;
  Endless& operator=(const Endless&) = delete;

  /// Adds a column: an array of lasers and one column.
  std::vector<Cluster> add(const py::array& x, const py::array& y, const py::array& z, std::optional<double> position) {
    const Points points(x, y, z);
    if (points.columns() != 1) throw std::invalid_argument("a column has one point for each laser");
    const py::gil_scoped_release release;
    const std::lock_guard<std::mutex> lock(mutex_);
    History::Column& column = history_.add(points.lasers(), position ? *position : clusterer_.nextPosition());
    for (std::size_t laser = 0; laser < points.lasers(); ++laser) {
      column.cells[laser] = points.at(laser, 0);
      column.cells[laser].source_index = column.first_index + static_cast<std::uint32_t>(laser);
    }
    try {
      if (position)
        clusterer_.addColumn(column.cells.data(), column.cells.size(), *position);
      else
        clusterer_.addColumn(column.cells.data(), column.cells.size());
    } catch (const std::logic_error&) {  // the clusterer has not taken it
      history_.takeBack();
      throw;
    }
    history_.forget();
    return std::exchange(delivered_, {});
  }

  std::vector<Cluster> update() {
    const py::gil_scoped_release release;
    const std::lock_guard<std::mutex> lock(mutex_);
    clusterer_.update();
    return std::exchange(delivered_, {});
  }

  std::vector<Cluster> finish() {
    const py::gil_scoped_release release;
    const std::lock_guard<std::mutex> lock(mutex_);
    clusterer_.finish();
    history_.clear();
    return std::exchange(delivered_, {});
  }

  std::size_t columnsHeld() {
    const py::gil_scoped_release release;
    const std::lock_guard<std::mutex> lock(mutex_);
    return history_.size();
  }

 private:
  void deliver(const lisco::EndlessCluster& from) {
    Cluster cluster{{}, {}, {}, from.firstPosition(), from.lastPosition(), from.isCut(), from.isContinued()};
    cluster.points.reserve(3 * from.size());
    cluster.columns.reserve(from.size());
    cluster.lasers.reserve(from.size());
    from.forEachRun([&](const std::uint32_t* indices, std::size_t count) {
      for (std::size_t i = 0; i < count; ++i) {
        const History::Column& column = history_.of(indices[i]);
        const std::uint32_t laser = indices[i] - column.first_index;
        const lisco::Return& cell = column.cells[laser];
        cluster.points.insert(cluster.points.end(), {cell.x, cell.y, cell.z});
        cluster.columns.push_back(column.number);
        cluster.lasers.push_back(static_cast<std::int32_t>(laser));
      }
    });
    delivered_.push_back(std::move(cluster));
  }

  std::mutex mutex_;
  lisco::EndlessClusterer clusterer_;
  History history_;
  std::vector<Cluster> delivered_;
};

/// An array of a vector's elements, which are copied.
template <typename Value>
py::array_t<Value> arrayOf(const std::vector<Value>& values) {
  return py::array_t<Value>(static_cast<py::ssize_t>(values.size()), values.data());
}

py::array_t<float> pointsOf(const Cluster& cluster) {
  const auto count = static_cast<py::ssize_t>(cluster.lasers.size());
  return py::array_t<float>({count, py::ssize_t{3}}, cluster.points.data());
}

}  // namespace

void defineEndless(py::module_& module) {
  py::class_<Cluster>(module, "Cluster")
      .def_property_readonly("points", &pointsOf)
      .def_property_readonly("columns", [](const Cluster& cluster) { return arrayOf(cluster.columns); })
      .def_property_readonly("lasers", [](const Cluster& cluster) { return arrayOf(cluster.lasers); })
      .def_readonly("first_position", &Cluster::first_position)
      .def_readonly("last_position", &Cluster::last_position)
      .def_readonly("is_cut", &Cluster::is_cut)
      .def_readonly("is_continued", &Cluster::is_continued);
  py::class_<Endless>(module, "Endless")
      .def(py::init<float, std::size_t, std::size_t, double, bool, double, std::array<float, 3>, double>(),
           py::arg("tolerance"), py::arg("min_size"), py::arg("max_size"), py::arg("columns_per_turn"),
           py::arg("clockwise"), py::arg("start_azimuth"), py::arg("origin"), py::arg("stagger"))
      .def("add", &Endless::add, py::arg("x"), py::arg("y"), py::arg("z"), py::arg("position"))
      .def("update", &Endless::update)
      .def("finish", &Endless::finish)
      .def_property_readonly("columns_held", &Endless::columnsHeld);
  module.attr("MAX_STAGGER") = lisco::EndlessParameters::kMaxStagger;
}

}  // namespace lisco_python
