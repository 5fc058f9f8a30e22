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

#include "io/scan_file.h"
#include "recordings/packet_input.h"
#include "recordings/recording.h"
#include "recordings/scan_source.h"
#include "sensors/decoder.h"
#include "sensors/rotation_cutter.h"
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
  Capture(const fs::path& file, const Reading& reading) {
    const lisco_apps::InputOptions options = reading.options();
    lisco_apps::PacketInput input =
        lisco_apps::openPackets(file, options.recording, options.decoder, options.port, [] { return false; });
    decoder_ = std::move(input.decoder);
    source_ = std::move(input.source);
    cutter_ = lisco_apps::RotationCutter(decoder_->rotationStart());
  }

  /// \return nothing at the end
  std::optional<Turn> next() {
    const py::gil_scoped_release release;
    const std::lock_guard<std::mutex> lock(mutex_);
    lisco_apps::Packet packet;
    const std::function<void(const lisco_apps::Column&)> take = [&](const lisco_apps::Column& column) {
      add(column, packet);
    };
    while (ended_.empty()) {
      if (source_->next(packet) != lisco_apps::PacketSource::Arrival::kPacket) {
        decoder_->flush(take);
        if (!turn_.azimuths.empty()) ended_.push_back(std::exchange(turn_, {}));
        if (!ended_.empty()) break;
        if (const std::string error = std::exchange(error_, source_->error()); error.empty() && !error_.empty())
          throw std::runtime_error(error_);
        return std::nullopt;
      }
      decoder_->decode(packet, take);
    }
    Turn first = std::move(ended_.front());
    ended_.erase(ended_.begin());
    return first;
  }

  /// Largest azimuth between a column and its returns, radians.
  double stagger() const { return decoder_->stagger(); }

  std::size_t dataPackets() {
    const py::gil_scoped_release release;
    const std::lock_guard<std::mutex> lock(mutex_);
    return decoder_->counts().data;
  }

 private:
  void add(const lisco_apps::Column& column, const lisco_apps::Packet& packet) {
    constexpr double kSecondsPerMicrosecond = 1e-6;
    const bool starts = cutter_.startsRotation(column.azimuth, column.after_break);
    if (starts || turn_.azimuths.size() == lisco_apps::kMaxColumns || column.cells.size() != turn_.lasers) {
      if (!turn_.azimuths.empty()) ended_.push_back(std::exchange(turn_, {}));
      turn_.lasers = column.cells.size();
      turn_.time = static_cast<double>(packet.time_us) * kSecondsPerMicrosecond;
    }
    for (const lisco_apps::Cell& cell : column.cells)
      turn_.cells.insert(turn_.cells.end(), {cell.x, cell.y, cell.z, cell.intensity});
    turn_.azimuths.push_back(column.azimuth);
    turn_.positions.push_back(position_.next(column.azimuth, std::nullopt, column.after_break));
  }

  std::mutex mutex_;
  std::unique_ptr<lisco_apps::Decoder> decoder_;
  std::unique_ptr<lisco_apps::PacketSource> source_;
  lisco_apps::RotationCutter cutter_;
  lisco_apps::TurnPosition position_;
  Turn turn_;                ///< that has begun
  std::vector<Turn> ended_;  ///< but not yet given
  std::string error_;
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
