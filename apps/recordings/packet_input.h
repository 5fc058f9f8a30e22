// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "recordings/options.h"
#include "sensors/decoder.h"
#include "sensors/packet_source.h"

namespace lisco_apps {

/// Whether an input is a capture of packets (pcap, pcapng, cap), by its ending.
bool isCapture(const fs::path& input);

/// "A, B": files without their folders.
std::string fileNamesOf(const std::vector<fs::path>& files);

/// Packets on file and the sensor they are from.
struct PacketInput {
  std::unique_ptr<PacketSource> source;
  std::unique_ptr<Decoder> decoder;
  std::vector<std::string> notes;  ///< what was found out beyond the options, a line each
};

/// Opens a capture, or a topic of packets in a recording, for reading from its beginning.
/// - Without a sensor, it is found out by the packets; those of a pipe must be named.
/// - Ouster's metadata are found in the recording, or beside the input: a `.json` of its name, of a beginning of it, of
///   its name and more, or the only one that describes the packets.
/// - The calibration is found beside the input by its name: a `.csv` of a Hesai's, a `.yaml` of a vlp32c or hdl64e, or
///   an `.xml` of the latter.
/// The decoder is prepared on the packets at the beginning.
/// \param input a pipe is read once: its decoder is not prepared
/// \param port of a capture: takes only packets to it
/// \param is_interrupted ends the preparation
/// \throws std::runtime_error with one line, or with the recording's topics
PacketInput openPackets(const fs::path& input, const RecordingOptions& options, DecoderOptions decoder,
                        std::optional<std::uint16_t> port, const std::function<bool()>& is_interrupted);

}  // namespace lisco_apps
