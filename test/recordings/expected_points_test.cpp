// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Recordings of real sensors' packets against the points that an independent decoder makes of one rotation.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <sstream>
#include <string>
#include <unordered_map>
#include <vector>

#include "recordings/packet_input.h"
#include "sensors/rotation_cutter.h"

namespace lisco_test {
namespace {

namespace fs = std::filesystem;
using lisco_apps::Column;
using lisco_apps::DecoderOptions;
using lisco_apps::Packet;
using lisco_apps::PacketSource;
using Point = std::array<double, 3>;

fs::path folder() {
  const char* const data = std::getenv("LISCO_TEST_DATA");
  return fs::path(data != nullptr ? data : LISCO_TEST_DATA_DEFAULT) / "bags";
}

double rangeOf(const Point& p) {
  return std::hypot(p[0], p[1], p[2]);
}

/// The points of a binary PCD whose first fields are x, y, z, all floats.
std::vector<Point> readPoints(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  std::istringstream header(text);
  std::size_t bytes = 0, count = 0;
  for (std::string line; std::getline(header, line) && line.rfind("DATA", 0) != 0;) {
    std::istringstream values(line);
    std::string key;
    values >> key;
    if (key == "POINTS") values >> count;
    if (key != "SIZE") continue;
    for (std::size_t size = 0; values >> size;) bytes += size;
  }
  const auto begin = static_cast<std::size_t>(header.tellg());
  std::vector<Point> points;
  for (std::size_t i = 0; i < count && begin + (i + 1) * bytes <= text.size(); ++i) {
    std::array<float, 3> xyz{};
    std::memcpy(xyz.data(), text.data() + begin + i * bytes, sizeof xyz);
    points.push_back({xyz[0], xyz[1], xyz[2]});
  }
  EXPECT_EQ(points.size(), count);
  return points;
}

/// Finds points within a distance.
class Neighbours {
 public:
  Neighbours(const std::vector<Point>& points, double distance) : distance_(distance) {
    for (const Point& p : points) cells_[keyOf(p, 0, 0, 0)].push_back(p);
  }
  bool hasOne(const Point& p) const {
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dz = -1; dz <= 1; ++dz) {
          const auto cell = cells_.find(keyOf(p, dx, dy, dz));
          if (cell == cells_.end()) continue;
          for (const Point& q : cell->second)
            if (std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]) <= distance_) return true;
        }
    return false;
  }

 private:
  std::int64_t keyOf(const Point& p, int dx, int dy, int dz) const {
    const auto index = [&](double value, int shift) {
      return (static_cast<std::int64_t>(std::floor(value / distance_)) + shift) & 0xFFFFF;
    };
    return index(p[0], dx) << 40 | index(p[1], dy) << 20 | index(p[2], dz);
  }

  double distance_;
  std::unordered_map<std::int64_t, std::vector<Point>> cells_;
};

struct Decoded {
  std::vector<std::vector<Point>> columns;  ///< their returns
  std::size_t columns_per_turn = 0;         ///< of the longest rotation, which may be a part of a turn
};

Decoded decode(const std::string& name, const DecoderOptions& options) {
  const lisco_apps::PacketInput input =
      lisco_apps::openPackets(folder() / (name + ".db3"), {}, options, std::nullopt, [] { return false; });
  Decoded decoded;
  std::vector<std::vector<Point>>& columns = decoded.columns;
  lisco_apps::RotationCutter cutter(input.decoder->rotationStart());
  std::size_t begin = 0;
  const auto take = [&](const Column& column) {
    if (cutter.startsRotation(column.azimuth, column.after_break)) begin = columns.size();
    columns.emplace_back();
    decoded.columns_per_turn = std::max(decoded.columns_per_turn, columns.size() - begin);
    for (const lisco_apps::Cell& cell : column.cells)
      if (!std::isnan(cell.x)) columns.back().push_back({cell.x, cell.y, cell.z});
  };
  Packet packet;
  while (input.source->next(packet) == PacketSource::Arrival::kPacket) input.decoder->decode(packet, take);
  input.decoder->flush(take);
  EXPECT_EQ(input.source->error(), "");
  EXPECT_EQ(input.decoder->counts().foreign + input.decoder->counts().late, 0U);
  return decoded;
}

class RealRecordings : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::is_directory(folder()))
      GTEST_SKIP() << "no recordings: there is no folder " << folder() << "; set LISCO_TEST_DATA to the data folder";
  }
};

