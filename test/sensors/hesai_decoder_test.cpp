// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "sensors/hesai_decoder.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "columns.h"
#include "hesai_packets.h"
#include "random.h"
#include "temporary_folder.h"

namespace lisco_test {
namespace {

using lisco_apps::Cell;
using lisco_apps::HesaiDecoder;
using lisco_apps::makeHesaiModel;
using lisco_apps::ReturnChoice;
using Kind = lisco_apps::Decoder::Kind;

constexpr double kPi = 3.14159265358979323846;

/// Angles that differ for each laser and are not sorted.
double elevationOf(std::size_t laser) {
  return 40 - 0.7 * static_cast<double>(laser * 7 % 128);
}
double offsetOf(std::size_t laser) {
  return -5 + 0.1 * static_cast<double>(laser % 97);
}

class EachHesai : public InTemporaryFolder, public testing::WithParamInterface<const char*> {
 protected:
  HesaiDecoder decoder(ReturnChoice returns = ReturnChoice::kBoth) const {
    std::string csv = "EEFF,1,1\r\nLaser id,Elevation,Azimuth\r\n";
    for (std::size_t i = 0; i < HesaiEncoder(GetParam()).lasers(); ++i)
      csv += std::to_string(i + 1) + "," + std::to_string(elevationOf(i)) + "," + std::to_string(offsetOf(i)) + "\r\n";
    csv += "7f83b1657ff1fc53b92dc18148a1d65dfc2d4b1fa3d677284addd200126d9069\r\n";
    writeFile(folder_ / "angles.csv", Bytes(csv.begin(), csv.end()));
    return HesaiDecoder(makeHesaiModel(GetParam(), folder_ / "angles.csv"), returns);
  }
};
INSTANTIATE_TEST_SUITE_P(Sensors, EachHesai,
                         testing::Values("pandar40p", "pandar64", "pandarqt64", "pandarxt16", "pandarxt32",
                                         "pandarxt32m", "pandarqt128"),
                         [](const auto& test) { return std::string(test.param); });

TEST_P(EachHesai, PutsEachMeasurementIntoItsPlace) {
  constexpr std::array<std::uint8_t, 5> kModes{0x37, 0x38, 0x39, 0x3B, 0x3C};
  for (const std::uint8_t mode : kModes) {
    HesaiDecoder decoder = this->decoder();
    HesaiEncoder encoder(GetParam(), mode);
    encoder.azimuth = 35900;
    const auto distance = [](std::size_t firing, std::size_t laser, std::size_t second) {
      return 500 + 7 * firing + 11 * laser + 4001 * second;
    };
    const HesaiEncoder::World world = [&](std::size_t firing, std::size_t laser, std::size_t second) {
      return Measured{static_cast<std::uint16_t>(distance(firing, laser, second)),
                      static_cast<std::uint8_t>(laser + second)};
    };
    std::vector<SavedColumn> columns;
    for (int i = 0; i < 20; ++i) ASSERT_EQ(decode(decoder, encoder.next(world), columns), Kind::kData);
    ASSERT_EQ(columns.size(), 20 * encoder.firingsPerPacket());
    for (std::size_t firing = 0; firing < columns.size(); ++firing) {
      const SavedColumn& column = columns[firing];
      const double turned = std::fmod(359 + 0.2 * static_cast<double>(firing), 360.);
      EXPECT_NEAR(std::remainder(column.azimuth - (turned - 90), 360), 0, 1e-9);  // +x is to the right
      EXPECT_FALSE(column.after_break);
      ASSERT_EQ(column.cells.size(), encoder.lasers() * encoder.returns());
      for (std::size_t row = 0; row < column.cells.size(); ++row) {
        const std::size_t laser = decoder.model().lasers[row / encoder.returns()].number;
        const double range = 0.004 * static_cast<double>(distance(firing, laser, row % encoder.returns()));
        const double azimuth = (turned + offsetOf(laser)) * kPi / 180, elevation = elevationOf(laser) * kPi / 180;
        const Cell& cell = column.cells[row];
        EXPECT_NEAR(cell.x, range * std::cos(elevation) * std::sin(azimuth), 1e-5);
        EXPECT_NEAR(cell.y, range * std::cos(elevation) * std::cos(azimuth), 1e-5);
        EXPECT_NEAR(cell.z, range * std::sin(elevation), 1e-5);
        EXPECT_EQ(cell.intensity, static_cast<float>(laser + row % encoder.returns()));
      }
      if (firing > 0) {
        EXPECT_NEAR(column.time_us - columns[firing - 1].time_us, encoder.period_us, 1.5);
      }
    }
    EXPECT_EQ(decoder.counts().dual, encoder.returns() > 1 ? 20U : 0U);
    EXPECT_NEAR(decoder.columnsPerTurn(), 1800, 1e-6);
    EXPECT_EQ(decoder.counts().missing + decoder.counts().late + decoder.counts().foreign, 0U);
  }
}

TEST_P(EachHesai, UsesTheDistanceUnitOfThePacket) {
  HesaiDecoder decoder = this->decoder();
  HesaiEncoder encoder(GetParam());
  encoder.distance_unit = 2;
  std::vector<SavedColumn> columns;
  decode(decoder, encoder.next([](std::size_t, std::size_t, std::size_t) { return Measured{1000, 1}; }), columns);
  const double unit = GetParam() == std::string("pandar40p") ? 0.004 : 0.002;  // it has no header
  EXPECT_NEAR(rangeOf(columns.front().cells.front()), 1000 * unit, 1e-5);
}

TEST_P(EachHesai, ChoosesAReturn) {
  const HesaiEncoder::World world = [](std::size_t, std::size_t laser, std::size_t second) {
    if (laser % 3 == 0) return second != 0 ? Measured{4000, 9} : Measured{6000, 7};
    if (laser % 3 == 1) return Measured{5000, 8};
    return second != 0 ? Measured{0, 0} : Measured{3000, 6};
  };
  for (const ReturnChoice choice : {ReturnChoice::kStrongest, ReturnChoice::kLast, ReturnChoice::kBoth}) {
    HesaiDecoder decoder = this->decoder(choice);
    HesaiEncoder encoder(GetParam(), 0x39);
    std::vector<SavedColumn> columns;
    decode(decoder, encoder.next(world), columns);
    const std::size_t each = choice == ReturnChoice::kBoth ? 2 : 1;
    const std::vector<Cell>& cells = columns.front().cells;
    ASSERT_EQ(cells.size(), each * encoder.lasers());
    for (std::size_t row = 0; row < encoder.lasers(); ++row) {
      const std::size_t laser = decoder.model().lasers[row].number;
      const double first = laser % 3 == 0 ? choice == ReturnChoice::kStrongest ? 16. : 24. : laser % 3 == 1 ? 20. : 12.;
      EXPECT_NEAR(rangeOf(cells[each * row]), first, 1e-5);
      if (each == 1) continue;
      ASSERT_EQ(isReturn(cells[2 * row + 1]), laser % 3 == 0);
      if (laser % 3 == 0) {
        EXPECT_NEAR(rangeOf(cells[2 * row + 1]), 16, 1e-5);
      }
    }
  }
}

TEST_P(EachHesai, CountsLostAndLatePacketsWithAndWithoutNumbers) {
  for (const bool has_number : {true, false}) {
    HesaiEncoder encoder(GetParam());
    encoder.has_number = has_number;
    encoder.number = 0xFFFFFFFD;
    const auto world = [](std::size_t, std::size_t, std::size_t) { return Measured{1000, 1}; };
    std::vector<Bytes> packets;
    for (int i = 0; i < 10; ++i) packets.push_back(encoder.next(world));
    if (GetParam() == std::string("pandarqt64") && !has_number) {
      // Its packets have numbers always, and are accepted without.
      EXPECT_EQ(packets.front().size(), 1068U);
    }
    HesaiDecoder decoder = this->decoder();
    std::vector<SavedColumn> columns;
    for (const std::size_t i : {0U, 1U, 4U, 2U, 5U, 5U, 9U}) decode(decoder, packets[i], columns);
    EXPECT_EQ(columns.size(), 5 * encoder.firingsPerPacket()) << has_number;
    EXPECT_EQ(decoder.counts().late, 2U) << has_number;
    EXPECT_EQ(decoder.counts().missing, 5U) << has_number;
    for (const SavedColumn& column : columns) EXPECT_FALSE(column.after_break);
    // More than a turn is missing; another recording begins.
    encoder.time_us += 0.7e6;
    encoder.number += 100;
    columns.clear();
    decode(decoder, encoder.next(world), columns);
    EXPECT_TRUE(columns.front().after_break);
    EXPECT_EQ(decoder.counts().clock_jumps, 0U);
    encoder.time_us += 100e6;
    columns.clear();
    decode(decoder, encoder.next(world), columns);
    EXPECT_TRUE(columns.front().after_break);
    EXPECT_EQ(decoder.counts().clock_jumps, 1U);
  }
}

TEST_P(EachHesai, CountsForeignPackets) {
  HesaiDecoder decoder = this->decoder();
  HesaiEncoder encoder(GetParam());
  const Bytes good = encoder.next([](std::size_t, std::size_t, std::size_t) { return Measured{1000, 1}; });
  std::vector<SavedColumn> columns;
  EXPECT_EQ(decode(decoder, Bytes(512), columns), Kind::kPosition);
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, good.size() / 2, good.size() + 1}) {
    Bytes resized = good;
    resized.resize(size);
    resized.shrink_to_fit();
    EXPECT_EQ(decode(decoder, resized, columns), Kind::kForeign) << size;
  }
  Bytes wrong = good;
  wrong[0] ^= 1;
  EXPECT_EQ(decode(decoder, wrong, columns), Kind::kForeign);
  for (const std::string other :
       {"pandar40p", "pandar64", "pandarqt64", "pandarxt16", "pandarxt32", "pandarxt32m", "pandarqt128"}) {
    const Bytes packet = HesaiEncoder(other).next([](std::size_t, std::size_t, std::size_t) {
      return Measured{1000, 1};
    });
    EXPECT_EQ(lisco_apps::sensorsThatSend(asPacket(packet)), std::vector<std::string>{other});
    if (other != GetParam()) {
      EXPECT_EQ(decode(decoder, packet, columns), Kind::kForeign) << other;
    }
  }
  EXPECT_TRUE(columns.empty());
  EXPECT_EQ(decode(decoder, good, columns), Kind::kData);
}

