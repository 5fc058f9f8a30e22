// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "sensors/ouster_decoder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "columns.h"
#include "ouster_packets.h"
#include "random.h"
#include "temporary_folder.h"

namespace lisco_test {
namespace {

using lisco_apps::Cell;
using lisco_apps::DecoderOptions;
using lisco_apps::OusterDecoder;
using lisco_apps::parseOusterMetadata;
using lisco_apps::ReturnChoice;
using Kind = lisco_apps::Decoder::Kind;

constexpr double kPi = 3.14159265358979323846;

OusterDecoder decoderOf(const OusterSensor& sensor, ReturnChoice returns = ReturnChoice::kBoth,
                        bool in_sections = true) {
  return {parseOusterMetadata(sensor.metadata(in_sections), "json"), returns};
}

/// Ranges that name frame, column, pixel and return: multiples of 8 mm within 19 bits.
std::uint32_t numberedRange(std::size_t frame, std::size_t column, std::size_t pixel, std::size_t second) {
  return static_cast<std::uint32_t>(8 * (200 + (frame * 7 + column * 3 + pixel * 11 + second * 101) % 20000));
}

/// By the manual's equations, in metres.
std::array<double, 3> positionOf(const OusterSensor& sensor, std::size_t column, std::size_t pixel, double range) {
  const double encoder = 2 * kPi * (1 - static_cast<double>(column) / static_cast<double>(sensor.columns));
  const double azimuth = -sensor.azimuth(pixel) * kPi / 180, altitude = sensor.altitude(pixel) * kPi / 180;
  const double n = sensor.beam_origin_mm;
  const double x = (range - n) * std::cos(encoder + azimuth) * std::cos(altitude) + n * std::cos(encoder);
  const double y = (range - n) * std::sin(encoder + azimuth) * std::cos(altitude) + n * std::sin(encoder);
  const double z = (range - n) * std::sin(altitude);
  return {-x / 1000, -y / 1000, (z + 38.195) / 1000};
}

class EachProfile : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Ouster, EachProfile,
                         testing::Values("LEGACY", "RNG19_RFL8_SIG16_NIR16", "RNG19_RFL8_SIG16_NIR16_DUAL",
                                         "RNG15_RFL8_NIR8", "FUSA_RNG15_RFL8_NIR8_DUAL", "FIVE_WORD_PIXEL",
                                         "RNG15_RFL8_NIR8_DUAL", "RNG15_RFL8_NIR8_ZONE16", "RNG15_RFL8_WIN8",
                                         "RNG19_RFL8_SIG16_NIR16_ZONE16", "RNG19_RFL8_SIG16_ZONE16_DUAL",
                                         "RNG19_RFL8_SIG16_NIR16_RGB16", "RNG19_RFL8_SIG16_NIR16_RGB16_DUAL"),
                         [](const auto& test) { return std::string(test.param); });

TEST_P(EachProfile, GivesEachPixelItsPlace) {
  for (const std::size_t pixels : {32U, 64U, 128U})
    for (const std::size_t columns : {512U, 1024U, 2048U})
      for (const bool in_sections : {false, true}) {
        OusterSensor sensor{GetParam(), pixels, columns, 16, {0, columns - 1}};
        OusterDecoder decoder = decoderOf(sensor, ReturnChoice::kBoth, in_sections);
        ASSERT_EQ(decoder.lasers(), pixels);
        std::vector<SavedColumn> came;
        for (const Bytes& packet : ousterFrame(sensor, 65530, numberedRange))
          ASSERT_EQ(decode(decoder, packet, came), Kind::kData);
        ASSERT_EQ(came.size(), columns);
        for (std::size_t column = 0; column < columns; column += 7) {
          const SavedColumn& saved = came[column];
          EXPECT_NEAR(saved.azimuth,
                      std::fmod(180 + 360. * static_cast<double>(column) / static_cast<double>(columns), 360.), 1e-9);
          ASSERT_EQ(saved.cells.size(), pixels * sensor.returns());
          for (std::size_t row = 0; row < saved.cells.size(); ++row) {
            const std::size_t pixel = row / sensor.returns(), second = row % sensor.returns();
            const auto position = positionOf(sensor, column, pixel, numberedRange(65530, column, pixel, second));
            EXPECT_NEAR(saved.cells[row].x, position[0], 1e-4);
            EXPECT_NEAR(saved.cells[row].y, position[1], 1e-4);
            EXPECT_NEAR(saved.cells[row].z, position[2], 1e-4);
            EXPECT_EQ(saved.cells[row].intensity, static_cast<float>(pixel + second));
          }
        }
        EXPECT_EQ(decoder.counts().dual, sensor.returns() == 2 ? columns / 16 : 0);
        EXPECT_EQ(decoder.columnsPerTurn(), static_cast<double>(columns));
        EXPECT_EQ(decoder.turnUs(), 50000);
        EXPECT_EQ(decoder.counts().columns, columns);
      }
}

TEST_P(EachProfile, ChoosesAReturn) {
  const OusterSensor sensor{GetParam()};
  if (sensor.returns() == 1) return;
  const struct {
    std::uint32_t first, second, strongest, last, both;
  } cases[] = {{8000, 16000, 16000, 16000, 2},  // the second return has the stronger signal
               {16000, 8000, 8000, 16000, 2},
               {8000, 8000, 8000, 8000, 1},
               {0, 8000, 8000, 8000, 1},
               {8000, 0, 8000, 8000, 1},
               {0, 0, 0, 0, 0}};
  for (const auto& c : cases) {
    const auto world = [&](std::size_t, std::size_t, std::size_t, std::size_t second) {
      return second != 0 ? c.second : c.first;
    };
    const Bytes packet = ousterFrame(sensor, 0, world).front();
    for (const ReturnChoice choice : {ReturnChoice::kStrongest, ReturnChoice::kLast, ReturnChoice::kBoth}) {
      OusterDecoder decoder = decoderOf(sensor, choice);
      std::vector<SavedColumn> came;
      ASSERT_EQ(decode(decoder, packet, came), Kind::kData);
      const std::vector<Cell>& cells = came.front().cells;
      if (choice == ReturnChoice::kBoth) {
        ASSERT_EQ(cells.size(), 64U);
        EXPECT_EQ(isReturn(cells[0]) + isReturn(cells[1]), static_cast<int>(c.both));
        EXPECT_EQ(isNoReturn(cells[0]) + isNoReturn(cells[1]), 2 - static_cast<int>(c.both));
        continue;
      }
      ASSERT_EQ(cells.size(), 32U);
      const std::uint32_t wanted = choice == ReturnChoice::kLast ? c.last : c.strongest;
      if (wanted == 0) {
        EXPECT_TRUE(isNoReturn(cells[0]));
      } else {
        EXPECT_NEAR(cells[0].x, positionOf(sensor, 0, 0, wanted)[0], 1e-5);
      }
    }
  }
}

TEST_P(EachProfile, PutsReorderedPacketsInOrderAndCountsLostOnes) {
  Random random(11);
  for (int run = 0; run < 30; ++run) {
    OusterSensor sensor{GetParam()};
    if (random.chance(0.5)) sensor.window = {random.below(1024), random.below(1024)};
    std::vector<Bytes> packets;
    const std::size_t first_frame = random.chance(0.5) ? 65534 : 5;  // its number has 16 bits
    for (std::size_t frame = first_frame; frame < first_frame + 4; ++frame)
      for (const Bytes& packet : ousterFrame(sensor, frame, numberedRange)) packets.push_back(packet);
    OusterDecoder whole = decoderOf(sensor), disturbed = decoderOf(sensor);
    std::vector<SavedColumn> all, came;
    for (const Bytes& packet : packets) decode(whole, packet, all);
    EXPECT_EQ(whole.counts().missing + whole.counts().late, 0U);

    // Each packet comes up to two places later, or twice.
    std::vector<Bytes> sent = packets;
    for (std::size_t i = 1; i + 3 < sent.size(); i += 3)
      if (random.chance(0.7)) std::swap(sent[i], sent[i + 1 + random.below(2)]);
    std::size_t copies = 0;
    for (std::size_t i = 0; i < sent.size(); ++i) {
      decode(disturbed, sent[i], came);
      if (!random.chance(0.2)) continue;
      EXPECT_EQ(decode(disturbed, sent[i], came), Kind::kLate);
      ++copies;
    }
    disturbed.flush(saveIn(came));
    ASSERT_EQ(came.size(), all.size());
    for (std::size_t i = 0; i < all.size(); ++i) {
      ASSERT_EQ(came[i].time_us, all[i].time_us) << i;
      ASSERT_EQ(came[i].azimuth, all[i].azimuth) << i;
      ASSERT_EQ(came[i].cells[3].x, all[i].cells[3].x) << i;
      ASSERT_FALSE(came[i].after_break);
    }
    EXPECT_EQ(disturbed.counts().late, copies);
    EXPECT_EQ(disturbed.counts().missing, 0U);

    // Some never come, among them never more than a turn.
    OusterDecoder lossy = decoderOf(sensor);
    came.clear();
    std::size_t lost = 0;
    for (std::size_t i = 0; i < packets.size(); ++i) {
      if (i > 0 && i + 1 < packets.size() && random.chance(0.1)) {
        ++lost;
        continue;
      }
      decode(lossy, packets[i], came);
    }
    lossy.flush(saveIn(came));
    EXPECT_EQ(lossy.counts().missing, lost);
    EXPECT_EQ(lossy.counts().late, 0U);
    EXPECT_EQ(lossy.counts().columns, came.size());
    for (std::size_t i = 1; i < came.size(); ++i) EXPECT_GT(came[i].time_us, came[i - 1].time_us);
  }
}

TEST_P(EachProfile, MarksBreaks) {
  const OusterSensor sensor{GetParam()};
  OusterDecoder decoder = decoderOf(sensor);
  std::vector<SavedColumn> came;
  const std::vector<Bytes> first = ousterFrame(sensor, 5, numberedRange);
  for (const Bytes& packet : first) decode(decoder, packet, came);
  EXPECT_FALSE(came.front().after_break);
  came.clear();
  // Two frames are missing.
  for (const Bytes& packet : ousterFrame(sensor, 8, numberedRange)) decode(decoder, packet, came);
  ASSERT_EQ(came.size(), 1024U);
  EXPECT_TRUE(came.front().after_break);
  EXPECT_FALSE(came[1].after_break);
  EXPECT_EQ(decoder.counts().missing, 128U);
  EXPECT_EQ(decoder.counts().clock_jumps, 0U);
  // Another recording: numbers begin again.
  came.clear();
  std::vector<Bytes> again = ousterFrame(sensor, 1, numberedRange);
  for (const Bytes& packet : again) decode(decoder, packet, came);
  EXPECT_EQ(decoder.counts().clock_jumps, 1U);
  EXPECT_EQ(decoder.counts().late, 16U);
  ASSERT_EQ(came.size(), 48U * 16);
  EXPECT_TRUE(came.front().after_break);
  // The sensor has been started again, which all but legacy packets say.
  if (sensor.profile == "LEGACY") return;
  came.clear();
  for (const Bytes& packet : ousterFrame(sensor, 0, numberedRange, 8)) decode(decoder, packet, came);
  EXPECT_EQ(came.size(), 1024U);
  EXPECT_EQ(decoder.counts().clock_jumps, 2U);
}

TEST_P(EachProfile, CountsForeignPackets) {
  const OusterSensor sensor{GetParam()};
  OusterDecoder decoder = decoderOf(sensor);
  const Bytes good = ousterFrame(sensor, 0, numberedRange).front();
  std::vector<SavedColumn> came;
  EXPECT_EQ(decode(decoder, Bytes(48), came), Kind::kPosition);
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{1206}, good.size() - 1, good.size() + 1}) {
    Bytes resized = good;
    resized.resize(size);
    resized.shrink_to_fit();
    EXPECT_EQ(decode(decoder, resized, came), Kind::kForeign);
  }
  const bool is_legacy = sensor.profile == "LEGACY";
  Bytes beyond = good;
  beyond[(is_legacy ? 0 : 32) + 9] = 4;  // column 1024
  EXPECT_EQ(decode(decoder, beyond, came), Kind::kForeign);
  Bytes other_type = good;
  other_type[0] ^= 2;
  EXPECT_EQ(decode(decoder, other_type, came), is_legacy ? Kind::kData : Kind::kForeign);
  EXPECT_EQ(decoder.counts().foreign, is_legacy ? 6U : 7U);
  EXPECT_EQ(came.size(), is_legacy ? 16U : 0U);
}

