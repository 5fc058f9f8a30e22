// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "recordings/packet_input.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <utility>

#include <boost/algorithm/string.hpp>

#include "recordings/packet_messages.h"
#include "recordings/topic_choice.h"
#include "sensors/capture_file.h"
#include "sensors/sensor_detection.h"

namespace lisco_apps {
namespace {

constexpr const char* kOuster = "ouster";

/// The packets of a time span.
class SpanPackets : public PacketSource {
 public:
  SpanPackets(std::unique_ptr<PacketSource> source, const TimeSpan& span) : source_(std::move(source)), span_(span) {}

  Arrival next(Packet& packet) override {
    while (true) {
      const Arrival arrival = source_->next(packet);
      foreign_ = source_->foreign();
      error_ = source_->error();
      if (arrival != Arrival::kPacket) return arrival;
      if (!first_us_) first_us_ = packet.time_us;
      const double seconds = 1e-6 * static_cast<double>(packet.time_us - *first_us_);
      if (seconds > span_.to) return Arrival::kEnd;
      if (!span_.holds(seconds)) continue;
      ++packets_;
      return arrival;
    }
  }
  double share() const override { return source_->share(); }

 private:
  std::unique_ptr<PacketSource> source_;
  TimeSpan span_;
  std::optional<std::int64_t> first_us_;
};

/// The packets at the beginning, for preparing a decoder.
class FirstPackets : public PacketSource {
 public:
  FirstPackets(PacketSource& source, const std::function<bool()>& is_interrupted)
      : source_(source), is_interrupted_(is_interrupted) {}

  Arrival next(Packet& packet) override {
    constexpr std::uint64_t kPackets = 100000;  // 8 s of a VLS-128 with two returns, two minutes of a VLP-16
    if (packets_ == kPackets || is_interrupted_()) return Arrival::kEnd;
    ++packets_;
    return source_.next(packet);
  }

