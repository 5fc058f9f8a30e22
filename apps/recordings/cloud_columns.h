// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "io/scan_file.h"
#include "lisco/sensor_hints.h"
#include "recordings/topic_reader.h"
#include "sensors/decoder.h"
#include "sensors/packet_source.h"

namespace lisco_apps {

/// The messages of a topic, each as one packet.
class RawMessages : public PacketSource {
 public:
  explicit RawMessages(std::unique_ptr<TopicReader> reader) : reader_(std::move(reader)) {}

  Arrival next(Packet& packet) override;
  double share() const override { return reader_->share(); }

 private:
  std::unique_ptr<TopicReader> reader_;
};

/// Takes clouds for packets, and gives the columns of each: a rotation begins with each cloud. The frame is the
/// cloud's, which may be a vehicle's: the sensor's place in it is estimated. An azimuth is that of a column's returns
/// in the mean, as seen from the sensor. Clouds that are malformed, or have no rows, neither by themselves nor by their
/// rings, are foreign.
class CloudColumns : public Decoder {
 public:
  /// \param read gives the cloud of a packet; throws Broken if it is malformed
  explicit CloudColumns(std::function<Scan(const Packet&)> read);
  /// The clouds of sensor_msgs/PointCloud2 messages.
  explicit CloudColumns(const Topic& topic);

  Kind decode(const Packet& packet, const Visitor& visit) override;
  SensorPlace sensorPlace() const override { return place_; }
  bool turnsClockwise() const override { return sensor_.clockwise || sensor_.steps_per_turn == 0; }

  /// Name of the latest cloud's frame; "" if it has none.
  const std::string& frame() const { return frame_; }
  /// The clouds that were left out since they are malformed, or since they have no rows: a line each; empty if none.
  std::vector<std::string> leftOut() const;

 private:
  std::function<Scan(const Packet&)> read_;
  void estimateSensor(const Cloud& cloud);

  std::vector<Cell> cells_;
  lisco::SensorHints sensor_;  ///< estimate of the last cloud
  SensorPlace place_;          ///< by the same, or as the cloud declares it if no rotating sensor is recognized
  std::string frame_;
  double azimuth_ = 0;  ///< of the last column
  std::uint64_t malformed_ = 0, without_rows_ = 0;
  std::string first_malformed_;  ///< when, and why
};

}  // namespace lisco_apps
