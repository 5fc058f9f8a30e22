// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "decoder.h"

#include <stdexcept>

#include "ouster_decoder.h"
#include "ouster_metadata.h"
#include "velodyne_decoder.h"
#include "velodyne_model.h"

namespace lisco_apps {

namespace {

constexpr const char* kOuster = "ouster";

OusterMetadata metadataOf(const DecoderOptions& options) {
  if (!options.metadata.empty()) return readOusterMetadata(options.metadata);
  if (options.metadata_json.empty())
    throw std::runtime_error(
        "the ouster needs its metadata, the JSON file that describes the sensor; give it by --metadata");
  return parseOusterMetadata(options.metadata_json, "the metadata in the recording");
}

}  // namespace

std::vector<std::string> sensorNames() {
  std::vector<std::string> names = velodyneModelNames();
  names.emplace_back(kOuster);
  return names;
}

std::unique_ptr<Decoder> makeDecoder(const DecoderOptions& options) {
  if (options.sensor == kOuster) {
    if (!options.calibration.empty())
      throw std::runtime_error("the ouster has no calibration file; its metadata is given by --metadata");
    return std::make_unique<OusterDecoder>(metadataOf(options), options.returns);
  }
  if (!options.metadata.empty())
    throw std::runtime_error("a metadata file is for the ouster only, not for the " + options.sensor);
  return std::make_unique<VelodyneDecoder>(makeVelodyneModel(options.sensor, options.calibration));
}

}  // namespace lisco_apps