 private:
  PacketSource& source_;
  const std::function<bool()>& is_interrupted_;
};

/// Whether a file is the metadata of an Ouster sensor.
bool isMetadata(const fs::path& file) {
  constexpr std::uintmax_t kMaxBytes = 10'000'000;
  std::error_code error;
  if (boost::to_lower_copy(file.extension().string()) != ".json" || fs::file_size(file, error) > kMaxBytes || error)
    return false;
  std::ifstream stream(file, std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  return boost::contains(content, "\"beam_altitude_angles\"");
}

struct MetadataBeside {
  std::vector<fs::path> all;  ///< in the folder of the input
  fs::path named;             ///< the one that the input's name leads to; empty if there is none
};

MetadataBeside metadataBeside(const fs::path& input) {
  MetadataBeside beside;
  std::error_code error;
  const std::string stem = input.stem().string();
  for (fs::directory_iterator entry(fs::absolute(input).parent_path(), error), end; !error && entry != end;
       entry.increment(error))
    if (isMetadata(entry->path())) beside.all.push_back(entry->path());
  std::sort(beside.all.begin(), beside.all.end());
  std::size_t longest = 0;
  for (const fs::path& file : beside.all) {
    const std::string other = file.stem().string();
    if (!boost::starts_with(stem, other) && !boost::starts_with(other, stem)) continue;
    const std::size_t common = std::min(stem.size(), other.size());
    if (common <= longest) continue;
    longest = common;
    beside.named = file;
  }
  return beside;
}

bool isPipe(const fs::path& input) {
  std::error_code unknown;
  const fs::file_type type = fs::status(input, unknown).type();
  return type == fs::file_type::fifo || type == fs::file_type::character;
}

/// Opens the packets from their beginning; empty if they can be read only once.
using OpenPackets = std::function<std::unique_ptr<PacketSource>()>;

/// Finds the metadata of an Ouster sensor beside the input: by its name, or by the packets that it describes. If the
/// sensor is not named, and the packets can be read again, it must describe them.
void findMetadata(const fs::path& input, DecoderOptions& decoder, std::vector<std::string>& notes,
                  const OpenPackets& open) {
  MetadataBeside beside = metadataBeside(input);
  const bool may_be_of_another = decoder.sensor.empty() && open;
  if (!beside.named.empty() && may_be_of_another && !describes(beside.named, *open())) beside.named.clear();
  if (beside.named.empty()) {
    std::vector<fs::path> fitting;
    for (const fs::path& file : beside.all)
      if (open && describes(file, *open())) fitting.push_back(file);
    if (fitting.size() == 1) beside.named = fitting.front();
    if (!open && decoder.sensor == kOuster && beside.all.size() == 1) beside.named = beside.all.front();
  }
  if (beside.named.empty()) return;
  decoder.sensor = kOuster;
  decoder.metadata = beside.named;
  notes.push_back("an Ouster sensor, by the metadata beside it: " + beside.named.filename().string());
}

/// Finds out which sensor sent the packets.
/// \param is_part whether some packets are left out
void findSensor(const fs::path& input, DecoderOptions& decoder, std::vector<std::string>& notes,
                const OpenPackets& open, bool is_part) {
  const std::string all = boost::join(decodableSensors(), ", ");
  if (!open) fail(input, "is no file: name the sensor by --sensor (" + all + ")");
  const std::vector<std::string> names = sensorsThatSent(*open());
  if (names.empty())
    fail(input, std::string("holds no packets ") + (is_part ? "in this part " : "") +
                    "that look like those of a known sensor (" + all + ")");
  if (names.size() > 1) fail(input, "holds packets of " + boost::join(names, " or ") + ": name it by --sensor");
  decoder.sensor = names.front();
  if (decoder.sensor != kOuster)
    notes.push_back("sensor " + decoder.sensor + ", by its packets (--sensor names another)");
}

/// Finds the calibration beside the input, by its name.
void findCalibration(const fs::path& input, DecoderOptions& decoder, std::vector<std::string>& notes) {
  if (!decoder.calibration.empty()) return;
  const bool is_hesai = boost::starts_with(decoder.sensor, "pandar");
  std::vector<std::string> endings;
  if (is_hesai) endings = {".csv"};
  if (decoder.sensor == "vlp32c" || decoder.sensor == "hdl64e") endings = {".yaml", ".yml"};
  if (decoder.sensor == "hdl64e") endings.emplace_back(".xml");
  for (const std::string& ending : endings) {
    std::error_code unknown;
    const fs::path beside = fs::path(input).replace_extension(ending);
    if (!fs::is_regular_file(beside, unknown)) continue;
    decoder.calibration = beside;
    notes.push_back("calibrated by the file beside it: " + beside.filename().string());
    return;
  }
}

}  // namespace

bool isCapture(const fs::path& input) {
  const std::string ending = boost::to_lower_copy(input.extension().string());
  return ending == ".pcap" || ending == ".pcapng" || ending == ".cap";
}

std::string fileNamesOf(const std::vector<fs::path>& files) {
  std::vector<std::string> names;
  for (const fs::path& file : files) names.push_back(file.filename().string());
  return boost::join(names, ", ");
}

PacketInput openPackets(const fs::path& input, const RecordingOptions& options, DecoderOptions decoder,
                        std::optional<std::uint16_t> port, const std::function<bool()>& is_interrupted) {
  PacketInput packets;
  const bool is_recording = isRecording(input);
  const InputKind kind = is_recording ? InputKind::kRecordedPackets : InputKind::kCapture;
  if (const std::string idle = withoutEffect(kind, options, decoder, port.has_value()); !idle.empty())
    packets.notes.push_back(idle);
  std::size_t topic = 0;
  std::string maker;
  if (is_recording) {
    const std::unique_ptr<Recording> recording = openRecording(input);
    topic = chooseTopic(*recording, input, options.topic, true);
    const Topic& chosen = recording->topics()[topic];
    if (kindOf(chosen) != TopicKind::kPackets) fail(input, "topic " + chosen.name + " holds clouds, not packets");
    maker = makerOfPackets(chosen.type);
    const bool is_ouster = decoder.sensor == kOuster || (decoder.sensor.empty() && boost::contains(maker, "Ouster"));
    if (is_ouster && decoder.metadata.empty()) {
      if (const std::string text = metadataIn(input, chosen.name); !text.empty()) {
        decoder.metadata_json = text;
        packets.notes.emplace_back("an Ouster sensor, by the metadata in the recording");
        decoder.sensor = kOuster;
      }
    }
  }
  const auto openSpan = [&](const TimeSpan& span) -> std::unique_ptr<PacketSource> {
    if (is_recording)
      return std::make_unique<MessagePackets>(std::make_unique<TopicReader>(openRecording(input), topic, span));
    return std::make_unique<SpanPackets>(std::make_unique<CaptureFile>(input, port), span);
  };
  const auto open = [&] { return openSpan(options.span); };
  if (!is_recording) packets.source = open();  // says why it is no capture, before anything is asked for

  const bool is_pipe = isPipe(input);
  if (decoder.sensor.empty() && !decoder.metadata.empty()) decoder.sensor = kOuster;
  const OpenPackets open_again = is_pipe ? OpenPackets() : OpenPackets(open);
  const bool may_be_ouster = decoder.sensor.empty() && (maker.empty() || boost::contains(maker, "Ouster"));
  if (decoder.metadata.empty() && decoder.metadata_json.empty() && (decoder.sensor == kOuster || may_be_ouster))
    findMetadata(input, decoder, packets.notes, open_again);
  if (decoder.sensor.empty())
    findSensor(input, decoder, packets.notes, open_again, options.isSpanGiven() || port.has_value());
  if (decoder.sensor == kOuster && decoder.metadata.empty() && decoder.metadata_json.empty()) {
    const std::string beside = fileNamesOf(metadataBeside(input).all);
    fail(input, "needs --metadata FILE, the JSON file of the Ouster sensor" +
                    (beside.empty() ? "" : " (beside it are " + beside + ")"));
  }
  findCalibration(input, decoder, packets.notes);
  if (decoder.sensor == "hdl64e" && decoder.calibration.empty())
    fail(input,
         "needs --calibration FILE, that of the very hdl64e which sent the packets: db.xml, or YAML as ROS has it");
  packets.decoder = makeDecoder(decoder);
  if (!is_pipe) {
    const std::unique_ptr<PacketSource> first = openSpan(TimeSpan());  // columns are the same whatever part is read
    FirstPackets source(*first, is_interrupted);
    packets.decoder->prepare(source);
  }
  if (!packets.source) packets.source = open();
  return packets;
}

}  // namespace lisco_apps
