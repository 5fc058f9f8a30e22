// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <string>

#include <boost/program_options.hpp>

#include "recordings/topic_reader.h"
#include "sensors/decoder.h"

namespace lisco_apps {

/// Which part of a recording is read.
struct RecordingOptions {
  std::string topic;
  TimeSpan span;
  unsigned every = 1;

  void addTo(boost::program_options::options_description& shown);
  /// \throws std::runtime_error with one line
  void check() const;
  bool isSpanGiven() const { return span.from > 0 || span.to < 1e300; }
  /// Whether any of them was given.
  bool areGiven() const { return !topic.empty() || every != 1 || isSpanGiven(); }
};

enum class InputKind { kCloudFiles, kRecordedClouds, kRecordedPackets, kCapture };

/// A line about the options that were given and do not act on such an input; "" if all do.
std::string withoutEffect(InputKind kind, const RecordingOptions& recording, const DecoderOptions& decoder,
                          bool has_port);

/// Adds the options that name a sensor: --sensor, --calibration, --metadata, --return and
/// --turning.
void addSensorOptions(boost::program_options::options_description& shown, DecoderOptions& decoder);

}  // namespace lisco_apps
