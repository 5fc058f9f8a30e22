// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "stream/other_sensors.h"

#include <cmath>

#include <boost/algorithm/string/join.hpp>

#include "io/text.h"
#include "sensors/velodyne_decoder.h"
#include "sensors/velodyne_model.h"

namespace lisco_apps {
namespace {

constexpr std::uint64_t kMaxInspected = 100;  ///< foreign packets
constexpr double kMaxOwnDeviation = 0.15;     ///< of the measured pace from the named sensor's
constexpr double kMaxOtherDeviation = 0.1;    ///< and from that of a proposed one

/// "a vlp16", "an ouster"
std::string withArticle(const std::string& name) {
  return (name.empty() || name.find_first_of("aeiou") != 0 ? "a " : "an ") + name;
}

std::string questionOf(const std::vector<std::string>& sensors) {
  return sensors.empty() ? "; is it another --sensor?" : "; is it " + withArticle(boost::join(sensors, " or ")) + "?";
}

}  // namespace

void OtherSensors::inspect(const Packet& packet, Decoder::Kind kind, const Decoder& decoder) {
  const Decoder::Counts& counts = decoder.counts();
  if (kind != Decoder::Kind::kForeign || counts.data > 0 || counts.foreign > kMaxInspected || !by_layout_.empty())
    return;
  by_layout_ = sensorsThatSend(packet);
}

std::string OtherSensors::paceWarning(const Decoder& decoder) {
  const double usual_us = decoder.usualGapUs();
  // Only Velodyne's sensors share a layout.
  if (knows_pace_ || usual_us <= 0) return {};
  knows_pace_ = true;
  const double own_us = decoder.packetPeriodUs();
  if (std::fabs(usual_us / own_us - 1) < kMaxOwnDeviation) return {};
  std::vector<std::string> by_pace;
  for (const std::string& name : velodyneModelNames())
    if (name != "hdl64e" &&  // whose packets are no other's
        std::fabs(usual_us / VelodyneDecoder(velodynePackets(name)).packetPeriodUs() - 1) < kMaxOtherDeviation)
      by_pace.push_back(name);
  return formatted("packets come every %.0f us, but those of %s every %.0f us", usual_us, decoder.name().c_str(),
                   own_us) +
         questionOf(by_pace);
}

std::string OtherSensors::nothingCame(const PacketSource& source, const Decoder& decoder) const {
  const Decoder::Counts& counts = decoder.counts();
  std::string text = "no data packet of " + withArticle(decoder.name()) + " has come";
  if (source.packets() + source.foreign() > 0)
    text += formatted(" (%llu position packets, %llu foreign)", static_cast<unsigned long long>(counts.position),
                      static_cast<unsigned long long>(counts.foreign + source.foreign()));
  return counts.foreign > 0 ? text + questionOf(by_layout_) : text;
}

}  // namespace lisco_apps