TEST_P(EachHesai, AcceptsAnyBytes) {
  Random random(13);
  HesaiDecoder decoder = this->decoder();
  std::uint64_t came = 0;
  constexpr std::array<std::uint8_t, 5> kModes{0x37, 0x39, 0x3D, 0, 0xFF};
  for (int run = 0; run < 3000; ++run) {
    HesaiEncoder encoder(GetParam(), 0x37);
    encoder.mode = random.oneOf(kModes);
    if (encoder.returns() == 3) encoder.mode = 0x37;
    encoder.number = static_cast<std::uint32_t>(run);
    Bytes payload = encoder.next([&](std::size_t, std::size_t, std::size_t) {
      return Measured{static_cast<std::uint16_t>(random.below(65536)), static_cast<std::uint8_t>(random.below(256))};
    });
    for (std::size_t i = random.below(5); i > 0; --i)
      payload[random.chance(0.5) ? payload.size() - 1 - random.below(40) : random.below(payload.size())] =
          static_cast<std::uint8_t>(random.below(256));
    if (random.chance(0.1)) payload.resize(random.below(payload.size()));
    payload.shrink_to_fit();
    decoder.decode(asPacket(payload), [&](const lisco_apps::Column& column) {
      ++came;
      EXPECT_GE(column.azimuth, 0);
      EXPECT_LT(column.azimuth, 360);
      EXPECT_GE(column.time_us, 0);
      for (const Cell& cell : column.cells) EXPECT_TRUE(isReturn(cell) || isNoReturn(cell));
    });
  }
  EXPECT_EQ(decoder.counts().columns, came);
  EXPECT_GT(came, 100U);
}

