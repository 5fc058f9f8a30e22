// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "sensors/velodyne_decoder.h"

#include <cmath>
#include <string>
#include <vector>

#include "calibration.h"
#include "columns.h"
#include "packets.h"
#include "random.h"
#include "temporary_folder.h"

namespace lisco_test {
namespace {

using lisco_apps::Cell;
using lisco_apps::Column;
using lisco_apps::Laser;
using lisco_apps::makeVelodyneModel;
using lisco_apps::ReturnChoice;
using lisco_apps::VelodyneDecoder;
using Kind = VelodyneDecoder::Kind;

constexpr double kPi = 3.14159265358979323846;

std::vector<SavedColumn> columnsOf(VelodyneDecoder& decoder, const Bytes& payload) {
  std::vector<SavedColumn> columns;
  EXPECT_EQ(decode(decoder, payload, columns), Kind::kData);
  return columns;
}

/// Clockwise from straight ahead, degrees.
double azimuthOf(const Cell& cell) {
  return std::atan2(-cell.y, cell.x) * 180 / kPi;
}

class DecoderTest : public InTemporaryFolder {
 protected:
  std::filesystem::path calibration(const std::string& xml) const {
    writeFile(folder_ / "db.xml", Bytes(xml.begin(), xml.end()));
    return folder_ / "db.xml";
  }
  VelodyneDecoder decoderOf(const std::string& name, ReturnChoice returns = ReturnChoice::kStrongest) const {
    return VelodyneDecoder(makeVelodyneModel(name, name == "hdl64e" ? calibration(calibrationXml(usualCalibration))
                                                                    : std::filesystem::path()),
                           returns);
  }
};

class EachSensor : public DecoderTest, public testing::WithParamInterface<const char*> {
 protected:
  VelodyneDecoder decoder() const { return decoderOf(GetParam()); }
};
INSTANTIATE_TEST_SUITE_P(Sensors, EachSensor, testing::Values("vlp16", "vlp32c", "hdl32e", "hdl64e", "vls128"),
                         [](const auto& test) { return std::string(test.param); });

TEST_P(EachSensor, GivesAColumnForEachFiring) {
  for (const bool is_dual : {false, true}) {
    VelodyneDecoder decoder = this->decoder();
    PacketEncoder encoder(GetParam(), is_dual);
    std::vector<SavedColumn> columns;
    constexpr int kPackets = 40;
    for (int i = 0; i < kPackets; ++i)
      EXPECT_EQ(decode(decoder, encoder.next(constantWorld({2500, 9})), columns), Kind::kData);
    ASSERT_EQ(columns.size(), kPackets * encoder.firingsPerPacket());
    const double unit = decoder.model().distance_unit;
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const SavedColumn& column = columns[i];
      ASSERT_EQ(column.cells.size(), encoder.lasers());
      EXPECT_NEAR(column.time_us, 5e6 + static_cast<double>(i) * decoder.model().firing_period_us, 1);
      EXPECT_FALSE(column.after_break);
      for (std::size_t row = 0; row < column.cells.size(); ++row) {
        const Cell& cell = column.cells[row];
        ASSERT_TRUE(isReturn(cell));
        EXPECT_EQ(cell.intensity, 9);
        if (GetParam() == std::string("hdl64e")) continue;  // its rays do not start at the origin
        EXPECT_NEAR(rangeOf(cell), 2500 * unit, 1e-5);
        EXPECT_NEAR(std::asin(cell.z / rangeOf(cell)) * 180 / kPi, decoder.model().lasers[row].elevation, 1e-4);
        EXPECT_TRUE(row == 0 || cell.z < column.cells[row - 1].z) << "not from top to bottom";
      }
    }
    const VelodyneDecoder::Counts& counts = decoder.counts();
    EXPECT_EQ(counts.data, 40U);
    EXPECT_EQ(counts.dual, is_dual ? 40U : 0U);
    EXPECT_EQ(counts.columns, columns.size());
    EXPECT_EQ(counts.late + counts.position + counts.foreign + counts.says_other_model, 0U);
    EXPECT_EQ(decoder.counts().missing, 0U);
    EXPECT_NEAR(decoder.packetPeriodUs(), encoder.packetPeriodUs(), 1e-6);
    EXPECT_NEAR(decoder.usualGapUs(), encoder.packetPeriodUs(), 1);
    EXPECT_DOUBLE_EQ(decoder.step(), 0.2);
    EXPECT_DOUBLE_EQ(decoder.columnsPerTurn(), 360 / 0.2 * (GetParam() == std::string("vlp16") ? 2 : 1));
  }
}

TEST_P(EachSensor, PutsEachMeasurementIntoItsCell) {
  VelodyneDecoder decoder = this->decoder();
  PacketEncoder encoder(GetParam());
  // One laser alone returns in each firing.
  const std::vector<lisco_apps::Laser>& lasers = decoder.model().lasers;
  std::size_t firing = 0;
  for (int i = 0; i < 60; ++i) {
    const Bytes payload = encoder.next([](std::size_t number, std::size_t laser, bool) {
      return Measured{static_cast<std::uint16_t>(laser == number % 128 ? 1000 : 0), static_cast<std::uint8_t>(laser)};
    });
    for (const SavedColumn& column : columnsOf(decoder, payload)) {
      for (std::size_t row = 0; row < column.cells.size(); ++row) {
        const bool has_one = lasers[row].number == firing % 128;
        ASSERT_TRUE(has_one ? isReturn(column.cells[row]) : isNoReturn(column.cells[row])) << firing << ' ' << row;
        EXPECT_TRUE(!has_one || column.cells[row].intensity == static_cast<float>(lasers[row].number));
      }
      ++firing;
    }
  }
}

TEST_P(EachSensor, WrapsTheAzimuth) {
  VelodyneDecoder decoder = this->decoder();
  PacketEncoder encoder(GetParam());
  encoder.step = 23;
  encoder.azimuth = 36000 - 23 * 30;
  double expected = encoder.azimuth / 100.;
  const bool has_two = GetParam() == std::string("vlp16");
  for (int i = 0; i < 12; ++i)
    for (const SavedColumn& column : columnsOf(decoder, encoder.next(constantWorld({5000, 1})))) {
      EXPECT_GE(column.azimuth, 0);
      EXPECT_LT(column.azimuth, 360);
      EXPECT_NEAR(std::remainder(column.azimuth - expected, 360.), 0, 1e-9);
      expected += has_two ? 0.115 : 0.23;
    }
  // Some sensors write 360.00.
  encoder.azimuth = 36000;
  EXPECT_EQ(columnsOf(decoder, encoder.next(constantWorld({5000, 1}))).front().azimuth, 0);
}

TEST_P(EachSensor, KeepsTheStrongerOfTwoReturns) {
  VelodyneDecoder decoder = this->decoder();
  PacketEncoder encoder(GetParam(), true);
  const auto only = [&](Measured first, Measured second) {
    std::vector<SavedColumn> columns = columnsOf(
        decoder, encoder.next([&](std::size_t, std::size_t, bool is_second) { return is_second ? second : first; }));
    return columns.front().cells.front();
  };
  EXPECT_EQ(only({5000, 30}, {6000, 40}).intensity, 40);
  EXPECT_EQ(only({5000, 50}, {6000, 40}).intensity, 50);
  EXPECT_EQ(only({5000, 0}, {0, 40}).intensity, 0) << "a missing return is not stronger";
  EXPECT_EQ(only({0, 50}, {6000, 0}).intensity, 0);
  EXPECT_TRUE(isNoReturn(only({0, 50}, {0, 60})));
}

TEST_P(EachSensor, GivesBothReturns) {
  VelodyneDecoder decoder = decoderOf(GetParam(), ReturnChoice::kBoth);
  VelodyneDecoder last = decoderOf(GetParam(), ReturnChoice::kLast);
  VelodyneDecoder strongest = decoderOf(GetParam(), ReturnChoice::kStrongest);
  PacketEncoder encoder(GetParam(), true);
  // Of three lasers: two returns, the same one twice, and one.
  const Bytes payload = encoder.next([](std::size_t, std::size_t laser, bool second) {
    if (laser % 3 == 0) return second ? Measured{4000, 9} : Measured{6000, 7};
    if (laser % 3 == 1) return Measured{5000, 8};
    return second ? Measured{0, 0} : Measured{3000, 6};
  });
  const SavedColumn both = columnsOf(decoder, payload).front(), far = columnsOf(last, payload).front(),
                    strong = columnsOf(strongest, payload).front();
  ASSERT_EQ(both.cells.size(), 2 * encoder.lasers());
  ASSERT_EQ(far.cells.size(), encoder.lasers());
  for (std::size_t row = 0; row < far.cells.size(); ++row) {
    const std::size_t laser = decoder.model().lasers[row].number;
    const Cell &first = both.cells[2 * row], &second = both.cells[2 * row + 1];
    EXPECT_EQ(first.intensity, laser % 3 == 0 ? 7 : laser % 3 == 1 ? 8 : 6);
    EXPECT_EQ(isReturn(second), laser % 3 == 0);
    EXPECT_EQ(far.cells[row].x, first.x);
    EXPECT_EQ(strong.cells[row].x, laser % 3 == 0 ? second.x : first.x);
    if (laser % 3 == 0) {
      EXPECT_EQ(second.intensity, 9);
    }
  }
  // The number of cells changes with the mode, which is a break.
  PacketEncoder single(GetParam(), false);
  single.time_us = encoder.time_us;
  const std::vector<SavedColumn> columns = columnsOf(decoder, single.next(constantWorld({5000, 1})));
  EXPECT_TRUE(columns.front().after_break);
  EXPECT_FALSE(columns[1].after_break);
  EXPECT_EQ(columns.front().cells.size(), encoder.lasers());
}

TEST_P(EachSensor, CountsForeignPackets) {
  VelodyneDecoder decoder = this->decoder();
  PacketEncoder encoder(GetParam());
  const Bytes good = encoder.next(constantWorld({5000, 1}));
  std::vector<SavedColumn> columns;
  EXPECT_EQ(decode(decoder, Bytes(512), columns), Kind::kPosition);
  for (const std::size_t size : {0U, 1U, 1205U, 1207U, 1248U, 2048U}) {
    Bytes resized = good;
    resized.resize(size);
    resized.shrink_to_fit();
    EXPECT_EQ(decode(decoder, resized, columns), Kind::kForeign) << size;
  }
  for (std::size_t block = 0; block < 12; ++block) {
    Bytes wrong_flag = good, wrong_azimuth = good;
    wrong_flag[100 * block] ^= 1;
    wrong_azimuth[100 * block + 3] = 0x8C;  // 360.01 or more
    wrong_azimuth[100 * block + 2] = 0xFF;
    EXPECT_EQ(decode(decoder, wrong_flag, columns), Kind::kForeign) << block;
    EXPECT_EQ(decode(decoder, wrong_azimuth, columns), Kind::kForeign) << block;
  }
  EXPECT_TRUE(columns.empty());
  EXPECT_EQ(decode(decoder, good, columns), Kind::kData);
  EXPECT_EQ(decoder.counts().position, 1U);
  EXPECT_EQ(decoder.counts().foreign, 30U);
  EXPECT_EQ(decoder.counts().data, 1U);
}

TEST_P(EachSensor, DetectsPacketsOfAnotherSensor) {
  for (const std::string other : {"vlp16", "vlp32c", "hdl32e", "hdl64e", "vls128"}) {
    if (other == GetParam()) continue;
    VelodyneDecoder decoder = this->decoder();
    PacketEncoder encoder(other);
    std::vector<SavedColumn> columns;
    for (int i = 0; i < 20; ++i) decode(decoder, encoder.next(constantWorld({5000, 1})), columns);
    const bool same_flags = decoder.model().flags.size() == 1 && other != "hdl64e" && other != "vls128";
    if (same_flags) {
      EXPECT_EQ(decoder.counts().says_other_model, 20U) << other;
      // A VLP-32C fires 12 times a packet, as an HDL-32E, but at the pace of a VLP-16.
      EXPECT_GT(std::abs(decoder.usualGapUs() / decoder.packetPeriodUs() - 1), 0.15) << other;
    } else {
      EXPECT_EQ(decoder.counts().foreign, 20U) << other;
      EXPECT_TRUE(columns.empty());
    }
  }
}

TEST_P(EachSensor, DropsLatePackets) {
  VelodyneDecoder decoder = this->decoder();
  PacketEncoder encoder(GetParam());
  std::vector<Bytes> payloads;
  for (int i = 0; i < 10; ++i) payloads.push_back(encoder.next(constantWorld({5000, 1})));
  std::vector<SavedColumn> columns;
  for (const std::size_t i : {0U, 1U, 4U, 2U, 5U, 5U, 9U}) decode(decoder, payloads[i], columns);
  EXPECT_EQ(columns.size(), 5 * encoder.firingsPerPacket());
  EXPECT_EQ(decoder.counts().late, 2U);
  EXPECT_EQ(decoder.counts().missing, 5U);
  for (const SavedColumn& column : columns) EXPECT_FALSE(column.after_break);
}

TEST_P(EachSensor, MarksABreak) {
  VelodyneDecoder decoder = this->decoder();
  PacketEncoder encoder(GetParam());
  columnsOf(decoder, encoder.next(constantWorld({5000, 1})));
  for (const double seconds : {0.7, 100.}) {  // more than a turn; more than can be counted
    encoder.time_us += seconds * 1e6;
    const std::vector<SavedColumn> columns = columnsOf(decoder, encoder.next(constantWorld({5000, 1})));
    for (std::size_t i = 0; i < columns.size(); ++i) EXPECT_EQ(columns[i].after_break, i == 0);
  }
  EXPECT_EQ(decoder.counts().clock_jumps, 1U);
}

TEST_P(EachSensor, AcceptsAnyBytes) {
  constexpr std::uint64_t kSeed = 3;
  Random random(kSeed);
  VelodyneDecoder decoder = this->decoder();
  for (int run = 0; run < 3000; ++run) {
    PacketEncoder encoder(GetParam(), random.chance(0.5));
    Bytes payload = encoder.next([&](std::size_t, std::size_t, bool) {
      return Measured{static_cast<std::uint16_t>(random.below(65536)), static_cast<std::uint8_t>(random.below(256))};
    });
    for (std::size_t i = random.below(4); i > 0; --i)
      payload[random.below(payload.size())] = static_cast<std::uint8_t>(random.below(256));
    if (random.chance(0.1))
      for (std::uint8_t& byte : payload) byte = static_cast<std::uint8_t>(random.below(256));
    if (random.chance(0.1)) payload.resize(random.below(payload.size()));
    payload.shrink_to_fit();
    std::vector<SavedColumn> columns;
    const Kind kind = decode(decoder, payload, columns);
    EXPECT_EQ(columns.empty(), kind != Kind::kData) << "seed " << kSeed << ", run " << run;
    for (const SavedColumn& column : columns) {
      EXPECT_GE(column.azimuth, 0);
      EXPECT_LT(column.azimuth, 360);
      for (const Cell& cell : column.cells) EXPECT_TRUE(isReturn(cell) || isNoReturn(cell));
    }
  }
}

TEST_F(DecoderTest, UsesTheSensorsAxes) {
  PacketEncoder encoder("vlp16");
  encoder.step = 0;
  // The laser 15 degrees up is the last one of a firing.
  const double side = 10 * std::cos(15 * kPi / 180), up = 10 * std::sin(15 * kPi / 180);
  const struct {
    unsigned azimuth;
    double x, y;
  } cases[] = {{0, side, 0}, {9000, 0, -side}, {18000, -side, 0}, {27000, 0, side}};
  for (const auto& c : cases) {
    VelodyneDecoder decoder(makeVelodyneModel("vlp16"));
    encoder.azimuth = c.azimuth;
    const Cell cell = columnsOf(decoder, encoder.next(constantWorld({5000, 1}))).front().cells.front();
    EXPECT_NEAR(cell.x, c.x, 1e-5) << c.azimuth;
    EXPECT_NEAR(cell.y, c.y, 1e-5) << c.azimuth;
    EXPECT_NEAR(cell.z, up, 1e-5) << c.azimuth;
  }
}

TEST_F(DecoderTest, AppliesTheDelaysOfLasers) {
  // By the manuals: a VLP-16's laser fires each 2.304 us, an HDL-32E's each 1.152 us.
  const struct {
    const char* name;
    double share;  ///< of a step from one laser to the next
  } cases[] = {{"vlp16", 2.304 / 110.592}, {"hdl32e", 1.152 / 46.08}};
  for (const auto& c : cases) {
    VelodyneDecoder decoder(makeVelodyneModel(c.name));
    PacketEncoder encoder(c.name);
    encoder.step = 40;
    const SavedColumn column = columnsOf(decoder, encoder.next(constantWorld({5000, 1}))).front();
    for (std::size_t row = 0; row < column.cells.size(); ++row)
      EXPECT_NEAR(azimuthOf(column.cells[row]), 0.4 * c.share * static_cast<double>(decoder.model().lasers[row].number),
                  1e-4);
  }
}

// The last firings of a packet are turned by none, second returns to the next azimuth of the packet.
TEST_F(DecoderTest, TurnsAsTheDriverDoes) {
  const struct {
    const char* name;
    bool is_dual;
    std::size_t columns, firings;  ///< of a packet; of a block
    double share;                  ///< of a step from one laser to the next, every other one of the VLP-32C
  } cases[] = {{"vlp16", true, 12, 2, 2.304 / 110.592},
               {"vlp32c", false, 12, 1, 2.304 / 55.296},
               {"vlp32c", true, 6, 1, 2.304 / 55.296}};
  for (const auto& c : cases) {
    const std::size_t returns = c.is_dual ? 2 : 1;
    VelodyneDecoder decoder(makeVelodyneModel(c.name));
    PacketEncoder encoder(c.name, c.is_dual);
    encoder.azimuth = 35990;
    encoder.step = 40;
    const std::vector<SavedColumn> columns = columnsOf(decoder, encoder.next([](std::size_t, std::size_t, bool second) {
      return second ? Measured{4000, 1} : Measured{5000, 1};
    }));
    ASSERT_EQ(columns.size(), c.columns) << c.name;
    for (std::size_t i = 0; i < columns.size(); ++i)
      for (std::size_t row = 0; row < decoder.lasers(); ++row) {
        const Laser& laser = decoder.model().lasers[row];
        const double order = static_cast<double>(c.firings == 2 ? laser.number : laser.number / 2 * 2);
        const bool is_last = i / c.firings + 1 == columns.size() / c.firings;
        const double block = 359.9 + 0.4 * static_cast<double>(i / c.firings) + laser.azimuth_offset;
        const double firing = static_cast<double>(i % c.firings) / 2;
        const auto departure = [&](std::size_t which, double azimuth) {
          return std::remainder(azimuthOf(columns[i].cells[returns * row + which]) - azimuth, 360.);
        };
        EXPECT_NEAR(departure(0, block + (is_last ? 0 : 0.4 * (firing + c.share * order))), 0, 1e-4) << c.name << i;
        if (c.is_dual) {
          EXPECT_NEAR(departure(1, block + (is_last ? 0 : 0.4)), 0, 1e-4) << c.name << i;
        }
      }
  }
}

TEST_F(DecoderTest, TurnsByTheManual) {
  for (const bool is_dual : {false, true}) {
    VelodyneDecoder decoder(makeVelodyneModel("vlp32c"), ReturnChoice::kBoth, lisco_apps::Turning::kManual);
    PacketEncoder encoder("vlp32c", is_dual);
    encoder.step = 40;
    const std::vector<SavedColumn> columns = columnsOf(decoder, encoder.next([](std::size_t, std::size_t, bool second) {
      return second ? Measured{4000, 1} : Measured{5000, 1};
    }));
    const std::size_t returns = is_dual ? 2 : 1;
    for (std::size_t i = 0; i < columns.size(); ++i)
      for (std::size_t cell = 0; cell < columns[i].cells.size(); ++cell) {
        const Laser& laser = decoder.model().lasers[cell / returns];
        const double order = static_cast<double>(laser.number / 2);
        const double azimuth = 0.4 * (static_cast<double>(i) + order * 2.304 / 55.296) + laser.azimuth_offset;
        EXPECT_NEAR(std::remainder(azimuthOf(columns[i].cells[cell]) - azimuth, 360.), 0, 1e-4);
      }
  }
}

TEST_F(DecoderTest, FollowsChangesOfSpeed) {
  VelodyneDecoder decoder(makeVelodyneModel("hdl32e"));
  PacketEncoder encoder("hdl32e");
  std::vector<SavedColumn> columns;
  for (const unsigned step : {20U, 40U, 10U, 0U}) {
    encoder.step = step;
    for (int i = 0; i < 20000; ++i) {
      columns.clear();
      decode(decoder, encoder.next(constantWorld({0, 0})), columns);
    }
    EXPECT_DOUBLE_EQ(decoder.step(), step / 100.);
  }
}

TEST_F(DecoderTest, AcceptsWrongFactoryBytes) {
  VelodyneDecoder decoder(makeVelodyneModel("vlp16"));
  PacketEncoder encoder("vlp16");
  encoder.model_byte = 0x21;
  EXPECT_EQ(columnsOf(decoder, encoder.next(constantWorld({5000, 1}))).size(), 24U);
  EXPECT_EQ(decoder.counts().says_other_model, 1U);
  // Blocks that do not come in pairs are single returns in any mode.
  Bytes payload = encoder.next(constantWorld({5000, 1}));
  payload[1204] = 0x39;
  EXPECT_EQ(columnsOf(decoder, payload).size(), 24U);
  EXPECT_EQ(decoder.counts().dual, 0U);
}

TEST_F(DecoderTest, RefusesUnknownSensorsAndBadCalibrations) {
  EXPECT_EQ(refusalOf([] { makeVelodyneModel("os1"); }),
            "there is no sensor 'os1': it is one of vlp16, vlp32c, hdl32e, hdl64e, vls128");
  EXPECT_EQ(refusalOf([] { makeVelodyneModel("hdl64e"); }),
            "the hdl64e needs its calibration file: each of these sensors has its own; give it by --calibration");
  EXPECT_EQ(refusalOf([] { makeVelodyneModel("vlp16", "db.xml"); }),
            "a calibration file is for the hdl64e or the vlp32c, not for the vlp16");

  const auto refusal = [&](const std::string& xml) {
    const std::string said = refusalOf([&] { makeVelodyneModel("hdl64e", calibration(xml)); });
    EXPECT_EQ(said.find((folder_ / "db.xml").string() + ": "), 0U) << said;
    EXPECT_EQ(said.find('\n'), std::string::npos) << said;
    return said.substr((folder_ / "db.xml: ").string().size());
  };
  EXPECT_EQ(refusalOf([&] { makeVelodyneModel("hdl64e", folder_ / "missing.xml"); }),
            (folder_ / "missing.xml").string() + ": is no calibration file: cannot open file");
  const std::string good = calibrationXml(usualCalibration);
  EXPECT_NE(refusal("").find("is no calibration file"), std::string::npos);
  EXPECT_NE(refusal(good.substr(0, good.size() / 2)).find("is no calibration file"), std::string::npos);
  EXPECT_NE(refusal("<boost_serialization/>").find("is no calibration file of an HDL-64E"), std::string::npos);
  EXPECT_EQ(refusal(calibrationXml(usualCalibration, 63)), "does not describe laser 63");
  EXPECT_EQ(refusal(calibrationXml(usualCalibration, 65)), "there is no laser 64");
  for (const std::string number : {"nan", "1e999", "", "3 degrees", "0x1"}) {
    std::string bad = good;
    bad.insert(bad.find("<vertCorrection_>") + 17, number + "</vertCorrection_><vertCorrection_>");
    EXPECT_EQ(refusal(bad), "vertCorrection_ is no number: '" + number + "'");
  }
  for (const std::string number : {"-1", "64", "1.5", "99999999999999999999"}) {
    std::string bad = good;
    bad.replace(bad.find("<id_>7<") + 5, 1, number);
    EXPECT_EQ(refusal(bad), "there is no laser " + number);
  }
  EXPECT_NE(refusal(calibrationXml([](int laser) {
              auto values = usualCalibration(laser);
              values.erase("rotCorrection_");
              return values;
            })).find("rotCorrection_"),
            std::string::npos);
}

TEST_F(DecoderTest, ReadsTheYamlOfRos) {
  const std::filesystem::path file = folder_ / "vlp32c.yaml";
  const auto refusal = [&](const std::string& yaml) {
    writeFile(file, Bytes(yaml.begin(), yaml.end()));
    const std::string said = refusalOf([&] { makeVelodyneModel("vlp32c", file); });
    return said.find(file.string()) == 0 ? said.substr(file.string().size()) : std::string();
  };
  std::string flow = "# a comment\nlasers:\n", block = "num_lasers: 32\nlasers:\n";
  for (int i = 0; i < 32; ++i) {
    const std::string values =
        "dist_correction: 0.5, horiz_offset_correction: 0.02,\n  laser_id: " + std::to_string(i) +
        ", rot_correction: -0.01, vert_correction: " + std::to_string(0.01 * i) + ", vert_offset_correction: 0.03";
    flow += "- {" + values + "}\n";
    std::string lines = "  - " + values + "\n";
    for (std::size_t at = 0; (at = lines.find(", ")) != std::string::npos;) lines.replace(at, 2, "\n    ");
    block += lines;
  }
  flow += "num_lasers: 32\ndistance_resolution: 0.004\n";
  for (const std::string& yaml : {flow, block}) {
    EXPECT_EQ(refusal(yaml), "");
    const lisco_apps::VelodyneModel model = makeVelodyneModel("vlp32c", file);
    ASSERT_EQ(model.lasers.size(), 32U);
    for (std::size_t i = 0; i < 32; ++i) {
      const lisco_apps::Laser& laser = model.lasers[i];
      EXPECT_EQ(laser.number, 31 - i) << "from top to bottom";
      EXPECT_NEAR(laser.elevation, 0.01 * static_cast<double>(laser.number) * 180 / kPi, 1e-6);
      EXPECT_NEAR(laser.azimuth_offset, 0.01 * 180 / kPi, 1e-9);
      EXPECT_EQ(laser.distance_offset, 0.5);
      EXPECT_EQ(laser.height, 0.03);
      EXPECT_EQ(laser.side, 0.02);
      EXPECT_NEAR(laser.delay_us, 2.304 * static_cast<double>(laser.number / 2), 1e-9);
    }
  }
  EXPECT_EQ(refusal("lasers:\n"), ": is no calibration file: it has no list of lasers");
  EXPECT_EQ(refusal("lasers:\n- {laser_id: 32}"), ": there is no laser 32");
  EXPECT_EQ(refusal("lasers:\n- {laser_id: 3}"), ": is no calibration file: a laser has no vert_correction");
  EXPECT_EQ(refusal(flow.substr(0, flow.find("- {", 40))), ": does not describe laser 1");
  EXPECT_EQ(refusal("lasers:\n- {laser_id: x, rot_correction: 1}"), ": laser_id is no number: 'x'");
}

TEST_F(DecoderTest, DropsNegativeDistances) {
  // A correction may make a distance negative.
  VelodyneDecoder decoder(makeVelodyneModel("hdl64e", calibration(calibrationXml([](int laser) {
                                              auto values = usualCalibration(laser);
                                              values["distCorrection_"] = -100;
                                              return values;
                                            }))));
  PacketEncoder encoder("hdl64e");
  const SavedColumn near = columnsOf(decoder, encoder.next(constantWorld({499, 1}))).front();
  for (const Cell& cell : near.cells) EXPECT_TRUE(isNoReturn(cell));
  const SavedColumn far = columnsOf(decoder, encoder.next(constantWorld({501, 1}))).front();
  for (const Cell& cell : far.cells) EXPECT_TRUE(isReturn(cell));
}

}  // namespace
}  // namespace lisco_test