TEST_P(EachProfile, HasOneOfTwoHeaders) {
  for (const std::string type : {"STANDARD", "FUSA"}) {
    OusterSensor sensor{GetParam()};
    if (sensor.profile == "LEGACY") continue;
    sensor.header_type = type;
    OusterDecoder decoder = decoderOf(sensor);
    std::vector<SavedColumn> came;
    for (std::size_t frame = 3; frame < 5; ++frame)
      for (const Bytes& packet : ousterFrame(sensor, frame, numberedRange)) {
        ASSERT_EQ(decode(decoder, packet, came), Kind::kData) << type;
        EXPECT_EQ(lisco_apps::sensorsThatSend(asPacket(packet)), std::vector<std::string>{"ouster"});
      }
    EXPECT_EQ(came.size(), 2 * sensor.columns);
    EXPECT_EQ(decoder.counts().missing + decoder.counts().says_other_model, 0U);
    // Motions with sentences of a GPS, and zones
    for (const std::uint8_t state : {std::uint8_t{2}, std::uint8_t{3}}) {
      Bytes packet(32 + 100 + 36 * 4 + 32);
      packet[0] = state;
      EXPECT_EQ(decode(decoder, packet, came), Kind::kPosition);
    }
  }
}

TEST_P(EachProfile, AcceptsAnyBytes) {
  Random random(12);
  const OusterSensor sensor{GetParam(), 32, 64, 16, {0, 63}};
  OusterDecoder decoder = decoderOf(sensor);
  std::vector<Bytes> packets;
  for (std::size_t frame = 0; frame < 20; ++frame)
    for (const Bytes& packet : ousterFrame(sensor, frame, numberedRange)) packets.push_back(packet);
  std::uint64_t came = 0;
  for (int run = 0; run < 5000; ++run) {
    Bytes payload = random.oneOf(packets);
    for (std::size_t i = random.below(20); i > 0; --i)
      payload[random.chance(0.5) ? random.below(50) : random.below(payload.size())] =
          static_cast<std::uint8_t>(random.below(256));
    if (random.chance(0.1)) payload.resize(random.below(payload.size()));
    payload.shrink_to_fit();
    decoder.decode(asPacket(payload), [&](const lisco_apps::Column& column) {
      ++came;
      EXPECT_GE(column.azimuth, 0);
      EXPECT_LT(column.azimuth, 360);
      for (const Cell& cell : column.cells) EXPECT_TRUE(isReturn(cell) || isNoReturn(cell));
    });
  }
  const lisco_apps::Decoder::Counts& counts = decoder.counts();
  EXPECT_EQ(counts.data + counts.late + counts.position + counts.foreign, 5000U);
  EXPECT_EQ(counts.columns, came);
  EXPECT_GT(came, 1000U);
}

