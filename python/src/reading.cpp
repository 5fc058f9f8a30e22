// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// The module `lisco._reading`: the readers of the programs. Separate, since it loads PCL.
#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "io/cloud_file.h"
#include "io/output_file.h"
#include "io/scan_file.h"
#include "recordings/packet_input.h"
#include "recordings/packet_rotations.h"
#include "recordings/recording.h"
#include "recordings/scan_source.h"
#include "sensors/decoder.h"
#include "stream/turn_position.h"

namespace lisco_python {
namespace {

namespace py = pybind11;
namespace fs = std::filesystem;

/// x, y, z of a cloud: (rows, columns, 3), or (points, 3) if it is not organized.
py::array_t<float> arrayOf(const lisco_apps::Cloud& cloud) {
  std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(cloud.size()), 3};
  if (cloud.height > 1) shape = {cloud.height, cloud.width, 3};
  py::array_t<float> points(shape);
  float* to = points.mutable_data();
  for (const pcl::PointXYZ& point : cloud) {
    *to++ = point.x;
    *to++ = point.y;
    *to++ = point.z;
  }
  return points;
}

py::array_t<float> readFile(const fs::path& file) {
  lisco_apps::Cloud::Ptr cloud;
  {
    const py::gil_scoped_release release;
    cloud = lisco_apps::readScan(file).cloud;
  }
  return arrayOf(*cloud);
}

/// What reads a recording's packets.
struct Reading {
  std::string sensor;
  fs::path calibration, metadata;
  std::string topic;
  std::optional<std::uint16_t> port;

  lisco_apps::InputOptions options() const {
    lisco_apps::InputOptions options;
    options.decoder.sensor = sensor;
    options.decoder.calibration = calibration;
    options.decoder.metadata = metadata;
    options.recording.topic = topic;
    options.port = port;
    return options;
  }
};

/// The clouds and rotations of a recording. Calls from several threads wait for each other.
class Scans {
 public:
  Scans(const fs::path& recording, const Reading& reading) : source_({recording.string()}, reading.options()) {}

  /// \return name, seconds since 1970, points and "", or None and an error; nothing at the end
  std::optional<std::tuple<std::string, double, std::optional<py::array_t<float>>, std::string>> next() {
    constexpr double kSecondsPerNanosecond = 1e-9;
    std::optional<lisco_apps::ScanItem> item;
    lisco_apps::Scan scan;
    std::string error;
    {
      const py::gil_scoped_release release;
      const std::lock_guard<std::mutex> lock(mutex_);
      item = source_.next();
      if (!item) return std::nullopt;
      try {
        scan = item->read();
      } catch (const std::runtime_error& failure) {
        error = failure.what();
      }
    }
    std::optional<py::array_t<float>> points;
    if (error.empty()) points = arrayOf(*scan.cloud);
    return std::make_tuple(item->name, static_cast<double>(item->time_ns) * kSecondsPerNanosecond, points, error);
  }

 private:
  std::mutex mutex_;
  lisco_apps::ScanSource source_;
};

/// A turn of the sensor.
struct Turn {
  std::size_t lasers = 0;
  std::vector<float> cells;       ///< x, y, z, intensity, column by column
  std::vector<double> azimuths;   ///< degrees clockwise
  std::vector<double> positions;  ///< turns
  double time = 0;                ///< of the packet of its first column, seconds since 1970
};

/// Rotations of a capture. Calls from several threads wait for each other.
class Capture {
 public:
  Capture(const fs::path& file, const Reading& reading) : rotations_(openedFor(file, reading)) {}

  /// \return nothing at the end
  std::optional<Turn> next() {
    const py::gil_scoped_release release;
    const std::lock_guard<std::mutex> lock(mutex_);
    std::optional<lisco_apps::PacketRotation> rotation = rotations_.next();
    if (rotation) return turnOf(*rotation);
    if (!std::exchange(is_over_, true) && !rotations_.error().empty()) throw std::runtime_error(rotations_.error());
    return std::nullopt;
  }

