// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "sensors/sensor_detection.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>

#include "sensors/ouster_decoder.h"
#include "sensors/ouster_metadata.h"
#include "sensors/velodyne_decoder.h"
#include "sensors/velodyne_model.h"

namespace lisco_apps {
namespace {

constexpr std::uint64_t kPackets = 1000;  ///< inspected

bool isVelodyne(const std::string& name) {
  const std::vector<std::string> names = velodyneModelNames();
  return std::find(names.begin(), names.end(), name) != names.end();
}

void ignore(const Column& /*column*/) {}

/// Those of Velodyne's sensors whose packets come at the pace of these.
std::vector<std::string> ofTheirPace(const std::vector<std::string>& names, std::vector<VelodyneDecoder>& decoders,
                                     PacketSource& source) {
  constexpr double kMaxDeviation = 0.1;
  Packet packet;
  while (decoders.front().usualGapUs() <= 0 && source.packets() < kPackets &&
         source.next(packet) == PacketSource::Arrival::kPacket)
    for (VelodyneDecoder& decoder : decoders) decoder.decode(packet, ignore);
  std::vector<std::string> of_pace, of_name;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double usual_us = decoders[i].usualGapUs();
    if (usual_us > 0 && std::fabs(usual_us / decoders[i].packetPeriodUs() - 1) < kMaxDeviation)
      of_pace.push_back(names[i]);
    if (decoders[i].counts().data > 0 && decoders[i].counts().says_other_model == 0) of_name.push_back(names[i]);
  }
  return !of_pace.empty() ? of_pace : !of_name.empty() ? of_name : names;
}

}  // namespace

std::vector<std::string> sensorsThatSent(PacketSource& source) {
  Packet packet;
  std::vector<std::string> names;
  while (names.empty() && source.packets() < kPackets && source.next(packet) == PacketSource::Arrival::kPacket)
    names = sensorsThatSend(packet);
  if (names.size() < 2 || !std::all_of(names.begin(), names.end(), isVelodyne)) return names;
  std::vector<VelodyneDecoder> decoders;
  for (const std::string& name : names) {
    decoders.emplace_back(makeVelodyneModel(name));
    decoders.back().decode(packet, ignore);
  }
  return ofTheirPace(names, decoders, source);
}

bool describes(const fs::path& metadata, PacketSource& source) try {
  constexpr std::uint64_t kData = 16;
  OusterDecoder decoder(readOusterMetadata(metadata), ReturnChoice::kBoth);
  Packet packet;
  while (decoder.counts().data + decoder.counts().foreign < kData && source.packets() < kPackets &&
         source.next(packet) == PacketSource::Arrival::kPacket)
    decoder.decode(packet, ignore);
  const Decoder::Counts& counts = decoder.counts();
  return counts.data > counts.foreign && counts.says_other_model == 0;
} catch (const std::runtime_error&) {
  return false;
}

}  // namespace lisco_apps
