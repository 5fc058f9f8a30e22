// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "sensors/decoder.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <boost/algorithm/string/join.hpp>

#include "sensors/hesai_decoder.h"
#include "sensors/hesai_model.h"
#include "sensors/ouster_decoder.h"
#include "sensors/ouster_metadata.h"
#include "sensors/velodyne_decoder.h"
#include "sensors/velodyne_model.h"

namespace lisco_apps {

bool SensorPlace::isAbout(const SensorPlace& other) const {
  constexpr float kMaxShift = 0.1F, kMaxTilt = 0.01F;  // metres, metres per metre
  const auto differ = [](float a, float b, float most) { return !(std::fabs(a - b) <= most); };
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (differ(origin[axis], other.origin[axis], kMaxShift)) return false;
  return !differ(tilt[0], other.tilt[0], kMaxTilt) && !differ(tilt[1], other.tilt[1], kMaxTilt);
}

namespace {

constexpr const char* kOuster = "ouster";

OusterMetadata metadataOf(const DecoderOptions& options) {
  if (!options.metadata.empty()) return readOusterMetadata(options.metadata);
  if (options.metadata_json.empty())
    throw std::runtime_error(
        "the ouster needs its metadata, the JSON file that describes the sensor; give it by --metadata");
  return parseOusterMetadata(options.metadata_json, "the metadata in the recording");
}

bool isIn(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

}  // namespace

std::vector<std::string> decodableSensors() {
  std::vector<std::string> names = velodyneModelNames();
  for (const std::string& name : hesaiModelNames()) names.push_back(name);
  names.emplace_back(kOuster);
  return names;
}

std::vector<std::string> sensorsThatSend(const Packet& packet) {
  std::vector<std::string> sensors;
  for (const std::string& name : velodyneModelNames())
    if (VelodyneDecoder(velodynePackets(name)).isData(packet)) sensors.push_back(name);
  for (const std::string& name : hesaiModelNames())
    if (HesaiDecoder(hesaiLayout(name)).decode(packet, [](const Column&) {}) == Decoder::Kind::kData)
      sensors.push_back(name);
  if (OusterDecoder::isFromAny(packet)) sensors.emplace_back(kOuster);
  return sensors;
}

std::uint16_t defaultPort(const std::string& sensor) {
  return sensor == kOuster ? 7502 : 2368;
}

std::unique_ptr<Decoder> makeDecoder(const DecoderOptions& options) {
  if (!isIn(decodableSensors(), options.sensor))
    throw std::runtime_error("there is no sensor '" + options.sensor + "': it is one of " +
                             boost::join(decodableSensors(), ", "));
  if (options.sensor == kOuster) {
    if (!options.calibration.empty())
      throw std::runtime_error("the ouster has no calibration file; its metadata is given by --metadata");
    return std::make_unique<OusterDecoder>(metadataOf(options), options.returns);
  }
  if (!options.metadata.empty())
    throw std::runtime_error("a metadata file is for the ouster only, not for the " + options.sensor);
  if (isIn(hesaiModelNames(), options.sensor))
    return std::make_unique<HesaiDecoder>(makeHesaiModel(options.sensor, options.calibration), options.returns);
  return std::make_unique<VelodyneDecoder>(makeVelodyneModel(options.sensor, options.calibration), options.returns,
                                           options.turning);
}

}  // namespace lisco_apps
