// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Captures of Ouster's sensors against what the maker's software makes of them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <boost/uuid/detail/md5.hpp>
#include <nlohmann/json.hpp>

#include "columns.h"
#include "pcd_scan.h"
#include "sensors/capture_file.h"
#include "sensors/ouster_decoder.h"
#include "sensors/rotation_cutter.h"

namespace lisco_test {
namespace {

namespace fs = std::filesystem;
using lisco_apps::CaptureFile;
using lisco_apps::Cell;
using lisco_apps::OusterDecoder;
using lisco_apps::OusterMetadata;
using lisco_apps::Packet;
using lisco_apps::ReturnChoice;

std::string md5Of(const std::vector<std::uint32_t>& numbers) {
  boost::uuids::detail::md5 md5;
  if (!numbers.empty()) md5.process_bytes(numbers.data(), numbers.size() * sizeof(std::uint32_t));
  boost::uuids::detail::md5::digest_type digest;
  md5.get_digest(digest);
  std::string text;
  for (const auto part : digest) {  // bytes, or words in Boost's earlier versions
    constexpr const char* kDigits = "0123456789abcdef";
    for (std::size_t i = 2 * sizeof part; i > 0; --i) text += kDigits[part >> (4 * (i - 1)) & 15U];
  }
  return text;
}

/// A frame, as images of a row per pixel.
struct Frame {
  std::vector<Cell> cells;  ///< column by column
  std::vector<std::uint32_t> ranges[2];
};

class OusterCapture : public testing::Test {
 protected:
  static fs::path folder() {
    const char* const data = std::getenv("LISCO_TEST_DATA");
    return fs::path(data != nullptr ? data : LISCO_TEST_DATA_DEFAULT) / "ouster";
  }
  void SetUp() override {
    if (!fs::is_directory(folder()))
      GTEST_SKIP() << "no real captures: there is no folder " << folder() << "; set LISCO_TEST_DATA to the data folder";
  }

  /// The range in millimetres whose return lies at the cell.
  static std::uint32_t rangeAt(const Cell& cell, const OusterMetadata& metadata, std::size_t column) {
    const lisco_apps::Transform& t = metadata.lidar_to_sensor;
    const double turn =
        2 * 3.14159265358979323846 * static_cast<double>(column) / static_cast<double>(metadata.columns_per_frame);
    const double n = metadata.beam_to_lidar[3];
    // All these sensors' transforms are half a turn and a height.
    const double x = -(1000. * cell.x - t[3]) - n * std::cos(turn);
    const double y = -(1000. * cell.y - t[7]) + n * std::sin(turn);
    const double z = 1000. * cell.z - t[11];
    const double range = n + std::hypot(x, y, z);
    EXPECT_NEAR(range, std::round(range), 0.1);
    return static_cast<std::uint32_t>(std::lround(range));
  }

  static std::vector<Frame> framesOf(const std::string& capture, const std::string& json, ReturnChoice returns,
                                     lisco_apps::Decoder::Counts* counts = nullptr) {
    const OusterMetadata metadata = lisco_apps::readOusterMetadata(folder() / (json + ".json"));
    OusterDecoder decoder(metadata, returns);
    CaptureFile source(folder() / (capture + ".pcap"));
    lisco_apps::RotationCutter cutter(decoder.rotationStart());
    std::vector<Frame> frames;
    const auto take = [&](const lisco_apps::Column& column) {
      if (cutter.startsRotation(column.azimuth, column.after_break)) {
        frames.emplace_back();
        for (auto& ranges : frames.back().ranges) ranges.assign(metadata.columns_per_frame * metadata.pixels(), 0);
      }
      const double start = *decoder.rotationStart();
      const double turned = std::fmod(column.azimuth - start + 360, 360.) / 360;
      const auto number =
          static_cast<std::size_t>(std::lround(turned * static_cast<double>(metadata.columns_per_frame)) %
                                   static_cast<long>(metadata.columns_per_frame));
      const std::size_t each = column.cells.size() / metadata.pixels();
      frames.back().cells.insert(frames.back().cells.end(), column.cells.begin(), column.cells.end());
      for (std::size_t row = 0; row < column.cells.size(); ++row)
        if (isReturn(column.cells[row]))
          frames.back().ranges[row % each][row / each * metadata.columns_per_frame + number] =
              rangeAt(column.cells[row], metadata, number);
    };
    Packet packet;
    while (source.next(packet) == CaptureFile::Arrival::kPacket) decoder.decode(packet, take);
    decoder.flush(take);
    EXPECT_EQ(source.error(), "");
    if (counts != nullptr) *counts = decoder.counts();
    return frames;
  }
};

TEST_F(OusterCapture, HasTheDigestsOfTheMakersSoftware) {
  ASSERT_EQ(md5Of({}), "d41d8cd98f00b204e9800998ecf8427e");
  const std::string ending = "_digest.json";
  std::size_t captures = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder())) {
    std::string name = entry.path().filename().string();
    if (name.size() <= ending.size() || name.substr(name.size() - ending.size()) != ending) continue;
    name.resize(name.size() - ending.size());
    SCOPED_TRACE(name);
    ++captures;
    std::ifstream file(entry.path());
    const nlohmann::json scans = nlohmann::json::parse(file).at("scans");
    const std::vector<Frame> frames = framesOf(name, name, ReturnChoice::kBoth);
    ASSERT_EQ(frames.size(), scans.size());
    for (std::size_t i = 0; i < frames.size(); ++i) {
      EXPECT_EQ(md5Of(frames[i].ranges[0]), scans[i].at("RANGE").get<std::string>());
      if (scans[i].contains("RANGE2")) {
        EXPECT_EQ(md5Of(frames[i].ranges[1]), scans[i].at("RANGE2").get<std::string>());
      }
    }
  }
  EXPECT_GT(captures, 0U);
}

