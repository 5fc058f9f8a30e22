// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <string>
#include <vector>

#include "io/text.h"
#include "sensors/packet_source.h"

namespace lisco_apps {

/// The sensors that may have sent the packets at the beginning of a source: by their layout, see sensorsThatSend (),
/// and those of equal layouts (Velodyne's) by their pace, or by the model that the packets name if they are too few.
std::vector<std::string> sensorsThatSent(PacketSource& source);

/// Whether the metadata of an Ouster sensor describes the packets at the beginning of a source, by their size and the
/// serial number in them. False for a malformed file.
bool describes(const fs::path& metadata, PacketSource& source);

}  // namespace lisco_apps
