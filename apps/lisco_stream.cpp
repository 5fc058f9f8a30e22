// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// Clusters a sensor's packets while it turns: of a capture, or live by UDP.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <boost/algorithm/string/join.hpp>
#include <boost/program_options.hpp>

#include "io/interruption.h"
#include "io/options.h"
#include "io/scan_file.h"
#include "io/scan_options.h"
#include "io/text.h"
#include "live/live_view.h"
#include "recordings/cloud_columns.h"
#include "recordings/cloud_files.h"
#include "recordings/options.h"
#include "recordings/packet_input.h"
#include "recordings/result_bag.h"
#include "recordings/scan_source.h"
#include "recordings/topic_choice.h"
#include "sensors/decoder.h"
#include "sensors/udp_receiver.h"
#include "stream/endless_stream.h"
#include "stream/labelled_pcd.h"
#include "stream/other_sensors.h"
#include "stream/packet_queue.h"
#include "stream/report.h"
#include "stream/rotation_choice.h"
#include "stream/rotation_stream.h"
#include "stream/window_stream.h"

namespace {

namespace po = boost::program_options;
using namespace lisco_apps;

enum class Mode { kRotation, kEndless, kWindows };

struct Options {
  fs::path capture;                   ///< or recording; empty: live
  std::optional<std::uint16_t> port;  ///< of a capture: only packets to it
  DecoderOptions decoder;
  RecordingOptions recording;
  ReadOptions files;
  Mode mode = Mode::kRotation;
  unsigned window = 0, hop = 0;  ///< columns
  StreamOptions stream;
  bool realtime = false;
  fs::path output, bag;
  bool json = false;
  bool statistics = false;
  std::optional<HttpAddress> http;
  unsigned viewers = 0;  ///< before a capture is read
};

Mode modeOf(const std::string& text) {
  if (text == "rotation") return Mode::kRotation;
  if (text == "endless") return Mode::kEndless;
  if (text == "windows") return Mode::kWindows;
  throw std::runtime_error("--mode must be rotation, endless or windows, not '" + text + "'");
}

/// \return false if --help or --version was given
bool parse(int argc, char** argv, Options& options) {
  po::options_description shown(
      "Usage: lisco_stream CAPTURE.pcap --sensor NAME --tolerance M [options]\n"
      "       lisco_stream RECORDING | CLOUDS --tolerance M [options]\n"
      "       lisco_stream --port N --sensor NAME --tolerance M [options]\n\n"
      "Finds the Euclidean clusters in a rotating LiDAR's packets while the sensor turns. The packets are those of\n"
      "a capture (pcap or pcapng), of messages in a recording (.db3 or .mcap of ROS 2, the folder of such a bag, or\n"
      ".bag of ROS 1), or come by UDP. A recording's clouds (sensor_msgs/PointCloud2 with rows or rings), and those\n"
      "of a file or of a folder of files, are taken column by column, too: each is a rotation. There are three modes:\n"
      "  rotation  The clusters of each rotation, as soon as its last column is in: those of PCL's\n"
      "            EuclideanClusterExtraction on the rotation as an organized cloud, in the same order.\n"
      "            Rotations begin at the azimuth of the first column.\n"
      "  endless   Clusters cross the borders of rotations: each is delivered once, as soon as no later column can\n"
      "            reach it. A cluster of a whole turn is cut there, and continued by others.\n"
      "  windows   The clusters of the last --window columns, after every --hop columns: those of PCL's\n"
      "            EuclideanClusterExtraction on these columns as an organized cloud, in the same order.\n"
      "With --http, a page in any browser shows the columns as they come, the subclusters so far, and the clusters.\n"
      "Ctrl-C ends the program after the packets received so far; a second one ends it at once.\n\n"
      "With --json, each line of the output is an object. Metres; azimuths in degrees clockwise, 0 ahead;\n"
      "time is when the last packet came, in seconds since 1970.\n"
      "  rotation  one line per rotation: rotation (from 1), time, azimuth (where it begins), columns, returns\n"
      "            (clustered), ground (returns left out), lost_packets, latency_ms (from its last column to its\n"
      "            clusters, before their features), and clusters, largest first, each with id (from 1), azimuth\n"
      "            (of its centroid), size, centroid, box (min and max), oriented_box (center, yaw in degrees\n"
      "            counterclockwise from x, length, width, height), nearest_range and density (returns per m2).\n"
      "  windows   the same, one line per window, whose number is window.\n"
      "  endless   one line per cluster: id (from 1, in the order of delivery), time, first_azimuth,\n"
      "            last_azimuth and turns (of its columns, and from the first to the last), size, centroid,\n"
      "            box, oriented_box, nearest_range, density, cut, continued, and latency_ms (from the first\n"
      "            column that cannot reach it to its delivery; null if the end of the packets delivered it).\n\n"
      "Exit code 0; 2 on wrong usage, if no packet is one of the sensor's, if messages or files cannot be read or\n"
      "are left out, or if the recording breaks off (after the packets before it have been clustered).\n\n"
      "Options");
  std::vector<std::string> inputs;
  std::string port;
  ClusterOptions clustering;
  addSensorOptions(shown, options.decoder);
  clustering.addTo(shown);
  ScanOptions scan("slope", false);
  scan.addTo(shown);
  options.recording.addTo(shown);
  addFileOptions(shown, options.files);
  // clang-format off
  shown.add_options()
    ("port", po::value<std::string>(&port)->value_name("N")->implicit_value("default"),
     "UDP port to receive from (without a number: 2368, or 7502 for the ouster; 0: any that is free); with a capture, "
     "take only packets to it")
    ("mode", textOption("NAME", [&](const std::string& text) { options.mode = modeOf(text); }),
     "rotation, endless or windows (default rotation)")
    ("window", countOption("--window", options.window, 1), "columns of a window, a multiple of the hop")
    ("hop", countOption("--hop", options.hop, 1), "a window ends after every N columns")
    ("rotations", countOption("--rotations", options.stream.rotations, 1), "end after N rotations, or windows")
    ("realtime", po::bool_switch(&options.realtime),
     "read a capture at the pace of its recording, without breaks of more than ten seconds (default: as fast as "
     "possible)")
    ("output,o", pathOption("DIR", "--output", options.output),
     "folder for rotation_000001.pcd and so on: each rotation (or window) as an organized cloud of x y z intensity "
     "label ground, where the label is the cluster's id, 0 for none, and ground is 1 for returns left out as ground "
     "(no such field with --ground none); in mode endless, written once all its clusters have been delivered. Removes "
     "those of an earlier run")
    ("bag", pathOption("FILE.mcap", "--bag", options.bag),
     "write each rotation or window as a recording of ROS 2: the labelled cloud (sensor_msgs/PointCloud2) and oriented "
     "boxes (visualization_msgs/MarkerArray)")
    ("json", po::bool_switch(&options.json), "print JSON lines instead of text")
    ("http", textOption("[ADDRESS:]PORT", [&](const std::string& text) { options.http = httpAddressOf(text); }),
     "serve a page that shows the stream to any number of browsers, at http://ADDRESS:PORT/ (default ADDRESS "
     "127.0.0.1: this machine only; PORT 0: any that is free). Slow viewers lose frames and delay nothing")
    ("viewers", countOption("--viewers", options.viewers, 1),
     "with --http, begin a capture or recording when N viewers have opened the page (default: at once)")
    ("stats", po::bool_switch(&options.statistics),
     "print a table of packets, columns, clusters and latencies at the end (with --json, on stderr)");
  // clang-format on
  po::variables_map given;
  if (!readCommandLine(argc, argv, "lisco_stream", shown, &inputs, given)) return false;
  if (inputs.size() > 1) throw std::runtime_error("more than one capture; see --help");
  if (inputs.empty() && given.count("port") == 0) throw std::runtime_error("no capture and no --port; see --help");
  if (!inputs.empty()) options.capture = inputs.front();
  if (!inputs.empty() && inputs.front().empty()) throw std::runtime_error("the capture's name is empty");
  if (port == "default")
    options.port = defaultPort(options.decoder.sensor);
  else if (given.count("port") != 0)
    options.port = static_cast<std::uint16_t>(countOf(port, "--port", 0, std::numeric_limits<std::uint16_t>::max()));
  if (options.realtime && options.capture.empty()) throw std::runtime_error("--realtime is for captures only");
  if (options.capture.empty() && options.decoder.sensor.empty())
    throw std::runtime_error("--sensor is missing (" + boost::join(decodableSensors(), ", ") + "); see --help");
  options.recording.check();
  if (options.capture.empty() && options.recording.areGiven())
    throw std::runtime_error("--topic, --from, --to and --every are for recordings only");
  if (options.mode == Mode::kWindows && (options.window == 0 || options.hop == 0 || options.window % options.hop != 0))
    throw std::runtime_error("--mode windows needs --window and --hop, of which the window is a multiple");
  if (options.mode == Mode::kEndless && !options.bag.empty())
    throw std::runtime_error("--bag is for rotations and windows only");
  if (options.mode != Mode::kWindows && options.window + options.hop > 0)
    throw std::runtime_error("--window and --hop are for --mode windows only");

  if (options.viewers > 0 && (!options.http || options.capture.empty()))
    throw std::runtime_error("--viewers is for captures and recordings with --http only");

  clustering.check();
  scan.check();
  options.stream.tolerance = static_cast<float>(clustering.tolerance);
  options.stream.ground = scan.ground.of("");
  options.stream.region = scan.region;
  options.stream.min_size = clustering.min_size;
  options.stream.max_size = clustering.max_size;
  return true;
}

/// The packets of a capture at the pace of their recording. Breaks of more than ten seconds are skipped.
class PacedCapture : public PacketSource {
 public:
  explicit PacedCapture(std::unique_ptr<PacketSource> capture) : capture_(std::move(capture)) {}