// The scans were decoded by other software, which gives them in the lidar frame, half a turn and up to 45 mm from the
// sensor's, takes all beams as starting at its origin, and has the reflectivity as the intensity.
TEST_F(OusterCapture, GivesTheReturnsOfTheScan) {
  const struct {
    const char *capture, *json, *scan;
  } cases[] = {{"OS-1-128_v2.3.0_1024x10_lb_n3", "OS-1-128_v2.3.0_1024x10", "os1_128_outdoor_0"},
               {"OS-1-64_1024x10_fw20", "OS-1-64_sensor_config_reduced", "os1_64_sparse_0"}};
  for (const auto& c : cases) {
    const Scan scan = readPcd(folder().parent_path() / "scans" / (std::string(c.scan) + ".pcd"));
    const Frame frame = framesOf(c.capture, c.json, ReturnChoice::kBoth).front();
    ASSERT_EQ(frame.cells.size(), scan.cells.size());
    double most = 0, most_of_range = 0;
    std::size_t returns = 0, unlike = 0;
    for (std::size_t column = 0; column < scan.width; ++column)
      for (std::size_t row = 0; row < scan.height; ++row) {
        const Cell &ours = frame.cells[column * scan.height + row], &theirs = scan.cells[row * scan.width + column];
        if (isReturn(ours) != isReturn(theirs)) ++unlike;
        if (!isReturn(ours) || !isReturn(theirs)) continue;
        ++returns;
        if (ours.intensity != theirs.intensity) ++unlike;
        most = std::max<double>(most, std::hypot(ours.x + theirs.x, ours.y + theirs.y, ours.z - theirs.z));
        const double range = frame.ranges[0][row * scan.width + column];
        most_of_range = std::max(most_of_range, std::fabs(range / 1000 - rangeOf(theirs)));
      }
    EXPECT_GT(returns, 10000U);
    EXPECT_EQ(unlike, 0U) << c.scan;
    EXPECT_LE(most_of_range, 5e-4) << c.scan;
    EXPECT_LE(most, 0.045) << c.scan;
  }
}

TEST_F(OusterCapture, OfEachKindIsDecoded) {
  const struct {
    const char *capture, *json;
    std::size_t frames;
    std::uint64_t data, positions, columns;
  } cases[] = {
      {"OS-1-128_v2.3.0_1024x10_lb_n3", "OS-1-128_v2.3.0_1024x10", 3, 192, 30, 3072},
      {"OS-1-64_1024x10_fw20", "OS-1-64_sensor_config_reduced", 1, 64, 11, 1024},
      {"OS-1-128_767798045_1024x10_20230712_120049", "OS-1-128_767798045_1024x10_20230712_120049", 1, 8, 2, 128},
      {"windowed_frame1", "windowed_frame1_0", 1, 17, 10, 256},
      {"duplicate_id", "duplicate_id", 1, 1, 0, 16},
      {"empty_pcap", "empty_pcap", 0, 0, 0, 0}};
  for (const auto& c : cases) {
    lisco_apps::Decoder::Counts counts;
    const std::vector<Frame> frames = framesOf(c.capture, c.json, ReturnChoice::kBoth, &counts);
    EXPECT_EQ(frames.size(), c.frames) << c.capture;
    EXPECT_EQ(counts.data, c.data) << c.capture;
    EXPECT_EQ(counts.position, c.positions) << c.capture;
    EXPECT_EQ(counts.columns, c.columns) << c.capture;
    EXPECT_EQ(counts.foreign + counts.late + counts.missing + counts.says_other_model, 0U) << c.capture;
  }
}

}  // namespace
}  // namespace lisco_test
