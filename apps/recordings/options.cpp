// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "recordings/options.h"

#include <limits>
#include <stdexcept>
#include <vector>

#include <boost/algorithm/string/join.hpp>

#include "io/options.h"

namespace lisco_apps {
namespace {

ReturnChoice returnChoice(const std::string& text) {
  if (text == "strongest") return ReturnChoice::kStrongest;
  if (text == "last") return ReturnChoice::kLast;
  if (text == "both") return ReturnChoice::kBoth;
  throw std::runtime_error("--return must be strongest, last or both, not '" + text + "'");
}

Turning turningOf(const std::string& text) {
  if (text == "driver") return Turning::kDriver;
  if (text == "manual") return Turning::kManual;
  throw std::runtime_error("--turning must be driver or manual, not '" + text + "'");
}

const char* nameOf(InputKind kind) {
  switch (kind) {
    case InputKind::kCloudFiles:
      return "files of clouds";
    case InputKind::kRecordedClouds:
      return "clouds";
    case InputKind::kRecordedPackets:
      return "recordings";
    case InputKind::kCapture:
      return "captures";
  }
  return "";
}

}  // namespace

std::string withoutEffect(InputKind kind, const RecordingOptions& recording, const DecoderOptions& decoder,
                          bool has_port) {
  const bool is_recording = kind == InputKind::kRecordedClouds || kind == InputKind::kRecordedPackets;
  const bool has_packets = kind == InputKind::kRecordedPackets || kind == InputKind::kCapture;
  std::vector<std::string> names;
  const auto add = [&names](bool is_idle, const char* name) {
    if (is_idle) names.emplace_back(name);
  };
  add(!recording.topic.empty() && !is_recording, "--topic");
  add(recording.span.from > 0 && kind == InputKind::kCloudFiles, "--from");
  add(recording.span.to < std::numeric_limits<double>::infinity() && kind == InputKind::kCloudFiles, "--to");
  add(has_port && kind != InputKind::kCapture, "--port");
  add(!decoder.sensor.empty() && !has_packets, "--sensor");
  add(!decoder.calibration.empty() && !has_packets, "--calibration");
  add(!decoder.metadata.empty() && !has_packets, "--metadata");
  add(decoder.returns != DecoderOptions().returns && !has_packets, "--return");
  add(decoder.turning != DecoderOptions().turning && !has_packets, "--turning");
  return names.empty() ? "" : boost::algorithm::join(names, ", ") + ": without effect on " + nameOf(kind);
}

void addSensorOptions(boost::program_options::options_description& shown, DecoderOptions& decoder) {
  const std::string sensors = "of packets: the sensor: " + boost::algorithm::join(decodableSensors(), ", ");
  // clang-format off
  shown.add_options()
    ("sensor", textOption("NAME", [&decoder](const std::string& text) { decoder.sensor = text; }), sensors.c_str())
    ("calibration", textOption("FILE", [&decoder](const std::string& text) { decoder.calibration = text; }),
     "of packets: the angles of the sensor's own lasers: of the hdl64e db.xml, or YAML as ROS has it; of the vlp32c "
     "YAML; of Hesai's sensors (pandar...) the maker's CSV. Without it, those of the manual; the hdl64e "
     "needs it")
    ("metadata", textOption("FILE", [&decoder](const std::string& text) { decoder.metadata = text; }),
     "of packets: the metadata (JSON) of the ouster (default: found in the recording, or beside it by its name)")
    ("return", textOption("WHICH", [&decoder](const std::string& text) { decoder.returns = returnChoice(text); }),
     "of packets: strongest, last or both: which returns of a laser and firing are clustered, if the sensor sends two "
     "(default both: a cloud then has two rows for each laser)")
    ("turning", textOption("HOW", [&decoder](const std::string& text) { decoder.turning = turningOf(text); }),
     "of packets of the vlp32c, and of those of the vlp16 with two returns: how far the sensor turns until a laser "
     "fires: driver, as Nebula, a driver for ROS 2, or manual, by the firing times of the manual (default driver)");
  // clang-format on
}

void RecordingOptions::addTo(boost::program_options::options_description& shown) {
  // clang-format off
  shown.add_options()
    ("topic", textOption("NAME", [this](const std::string& text) { topic = text; }),
     "of a recording: the topic of clouds or packets to read (default: the only one that fits; a list if there are "
     "several)")
    ("from", numberOption("S", "--from", span.from),
     "of a recording: begin S seconds after its first message or packet (default 0)")
    ("to", numberOption("S", "--to", span.to), "of a recording: end S seconds after its first message or packet")
    ("every", countOption("--every", every, 1),
     "take the first of every N messages, rotations or files of clouds (default 1)");
  // clang-format on
}

void RecordingOptions::check() const {
  if (span.from < 0) throw std::runtime_error("--from must not be negative");
  if (span.to < span.from) throw std::runtime_error("--to is before --from");
}

}  // namespace lisco_apps