/// The other decoder drops returns out of its range limits, and cuts the rotation at an azimuth of its own: of ours,
/// the rotation is the run of columns with the fewest returns that it has not.
/// \param name of a sensor: of the bag, its expected points and its calibration
void expectItsPoints(const std::string& name) {
  constexpr double kDistance = 0.01;
  DecoderOptions options;
  options.sensor = name;
  for (const char* const ending : {".csv", ".yaml"})
    if (const fs::path file = folder() / (name + ending); fs::exists(file)) options.calibration = file;
  const auto [columns, columns_per_turn] = decode(name, options);
  const std::vector<Point> expected = readPoints(folder() / (name + "_expected.pcd"));
  ASSERT_GT(expected.size(), 10000U);

  std::vector<Point> ours;
  for (const auto& column : columns) ours.insert(ours.end(), column.begin(), column.end());
  const Neighbours near_ours(ours, kDistance), near_expected(expected, kDistance);
  const auto missing =
      std::count_if(expected.begin(), expected.end(), [&](const Point& p) { return !near_ours.hasOne(p); });
  EXPECT_LE(static_cast<double>(missing), 0.001 * static_cast<double>(expected.size()));

  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (const Point& p : expected) {
    least = std::min(least, rangeOf(p));
    most = std::max(most, rangeOf(p));
  }
  std::vector<std::size_t> before{0}, extra_before{0};  // returns in the first columns, and those that are not expected
  for (const auto& column : columns) {
    std::size_t returns = 0, extra = 0;
    for (const Point& p : column) {
      if (rangeOf(p) < least || rangeOf(p) > most) continue;
      ++returns;
      if (!near_expected.hasOne(p)) ++extra;
    }
    before.push_back(before.back() + returns);
    extra_before.push_back(extra_before.back() + extra);
  }
  double best = 1;  // of runs a little shorter than a rotation, as the expected points of the QT64 end early
  for (std::size_t begin = 0, count = columns_per_turn * 85 / 100; begin + count < before.size(); ++begin) {
    const auto returns = static_cast<double>(before[begin + count] - before[begin]);
    const auto extra = static_cast<double>(extra_before[begin + count] - extra_before[begin]);
    if (returns > 0.8 * static_cast<double>(expected.size())) best = std::min(best, extra / returns);
  }
  EXPECT_LE(best, 0.001);
  std::printf("%s: %zu of %zu expected points have none of ours within 1 cm; %.4f %% of ours have none\n", name.c_str(),
              static_cast<std::size_t>(missing), expected.size(), 100 * best);
}

TEST_F(RealRecordings, HaveTheExpectedPoints) {
  const std::string ending = "_expected.pcd";
  std::size_t sensors = 0;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder())) {
    const std::string name = entry.path().filename().string();
    if (name.size() <= ending.size() || name.substr(name.size() - ending.size()) != ending) continue;
    SCOPED_TRACE(name);
    expectItsPoints(name.substr(0, name.size() - ending.size()));
    ++sensors;
  }
  EXPECT_GT(sensors, 0U);
}

/// A return as a range, an elevation and an azimuth, where the latter may differ.
struct Ray {
  double range, elevation, azimuth;  ///< metres, degrees
};
Ray rayOf(const Point& p) {
  constexpr double kDegree = 3.14159265358979323846 / 180;
  return {rangeOf(p), std::asin(p[2] / rangeOf(p)) / kDegree, std::atan2(-p[1], p[0]) / kDegree};
}

// By the manual's firing times the returns are the same but for their azimuths.
TEST_F(RealRecordings, OfVelodyneDifferInTheirAzimuthsOnlyByTheManual) {
  const struct {
    const char* name;
    double most;  ///< degrees of the azimuth
  } cases[] = {{"vlp16", 0.45}, {"vlp32c", 0.2}};
  for (const auto& c : cases) {
    DecoderOptions options;
    options.sensor = c.name;
    options.turning = lisco_apps::Turning::kManual;
    for (const bool is_calibrated : {false, true}) {
      if (is_calibrated && options.sensor == "vlp16") continue;
      if (is_calibrated) options.calibration = folder() / "vlp32c.yaml";
      std::unordered_map<std::int64_t, std::vector<Ray>> by_range;  // in steps of 2 mm
      for (const auto& column : decode(c.name, options).columns)
        for (const Point& p : column) by_range[std::llround(rangeOf(p) / 0.002)].push_back(rayOf(p));
      std::size_t missing = 0;
      const std::vector<Point> expected = readPoints(folder() / (std::string(c.name) + "_expected.pcd"));
      for (const Point& p : expected) {
        const Ray wanted = rayOf(p);
        const std::vector<Ray>& rays = by_range[std::llround(wanted.range / 0.002)];
        if (std::none_of(rays.begin(), rays.end(), [&](const Ray& ray) {
              return std::fabs(ray.elevation - wanted.elevation) < 0.01 &&
                     std::fabs(std::remainder(ray.azimuth - wanted.azimuth, 360.)) <= c.most;
            }))
          ++missing;
      }
      EXPECT_LE(static_cast<double>(missing), 0.001 * static_cast<double>(expected.size())) << c.name;
      std::printf("%s: %zu of %zu expected returns have none of ours\n", c.name, missing, expected.size());
    }
  }
}

}  // namespace
}  // namespace lisco_test
