// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "recordings/scan_source.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "io/formats.h"
#include "io/options.h"
#include "recordings/bytes.h"
#include "recordings/packet_input.h"
#include "recordings/packet_rotations.h"
#include "recordings/point_cloud2.h"
#include "recordings/topic_choice.h"

namespace lisco_apps {
namespace {

std::vector<fs::path> recordingsIn(const fs::path& folder) {
  std::vector<fs::path> found;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (isRecording(entry->path()) || isCapture(entry->path())) found.push_back(entry->path());
  std::sort(found.begin(), found.end());
  return found;
}

/// An item that reports a failure.
ScanItem failureOf(const fs::path& file, const std::string& line) {
  ScanItem item;
  item.name = file.filename().string();
  item.file = file;
  item.read = [line]() -> Scan { throw std::runtime_error(line); };
  return item;
}

/// A message or rotation.
ScanItem itemOf(const fs::path& file, std::uint64_t number, std::int64_t time_ns) {
  ScanItem item;
  const auto seconds = static_cast<long long>(time_ns / 1000000000);
  const auto micros = static_cast<long long>(time_ns / 1000 % 1000000);
  item.folder = formatted("%06llu_%lld.%06lld", static_cast<unsigned long long>(number), seconds, micros);
  item.name = formatted("%s %llu at %lld.%06lld", file.filename().c_str(), static_cast<unsigned long long>(number),
                        seconds, micros);
  item.file = file;
  item.time_ns = time_ns;
  return item;
}

/// Seconds from one time past the hour to another, the nearest.
float secondsBetween(double from_us, double to_us) {
  constexpr double kHourUs = 3600e6;
  return static_cast<float>(1e-6 * std::remainder(to_us - from_us, kHourUs));
}

/// A rotation as a cloud, with fields x y z intensity ring time: the laser, 0 at the top, and seconds since the first
/// column, of the firing of the column's first laser.
/// \param lasers of the sensor; one with several returns has a row for each
Scan scanOf(const PacketRotation& rotation, std::size_t lasers) {
  static_assert(sizeof(Cell) == 4 * sizeof(float), "cells are written as they are");
  const std::size_t columns = rotation.columns.size();
  const std::size_t rows_of_laser = std::max<std::size_t>(1, rotation.rows / lasers);
  Scan scan;
  scan.cloud = std::make_shared<Cloud>(static_cast<std::uint32_t>(columns), static_cast<std::uint32_t>(rotation.rows));
  scan.cloud->is_dense = false;
  for (const char* const name : {"x", "y", "z", "intensity"}) addField(scan.fields, name, pcl::PCLPointField::FLOAT32);
  addField(scan.fields, "ring", pcl::PCLPointField::UINT16);
  addField(scan.fields, "time", pcl::PCLPointField::FLOAT32);
  scan.fields.is_dense = 0;
  allocate(scan.fields, scan.cloud->width, scan.cloud->height);
  std::uint8_t* at = scan.fields.data.data();
  const auto put = [&at](const auto& value) {
    std::memcpy(at, &value, sizeof value);
    at += sizeof value;
  };
  for (std::size_t row = 0; row < rotation.rows; ++row)
    for (std::size_t column = 0; column < columns; ++column) {
      const Cell& cell = rotation.cells[column * rotation.rows + row];
      (*scan.cloud)[row * columns + column] = pcl::PointXYZ(cell.x, cell.y, cell.z);
      put(cell);
      put(static_cast<std::uint16_t>(row / rows_of_laser));
      put(secondsBetween(rotation.columns.front().time_us, rotation.columns[column].time_us));
    }
  return scan;
}

}  // namespace

/// The scans of one recording.
class ScanSource::Sequence {
 public:
  virtual ~Sequence() = default;
  /// Throws what ends it.
  virtual std::optional<ScanItem> next() = 0;
  virtual double share() const = 0;
};

/// Each message of a topic of clouds.
class ScanSource::Messages : public Sequence {
 public:
  Messages(fs::path file, std::unique_ptr<TopicReader> reader) : file_(std::move(file)), reader_(std::move(reader)) {}

  std::optional<ScanItem> next() override {
    Message message;
    if (!reader_->next(message)) {
      if (!reader_->error().empty()) throw std::runtime_error(reader_->error());
      if (!has_begun_)
        fail(file_, "topic " + reader_->topic().name + " has no message, or none between --from and --to");
      return std::nullopt;
    }
    has_begun_ = true;
    const Topic& topic = reader_->topic();  // valid until the next message, which may add topics
    ScanItem item = itemOf(file_, reader_->number(), message.time_ns);
    const std::string malformed =
        file_.string() +
        formatted(": message %llu of %s is malformed: ", static_cast<unsigned long long>(reader_->number()),
                  topic.name.c_str());
    try {
      const auto cloud = std::make_shared<const pcl::PCLPointCloud2>(pointCloud2In(message, topic));
      item.read = [cloud, malformed] {
        try {
          return scanOf(*cloud);
        } catch (const Broken& why) {
          throw std::runtime_error(malformed + why.what());
        }
      };
    } catch (const Broken& why) {
      return failureOf(file_, malformed + why.what());
    }
    return item;
  }
  double share() const override { return reader_->share(); }

 private:
  fs::path file_;
  std::unique_ptr<TopicReader> reader_;
  bool has_begun_ = false;
};

/// Each rotation of a sensor's packets: a row per laser, from top to bottom, a column per firing.
class ScanSource::Turns : public Sequence {
 public:
  Turns(fs::path file, PacketInput input, const RecordingOptions& part)
      : file_(std::move(file)), rotations_(std::move(input)), part_(part) {}