  /// Largest azimuth between a column and its returns, radians.
  double stagger() const { return rotations_.decoder().stagger(); }

  std::size_t dataPackets() {
    const py::gil_scoped_release release;
    const std::lock_guard<std::mutex> lock(mutex_);
    return rotations_.decoder().counts().data;
  }

 private:
  static lisco_apps::PacketInput openedFor(const fs::path& file, const Reading& reading) {
    const lisco_apps::InputOptions options = reading.options();
    return lisco_apps::openPackets(file, options.recording, options.decoder, options.port, [] { return false; });
  }

  Turn turnOf(const lisco_apps::PacketRotation& rotation) {
    constexpr double kSecondsPerMicrosecond = 1e-6;
    Turn turn;
    turn.lasers = rotation.rows;
    turn.time = static_cast<double>(rotation.first_packet_us) * kSecondsPerMicrosecond;
    turn.cells.reserve(4 * rotation.cells.size());
    for (const lisco_apps::Cell& cell : rotation.cells)
      turn.cells.insert(turn.cells.end(), {cell.x, cell.y, cell.z, cell.intensity});
    for (const auto& column : rotation.columns) {
      turn.azimuths.push_back(column.azimuth);
      turn.positions.push_back(position_.next(column.azimuth, std::nullopt, column.after_break));
    }
    return turn;
  }

  std::mutex mutex_;
  lisco_apps::PacketRotations rotations_;
  lisco_apps::TurnPosition position_;
  bool is_over_ = false;
};

/// (lasers, columns, 4): a view of the columns, which are copied.
py::object pointsOf(const Turn& turn) {
  const auto columns = static_cast<py::ssize_t>(turn.azimuths.size());
  const auto lasers = static_cast<py::ssize_t>(turn.lasers);
  const py::array_t<float> cells({columns, lasers, py::ssize_t{4}}, turn.cells.data());
  return cells.attr("transpose")(1, 0, 2);
}

py::array_t<double> arrayOf(const std::vector<double>& values) {
  return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
}

}  // namespace

PYBIND11_MODULE(_reading, module) {
  module.doc() = "The readers of the programs.";
  module.def("read_file", &readFile, py::arg("file"));
  module.def("sensors", &lisco_apps::decodableSensors);
  module.def("cloud_files_in", &lisco_apps::cloudFilesIn, py::arg("folder"));
  module.def(
      "results_in", [](const fs::path& folder) { return lisco_apps::ownFilesIn(folder, lisco_apps::kClusterProgram); },
      py::arg("folder"));
  module.def("is_capture", &lisco_apps::isCapture, py::arg("path"));
  module.def("is_recording", &lisco_apps::isRecording, py::arg("path"));
  py::class_<Reading>(module, "Reading")
      .def(py::init([](std::string sensor, fs::path calibration, fs::path metadata, std::string topic,
                       std::optional<std::uint16_t> port) {
             return Reading{std::move(sensor), std::move(calibration), std::move(metadata), std::move(topic), port};
           }),
           py::arg("sensor"), py::arg("calibration"), py::arg("metadata"), py::arg("topic"), py::arg("port"));
  py::class_<Scans>(module, "Scans")
      .def(py::init<const fs::path&, const Reading&>(), py::arg("recording"), py::arg("reading"))
      .def("next", &Scans::next);
  py::class_<Turn>(module, "Turn")
      .def_property_readonly("points", &pointsOf)
      .def_property_readonly("azimuths", [](const Turn& turn) { return arrayOf(turn.azimuths); })
      .def_property_readonly("positions", [](const Turn& turn) { return arrayOf(turn.positions); })
      .def_readonly("time", &Turn::time);
  py::class_<Capture>(module, "Capture")
      .def(py::init<const fs::path&, const Reading&>(), py::arg("file"), py::arg("reading"))
      .def("next", &Capture::next)
      .def_property_readonly("stagger", &Capture::stagger)
      .def_property_readonly("data_packets", &Capture::dataPackets);
}

}  // namespace lisco_python
