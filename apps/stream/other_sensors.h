// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <string>
#include <vector>

#include "sensors/decoder.h"
#include "sensors/packet_source.h"

namespace lisco_apps {

/// Finds out whether packets are another sensor's than the one that was named, and whose they may be. The hdl64e is never
/// proposed, since it needs a calibration.
class OtherSensors {
 public:
  /// \param kind what the decoder made of the packet
  void look(const Packet& packet, Decoder::Kind kind, const Decoder& decoder);

  /// One line, once, if packets come at another pace than this sensor sends them; else empty.
  std::string paceWarning(const Decoder& decoder);

  /// One line, if none of the packets was this sensor's.
  std::string nothingCame(const PacketSource& source, const Decoder& decoder) const;

 private:
  std::vector<std::string> by_layout_;  ///< sensors that send such packets
  bool knows_pace_ = false;
};

}  // namespace lisco_apps