  Arrival next(Packet& packet) override {
    if (!waits_) {
      const Arrival arrival = capture_->next(waiting_);
      foreign_ = capture_->foreign();
      error_ = capture_->error();
      if (arrival != Arrival::kPacket) return arrival;
      const std::chrono::microseconds gap(waiting_.time_us - last_time_us_);
      const auto now = Clock::now();
      const bool goes_on = packets_ > 0 && waiting_.time_us >= last_time_us_ && gap <= kMaxBreak;
      due_ = goes_on ? due_ + gap : now;
      last_time_us_ = waiting_.time_us;
      waits_ = true;
    }
    const auto return_by = Clock::now() + kMaxWait;
    if (due_ > return_by) {
      std::this_thread::sleep_until(return_by);
      return Arrival::kNothing;
    }
    std::this_thread::sleep_until(due_);
    waits_ = false;
    ++packets_;
    packet = waiting_;
    return Arrival::kPacket;
  }
  double share() const override { return capture_->share(); }

 private:
  static constexpr std::chrono::seconds kMaxBreak{10};
  static constexpr std::chrono::milliseconds kMaxWait{50};

  std::unique_ptr<PacketSource> capture_;
  Packet waiting_;  ///< until it is due
  bool waits_ = false;
  std::int64_t last_time_us_ = 0;
  Clock::time_point due_;
};

struct Input {
  std::unique_ptr<PacketSource> source;
  std::unique_ptr<Decoder> decoder;
  PacketQueue* queue = nullptr;    ///< the source, if live
  CloudColumns* clouds = nullptr;  ///< the decoder, if there are clouds instead of packets
  unsigned every = 1;              ///< of how many rotations of packets the first is taken
  std::string name{};              ///< for people: the file or folder, or the port
};

/// A file's or folder's name without those before it, also of "drives/" and ".".
std::string fileNameOf(const fs::path& path) {
  const fs::path whole = fs::absolute(path).lexically_normal();
  return (whole.has_filename() ? whole : whole.parent_path()).filename().string();
}

Input inputOf(std::unique_ptr<PacketSource> source, std::unique_ptr<CloudColumns> columns) {
  CloudColumns* const clouds = columns.get();
  return {std::move(source), std::move(columns), nullptr, clouds};
}

/// Warns of options that do not act on clouds.
void warnOfIdle(const Options& options, InputKind kind, Report& report) {
  const std::string idle = withoutEffect(kind, options.recording, options.decoder, options.port.has_value());
  if (!idle.empty()) report.warn(options.capture.string() + ": " + idle);
}

/// The clouds of a recording, if its topic holds clouds.
std::optional<Input> openClouds(const Options& options, Report& report) {
  if (!isRecording(options.capture)) return std::nullopt;
  std::unique_ptr<Recording> recording = openRecording(options.capture);
  const RecordingOptions& part = options.recording;
  const std::size_t index = chooseTopic(*recording, options.capture, part.topic, !options.decoder.sensor.empty());
  const Topic topic = recording->topics()[index];
  if (kindOf(topic) != TopicKind::kClouds) return std::nullopt;
  report.warn(options.capture.string() + ": topic " + topic.name);
  warnOfIdle(options, InputKind::kRecordedClouds, report);
  auto reader = std::make_unique<TopicReader>(std::move(recording), index, part.span, part.every);
  return inputOf(std::make_unique<RawMessages>(std::move(reader)), std::make_unique<CloudColumns>(topic));
}

/// The clouds of a file, or of the files in a folder.
std::optional<Input> openCloudFiles(const Options& options, Report& report) {
  std::error_code unknown;
  if (isRecording(options.capture)) return std::nullopt;
  if (!fs::is_directory(options.capture, unknown) && !isCloudFile(options.capture)) return std::nullopt;
  ScanSource scans({options.capture.string()}, {});
  if (scans.files().empty()) throw std::runtime_error(scans.takeFailures().front());
  warnOfIdle(options, InputKind::kCloudFiles, report);
  auto clouds = std::make_unique<CloudFiles>(scans.files(), options.recording.every, options.files,
                                             [&report](const std::string& note) { report.warn(note); });
  auto columns = std::make_unique<CloudColumns>([from = clouds.get()](const Packet&) { return from->take(); });
  return inputOf(std::move(clouds), std::move(columns));
}

Input openFile(const Options& options, Report& report) {
  if (std::optional<Input> files = openCloudFiles(options, report)) return std::move(*files);
  if (std::optional<Input> clouds = openClouds(options, report)) return std::move(*clouds);
  if (options.recording.every != 1 && options.mode != Mode::kRotation)
    throw std::runtime_error("--every is for --mode rotation and for clouds only");
  PacketInput packets =
      openPackets(options.capture, options.recording, options.decoder, options.port, Interruption::happened);
  for (const std::string& note : packets.notes) report.warn(options.capture.string() + ": " + note);
  return {std::move(packets.source), std::move(packets.decoder), nullptr, nullptr, options.recording.every};
}

Input open(const Options& options, Report& report) {
  if (options.capture.empty()) {
    std::unique_ptr<Decoder> decoder = makeDecoder(options.decoder);
    auto receiver = std::make_unique<UdpReceiver>(*options.port);
    const std::string name = "UDP port " + std::to_string(receiver->port());
    report.warn("listening on " + name);
    auto queue = std::make_unique<PacketQueue>(std::move(receiver));
    PacketQueue* const live = queue.get();
    return {std::move(queue), std::move(decoder), live, nullptr, 1, name};
  }
  Input input = openFile(options, report);
  input.name = fileNameOf(options.capture);
  if (options.realtime) input.source = std::make_unique<PacedCapture>(std::move(input.source));
  return input;
}

/// When a packet was at hand; live ones wait in the queue after that.
Clock::time_point receivedAt(const Packet& packet, bool is_live) {
  const auto now = Clock::now();
  if (!is_live) return now;
  const auto since_1970 = std::chrono::system_clock::now().time_since_epoch();
  const std::chrono::microseconds arrival(packet.time_us);
  return now - std::max(Clock::duration::zero(), std::chrono::duration_cast<Clock::duration>(since_1970 - arrival));
}

/// Clusters packets until the source ends, a signal comes, or the stream has the wanted rotations.
void takePackets(const Input& input, Decoder& decoder, OtherSensors& others, Stream& stream, Report& report,
                 LiveView* live) {
  bool is_open = true;
  Packet packet;
  Origin origin;
  RotationChoice choice(input.every, decoder.rotationStart());
  const std::function<void(const Column&)> take = [&](const Column& column) {
    if (const std::optional<Column> chosen = choice.choose(column)) is_open = is_open && stream.add(*chosen, origin);
  };
  while (is_open) {
    if (Interruption::happened() && input.queue == nullptr) return;
    if (Interruption::happened()) input.queue->stop();  // packets received so far are still clustered
    const PacketSource::Arrival arrival = input.source->next(packet);
    if (arrival != PacketSource::Arrival::kPacket) decoder.flush(take);
    if (arrival == PacketSource::Arrival::kEnd) return;
    if (arrival == PacketSource::Arrival::kNothing) {
      stream.wait();
    } else {
      origin = {packet.time_us, receivedAt(packet, input.queue != nullptr)};
      others.inspect(packet, decoder.decode(packet, take), decoder);
      if (const std::string warning = others.paceWarning(decoder); !warning.empty()) report.warn(warning);
    }
    report.flush();
    report.showStatus(decoder, stream, input.queue == nullptr ? input.source.get() : nullptr);
    if (live != nullptr) live->handOver(decoder, stream);
  }
}

/// A rotation or window as a recording has it: a row for each laser.
/// \param frame of the coordinates; empty: the sensor's
LabelledScan labelledScanOf(const Turn& turn, const std::vector<FoundCluster>& clusters, const std::string& frame,
                            bool has_ground) {
  LabelledScan scan;
  scan.time_ns = 1000 * turn.time_us;
  scan.frame = frame.empty() ? "lidar" : frame;
  scan.rows = turn.lasers;
  scan.columns = turn.columns();
  for (std::size_t row = 0; row < scan.rows; ++row)
    for (std::size_t column = 0; column < scan.columns; ++column) {
      const std::size_t cell = column * turn.lasers + row;
      scan.points.push_back({turn.cells[cell].x, turn.cells[cell].y, turn.cells[cell].z});
      scan.labels.push_back(turn.labels[cell]);
      if (has_ground) scan.ground.push_back(turn.isGround(cell) ? 1 : 0);
    }
  for (const FoundCluster& cluster : clusters) scan.boxes.push_back({cluster.id, cluster.features.box});
  return scan;
}

std::unique_ptr<Stream> makeStream(const Options& options, const Decoder& decoder, Listener& report) {
  if (options.mode == Mode::kEndless) return std::make_unique<EndlessStream>(options.stream, decoder, report);
  if (options.mode == Mode::kWindows)
    return std::make_unique<WindowStream>(options.stream, decoder, report, options.window, options.hop);
  return std::make_unique<RotationStream>(options.stream, decoder, report);
}

int run(const Options& options) {
  Interruption::listen();
  std::optional<LabelledClouds> clouds;
  Report report(options.json ? Report::Format::kJson : Report::Format::kText);
  const Input input = open(options, report);
  Decoder& decoder = *input.decoder;
  const bool has_ground = options.stream.ground.method != GroundChoice::Method::kNone;
  std::optional<ResultBag> bag;
  if (!options.bag.empty()) {
    bag.emplace(options.bag, "lisco_stream");
    report.callWith([&bag, &input, has_ground](const Turn& turn, const std::vector<FoundCluster>& clusters) {
      bag->write(labelledScanOf(turn, clusters, input.clouds != nullptr ? input.clouds->frame() : "", has_ground));
    });
  }
  std::unique_ptr<LiveView> live;
  if (options.http) {
    live = std::make_unique<LiveView>(*options.http, report, options.stream, input.name + ", " + decoder.name(),
                                      options.window);
    report.warn("view at " + live->url());
  }
  if (!options.output.empty()) {  // last, as it replaces earlier clouds
    clouds.emplace(options.output, has_ground);
    report.writeTo(*clouds);
  }
  const std::unique_ptr<Stream> stream =
      makeStream(options, decoder, live ? live->listener() : static_cast<Listener&>(report));

  OtherSensors others;
  while (live && live->viewers() < options.viewers && !Interruption::happened())
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  takePackets(input, decoder, others, *stream, report, live.get());
  stream->finish();
  report.flush();
  if (live) live->finish(decoder, *stream);
  report.warnOfOutliers(*stream);
  if (bag) bag->finish();
  if (options.statistics) report.printStatistics(*input.source, decoder, *stream);

  const std::string& error = input.source->error();
  if (!error.empty()) report.warn(error);
  const std::vector<std::string> left_out =
      input.clouds != nullptr ? input.clouds->leftOut() : std::vector<std::string>();
  for (const std::string& line : left_out) report.warn(options.capture.string() + ": " + line);
  const bool was_cut_short = Interruption::happened() && input.queue == nullptr;
  if (input.clouds != nullptr && decoder.counts().data == 0 && left_out.empty() && error.empty() && !was_cut_short)
    fail(options.capture,
         options.recording.isSpanGiven() ? "holds no cloud between --from and --to" : "holds no cloud");
  if (input.clouds != nullptr) return error.empty() && left_out.empty() ? 0 : 2;
  if (decoder.counts().data == 0 && !was_cut_short)
    throw std::runtime_error((options.capture.empty() ? "" : options.capture.string() + ": ") +
                             others.nothingCame(*input.source, decoder) +
                             (options.port && !isRecording(options.capture) && decoder.counts().foreign == 0
                                  ? "; only packets to port " + std::to_string(*options.port) + " count"
                                  : ""));
  return error.empty() ? 0 : 2;
}

}  // namespace

int main(int argc, char** argv) {
  return runProgram("lisco_stream", [&] {
    Options options;
    return parse(argc, argv, options) ? run(options) : 0;
  });
}
