// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// Scans as the page's data, without a browser.
#include "view/scan_encoder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <tuple>

#include <nlohmann/json.hpp>

#include "scenes.h"
#include "view/page.h"

using lisco_apps::encodeViewScan;
using lisco_apps::ViewScan;
using Json = nlohmann::json;

namespace {

/// A scan read from its bytes, by their definition in doc/view.md.
struct Decoded {
  Json header;
  std::vector<std::array<double, 3>> points;
  std::vector<std::vector<std::int64_t>> classes;
  std::vector<double> intensity;
  std::vector<std::int64_t> ring;
};

Decoded decode(const std::string& bytes) {
  const auto byte = [&](std::size_t at) { return static_cast<std::uint8_t>(bytes.at(at)); };
  std::size_t at = 4;
  const std::size_t size = byte(0) + 256U * byte(1) + 65536U * byte(2) + 16777216U * byte(3);
  Decoded decoded;
  decoded.header = Json::parse(bytes.substr(at, size));
  at += size;
  const std::size_t count = decoded.header["points"];
  const auto numbers = [&] {
    std::vector<std::int64_t> values;
    std::int64_t value = 0;
    while (values.size() < count) {
      std::uint64_t code = 0;
      for (unsigned shift = 0;; shift += 7) {
        code |= std::uint64_t{byte(at) & 127U} << shift;
        if (byte(at++) < 128) break;
      }
      value += (code & 1U) != 0 ? -static_cast<std::int64_t>((code + 1) / 2) : static_cast<std::int64_t>(code / 2);
      values.push_back(value);
    }
    return values;
  };
  decoded.points.resize(count);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double origin = decoded.header["origin"][axis];
    const double step = decoded.header["step"];
    const std::vector<std::int64_t> steps = numbers();
    for (std::size_t i = 0; i < count; ++i) decoded.points[i][axis] = origin + step * static_cast<double>(steps[i]);
  }
  for (std::size_t k = 0; k < decoded.header["labellings"].size(); ++k) decoded.classes.push_back(numbers());
  if (decoded.header.contains("intensity")) {
    const double low = decoded.header["intensity"][0];
    const double high = decoded.header["intensity"][1];
    for (std::size_t i = 0; i < count; ++i) decoded.intensity.push_back(low + (high - low) * byte(at++) / 255);
  }
  if (decoded.header.contains("ring")) decoded.ring = numbers();
  EXPECT_EQ(at, bytes.size());
  return decoded;
}

double distance(const std::array<double, 3>& a, const std::array<float, 3>& b) {
  return std::hypot(a[0] - static_cast<double>(b[0]), a[1] - static_cast<double>(b[1]),
                    a[2] - static_cast<double>(b[2]));
}

/// Points of a scan whose ring numbers are their indices, random within a cube.
ViewScan randomScan(std::size_t points, float side, const std::array<float, 3>& middle, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> offset(-side / 2, side / 2);
  ViewScan scan;
  scan.labellings.push_back({"", 0.5, {}, {}});
  for (std::size_t i = 0; i < points; ++i) {
    scan.points.push_back({middle[0] + offset(random), middle[1] + offset(random), middle[2] + offset(random)});
    scan.ring.push_back(static_cast<std::uint16_t>(i));
    scan.intensity.push_back(static_cast<float>(random() % 256));
    scan.is_ground.push_back(random() % 3 == 0 ? 1 : 0);
    scan.labellings[0].labels.push_back(scan.is_ground.back() != 0 ? 0 : static_cast<std::uint32_t>(random() % 5));
  }
  return scan;
}

/// Expects all of a scan's points, in any order.
void expectSame(const ViewScan& scan, const Decoded& decoded) {
  ASSERT_EQ(decoded.points.size(), scan.points.size());
  std::vector<bool> is_there(scan.points.size());
  for (std::size_t i = 0; i < decoded.points.size(); ++i) {
    const auto original = static_cast<std::size_t>(decoded.ring[i]);
    ASSERT_FALSE(is_there[original]);
    is_there[original] = true;
    EXPECT_LE(distance(decoded.points[i], scan.points[original]), 0.002);
    EXPECT_EQ(decoded.intensity[i], static_cast<double>(scan.intensity[original]));
    const std::int64_t expected = scan.is_ground[original] != 0 ? 0 : scan.labellings[0].labels[original] + 1;
    EXPECT_EQ(decoded.classes[0][i], expected);
  }
}