/// Packets of any form hold the same returns.
void expectSameReturns(const std::string& name, const std::function<void(HesaiEncoder&)>& change) {
  const HesaiEncoder::World world = [](std::size_t firing, std::size_t laser, std::size_t second) {
    return Measured{static_cast<std::uint16_t>(500 + 7 * firing + 11 * laser + 4001 * second),
                    static_cast<std::uint8_t>(laser)};
  };
  for (const std::uint8_t mode : {std::uint8_t{0x37}, std::uint8_t{0x39}}) {
    std::vector<SavedColumn> usual, others;
    HesaiDecoder of_usual(makeHesaiModel(name)), of_others(makeHesaiModel(name));
    HesaiEncoder encoder(name, mode), other(name, mode);
    change(other);
    while (usual.size() < 42) decode(of_usual, encoder.next(world), usual);
    while (others.size() < 42) ASSERT_EQ(decode(of_others, other.next(world), others), Kind::kData);
    for (std::size_t i = 0; i < 42; ++i) {
      EXPECT_EQ(others[i].azimuth, usual[i].azimuth);
      EXPECT_FALSE(others[i].after_break);
      ASSERT_EQ(others[i].cells.size(), usual[i].cells.size());
      for (std::size_t row = 0; row < usual[i].cells.size(); ++row) {
        EXPECT_EQ(others[i].cells[row].x, usual[i].cells[row].x);
        EXPECT_EQ(others[i].cells[row].intensity, usual[i].cells[row].intensity);
      }
    }
    EXPECT_EQ(of_others.counts().missing + of_others.counts().foreign + of_others.counts().late, 0U);
    EXPECT_EQ(lisco_apps::sensorsThatSend(asPacket(other.next(world))), std::vector<std::string>{name});
  }
}

