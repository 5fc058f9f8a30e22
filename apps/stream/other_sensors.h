// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <string>
#include <vector>

#include "sensors/decoder.h"
#include "sensors/packet_source.h"

namespace lisco_apps {

/// Detects packets of another sensor than the one named, and proposes which.
class OtherSensors {
 public:
  /// \param kind the decoder's result for the packet
  void inspect(const Packet& packet, Decoder::Kind kind, const Decoder& decoder);

  /// One line, once, if packets come at another pace than this sensor's; otherwise empty.
  std::string paceWarning(const Decoder& decoder);

  /// One line, for the case that no packet was this sensor's.
  std::string nothingCame(const PacketSource& source, const Decoder& decoder) const;

 private:
  std::vector<std::string> by_layout_;  ///< sensors that send such packets
  bool knows_pace_ = false;
};

}  // namespace lisco_apps
