// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// lisco_stream, run as a program: on captures and on live packets.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <numeric>
#include <ostream>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "../sensors/calibration.h"
#include "../sensors/ouster_packets.h"
#include "../sensors/packets.h"
#include "child.h"
#include "program_test.h"
#include "sensors/capture_file.h"

namespace {

namespace fs = std::filesystem;
using lisco_test::Bytes;
using lisco_test::Frame;
using lisco_test::Measured;
using lisco_test::PacketEncoder;
using Json = nlohmann::json;

/// A binary PCD, its fields as 32 bits each, smaller ones extended by zeros.
struct Pcd {
  std::size_t width = 0, height = 0;
  std::vector<std::string> fields;
  std::vector<std::uint32_t> values;

  std::size_t cells() const { return width * height; }
  std::vector<std::uint32_t> field(const std::string& name) const {
    const auto found = std::find(fields.begin(), fields.end(), name);
    std::vector<std::uint32_t> column;
    if (found == fields.end()) return column;
    for (auto at = static_cast<std::size_t>(found - fields.begin()); at < values.size(); at += fields.size())
      column.push_back(values[at]);
    return column;
  }
};

Pcd pcdOf(const std::string& content) {
  Pcd pcd;
  std::vector<std::size_t> sizes;
  std::istringstream header(content);
  for (std::string line; std::getline(header, line) && line != "DATA binary";) {
    std::istringstream words(line);
    std::string key;
    words >> key;
    if (key == "WIDTH") words >> pcd.width;
    if (key == "HEIGHT") words >> pcd.height;
    if (key == "FIELDS")
      for (std::string name; words >> name;) pcd.fields.push_back(name);
    if (key == "SIZE")
      for (std::size_t size; words >> size;) sizes.push_back(size);
  }
  EXPECT_EQ(sizes.size(), pcd.fields.size());
  const std::size_t bytes = pcd.cells() * std::accumulate(sizes.begin(), sizes.end(), std::size_t{0});
  const auto start = static_cast<std::size_t>(std::max<std::streamoff>(0, header.tellg()));
  EXPECT_EQ(content.size(), start + bytes);
  if (content.size() != start + bytes) return pcd;
  const char* at = content.data() + start;
  for (std::size_t cell = 0; cell < pcd.cells(); ++cell)
    for (const std::size_t size : sizes) {
      std::uint32_t value = 0;
      std::memcpy(&value, at, std::min(size, sizeof value));
      pcd.values.push_back(value);
      at += size;
    }
  return pcd;
}

std::vector<Json> linesOf(const std::string& out) {
  std::vector<Json> lines;
  std::istringstream stream(out);
  for (std::string line; std::getline(stream, line);) lines.push_back(Json::parse(line));
  return lines;
}
std::vector<Json> withoutTimes(std::vector<Json> lines) {
  for (Json& line : lines) {
    line.erase("time");
    line.erase("latency_ms");
  }
  return lines;
}

/// A number of the closing table: the first in the row of this name, otherwise the one before this word.
long long statOf(const std::string& table, const std::string& word) {
  std::istringstream rows(table);
  for (std::string row; std::getline(rows, row);)
    if (row.rfind(word + " ", 0) == 0) return std::stoll(row.substr(word.size()));
  const std::size_t at = table.find(" " + word);
  if (at == std::string::npos) {
    ADD_FAILURE() << "no " << word << " in\n" << table;
    return -1;
  }
  return std::stoll(table.substr(table.rfind(' ', at - 1) + 1));
}

class LiscoStream : public ProgramTest {
 protected:
  LiscoStream() : ProgramTest(LISCO_STREAM) {}

  void writeCapture(const std::string& name, const std::vector<Bytes>& payloads) const {
    std::vector<Frame> frames;
    for (std::size_t i = 0; i < payloads.size(); ++i)
      frames.push_back({lisco_test::ethernetOf(lisco_test::ipv4Of(lisco_test::udpOf(payloads[i]))),
                        1700000000000000 + 500 * static_cast<std::int64_t>(i)});
    lisco_test::writeFile(folder_ / name, lisco_test::captureOf(frames));
  }

  Pcd cloud(const std::string& folder, std::size_t number) const {
    char name[32];
    std::snprintf(name, sizeof name, "rotation_%06zu.pcd", number);
    return pcdOf(textOf(folder_ / folder / name));
  }

  /// Compares the labels of each cloud with lisco_cluster's.
  void expectLabelsOfBatch(const std::string& folder, std::size_t clouds, const std::string& options) const {
    const Outcome batch = runLine(std::string(LISCO_CLUSTER) + " " + folder + " " + options + " -o batch");
    ASSERT_EQ(batch.status, 0) << batch.err;
    for (std::size_t i = 1; i <= clouds; ++i) {
      char name[32];
      std::snprintf(name, sizeof name, "rotation_%06zu", i);
      const fs::path labels = clouds == 1 ? folder_ / "batch" : folder_ / "batch" / name;
      EXPECT_EQ(cloud(folder, i).field("label"), pcdOf(textOf(labels / "labels.pcd")).field("label")) << i;
    }
  }