TEST(HesaiPackets, OfAPandar64MayHaveSevenBlocks) {
  const HesaiEncoder::World world = [](std::size_t firing, std::size_t, std::size_t) {
    return Measured{static_cast<std::uint16_t>(1000 + firing), 1};
  };
  for (const bool has_number : {false, true}) {
    HesaiDecoder decoder(makeHesaiModel("pandar64"));
    HesaiEncoder encoder("pandar64");
    encoder.blocks = 7;
    encoder.has_number = has_number;
    std::vector<SavedColumn> columns;
    const Bytes packet = encoder.next(world);
    EXPECT_EQ(packet.size(), has_number ? 1392U : 1388U);
    ASSERT_EQ(decode(decoder, packet, columns), Kind::kData);
    ASSERT_EQ(columns.size(), 7U);
    for (std::size_t i = 0; i < columns.size(); ++i)
      EXPECT_NEAR(rangeOf(columns[i].cells.front()), 0.004 * (1000. + static_cast<double>(i)), 1e-5);
    EXPECT_NEAR(decoder.packetPeriodUs(), 7 * 55.56, 1e-6);
  }
}

TEST(HesaiPackets, OfAQt128MayLackWhatItsFlagsTurnOff) {
  expectSameReturns("pandarqt128", [](HesaiEncoder& encoder) { encoder.has_confidence = false; });
  expectSameReturns("pandarqt128", [](HesaiEncoder& encoder) { encoder.has_safety = false; });
  expectSameReturns("pandarqt128", [](HesaiEncoder& encoder) { encoder.has_number = false; });
  expectSameReturns("pandarqt128", [](HesaiEncoder& encoder) {
    encoder.has_number = encoder.has_check_sums = encoder.has_safety = encoder.has_confidence = false;
  });
}

