// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "other_sensors.h"

#include <cmath>

#include "io/text.h"

namespace lisco_apps {
namespace {

/// The sensors that fit, by fits (decoder).
template <typename Fits>
std::vector<std::string> sensorsThat(Fits&& fits) {
  std::vector<std::string> sensors;
  for (const std::string& name : sensorModelNames()) {
    if (name == "hdl64e") continue;
    Decoder decoder(makeSensorModel(name));
    if (fits(decoder)) sensors.push_back(name);
  }
  return sensors;
}

std::string questionOf(const std::vector<std::string>& sensors) {
  std::string names;
  for (const std::string& sensor : sensors) names += (names.empty() ? "" : " or ") + sensor;
  return names.empty() ? "; is it another --sensor?" : "; is it a " + names + "?";
}

}  // namespace

void OtherSensors::look(const Packet& packet, Decoder::Kind kind, const Decoder& decoder) {
  constexpr std::uint64_t kEnough = 100;
  const Decoder::Counts& counts = decoder.counts();
  if (kind != Decoder::Kind::kForeign || counts.data > 0 || counts.foreign > kEnough || !by_layout_.empty()) return;
  by_layout_ =
      sensorsThat([&](Decoder& other) { return other.decode(packet, [](const Column&) {}) == Decoder::Kind::kData; });
}

std::string OtherSensors::paceWarning(const Decoder& decoder) {
  const double usual_us = decoder.order().usualGap();
  if (knows_pace_ || usual_us <= 0) return {};
  knows_pace_ = true;
  constexpr double kUnlike = 0.3, kAlike = 0.1;
  const double own_us = decoder.packetPeriodUs();
  if (std::fabs(usual_us / own_us - 1) < kUnlike) return {};
  const std::vector<std::string> by_pace =
      sensorsThat([&](const Decoder& other) { return std::fabs(usual_us / other.packetPeriodUs() - 1) < kAlike; });
  return formatted("packets come every %.0f us, but those of a %s every %.0f us", usual_us,
                   decoder.model().name.c_str(), own_us) +
         questionOf(by_pace);
}

std::string OtherSensors::nothingCame(const PacketSource& source, const Decoder& decoder) const {
  const Decoder::Counts& counts = decoder.counts();
  std::string text = "no data packet of a " + decoder.model().name + " has come";
  if (source.packets() + source.foreign() > 0)
    text += formatted(" (%llu position packets, %llu foreign)", static_cast<unsigned long long>(counts.position),
                      static_cast<unsigned long long>(counts.foreign + source.foreign()));
  return counts.foreign > 0 ? text + questionOf(by_layout_) : text;
}

}  // namespace lisco_apps