  /// Checks that lines of mode rotation, table and clouds agree.
  void expectRotationsAgree(const std::vector<Json>& lines, const std::string& table, const std::string& folder) const {
    std::size_t columns = 0, returns = 0, clusters = 0, in_clusters = 0;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const Json& line = lines[i];
      SCOPED_TRACE(i);
      EXPECT_EQ(line["rotation"], i + 1);
      EXPECT_GE(line["latency_ms"].get<double>(), 0);
      columns += line["columns"].get<std::size_t>();
      returns += line["returns"].get<std::size_t>();
      clusters += line["clusters"].size();
      const Pcd pcd = cloud(folder, i + 1);
      EXPECT_EQ(pcd.width, line["columns"].get<std::size_t>());
      std::map<std::uint32_t, std::size_t> sizes;
      for (const std::uint32_t label : pcd.field("label")) ++sizes[label];
      sizes.erase(0);
      EXPECT_EQ(sizes.size(), line["clusters"].size());
      const std::vector<std::uint32_t> ground = pcd.field("ground");  // empty with --ground none
      EXPECT_EQ(std::accumulate(ground.begin(), ground.end(), std::size_t{0}), line["ground"].get<std::size_t>());
      for (std::size_t k = 0; k < line["clusters"].size(); ++k) {
        const Json& cluster = line["clusters"][k];
        EXPECT_EQ(cluster["id"], k + 1);
        EXPECT_EQ(cluster["size"], sizes[static_cast<std::uint32_t>(k + 1)]);
        in_clusters += cluster["size"].get<std::size_t>();
        for (std::size_t axis = 0; axis < 3; ++axis) {
          EXPECT_LE(cluster["box"]["min"][axis], cluster["centroid"][axis]);
          EXPECT_LE(cluster["centroid"][axis], cluster["box"]["max"][axis]);
        }
      }
    }
    EXPECT_EQ(statOf(table, "rotations"), static_cast<long long>(lines.size()));
    EXPECT_EQ(statOf(table, "columns"), static_cast<long long>(columns));
    EXPECT_EQ(statOf(table, "returns"), static_cast<long long>(returns));
    EXPECT_EQ(statOf(table, "clusters"), static_cast<long long>(clusters));
    EXPECT_NE(table.find(", of " + std::to_string(in_clusters) + " returns"), std::string::npos) << table;
  }

  /// Checks that lines of mode endless, table and clouds agree.
  void expectDeliveriesAgree(const std::vector<Json>& lines, const std::string& table,
                             const std::string& folder) const {
    std::map<std::uint32_t, std::size_t> sizes;
    const auto turns = static_cast<std::size_t>(statOf(table, "rotations"));
    for (std::size_t i = 1; i <= turns; ++i)
      for (const std::uint32_t label : cloud(folder, i).field("label")) ++sizes[label];
    std::size_t in_clusters = 0;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      EXPECT_EQ(lines[i]["id"], i + 1);
      EXPECT_EQ(lines[i]["size"], sizes[static_cast<std::uint32_t>(i + 1)]) << i;
      EXPECT_TRUE(lines[i]["latency_ms"].is_null() || lines[i]["latency_ms"] >= 0);
      EXPECT_LT(lines[i]["turns"], 1);
      in_clusters += lines[i]["size"].get<std::size_t>();
    }
    sizes.erase(0);
    EXPECT_EQ(sizes.size(), lines.size());
    EXPECT_EQ(statOf(table, "clusters"), static_cast<long long>(lines.size()));
    EXPECT_NE(table.find(", of " + std::to_string(in_clusters) + " returns"), std::string::npos) << table;
  }
};

/// Objects around the sensor that drift from rotation to rotation.
Measured objectsAround(std::size_t firing, std::size_t laser, bool) {
  const std::size_t place = firing / 40;
  if (place % 3 == 2 || laser % 16 == 15) return {};
  const std::size_t distance = 2500 + 700 * (place % 7) + firing / 50;
  return {static_cast<std::uint16_t>(distance), static_cast<std::uint8_t>(laser)};
}

std::vector<Bytes> packetsOf(PacketEncoder encoder, std::size_t count) {
  std::vector<Bytes> packets;
  for (std::size_t i = 0; i < count; ++i) packets.push_back(encoder.next(objectsAround));
  return packets;
}

// --- Captures of real sensors --------------------------------------------------------------------------------------

struct Case {
  const char *capture, *sensor, *scan;
  std::size_t rotation;  ///< of the scan, from 1
  const char* ground_z;
  std::size_t compared;  ///< rotations whose clusters are compared with lisco_cluster's
};
void PrintTo(const Case& c, std::ostream* out) {
  *out << c.scan;
}

class StreamOfCapture : public LiscoStream, public testing::WithParamInterface<Case> {
 protected:
  void SetUp() override {
    LiscoStream::SetUp();
    const char* const folder = std::getenv("LISCO_TEST_DATA");
    data_ = fs::absolute(folder != nullptr ? folder : LISCO_TEST_DATA_DEFAULT);
    if (!fs::is_directory(data_ / "captures"))
      GTEST_SKIP() << "no real captures: there is no folder " << data_ / "captures"
                   << "; set LISCO_TEST_DATA to the data folder";
  }
  fs::path capture() const { return data_ / "captures" / (std::string(GetParam().capture) + ".pcap"); }
  std::string input() const {
    return "'" + capture().string() + "' --sensor " + GetParam().sensor + " " + clustering();
  }
  static std::string clustering() { return std::string("--tolerance 0.4 --ground-z ") + GetParam().ground_z; }

  fs::path data_;
};
INSTANTIATE_TEST_SUITE_P(Captures, StreamOfCapture,
                         testing::Values(Case{"hdl32e_outdoor", "hdl32e", "hdl32e_outdoor_0", 3, "-2.10", 18},
                                         Case{"vlp16_close", "vlp16", "vlp16_close_0", 11, "-0.57", 15},
                                         Case{"vlp16_street", "vlp16", "vlp16_street_0", 1, "-1.99", 2},
                                         Case{"vls128_street", "vls128", "vls128_street_0", 1, "-1.74", 4}),
                         [](const auto& test) { return std::string(test.param.scan); });

TEST_P(StreamOfCapture, GivesTheScansAndTheirClusters) {
  const std::string rotations = " --rotations " + std::to_string(GetParam().rotation);
  ASSERT_EQ(run(input() + rotations + " -o clouds").status, 0);
  const fs::path scan = data_ / "scans" / (std::string(GetParam().scan) + ".pcd");
  ASSERT_EQ(runLine(std::string(LISCO_CLUSTER) + " '" + scan.string() + "' " + clustering() + " -o batch").status, 0);
  const Pcd streamed = cloud("clouds", GetParam().rotation);
  const Pcd expected = pcdOf(textOf(scan));
  EXPECT_EQ(streamed.width, expected.width);
  EXPECT_EQ(streamed.height, expected.height);
  for (const char* field : {"x", "y", "z", "intensity"}) {
    const std::vector<std::uint32_t> ours = streamed.field(field), theirs = expected.field(field);
    ASSERT_EQ(ours.size(), theirs.size());
    std::size_t unlike = 0;
    for (std::size_t i = 0; i < ours.size(); ++i) {
      float a, b;
      std::memcpy(&a, &ours[i], sizeof a);
      std::memcpy(&b, &theirs[i], sizeof b);
      unlike += std::fabs(a - b) < 1e-6F || (std::isnan(a) && std::isnan(b)) ? 0 : 1;
    }
    EXPECT_EQ(unlike, 0U) << field;
  }
  const Pcd batch = pcdOf(textOf(folder_ / "batch/labels.pcd"));
  EXPECT_EQ(streamed.field("label"), batch.field("label"));
  EXPECT_EQ(streamed.field("ground"), batch.field("ground"));
}