TEST(HesaiPackets, HaveTheLengthsOfTheManuals) {
  const struct {
    const char* name;
    std::size_t bytes;
  } cases[] = {{"pandar40p", 1266},  {"pandar64", 1198},   {"pandarqt64", 1072}, {"pandarxt16", 568},
               {"pandarxt32", 1080}, {"pandarxt32m", 820}, {"pandarqt128", 1127}};
  for (const auto& c : cases)
    EXPECT_EQ(HesaiEncoder(c.name).next([](auto...) { return Measured{1000, 1}; }).size(), c.bytes) << c.name;
}

using HesaiModels = InTemporaryFolder;

TEST_F(HesaiModels, HaveNominalAngles) {
  const struct {
    const char* name;
    double top, bottom;
  } cases[] = {{"pandar40p", 15, -25},          {"pandar64", 14.882, -24.897}, {"pandarqt64", 52.133, -52.121},
               {"pandarxt16", 15, -15},         {"pandarxt32", 15, -16},       {"pandarxt32m", 19.5, -20.8},
               {"pandarqt128", 52.627, -52.627}};
  for (const auto& c : cases) {
    const lisco_apps::HesaiModel model = makeHesaiModel(c.name);
    EXPECT_NEAR(model.lasers.front().elevation, c.top, 1e-9) << c.name;
    EXPECT_NEAR(model.lasers.back().elevation, c.bottom, 1e-9) << c.name;
    for (std::size_t i = 1; i < model.lasers.size(); ++i)
      EXPECT_LT(model.lasers[i].elevation, model.lasers[i - 1].elevation) << c.name << ' ' << i;
  }
  // Lasers of a QT128 by their numbers, from 0: the last 32 are the mirror image of the first 32.
  const lisco_apps::HesaiModel layout = lisco_apps::hesaiLayout("pandarqt128");
  const struct {
    std::size_t number;
    double elevation, offset;
  } lasers[] = {
      {0, -52.627, 10.108}, {32, -18.331, -6.217}, {95, 35.549, 7.327}, {96, 19.191, -6.25}, {127, 52.627, -10.108}};
  for (const auto& laser : lasers) {
    EXPECT_EQ(layout.lasers[laser.number].number, laser.number);
    EXPECT_NEAR(layout.lasers[laser.number].elevation, laser.elevation, 1e-9);
    EXPECT_NEAR(layout.lasers[laser.number].azimuth_offset, laser.offset, 1e-9);
  }
}

TEST_F(HesaiModels, RefuseBadCalibrations) {
  const std::filesystem::path file = folder_ / "a.csv";
  const auto refusal = [&](const std::string& csv) {
    writeFile(file, Bytes(csv.begin(), csv.end()));
    const std::string said = refusalOf([&] { makeHesaiModel("pandarxt16", file); });
    EXPECT_EQ(said.find(file.string() + ": "), 0U) << said;
    return said.substr(std::min(said.size(), file.string().size() + 2));
  };
  EXPECT_EQ(refusal(""), "does not describe laser 1");
  EXPECT_EQ(refusal("Channel,Elevation,Azimuth\n1,15,0\n3,11,0\n"), "does not describe laser 2");
  EXPECT_EQ(refusal("17,15,0\n"), "there is no laser 17 of 16");
  EXPECT_EQ(refusal("0,15,0\n"), "there is no laser 0 of 16");
  EXPECT_EQ(refusal("1,nan,0\n"), "the angles of laser 1 are not two numbers of degrees");
  EXPECT_EQ(refusal("1,15,x\n"), "the angles of laser 1 are not two numbers of degrees");
  EXPECT_EQ(refusal("1,91,0\n"), "the angles of laser 1 are not two numbers of degrees");
  EXPECT_EQ(refusalOf([&] { makeHesaiModel("pandarxt16", folder_ / "missing"); }),
            (folder_ / "missing").string() + ": is no calibration file: cannot open file");
}

}  // namespace
}  // namespace lisco_test