  std::optional<ScanItem> next() override {
    while (std::optional<PacketRotation> rotation = rotations_.next()) {
      if (count_++ % part_.every != 0) continue;
      ScanItem item = itemOf(file_, count_, 1000 * rotation->last_packet_us);
      item.of_packets = true;
      item.read = [rotation = std::move(*rotation), lasers = rotations_.decoder().lasers()] {
        return scanOf(rotation, lasers);
      };
      return item;
    }
    if (!rotations_.error().empty()) throw std::runtime_error(rotations_.error());
    if (count_ == 0)
      fail(file_, "holds no data packet of the sensor (" + rotations_.decoder().name() + ")" +
                      (part_.isSpanGiven() ? " between --from and --to" : ""));
    return std::nullopt;
  }
  double share() const override { return rotations_.share(); }

 private:
  fs::path file_;
  PacketRotations rotations_;
  RecordingOptions part_;
  std::uint64_t count_ = 0;  ///< of rotations
};

void addFileOptions(boost::program_options::options_description& shown, ReadOptions& files) {
  shown.add_options()(
      "bin-fields", countOption("--bin-fields", files.bin_fields, 3, 64),
      "floats a point of a .bin: 4 of KITTI (x y z intensity), 5 of nuScenes (and ring), others (default: by their "
      "looks)");
}

void InputOptions::addTo(boost::program_options::options_description& shown) {
  recording.addTo(shown);
  addSensorOptions(shown, decoder);
  // clang-format off
  shown.add_options()
    ("port", textOption("N", [this](const std::string& text) {
       port = static_cast<std::uint16_t>(countOf(text, "--port", 1, 65535)); }),
     "of a capture: take only packets to this UDP port");
  // clang-format on
  addFileOptions(shown, files);
}

void InputOptions::check() const {
  recording.check();
}

ScanSource::ScanSource(const std::vector<std::string>& inputs, const InputOptions& options,
                       std::function<bool()> is_interrupted)
    : options_(options), is_interrupted_(std::move(is_interrupted)) {
  for (const std::string& input : inputs) {
    if (isRecording(input)) {
      files_.emplace_back(input);
      continue;
    }
    const std::vector<fs::path> recordings = recordingsIn(input);
    std::vector<std::string> failures;
    const std::vector<fs::path> found = expandInputs({input}, failures);
    if (found.empty() && !recordings.empty())
      failures = {input + ": holds no scans, but recordings, to be given by name: " + fileNamesOf(recordings)};
    failures_.insert(failures_.end(), failures.begin(), failures.end());
    files_.insert(files_.end(), found.begin(), found.end());
  }
}

ScanSource::~ScanSource() = default;

bool ScanSource::hasRecording() const {
  for (const fs::path& file : files_)
    if (isRecording(file) || isCapture(file)) return true;
  return false;
}

std::unique_ptr<ScanSource::Sequence> ScanSource::open(const fs::path& file) {
  const RecordingOptions& part = options_.recording;
  if (isRecording(file)) {
    std::unique_ptr<Recording> recording = openRecording(file);
    const std::size_t topic = chooseTopic(*recording, file, part.topic, !options_.decoder.sensor.empty());
    if (kindOf(recording->topics()[topic]) == TopicKind::kClouds) {
      note_(file.string() + ": topic " + recording->topics()[topic].name);
      noteIdle(InputKind::kRecordedClouds, file.string() + ": ");
      return std::make_unique<Messages>(
          file, std::make_unique<TopicReader>(std::move(recording), topic, part.span, part.every));
    }
  }
  PacketInput packets = openPackets(file, part, options_.decoder, options_.port, is_interrupted_);
  for (const std::string& note : packets.notes) note_(file.string() + ": " + note);
  return std::make_unique<Turns>(file, std::move(packets), part);
}

void ScanSource::noteIdle(InputKind kind, const std::string& heading) const {
  const std::string idle = withoutEffect(kind, options_.recording, options_.decoder, options_.port.has_value());
  if (!idle.empty()) note_(heading + idle);
}

std::optional<ScanItem> ScanSource::next() {
  if (!failures_.empty()) {
    const std::string line = failures_.front();
    failures_.erase(failures_.begin());
    return failureOf({}, line);
  }
  while (at_ < files_.size()) {
    const fs::path& file = files_[at_];
    ScanItem item;
    try {
      if (!isRecording(file) && !isCapture(file)) {
        if (scan_files_ == 0 && !hasRecording()) noteIdle(InputKind::kCloudFiles, "");
        if (scan_files_++ % options_.recording.every != 0) {
          ++at_;
          continue;
        }
        item.name = file.filename().string();
        item.file = file;
        item.read = [file, options = options_.files] { return readScan(file, options); };
        item.input = at_++;
        return item;
      }
      if (!open_) open_ = open(file);
      if (std::optional<ScanItem> scan = open_->next()) {
        scan->input = at_;
        return scan;
      }
      open_.reset();
      ++at_;
    } catch (const std::runtime_error& why) {
      open_.reset();
      item = failureOf(file, why.what());
      item.input = at_++;
      return item;
    }
  }
  return std::nullopt;
}

double ScanSource::share() const {
  if (files_.empty()) return 1;
  return (static_cast<double>(at_) + (open_ ? open_->share() : 0)) / static_cast<double>(files_.size());
}

}  // namespace lisco_apps