TEST_P(StreamOfCapture, LeavesOutTheGroundUnlessToldOtherwise) {
  const auto totals = [this](const std::string& options, const char* mode) {
    const Outcome outcome = run("'" + capture().string() + "' --sensor " + GetParam().sensor +
                                " --json --stats --rotations 2 --tolerance 0.4 " + options + " --mode " + mode);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const bool has_ground =
        outcome.err.find("of the ground, left out; --ground none keeps them\n") != std::string::npos;
    for (const Json& line : linesOf(outcome.out)) {
      const bool is_rotation = mode == std::string("rotation");
      if (is_rotation && line["clusters"].empty()) continue;
      const Json& cluster = is_rotation ? line["clusters"].back() : line;
      EXPECT_GE(cluster["oriented_box"]["length"], cluster["oriented_box"]["width"]);
      EXPECT_GE(cluster["density"], 0);
    }
    return std::pair<double, bool>{static_cast<double>(statOf(outcome.err, "returns")), has_ground};
  };
  for (const char* mode : {"rotation", "endless"}) {
    const auto all = totals("--ground none", mode);
    const auto rest = totals("", mode);
    EXPECT_FALSE(all.second);
    // Too few columns of that one show the floor.
    const bool shows_ground = GetParam().scan != std::string("vlp16_close_0");
    EXPECT_EQ(rest.second, shows_ground);
    EXPECT_EQ(rest.first < all.first, shows_ground) << mode;
    EXPECT_GT(rest.first, 0.3 * all.first) << mode;
    EXPECT_LT(totals("--ground none --max-range 8", mode).first, all.first) << mode;
    EXPECT_EQ(totals("--ground none --ignore-box -300,-300,-300,300,300,300", mode).first, 0) << mode;
  }
}

TEST_P(StreamOfCapture, ClustersEachRotationAsABatchDoes) {
  const Outcome all = run(input() + " --json --stats -o all");
  ASSERT_EQ(all.status, 0) << all.err;
  expectRotationsAgree(linesOf(all.out), all.err, "all");
  const std::string some = " --rotations " + std::to_string(GetParam().compared);
  ASSERT_EQ(run(input() + some + " -o clouds").status, 0);
  expectLabelsOfBatch("clouds", GetParam().compared, clustering());
}

TEST_P(StreamOfCapture, DeliversEachClusterOnce) {
  const Outcome outcome = run(input() + " --mode endless --json --stats -o clouds");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  expectDeliveriesAgree(linesOf(outcome.out), outcome.err, "clouds");
  EXPECT_EQ(statOf(outcome.err, "lost"), 0);
  EXPECT_NE(outcome.err.find("0 outliers"), std::string::npos) << outcome.err;
}

TEST_P(StreamOfCapture, PrintsText) {
  for (const char* mode : {"rotation", "endless"}) {
    const Outcome outcome = run(input() + " --rotations 1 --stats --mode " + mode);
    EXPECT_EQ(outcome.status, 0);
    EXPECT_EQ(outcome.err, "");
    EXPECT_EQ(outcome.out.find(mode == std::string("rotation") ? "rotation 1: " : "turn 1: "), 0U) << outcome.out;
    EXPECT_EQ(statOf(outcome.out, "rotations"), 1);
  }
}

// --- Live packets ---------------------------------------------------------------------------------------------------