TEST(ScanEncoder, KeepsPositionsWithinTwoMillimetresAndTheRestAsItIs) {
  for (const float side : {0.01F, 3.0F, 400.0F, 20000.0F}) {
    const ViewScan scan = randomScan(5000, side, {1, -2, 3}, 7);
    expectSame(scan, decode(encodeViewScan(scan)));
  }
}

TEST(ScanEncoder, KeepsMapCoordinates) {
  const ViewScan scan = randomScan(2000, 800, {513000, 5403000, 400}, 8);
  expectSame(scan, decode(encodeViewScan(scan)));
}

TEST(ScanEncoder, StatesItsError) {
  const Decoded decoded = decode(encodeViewScan(randomScan(10, 3, {}, 1)));
  EXPECT_LE(decoded.header["error"].get<double>(), 0.002);
  EXPECT_GE(decoded.header["error"].get<double>(), decoded.header["step"].get<double>() * std::sqrt(3.0) / 2 - 1e-4);
}

TEST(ScanEncoder, TakesThousandsOfPointsInAnyOrderIntoTenBytesEach) {
  const ViewScan scan = largeScan();
  const ViewScan any_order = shuffled(scan, 3);
  for (const ViewScan& each : {scan, any_order}) {
    const std::string bytes = encodeViewScan(each);
    const std::size_t points = decode(bytes).points.size();
    EXPECT_GE(points, 200000U);
    EXPECT_LE(lisco_apps::viewPage("room", {bytes}).size(), 10 * points);
  }
}

TEST(ScanEncoder, LeavesOutWhatIsNoReturn) {
  ViewScan scan = randomScan(100, 3, {}, 2);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  scan.points[3] = {nan, 1, 1};
  scan.points[4] = {1, infinity, 1};
  scan.points[5] = {0, 0, 0};
  const Decoded decoded = decode(encodeViewScan(scan));
  EXPECT_EQ(decoded.points.size(), 97U);
  EXPECT_EQ(decoded.header["too_far"], 0);
  for (const std::int64_t ring : decoded.ring) EXPECT_TRUE(ring < 3 || ring > 5);
}

TEST(ScanEncoder, CountsWhatIsTooFarAway) {
  ViewScan scan = randomScan(100, 3, {}, 2);
  scan.points[3] = {1e30F, 1, 1};
  scan.points[4] = {1, -3e38F, 1};
  scan.points[5] = {1, 1, 17000};
  const Decoded decoded = decode(encodeViewScan(scan));
  EXPECT_EQ(decoded.points.size(), 97U);
  EXPECT_EQ(decoded.header["too_far"], 3);
}

TEST(ScanEncoder, EncodesScansWithoutReturns) {
  ViewScan scan;
  scan.labellings.push_back({"", 0.5, {}, {}});
  EXPECT_EQ(decode(encodeViewScan(scan)).header["points"], 0);
  scan.points.assign(3, {});
  scan.labellings[0].labels.assign(3, 0);
  EXPECT_EQ(decode(encodeViewScan(scan)).header["points"], 0);
}

TEST(ScanEncoder, KeepsMostOfAnyIntensity) {
  ViewScan scan = randomScan(1000, 3, {}, 2);
  for (std::size_t i = 0; i < 1000; ++i) scan.intensity[i] = 0.001F * static_cast<float>(i);
  scan.intensity[0] = 1e9F;
  scan.intensity[1] = std::numeric_limits<float>::quiet_NaN();
  const Decoded decoded = decode(encodeViewScan(scan));
  for (std::size_t i = 0; i < 1000; ++i) {
    const auto original = static_cast<std::size_t>(decoded.ring[i]);
    if (original <= 5 || original >= 990) continue;
    EXPECT_NEAR(decoded.intensity[i], static_cast<double>(scan.intensity[original]), 0.006);
  }
}

TEST(ViewPage, ContainsNamesAsText) {
  ViewScan scan = randomScan(10, 3, {}, 2);
  scan.name = "\xff</script>";
  const std::string page = lisco_apps::viewPage("a</script><script>alert(1)</script>\xff", {encodeViewScan(scan)});
  EXPECT_EQ(page.find("<script>alert"), std::string::npos);
  EXPECT_NE(page.find("\\u003cscript>alert"), std::string::npos);
  EXPECT_LT(page.find(lisco_apps::kViewSignature), 200U);
}

}  // namespace