TEST(OusterMetadata, HasDefaultsOfTheFirstSensors) {
  const lisco_apps::OusterMetadata metadata = parseOusterMetadata(
      R"({"beam_altitude_angles": [1, -1], "beam_azimuth_angles": [3, -3], "lidar_mode": "512x20"})", "json");
  EXPECT_EQ(metadata.columns_per_frame, 512U);
  EXPECT_EQ(metadata.columns_per_packet, 16U);
  EXPECT_EQ(metadata.frames_per_second, 20);
  EXPECT_EQ(metadata.beam_to_lidar[3], 12.163);
  EXPECT_EQ(metadata.lidar_to_sensor[11], 36.18);
  EXPECT_EQ(metadata.lidar_to_sensor[0], -1);
  EXPECT_EQ(metadata.last_column, 511U);
}

TEST(OusterMetadata, RefusesWhatItCannotUse) {
  const std::string good = OusterSensor().metadata();
  const auto refusal = [&](const std::string& from, const std::string& to) {
    std::string json = good;
    EXPECT_NE(json.find(from), std::string::npos) << from;
    json.replace(json.find(from), from.size(), to);
    const std::string said = refusalOf([&] { parseOusterMetadata(json, "m.json"); });
    EXPECT_EQ(said.find("m.json: "), 0U) << said;
    EXPECT_EQ(said.find('\n'), std::string::npos) << said;
    return said.substr(8);
  };
  EXPECT_EQ(refusal("{", ""), "is no metadata of an Ouster sensor: it is not JSON");
  EXPECT_EQ(refusalOf([] { parseOusterMetadata("[]", "m.json"); }), "m.json: is no metadata of an Ouster sensor");
  EXPECT_NE(refusalOf([] { parseOusterMetadata("{}", "m.json"); }).find("0 beam_altitude_angles"), std::string::npos);
  EXPECT_NE(refusal("\"LEGACY\"", "\"RNG7\"").find("udp_profile_lidar is RNG7, which cannot be read"),
            std::string::npos);
  EXPECT_EQ(refusal("\"pixels_per_column\": 32", "\"pixels_per_column\": 31"),
            "pixels_per_column is not 32, the number of beam_altitude_angles");
  EXPECT_EQ(refusal("[0, 1023]", "[0, 1024]"), "column_window is not the first and the last column of a frame");
  EXPECT_EQ(refusal("[0, 1023]", "[0]"), "column_window is not the first and the last column of a frame");
  EXPECT_EQ(refusal("1024x20", "1024"), "lidar_mode is '1024', not columns x frames per second, as in 1024x10");
  EXPECT_EQ(refusal("15.806", "\"a\""), "lidar_origin_to_beam_origin_mm is not a number from -1000 to 1000");
  EXPECT_EQ(refusal("[-1, 0, 0, 0,", "[-1, 0, 0,"), "lidar_to_sensor_transform has not 16 numbers");
  EXPECT_EQ(refusal("[16, ", "[1e9, "), "beam_altitude_angles is not a list of numbers within +-90");
  EXPECT_EQ(refusal("\"columns_per_packet\": 16", "\"columns_per_packet\": 0"),
            "columns_per_packet is not a number from 1 to 256");
  DecoderOptions options;
  options.sensor = "ouster";
  EXPECT_EQ(refusalOf([&] { makeDecoder(options); }),
            "the ouster needs its metadata, the JSON file that describes the sensor; give it by --metadata");
  options.metadata = "missing.json";
  EXPECT_EQ(refusalOf([&] { makeDecoder(options); }), "missing.json: cannot be read");
}

}  // namespace
}  // namespace lisco_test