/// Sends packets to a UDP port of this machine at about the rate of a sensor.
void sendTo(std::uint16_t port, const std::vector<Bytes>& payloads) {
  const int from = socket(AF_INET, SOCK_DGRAM, 0);
  ASSERT_GE(from, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(port);
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  for (const Bytes& payload : payloads) {
    sendto(from, payload.data(), payload.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
    std::this_thread::sleep_for(std::chrono::microseconds(250));
  }
  close(from);
}

/// The port that the program reports.
std::uint16_t portOf(const Child& child) {
  const std::string said = "listening on UDP port ";
  EXPECT_TRUE(Child::waitUntil([&] { return child.err().find('\n') != std::string::npos; }));
  const std::size_t at = child.err().find(said);
  return at == std::string::npos ? std::uint16_t{0}
                                 : static_cast<std::uint16_t>(std::stoul(child.err().substr(at + said.size())));
}

/// Runs the program on a free port, sends it packets, and ends it by Ctrl-C after all lines that come before the end.
Outcome receive(const fs::path& folder, const std::vector<Bytes>& payloads, const std::vector<std::string>& arguments,
                std::size_t lines_before_end) {
  std::vector<std::string> all{"--port", "0"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  Child child(LISCO_STREAM, all, folder);
  sendTo(portOf(child), payloads);
  // Until no more lines come, as lost packets may have cost some.
  std::size_t lines = 0, before = 0;
  do {
    before = lines;
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    const std::string out = child.out();
    lines = static_cast<std::size_t>(std::count(out.begin(), out.end(), '\n'));
  } while (lines < lines_before_end && lines != before);
  child.signal(SIGINT);
  return child.end();
}

/// Repeats receive (), up to three times, if the system has lost packets.
Outcome receiveAll(const fs::path& folder, const std::vector<Bytes>& payloads,
                   const std::vector<std::string>& arguments, std::size_t lines_before_end, long long data_packets) {
  Outcome outcome{};
  for (int attempt = 0; attempt < 3; ++attempt) {
    outcome = receive(folder, payloads, arguments, lines_before_end);
    if (outcome.status != 0 || statOf(outcome.err, "data") == data_packets) break;
  }
  return outcome;
}

std::size_t linesThatArePrintedBeforeTheEnd(const std::vector<Json>& lines, bool endless) {
  if (!endless) return lines.size() - 1;
  return static_cast<std::size_t>(
      std::count_if(lines.begin(), lines.end(), [](const Json& line) { return !line["latency_ms"].is_null(); }));
}

TEST_F(LiscoStream, GivesTheSameLiveAsFromACapture) {
  for (const char* sensor : {"vlp16", "hdl32e", "vls128"}) {
    PacketEncoder encoder(sensor);
    const std::vector<Bytes> payloads = packetsOf(encoder, 2 * 1800 / encoder.firingsPerPacket());
    writeCapture("a.pcap", payloads);
    for (const bool endless : {false, true}) {
      SCOPED_TRACE(std::string(sensor) + (endless ? " endless" : ""));
      const std::string mode = endless ? "endless" : "rotation";
      const Outcome file = run(std::string("a.pcap --json --stats -t 0.5 --sensor ") + sensor + " --mode " + mode);
      ASSERT_EQ(file.status, 0) << file.err;
      const long long data = statOf(file.err, "data");
      const std::vector<Json> expected = linesOf(file.out);
      ASSERT_GT(expected.size(), 0U);
      const Outcome live =
          receiveAll(folder_, payloads, {"--json", "--stats", "-t", "0.5", "--sensor", sensor, "--mode", mode},
                     linesThatArePrintedBeforeTheEnd(expected, endless), data);
      EXPECT_EQ(live.status, 0) << live.err;
      EXPECT_EQ(withoutTimes(linesOf(live.out)), withoutTimes(expected)) << live.err;
    }
  }
}

TEST_P(StreamOfCapture, GivesTheSameByUdp) {
  // Live packets and pipes are decoded without the step of the whole capture.
  std::vector<Bytes> payloads;
  lisco_apps::CaptureFile file(capture());
  lisco_apps::Packet packet;
  while (payloads.size() < 1200 && file.next(packet) == lisco_apps::PacketSource::Arrival::kPacket)
    payloads.emplace_back(packet.data, packet.data + packet.size);
  writeCapture("a.pcap", payloads);
  for (const bool endless : {false, true}) {
    SCOPED_TRACE(endless);
    const std::string mode = endless ? "endless" : "rotation";
    const Outcome piped = runLine("sh -c 'cat a.pcap | " + program_ + " /dev/stdin --json --stats --sensor " +
                                  GetParam().sensor + " --mode " + mode + " " + clustering() + "'");
    ASSERT_EQ(piped.status, 0) << piped.err;
    const long long data = statOf(piped.err, "data");
    const std::vector<Json> expected = linesOf(piped.out);
    const Outcome live = receiveAll(folder_, payloads,
                                    {"--json", "--stats", "--sensor", GetParam().sensor, "--mode", mode, "-t", "0.4",
                                     "--ground-z", GetParam().ground_z},
                                    linesThatArePrintedBeforeTheEnd(expected, endless), data);
    EXPECT_EQ(live.status, 0) << live.err;
    EXPECT_EQ(withoutTimes(linesOf(live.out)), withoutTimes(expected)) << live.err;
  }
}

TEST_F(LiscoStream, EndsAfterTheWantedRotations) {
  PacketEncoder encoder("hdl32e");
  const std::vector<Bytes> payloads = packetsOf(encoder, 500);
  for (const char* mode : {"rotation", "endless"}) {
    Child child(LISCO_STREAM,
                {"--port", "0", "--sensor", "hdl32e", "-t", "0.5", "--rotations", "2", "--mode", mode, "--stats"},
                folder_);
    sendTo(portOf(child), payloads);
    const Outcome outcome = child.end();
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(statOf(outcome.out, "rotations"), 2);
    EXPECT_LE(statOf(outcome.out, "columns"), 2 * 1800);  // the system may lose packets
  }
}

TEST_F(LiscoStream, ReportsThatNoPacketCame) {
  const Outcome outcome = receive(folder_, {}, {"--sensor", "vlp16", "-t", "1"}, 0);
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("no data packet of a vlp16 has come"), std::string::npos) << outcome.err;
}

// --- Ctrl-C, and the pace ------------------------------------------------------------------------------------------

TEST_F(LiscoStream, ClustersReceivedPacketsOnCtrlC) {
  writeCapture("a.pcap", packetsOf(PacketEncoder("hdl32e"), 4000));  // 2 s
  for (const bool endless : {false, true})
    for (const int number : {SIGINT, SIGTERM}) {
      const std::string mode = endless ? "endless" : "rotation";
      const std::string options = "a.pcap --json --stats -t 0.5 --sensor hdl32e --mode " + mode;
      const std::vector<Json> all = withoutTimes(linesOf(run(options).out));
      fs::remove_all(folder_ / "clouds");
      Child child(LISCO_STREAM,
                  {"a.pcap", "--realtime", "--json", "--stats", "-t", "0.5", "--sensor", "hdl32e", "--mode", mode, "-o",
                   "clouds"},
                  folder_);
      ASSERT_TRUE(Child::waitUntil([&] { return child.out().find('\n') != std::string::npos; }));
      std::this_thread::sleep_for(std::chrono::milliseconds(300));
      child.signal(number);
      const Outcome outcome = child.end();
      EXPECT_EQ(outcome.status, 0) << outcome.err;
      const std::vector<Json> lines = linesOf(outcome.out);
      ASSERT_GT(lines.size(), 1U);
      EXPECT_LT(lines.size(), all.size());
      if (endless) {
        expectDeliveriesAgree(lines, outcome.err, "clouds");
      } else {
        expectRotationsAgree(lines, outcome.err, "clouds");
        const std::vector<Json> told = withoutTimes(lines);
        EXPECT_TRUE(std::equal(told.begin(), told.end() - 1, all.begin()));
        EXPECT_LE(told.back()["columns"], all[told.size() - 1]["columns"]);
      }
    }
}

TEST_F(LiscoStream, KeepsThePaceOfTheCapture) {
  writeCapture("a.pcap", packetsOf(PacketEncoder("hdl32e"), 600));  // 0.3 s
  const auto start = std::chrono::steady_clock::now();
  ASSERT_EQ(run("a.pcap --realtime -t 0.5 --sensor hdl32e").status, 0);
  EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(290));
}

// --- Simulated drives ----------------------------------------------------------------------------------------------

TEST_F(LiscoStream, FindsTheObjectsOfASimulatedDrive) {
  const Outcome simulated = runLine(std::string(LISCO_SIMULATE) +
                                    " --terrain plane --sensor hdl32e --speed 10 --rotations 3 --pcap -o drive");
  ASSERT_EQ(simulated.status, 0) << simulated.err;
  const Outcome outcome = run("drive/capture.pcap --sensor hdl32e -t 0.4 --ground-z -1.5 -o clouds");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  for (std::size_t rotation = 1; rotation <= 3; ++rotation) {
    const Pcd truth = cloud("drive", rotation);
    const Pcd streamed = cloud("clouds", rotation);
    ASSERT_EQ(streamed.width, truth.width);
    ASSERT_EQ(streamed.height, truth.height);
    for (const char* axis : {"x", "y", "z"}) {
      const std::vector<std::uint32_t> is = streamed.field(axis);
      const std::vector<std::uint32_t> was = truth.field(axis);
      for (std::size_t i = 0; i < is.size(); ++i) {
        float value, expected;
        std::memcpy(&value, &is[i], sizeof value);
        std::memcpy(&expected, &was[i], sizeof expected);
        ASSERT_EQ(std::isnan(value), std::isnan(expected)) << "cell " << i;
        if (!std::isnan(value)) {
          ASSERT_NEAR(value, expected, 1e-4F) << "cell " << i;
        }
      }
    }
    // Most returns of a cluster lie on one object.
    const std::vector<std::uint32_t> labels = streamed.field("label");
    const std::vector<std::uint32_t> objects = truth.field("label");
    std::map<std::uint32_t, std::map<std::uint32_t, std::size_t>> clusters;
    std::size_t clustered = 0;
    for (std::size_t i = 0; i < labels.size(); ++i) {
      if (labels[i] == 0) continue;
      ++clustered;
      ++clusters[labels[i]][objects[i]];
    }
    std::size_t of_one_object = 0;
    for (const auto& [label, of] : clusters) {
      std::size_t most = 0;
      for (const auto& [object, returns] : of) most = std::max(most, returns);
      of_one_object += most;
    }
    EXPECT_GT(clusters.size(), 30U);
    EXPECT_GT(clustered, 20000U);
    EXPECT_GT(of_one_object, clustered * 8 / 10);
  }
}

/// A simulated road, and the same scan in other frames and orders.
class OtherClouds : public LiscoStream, public testing::WithParamInterface<const char*> {
 protected:
  struct Found {
    double ground, clusters;
  };

  void write(const std::string& name) {
    const Outcome simulated = runLine(std::string(LISCO_SIMULATE) + " --terrain road --sensor hdl32e -o " + name);
    ASSERT_EQ(simulated.status, 0) << simulated.err;
    if (name == "road.pcd") return;
    const std::string content = textOf(folder_ / name);
    const std::size_t data = content.find("DATA binary\n") + 12;
    std::string header = content.substr(0, data);
    struct Point {
      float x, y, z;
      std::uint32_t label;
    };
    std::vector<Point> points((content.size() - data) / sizeof(Point));
    std::memcpy(points.data(), content.data() + data, points.size() * sizeof(Point));
    const std::size_t width = pcdOf(content).width;
    for (std::size_t row = 0; name == "reversed.pcd" && row < points.size(); row += width)
      std::reverse(points.begin() + static_cast<std::ptrdiff_t>(row),
                   points.begin() + static_cast<std::ptrdiff_t>(row + width));
    const std::string viewpoint = "VIEWPOINT 0 0 0 ";
    if (name == "in_a_map.pcd") header.replace(header.find(viewpoint), viewpoint.size(), "VIEWPOINT 1000 2000 100 ");
    for (Point& point : points) {
      if (name == "in_a_vehicles_frame.pcd") point = {point.x - 2, point.y, point.z + 1.8F, 0};
      if (name == "in_a_map.pcd") point = {point.x + 1000, point.y + 2000, point.z + 100, 0};
    }
    header += std::string(reinterpret_cast<const char*>(points.data()), points.size() * sizeof(Point));
    LiscoStream::write(name, header);
  }

  Found found(const std::string& cloud, const std::string& mode) {
    const Outcome outcome = run(cloud + " -t 0.4 --json --stats --mode " + mode);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    const std::size_t at = outcome.err.find(" of the ground");
    EXPECT_NE(at, std::string::npos) << outcome.err;
    if (mode == "endless") {
      EXPECT_NE(outcome.err.find(" 0 outliers"), std::string::npos) << outcome.err;
    }
    const std::size_t number = outcome.err.rfind(' ', at - 1);
    return {std::stod(outcome.err.substr(number)), static_cast<double>(statOf(outcome.err, "clusters"))};
  }
};
INSTANTIATE_TEST_SUITE_P(Name, OtherClouds, testing::Values("reversed", "in_a_vehicles_frame", "in_a_map"),
                         [](const auto& test) { return std::string(test.param); });

TEST_P(OtherClouds, HaveTheSameGroundAndClusters) {
  const std::string name = std::string(GetParam()) + ".pcd";
  write("road.pcd");
  write(name);
  for (const char* mode : {"rotation", "endless"}) {
    const Found expected = found("road.pcd", mode);
    const Found other = found(name, mode);
    EXPECT_GT(expected.clusters, 50);
    EXPECT_NEAR(other.ground, expected.ground, 0.02 * expected.ground) << mode;
    EXPECT_NEAR(other.clusters, expected.clusters, 0.1 * expected.clusters) << mode;
  }
}

// --- Errors --------------------------------------------------------------------------------------------------------

TEST_F(LiscoStream, EndsAtTheTruncationOfACapture) {
  const std::vector<Bytes> payloads = packetsOf(PacketEncoder("hdl32e"), 400);
  writeCapture("whole.pcap", payloads);
  const std::string whole = textOf(folder_ / "whole.pcap");
  write("a.pcap", whole.substr(0, whole.size() / 2 + 100));
  const std::vector<Json> all = linesOf(run("whole.pcap --json -t 0.5 --sensor hdl32e").out);
  for (const char* mode : {"rotation", "endless"}) {
    const Outcome outcome = run(std::string("a.pcap --json --stats -t 0.5 --sensor hdl32e -o clouds --mode ") + mode);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_NE(outcome.err.find("lisco_stream: a.pcap: breaks off"), std::string::npos) << outcome.err;
    EXPECT_EQ(statOf(outcome.err, "data"), 200);
    EXPECT_EQ(statOf(outcome.err, "columns"), 200 * 12);
    const std::vector<Json> lines = linesOf(outcome.out);
    if (mode == std::string("rotation"))
      EXPECT_EQ(withoutTimes(lines).front(), withoutTimes(all).front());
    else
      expectDeliveriesAgree(lines, outcome.err, "clouds");
  }
}

TEST_F(LiscoStream, CountsLostLateAndForeignPackets) {
  std::vector<Bytes> payloads = packetsOf(PacketEncoder("hdl32e"), 700);
  std::swap(payloads[100], payloads[101]);                         // one late
  payloads.erase(payloads.begin() + 200, payloads.begin() + 230);  // 30 lost
  payloads.insert(payloads.begin() + 50, payloads[49]);            // a second copy
  payloads.insert(payloads.begin() + 300, {Bytes(512, 7), Bytes(1206, 7), Bytes(10, 7), Bytes{}});
  payloads.erase(payloads.begin() + 400, payloads.begin() + 580);  // more than a turn
  writeCapture("a.pcap", payloads);
  for (const char* mode : {"rotation", "endless"}) {
    const Outcome outcome =
        run(std::string("a.pcap --json --stats -t 0.5 --ground none --sensor hdl32e -o clouds --mode ") + mode);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(statOf(outcome.err, "late"), 2);
    EXPECT_EQ(statOf(outcome.err, "position"), 1);
    EXPECT_EQ(statOf(outcome.err, "foreign"), 3);
    EXPECT_EQ(statOf(outcome.err, "lost"), 30 + 180 + 1);
    const std::vector<Json> lines = linesOf(outcome.out);
    if (mode == std::string("endless")) {
      expectDeliveriesAgree(lines, outcome.err, "clouds");
      EXPECT_NE(outcome.err.find("0 outliers"), std::string::npos) << outcome.err;
      continue;
    }
    expectRotationsAgree(lines, outcome.err, "clouds");
    expectLabelsOfBatch("clouds", lines.size(), "-t 0.5 --ground none");
    std::size_t lost = 0;
    for (const Json& line : lines) lost += line["lost_packets"].get<std::size_t>();
    EXPECT_EQ(lost, 30U + 180U + 1U);
  }
}

TEST_F(LiscoStream, ClusterFilesKeepTheFieldsOfPackets) {
  for (const bool is_dual : {false, true}) {
    SCOPED_TRACE(is_dual);
    PacketEncoder encoder("vlp16", is_dual);
    encoder.time_us = 3599.95e6;  // the next hour begins within the rotation
    const double firing_us = encoder.packetPeriodUs() / static_cast<double>(encoder.firingsPerPacket());
    writeCapture("a.pcap", packetsOf(encoder, 3600 / encoder.firingsPerPacket()));
    const std::string input = "a.pcap --sensor vlp16 -t 0.5 --ground none";
    ASSERT_EQ(run(input + " -o clouds").status, 0);
    fs::remove_all(folder_ / "batch");
    const Outcome batch = runLine(std::string(LISCO_CLUSTER) + " " + input + " --write labels,clouds -o batch");
    ASSERT_EQ(batch.status, 0) << batch.err;
    std::vector<fs::path> rotations(fs::directory_iterator(folder_ / "batch"), {});
    std::sort(rotations.begin(), rotations.end());
    const Pcd streamed = cloud("clouds", 1), labelled = pcdOf(textOf(rotations.front() / "labels.pcd"));
    EXPECT_EQ(labelled.fields, (std::vector<std::string>{"x", "y", "z", "intensity", "ring", "time", "label"}));
    ASSERT_EQ(labelled.height, is_dual ? 32U : 16U);
    ASSERT_GT(labelled.width, 1000U);
    for (const char* field : {"x", "y", "z", "intensity", "label"})
      EXPECT_TRUE(labelled.field(field) == streamed.field(field)) << field;
    const std::vector<std::uint32_t> rings = labelled.field("ring"), times = labelled.field("time");
    double largest_difference = 0;
    for (std::size_t cell = 0; cell < labelled.cells(); ++cell) {
      ASSERT_EQ(rings[cell], cell / labelled.width / (is_dual ? 2 : 1)) << cell;
      float time;
      std::memcpy(&time, &times[cell], sizeof time);
      const double expected = 1e-6 * firing_us * static_cast<double>(cell % labelled.width);
      largest_difference = std::max(largest_difference, std::fabs(static_cast<double>(time) - expected));
    }
    EXPECT_LT(largest_difference, 2e-6);
    const std::string cluster = textOf(rotations.front() / "clusters/cluster_0001.pcd");
    EXPECT_NE(cluster.find("FIELDS x y z intensity ring time\nSIZE 4 4 4 4 2 4\n"), std::string::npos)
        << cluster.substr(0, 200);
  }
}

TEST_F(LiscoStream, ProposesTheRightSensor) {
  writeCapture("vlp16.pcap", packetsOf(PacketEncoder("vlp16"), 100));
  writeCapture("vls128.pcap", packetsOf(PacketEncoder("vls128"), 100));
  expectRefusal("vlp16.pcap --sensor vls128 -t 1", {"no data packet of a vls128", "100 foreign", "is it a vlp16"});
  expectRefusal("vls128.pcap --sensor hdl32e -t 1", {"no data packet of a hdl32e", "is it a vls128?"});
  writeCapture("hdl64e.pcap", packetsOf(PacketEncoder("hdl64e"), 100));
  expectRefusal("hdl64e.pcap --sensor vls128 -t 1", {"no data packet of a vls128", "is it a hdl64e?"});
  const Outcome outcome = run("vlp16.pcap --sensor hdl32e -t 1");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_NE(outcome.err.find("packets come every 1327 us"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("is it a vlp16?"), std::string::npos) << outcome.err;
}

TEST_F(LiscoStream, ReadsAnHdl64eByItsCalibration) {
  write("db.xml", lisco_test::calibrationXml(lisco_test::usualCalibration));
  writeCapture("a.pcap", packetsOf(PacketEncoder("hdl64e"), 800));
  const std::string options = "a.pcap --sensor hdl64e -t 0.5 --ground none ";
  expectRefusal(options, {"a.pcap: needs --calibration FILE, that of the very hdl64e"});
  // Its packets show what it is; its calibration may lie beside them.
  expectRefusal("a.pcap -t 0.5", {"a.pcap: needs --calibration FILE, that of the very hdl64e"});
  write("a.xml", lisco_test::calibrationXml(lisco_test::usualCalibration));
  const Outcome found = run("a.pcap -t 0.5 --ground none --rotations 1");
  EXPECT_EQ(found.status, 0) << found.err;
  EXPECT_NE(found.err.find("sensor hdl64e, by its packets"), std::string::npos) << found.err;
  EXPECT_NE(found.err.find("calibrated by the file beside it: a.xml"), std::string::npos) << found.err;
  const Outcome outcome = run(options + "--calibration db.xml --json --stats -o clouds");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::vector<Json> lines = linesOf(outcome.out);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines.front()["columns"], 1800);
  EXPECT_GT(lines.front()["clusters"].size(), 3U);
  expectRotationsAgree(lines, outcome.err, "clouds");
  expectLabelsOfBatch("clouds", lines.size(), "-t 0.5 --ground none");
  const Outcome endless = run(options + "--calibration db.xml --json --stats -o clouds --mode endless");
  ASSERT_EQ(endless.status, 0) << endless.err;
  expectDeliveriesAgree(linesOf(endless.out), endless.err, "clouds");
  EXPECT_NE(endless.err.find(" 0 outliers"), std::string::npos) << endless.err;
}

// Its clusters are those of lisco_cluster on the cloud of all returns.
TEST_F(LiscoStream, ClustersBothReturns) {
  PacketEncoder encoder("vlp16", true);
  std::vector<Bytes> payloads;
  for (int i = 0; i < 600; ++i)
    payloads.push_back(encoder.next([](std::size_t firing, std::size_t laser, bool second) {
      Measured measured = objectsAround(firing, laser, second);
      if (second && laser % 2 == 0 && measured.distance > 0) measured.distance += 300;  // 0.6 m behind
      return measured;
    }));
  writeCapture("a.pcap", payloads);
  for (const std::string which : {"", "--return both ", "--return strongest ", "--return last "}) {
    const bool is_both = which.empty() || which == "--return both ";
    const std::string options = "a.pcap --sensor vlp16 -t 0.5 --json --stats -o clouds " + which;
    const Outcome outcome = run(options);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    const std::vector<Json> lines = linesOf(outcome.out);
    ASSERT_GE(lines.size(), 2U);
    EXPECT_EQ(cloud("clouds", 1).height, is_both ? 32U : 16U) << which;
    expectRotationsAgree(lines, outcome.err, "clouds");
    expectLabelsOfBatch("clouds", lines.size(), "-t 0.5");
    const Outcome endless = run(options + "--mode endless");
    ASSERT_EQ(endless.status, 0) << endless.err;
    expectDeliveriesAgree(linesOf(endless.out), endless.err, "clouds");
    EXPECT_NE(endless.err.find(" 0 outliers"), std::string::npos) << endless.err;
  }
  expectRefusal("a.pcap --sensor vlp16 -t 0.5 --return first", {"--return must be strongest, last or both"});
}

TEST_F(LiscoStream, ReadsAnOusterByItsMetadata) {
  lisco_test::OusterSensor sensor;
  sensor.profile = "RNG15_RFL8_NIR8";
  sensor.pixels = 128;
  std::vector<Bytes> payloads;
  for (std::size_t frame = 0; frame < 3; ++frame)
    for (const Bytes& packet : lisco_test::ousterFrame(
             sensor, frame, [](std::size_t, std::size_t column, std::size_t pixel, std::size_t) -> std::uint32_t {
               return column / 40 % 3 == 2 || pixel % 16 == 15
                          ? 0
                          : 4000 + 1600 * static_cast<std::uint32_t>(column / 40 % 7);
             }))
      payloads.push_back(packet);
  writeCapture("a.pcap", payloads);
  write("a.json", sensor.metadata());
  const std::string options = "a.pcap --sensor ouster -t 0.5 --json --stats -o clouds ";
  const Outcome outcome = run(options + "--metadata a.json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const std::vector<Json> lines = linesOf(outcome.out);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines.front()["columns"], 1024);
  expectRotationsAgree(lines, outcome.err, "clouds");
  expectLabelsOfBatch("clouds", lines.size(), "-t 0.5");
  const Outcome endless = run(options + "--metadata a.json --mode endless");
  ASSERT_EQ(endless.status, 0) << endless.err;
  expectDeliveriesAgree(linesOf(endless.out), endless.err, "clouds");
  EXPECT_NE(endless.err.find(" 0 outliers"), std::string::npos) << endless.err;
  expectRefusal("a.pcap --sensor ouster -t 0.5 --metadata missing.json", {"missing.json: cannot be read"});
  expectRefusal("a.pcap --sensor pandarxt32 -t 0.5", {"no data packet of a pandarxt32", "is it an ouster?"});
  expectRefusal("a.pcap --sensor vlp16 -t 0.5 --metadata a.json", {"metadata file is for the ouster only"});
}

TEST_F(LiscoStream, ContinuesWhileTheSensorStandsStill) {
  PacketEncoder encoder("hdl32e");
  encoder.step = 0;
  std::vector<Bytes> payloads;
  for (int i = 0; i < 3200; ++i) payloads.push_back(encoder.next(lisco_test::constantWorld({3000, 9})));
  encoder.step = 20;
  for (int i = 0; i < 320; ++i) payloads.push_back(encoder.next(objectsAround));
  writeCapture("a.pcap", payloads);
  for (const char* mode : {"rotation", "endless"}) {
    const Outcome outcome = run(std::string("a.pcap --json --stats -t 0.5 --sensor hdl32e -o clouds --mode ") + mode);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(statOf(outcome.err, "columns"), 3520 * 12);
    EXPECT_GE(statOf(outcome.err, "rotations"), 3);
    if (mode == std::string("rotation"))
      expectRotationsAgree(linesOf(outcome.out), outcome.err, "clouds");
    else
      expectDeliveriesAgree(linesOf(outcome.out), outcome.err, "clouds");
  }
}

TEST_F(LiscoStream, RefusesBadInputInOneLine) {
  writeCapture("a.pcap", packetsOf(PacketEncoder("vlp16"), 10));
  writeCapture("nothing.pcap", {});
  write("garbage.pcap", std::string(5000, 'x'));
  write("empty.pcap", "");
  const std::string options = " --sensor vlp16 -t 0.5";
  expectRefusal("missing.pcap" + options, {"missing.pcap", "No such file"});
  expectRefusal("garbage.pcap" + options, {"garbage.pcap", "is no capture"});
  expectRefusal("empty.pcap" + options, {"empty.pcap", "it is empty"});
  expectRefusal("." + options, {".: holds no scans, but recordings", "a.pcap"});
  expectRefusal("nothing.pcap" + options, {"nothing.pcap: no data packet of a vlp16"});
  expectRefusal("a.pcap a.pcap" + options, {"more than one capture"});
  expectRefusal(options, {"no capture and no --port"});
  expectRefusal("nothing.pcap -t 0.5", {"no packets that look like those of a known sensor (vlp16, "});
  expectRefusal("a.pcap -t 0.5 --sensor os1",
                {"no sensor 'os1'", "vlp16, vlp32c, hdl32e, hdl64e, vls128, pandar40p", "ouster"});
  expectRefusal("a.pcap --sensor vlp16", {"--tolerance is missing"});
  expectRefusal("a.pcap --sensor vlp16 -t 0", {"--tolerance must be a positive number of metres, not '0'"});
  expectRefusal("a.pcap --sensor vlp16 -t nan", {"--tolerance"});
  expectRefusal("a.pcap" + options + " --mode backwards", {"--mode", "backwards"});
  expectRefusal("a.pcap" + options + " --min-size 0", {"--min-size"});
  expectRefusal("a.pcap" + options + " --max-size 9", {"--max-size"});
  expectRefusal("a.pcap" + options + " --ground-z inf", {"--ground-z"});
  expectRefusal("a.pcap" + options + " --ground a=none", {"--ground applies to all: NAME= is not taken here"});
  expectRefusal("a.pcap" + options + " --ground flat", {"--ground must be slope, height:Z or none, not 'flat'"});
  expectRefusal("a.pcap" + options + " --ignore-box 1", {"--ignore-box takes six numbers"});
  expectRefusal("a.pcap" + options + " --rotations 0", {"--rotations"});
  expectRefusal("a.pcap" + options + " --port 65536", {"--port must be a whole number from 0 to 65535"});
  expectRefusal("a.pcap" + options + " --port 99", {"no data packet", "only packets to port 99"});
  expectRefusal("a.pcap" + options + " --calibration db.xml", {"hdl64e or the vlp32c"});
  expectRefusal("--port --realtime" + options, {"--realtime"});
  expectRefusal("a.pcap" + options + " -o a.pcap", {"a.pcap", "no folder"});
  expectRefusal("a.pcap" + options + " -o a.pcap/b", {"cannot be written"});
}

TEST_F(LiscoStream, ReportsUnwritableOutput) {
  writeCapture("a.pcap", packetsOf(PacketEncoder("vlp16"), 200));
  const Outcome outcome = runLine("sh -c '" + program_ + " a.pcap --sensor vlp16 -t 0.5 --json >/dev/full'");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("cannot be written"), std::string::npos) << outcome.err;
}

TEST_F(LiscoStream, ReplacesOnlyItsOwnFiles) {
  writeCapture("a.pcap", packetsOf(PacketEncoder("hdl32e"), 400));
  const std::string options = "a.pcap --sensor hdl32e -t 0.5 -o clouds";
  ASSERT_EQ(run(options).status, 0);
  ASSERT_TRUE(fs::exists(folder_ / "clouds/rotation_000003.pcd"));
  write("clouds/mine.txt", "keep me");
  ASSERT_EQ(run(options + " --rotations 1").status, 0);
  EXPECT_FALSE(fs::exists(folder_ / "clouds/rotation_000003.pcd"));  // of the run before
  EXPECT_EQ(textOf(folder_ / "clouds/mine.txt"), "keep me");
  write("clouds/rotation_000009.pcd", "foreign");
  expectRefusal(options, {"rotation_000009.pcd", "was not written by this program"});
  EXPECT_TRUE(fs::exists(folder_ / "clouds/rotation_000001.pcd"));
}

TEST_F(LiscoStream, PrintsHelpAndVersion) {
  const Outcome help = run("--help");
  EXPECT_EQ(help.status, 0);
  for (const char* word : {"--sensor", "--tolerance", "--mode", "--realtime", "--json", "latency_ms", "--ground",
                           "--min-range", "--max-range", "--ignore-box", "oriented_box", "density"})
    EXPECT_NE(help.out.find(word), std::string::npos) << word;
  const Outcome version = run("--version");
  EXPECT_EQ(version.status, 0);
  EXPECT_EQ(version.out.rfind("lisco_stream ", 0), 0U);
}

}  // namespace
