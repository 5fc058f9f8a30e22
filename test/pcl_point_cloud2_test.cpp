// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Messages laid out as by drivers, organized and clustered, against pcl::EuclideanClusterExtraction on the same points.
#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <set>

#include <pcl/io/lisco_point_cloud2.h>

#include "pcl_client.h"
#include "pcl_clouds.h"

namespace lisco_test {
namespace {

using pcl::PCLPointCloud2;
using pcl::PCLPointField;
using pcl::PointXYZ;
using pcl::PointXYZI;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// What one laser measured in one firing.
struct Shot {
  float x, y, z;
  std::size_t ring, firing;
  double time;  ///< seconds from the first
};

constexpr double kPeriod = 55.296e-6;
constexpr double kDelay = 2.304e-6;

/// A scan's cells in the order in which a Velodyne fires them.
std::vector<Shot> shotsOf(const Scan& scan, double delay = kDelay) {
  std::vector<Shot> shots;
  for (std::size_t column = 0; column < scan.columns; ++column)
    for (std::size_t laser = 0; laser < scan.lasers; ++laser) {
      const lisco::Return& cell = scan.at(laser, column);
      shots.push_back({cell.x, cell.y, cell.z, laser, column,
                       kPeriod * static_cast<double>(column) + delay * static_cast<double>(laser)});
    }
  return shots;
}

/// Only the returns, as most drivers send them.
std::vector<Shot> onlyReturns(std::vector<Shot> shots) {
  shots.erase(std::remove_if(shots.begin(), shots.end(),
                             [](const Shot& shot) { return !lisco::isReturn(shot.x, shot.y, shot.z); }),
              shots.end());
  return shots;
}

std::size_t sizeOf(std::uint8_t datatype) {
  constexpr std::array<std::size_t, 9> kSizes{0, 1, 1, 2, 2, 4, 4, 4, 8};
  return kSizes.at(datatype);
}

struct Field {
  std::string name;
  std::uint8_t datatype;
  std::size_t offset;
};

template <typename Number>
void put(std::uint8_t* to, double value) {
  const auto number = static_cast<Number>(value);
  std::memcpy(to, &number, sizeof(number));
}

/// A message with these fields. Times are in seconds for floats and in nanoseconds for integers, after `start`.
PCLPointCloud2 messageOf(const std::vector<Shot>& shots, const std::vector<Field>& fields, std::size_t point_step,
                         double start = 0) {
  PCLPointCloud2 message;
  message.header.frame_id = "lidar";
  message.header.stamp = 1234567;
  message.header.seq = 89;
  message.height = 1;
  message.width = static_cast<std::uint32_t>(shots.size());
  message.point_step = static_cast<std::uint32_t>(point_step);
  message.row_step = message.width * message.point_step;
  message.is_dense = 0;
  message.data.assign(message.row_step, 0xA5);  // the bytes between the fields
  for (const Field& field : fields) {
    PCLPointField described;
    described.name = field.name;
    described.offset = static_cast<std::uint32_t>(field.offset);
    described.datatype = field.datatype;
    described.count = 1;
    message.fields.push_back(described);
    for (std::size_t i = 0; i < shots.size(); ++i) {
      const Shot& shot = shots[i];
      const bool is_float = field.datatype == PCLPointField::FLOAT32 || field.datatype == PCLPointField::FLOAT64;
      double value = static_cast<double>(i % 200);  // intensity and the like
      if (field.name == "x") value = static_cast<double>(shot.x);
      if (field.name == "y") value = static_cast<double>(shot.y);
      if (field.name == "z") value = static_cast<double>(shot.z);
      if (field.name == "ring" || field.name == "channel") value = static_cast<double>(shot.ring);
      if (field.name == "t" || field.name.find("time") == 0) value = (start + shot.time) * (is_float ? 1.0 : 1e9);
      std::uint8_t* const to = message.data.data() + i * point_step + field.offset;
      switch (field.datatype) {
        case PCLPointField::UINT8:
          put<std::uint8_t>(to, value);
          break;
        case PCLPointField::UINT16:
          put<std::uint16_t>(to, value);
          break;
        case PCLPointField::INT16:
          put<std::int16_t>(to, value);
          break;
        case PCLPointField::INT32:
          put<std::int32_t>(to, value);
          break;
        case PCLPointField::UINT32:
          put<std::uint32_t>(to, value);
          break;
        case PCLPointField::FLOAT32:
          put<float>(to, value);
          break;
        case PCLPointField::FLOAT64:
          put<double>(to, value);
          break;
        default:
          ADD_FAILURE() << "type " << static_cast<int>(field.datatype);
      }
    }
  }
  return message;
}

constexpr std::uint8_t kF32 = PCLPointField::FLOAT32;
constexpr std::uint8_t kF64 = PCLPointField::FLOAT64;
constexpr std::uint8_t kU8 = PCLPointField::UINT8;
constexpr std::uint8_t kU16 = PCLPointField::UINT16;
constexpr std::uint8_t kU32 = PCLPointField::UINT32;

/// As velodyne_pointcloud: packed, or padded for SSE as older versions do.
const std::vector<Field> kVelodyne{{"x", kF32, 0},          {"y", kF32, 4},     {"z", kF32, 8},
                                   {"intensity", kF32, 12}, {"ring", kU16, 16}, {"time", kF32, 18}};
const std::vector<Field> kVelodynePadded{{"x", kF32, 0},          {"y", kF32, 4},     {"z", kF32, 8},
                                         {"intensity", kF32, 16}, {"ring", kU16, 20}, {"time", kF32, 24}};
const std::vector<Field> kVelodyneWithoutTime{
    {"x", kF32, 0}, {"y", kF32, 4}, {"z", kF32, 8}, {"intensity", kF32, 12}, {"ring", kU16, 16}};
/// As ouster-ros, older and newer.
const std::vector<Field> kOuster{{"x", kF32, 0},          {"y", kF32, 4},        {"z", kF32, 8},
                                 {"intensity", kF32, 16}, {"t", kU32, 20},       {"reflectivity", kU16, 24},
                                 {"ring", kU8, 26},       {"ambient", kU16, 28}, {"range", kU32, 32}};
const std::vector<Field> kOusterNew{{"x", kF32, 0},          {"y", kF32, 4},        {"z", kF32, 8},
                                    {"intensity", kF32, 16}, {"t", kU32, 20},       {"reflectivity", kU16, 24},
                                    {"ring", kU16, 26},      {"ambient", kU16, 28}, {"range", kU32, 32}};
/// As Hesai's driver, padded and packed.
const std::vector<Field> kHesai{{"x", kF32, 0},          {"y", kF32, 4},          {"z", kF32, 8},
                                {"intensity", kF32, 16}, {"timestamp", kF64, 24}, {"ring", kU16, 32}};
const std::vector<Field> kHesaiPacked{{"x", kF32, 0},          {"y", kF32, 4},     {"z", kF32, 8},
                                      {"intensity", kF32, 12}, {"ring", kU16, 16}, {"timestamp", kF64, 18}};
/// As Autoware's drivers.
const std::vector<Field> kAutoware{{"x", kF32, 0},          {"y", kF32, 4},           {"z", kF32, 8},
                                   {"intensity", kU8, 12},  {"return_type", kU8, 13}, {"channel", kU16, 14},
                                   {"azimuth", kF32, 16},   {"elevation", kF32, 20},  {"distance", kF32, 24},
                                   {"time_stamp", kU32, 28}};

/// Each return is in one cell, and each cell holds its point of the message.
void expectWhole(const PCLPointCloud2& message, const pcl::PointCloud<PointXYZ>& points,
                 const pcl::PointCloud<PointXYZI>& cloud, const pcl::Indices& point_of_cell) {
  ASSERT_EQ(cloud.size(), point_of_cell.size());
  ASSERT_EQ(static_cast<std::size_t>(cloud.width) * cloud.height, cloud.size());
  EXPECT_EQ(cloud.header.stamp, message.header.stamp);
  EXPECT_EQ(cloud.header.frame_id, message.header.frame_id);
  EXPECT_EQ(cloud.header.seq, message.header.seq);
  std::vector<int> cells_of_point(points.size(), 0);
  for (std::size_t cell = 0; cell < cloud.size(); ++cell) {
    const PointXYZI& copy = cloud[cell];
    if (point_of_cell[cell] == pcl::UNAVAILABLE) {
      EXPECT_TRUE(std::isnan(copy.x) && std::isnan(copy.y) && std::isnan(copy.z));
      continue;
    }
    const auto index = static_cast<std::size_t>(point_of_cell[cell]);
    ASSERT_LT(index, points.size());
    ++cells_of_point[index];
    ASSERT_EQ(std::memcmp(&copy.x, &points[index].x, 3 * sizeof(float)), 0);
  }
  for (std::size_t i = 0; i < points.size(); ++i)
    if (lisco::isReturn(points[i].x, points[i].y, points[i].z))
      ASSERT_EQ(cells_of_point[i], 1) << i;
    else
      ASSERT_LE(cells_of_point[i], 1) << i;
}

/// Organizes the message and compares its clusters with PCL's of the message's points. \return the organization
pcl::PointCloud<PointXYZI> expectSameAsPcl(const PCLPointCloud2& message, double tolerance = 0.5) {
  const auto points = std::make_shared<pcl::PointCloud<PointXYZ>>();  // read here, independent of the code tested
  points->header = message.header;
  const auto offset_of = [&](const char* name) {
    return std::find_if(message.fields.begin(), message.fields.end(), [&](const auto& f) { return f.name == name; })
        ->offset;
  };
  for (std::size_t row = 0; row < message.height; ++row)
    for (std::size_t column = 0; column < message.width; ++column) {
      const std::uint8_t* const from = message.data.data() + row * message.row_step + column * message.point_step;
      PointXYZ point;
      std::memcpy(&point.x, from + offset_of("x"), sizeof(float));
      std::memcpy(&point.y, from + offset_of("y"), sizeof(float));
      std::memcpy(&point.z, from + offset_of("z"), sizeof(float));
      points->push_back(point);
    }

  const auto cloud = std::make_shared<pcl::PointCloud<PointXYZI>>();
  pcl::Indices point_of_cell;
  EXPECT_TRUE(pcl::organizeLiscoCloud(message, *cloud, point_of_cell));
  expectWhole(message, *points, *cloud, point_of_cell);
  Clusters expected;
  Clusters actual;
  PclClient<PointXYZ>().extract(points, returnsOf(*points), {tolerance, 2}, expected);
  LiscoClient<PointXYZI>().extract(cloud, nullptr, {tolerance, 2}, actual);
  EXPECT_TRUE(pcl::mapLiscoClusters(point_of_cell, actual));
  EXPECT_FALSE(expected.empty());
  expectSame(expected, actual);
  return *cloud;
}

Scan scanOfBoxes() {
  Random random(1);
  return boxesAround(random, 360, 16);
}

std::string errorOf(const PCLPointCloud2& message) {
  pcl::PointCloud<PointXYZI> cloud(3, 2);
  pcl::Indices point_of_cell{1, 2, 3};
  testing::internal::CaptureStderr();
  const bool is_read = pcl::organizeLiscoCloud(message, cloud, point_of_cell);
  std::string error = testing::internal::GetCapturedStderr();
  EXPECT_EQ(is_read, error.empty());
  if (!is_read) {
    EXPECT_TRUE(cloud.empty());
    EXPECT_TRUE(point_of_cell.empty());
    EXPECT_NE(error.find("[pcl::organizeLiscoCloud] "), std::string::npos);
  }
  return error;
}

TEST(PointCloud2, ClustersVelodynesMessages) {
  const Scan scan = scanOfBoxes();
  for (const auto& [fields, step] : {std::pair(kVelodyne, 22), std::pair(kVelodynePadded, 32)})
    for (const double start : {0.0, -0.1}) {
      const auto cloud =
          expectSameAsPcl(messageOf(onlyReturns(shotsOf(scan)), fields, static_cast<std::size_t>(step), start));
      EXPECT_EQ(cloud.height, 16U);
      EXPECT_GE(cloud.width, 200U);
      EXPECT_LE(cloud.width, 360U);
    }
}

// Without drop-outs the arrangement is the scan itself.
TEST(PointCloud2, GivesTheColumnsThatWereFired) {
  Random random(2);
  Scan scan(500, 16);
  for (std::size_t column = 0; column < 500; ++column)
    for (std::size_t laser = 0; laser < 16; ++laser)
      scan.set(laser, column, {5 + 0.01F * static_cast<float>(column), static_cast<float>(laser), 1});
  for (const auto& [fields, step, delay] :
       {std::tuple(kVelodyne, 22, kDelay), {kHesai, 40, kDelay}, {kOuster, 36, 0.0}, {kAutoware, 32, kDelay}})
    for (const bool by_ring : {false, true}) {
      std::vector<Shot> shots = shotsOf(scan, delay);
      if (by_ring)
        std::stable_sort(shots.begin(), shots.end(), [](const Shot& a, const Shot& b) { return a.ring < b.ring; });
      // Seconds of 2026 would leave no digits for a float.
      const double start = fields[4].datatype == kF64 ? 1.8e9 : 0;
      const auto cloud = expectSameAsPcl(messageOf(shots, fields, static_cast<std::size_t>(step), start));
      ASSERT_EQ(cloud.width, 500U);
      ASSERT_EQ(cloud.height, 16U);
      for (std::size_t column = 0; column < 500; ++column)
        for (std::size_t laser = 0; laser < 16; ++laser)
          ASSERT_EQ(cloud.at(static_cast<int>(column), static_cast<int>(laser)).x, scan.at(laser, column).x);
    }
}

TEST(PointCloud2, ClustersVelodynesMessagesWithoutTime) {
  const auto cloud = expectSameAsPcl(messageOf(onlyReturns(shotsOf(scanOfBoxes())), kVelodyneWithoutTime, 18));
  EXPECT_EQ(cloud.height, 16U);
  EXPECT_LE(cloud.width, 500U);
}

/// An organized message, as it is or transposed, whose rows end in spare bytes.
PCLPointCloud2 inRows(PCLPointCloud2 message, std::size_t height, std::size_t spare = 0) {
  const std::vector<std::uint8_t> data = message.data;
  message.height = static_cast<std::uint32_t>(height);
  message.width = static_cast<std::uint32_t>(message.width / height);
  const std::size_t row = static_cast<std::size_t>(message.width) * message.point_step;
  message.row_step = static_cast<std::uint32_t>(row + spare);
  message.data.assign(height * row + (height - 1) * spare, 0xFF);  // none after the last row
  for (std::size_t i = 0; i < height; ++i)
    std::memcpy(message.data.data() + i * message.row_step, data.data() + i * row, row);
  return message;
}

TEST(PointCloud2, KeepsTheOrganizationOfOuster) {
  const Scan scan = scanOfBoxes();
  std::vector<Shot> shots = shotsOf(scan, 0);
  std::stable_sort(shots.begin(), shots.end(), [](const Shot& a, const Shot& b) { return a.ring < b.ring; });
  for (Shot& shot : shots)
    if (!lisco::isReturn(shot.x, shot.y, shot.z)) shot.x = shot.y = shot.z = 0;  // as Ouster's
  for (const auto& [fields, step] : {std::pair(kOuster, 48), std::pair(kOusterNew, 48)})
    for (const std::size_t spare : {0U, 7U}) {
      const auto cloud = expectSameAsPcl(inRows(messageOf(shots, fields, static_cast<std::size_t>(step)), 16, spare));
      EXPECT_EQ(cloud.width, 360U);
      EXPECT_EQ(cloud.height, 16U);
    }
}

TEST(PointCloud2, TransposesRowsOfFirings) {
  const Scan scan = scanOfBoxes();
  for (const std::size_t spare : {0U, 3U}) {
    const auto cloud = expectSameAsPcl(inRows(messageOf(shotsOf(scan), kVelodyne, 22), 360, spare));
    EXPECT_EQ(cloud.width, 360U);
    EXPECT_EQ(cloud.height, 16U);
  }
}

TEST(PointCloud2, ClustersOustersMessagesInOneRow) {
  const auto cloud = expectSameAsPcl(messageOf(onlyReturns(shotsOf(scanOfBoxes(), 0)), kOuster, 48));
  EXPECT_EQ(cloud.height, 16U);
  EXPECT_LE(cloud.width, 360U);
}

TEST(PointCloud2, ClustersHesaisMessages) {
  const std::vector<Shot> shots = onlyReturns(shotsOf(scanOfBoxes()));
  for (const auto& [fields, step] : {std::pair(kHesai, 48), std::pair(kHesaiPacked, 26)}) {
    const auto cloud = expectSameAsPcl(messageOf(shots, fields, static_cast<std::size_t>(step), 1790000000.123));
    EXPECT_EQ(cloud.height, 16U);
    EXPECT_LE(cloud.width, 360U);
  }
}

TEST(PointCloud2, ClustersAutowaresMessages) {
  const auto cloud = expectSameAsPcl(messageOf(onlyReturns(shotsOf(scanOfBoxes())), kAutoware, 32));
  EXPECT_EQ(cloud.height, 16U);
  EXPECT_LE(cloud.width, 360U);
  float most = 0;
  for (const PointXYZI& point : cloud) most = std::max(most, point.intensity);
  EXPECT_EQ(most, 199.0F);  // from an integer
}

TEST(PointCloud2, KeepsTwoReturnsPerShot) {
  std::vector<Shot> shots;
  for (Shot shot : shotsOf(scanOfBoxes())) {
    shots.push_back(shot);
    shot.x *= 1.2F;
    shot.y *= 1.2F;
    shot.z *= 1.2F;
    shots.push_back(shot);
  }
  EXPECT_EQ(expectSameAsPcl(messageOf(onlyReturns(shots), kVelodyne, 22)).height, 16U);
  const auto by_azimuth = expectSameAsPcl(messageOf(onlyReturns(shots), kVelodyneWithoutTime, 18));
  EXPECT_EQ(by_azimuth.height, 16U);
  EXPECT_LE(by_azimuth.width, 1000U);
}

// All times of a packet equal, constant times, times that are NaN.
TEST(PointCloud2, AcceptsPoorTimes) {
  std::vector<Shot> shots = onlyReturns(shotsOf(scanOfBoxes()));
  for (Shot& shot : shots) shot.time = kPeriod * static_cast<double>(shot.firing / 12 * 12);
  EXPECT_EQ(expectSameAsPcl(messageOf(shots, kVelodyne, 22)).height, 16U);
  for (Shot& shot : shots) shot.time = 0;
  EXPECT_EQ(expectSameAsPcl(messageOf(shots, kVelodyne, 22)).height, 16U);
  shots[100].time = static_cast<double>(kNan);
  EXPECT_EQ(expectSameAsPcl(messageOf(shots, kVelodyne, 22)).height, 16U);
  Random random(3);
  for (Shot& shot : shots) shot.time = random.between(0, 0.1);
  expectSameAsPcl(messageOf(shots, kVelodyne, 22));
}

TEST(PointCloud2, KeepsTheOrganizationWithoutRing) {
  std::vector<Field> fields = kVelodyne;
  fields.erase(fields.begin() + 4);
  const auto cloud = expectSameAsPcl(messageOf(shotsOf(scanOfBoxes()), fields, 22));
  EXPECT_EQ(cloud.height, 1U);
  EXPECT_EQ(cloud.width, 5760U);
}

// A row and a column for every point would take the memory of their product.
TEST(PointCloud2, KeepsTheOrganizationWithARingForEachPoint) {
  std::vector<Shot> shots = shotsOf(scanOfBoxes());
  for (std::size_t i = 0; i < shots.size(); ++i) shots[i].ring = i / 2;
  EXPECT_EQ(expectSameAsPcl(messageOf(shots, kVelodyne, 22)).height, 1U);
  std::vector<Field> fields = kVelodynePadded;
  fields[4].datatype = kF32;  // 20..23
  shots[7].ring = 1U << 20;
  EXPECT_EQ(expectSameAsPcl(messageOf(shots, fields, 32)).height, 1U);
}

TEST(PointCloud2, AcceptsFieldsInAnyOrderAndOfAnyType) {
  const std::vector<Shot> all = shotsOf(scanOfBoxes());
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    std::vector<Field> fields{{"x", kF32, 0}, {"y", kF32, 0}, {"z", kF32, 0}};
    fields.push_back({random.chance(0.5) ? "ring" : "channel",
                      random.oneOf(std::array{kU8, kU16, kU32, std::uint8_t{PCLPointField::INT16}, kF32}), 0});
    if (random.chance(0.8))
      fields.push_back({random.oneOf(std::array{"time", "t", "timestamp", "time_stamp"}),
                        random.oneOf(std::array{kF32, kF64, kU32, std::uint8_t{PCLPointField::INT32}}), 0});
    if (random.chance(0.7)) fields.push_back({"intensity", random.oneOf(std::array{kU8, kU16, kF32, kF64}), 0});
    if (random.chance(0.5)) fields.push_back({"range", kU32, 0});
    random.shuffle(fields);
    std::size_t step = random.below(5);
    for (Field& field : fields) {
      field.offset = step;
      step += sizeOf(field.datatype) + random.below(6);
    }
    std::vector<Shot> shots = random.chance(0.5) ? all : onlyReturns(all);
    if (random.chance(0.3)) random.shuffle(shots);
    const auto cloud = expectSameAsPcl(messageOf(shots, fields, step), random.magnitude(0.1, 2.0));
    EXPECT_EQ(cloud.height, 16U);
    if (HasFailure()) return;
  }
}

TEST(PointCloud2, ConvertsNumbers) {
  const std::vector<Shot> shots{{1, 2, 3, 0, 0, 0}, {1e30F, -1, 0, 1, 0, 0}};
  PCLPointCloud2 message =
      messageOf(shots, {{"z", kF64, 0}, {"y", kF64, 8}, {"x", kF64, 16}, {"intensity", kU8, 24}}, 25);
  const double huge = -1e300;
  std::memcpy(message.data.data(), &huge, sizeof(huge));
  pcl::PointCloud<PointXYZI> cloud;
  pcl::Indices point_of_cell;
  ASSERT_TRUE(pcl::organizeLiscoCloud(message, cloud, point_of_cell));
  ASSERT_EQ(cloud.size(), 2U);
  EXPECT_EQ(cloud[0].x, 1.0F);
  EXPECT_EQ(cloud[0].z, -std::numeric_limits<float>::infinity());
  EXPECT_EQ(cloud[1].x, 1e30F);
  EXPECT_EQ(cloud[1].intensity, 1.0F);

  // Into an integer: PointXYZL's label, by limits.
  message = messageOf(shots, {{"x", kF32, 0}, {"y", kF32, 4}, {"z", kF32, 8}, {"label", kF32, 12}}, 16);
  for (const auto& [number, label] : {std::pair(-1.0F, 0U), {kNan, 0U}, {7.9F, 7U}, {1e20F, 0xFFFFFFFFU}}) {
    std::memcpy(message.data.data() + 12, &number, sizeof(number));
    pcl::PointCloud<pcl::PointXYZL> labelled;
    ASSERT_TRUE(pcl::organizeLiscoCloud(message, labelled, point_of_cell));
    EXPECT_EQ(labelled[0].label, label);
  }
}

TEST(PointCloud2, LeavesFieldsOfSeveralElementsOut) {
  PCLPointCloud2 message =
      messageOf({{1, 2, 3, 0, 0, 0}}, {{"x", kF32, 0}, {"y", kF32, 4}, {"z", kF32, 8}, {"intensity", kF32, 12}}, 20);
  const float intensities[2] = {5, 6};
  std::memcpy(message.data.data() + 12, intensities, sizeof(intensities));
  pcl::Indices point_of_cell;
  for (const auto& [elements, intensity] : {std::pair(1U, 5.0F), {2U, PointXYZI().intensity}}) {
    message.fields[3].count = elements;
    pcl::PointCloud<PointXYZI> cloud;
    ASSERT_TRUE(pcl::organizeLiscoCloud(message, cloud, point_of_cell));
    EXPECT_EQ(cloud[0].z, 3.0F);
    EXPECT_EQ(cloud[0].intensity, intensity);
  }
}

// Color is copied bit by bit under either name and type, as PCL does it.
TEST(PointCloud2, CopiesColor) {
  for (const char* const name : {"rgb", "rgba"})
    for (const std::uint8_t datatype : {kF32, kU32}) {
      PCLPointCloud2 message =
          messageOf({{1, 2, 3, 0, 0, 0}}, {{"x", kF32, 0}, {"y", kF32, 4}, {"z", kF32, 8}, {name, datatype, 12}}, 16);
      const std::uint32_t color = 0x12345678;
      std::memcpy(message.data.data() + 12, &color, sizeof(color));
      pcl::PointCloud<pcl::PointXYZRGB> rgb;
      pcl::PointCloud<pcl::PointXYZRGBA> rgba;
      pcl::Indices point_of_cell;
      ASSERT_TRUE(pcl::organizeLiscoCloud(message, rgb, point_of_cell));
      ASSERT_TRUE(pcl::organizeLiscoCloud(message, rgba, point_of_cell));
      EXPECT_EQ(rgb[0].rgba, color);
      EXPECT_EQ(rgba[0].rgba, color);
    }
}

TEST(PointCloud2, GivesAnEmptyCloudWithoutPoints) {
  PCLPointCloud2 message = messageOf({}, kVelodyne, 22);
  EXPECT_EQ(errorOf(message), "");
  pcl::PointCloud<PointXYZI> cloud(3, 2);
  pcl::Indices point_of_cell{1};
  EXPECT_TRUE(pcl::organizeLiscoCloud(PCLPointCloud2(), cloud, point_of_cell));
  EXPECT_TRUE(cloud.empty());
  EXPECT_TRUE(point_of_cell.empty());
}

TEST(PointCloud2, AcceptsOnlyNoReturns) {
  std::vector<Shot> shots = shotsOf(Scan(10, 4));
  pcl::PointCloud<PointXYZI> cloud;
  pcl::Indices point_of_cell;
  EXPECT_TRUE(pcl::organizeLiscoCloud(messageOf(shots, kVelodyne, 22), cloud, point_of_cell));
  EXPECT_EQ(cloud.size(), 40U);
}

TEST(PointCloud2, RejectsMalformedMessages) {
  const PCLPointCloud2 good = messageOf(shotsOf(scanOfBoxes()), kVelodyne, 22);
  EXPECT_EQ(errorOf(good), "");
  const auto expect = [&](const char* part, auto&& spoil) {
    PCLPointCloud2 message = good;
    spoil(message);
    const std::string error = errorOf(message);
    EXPECT_NE(error.find(part), std::string::npos) << error;
  };
  for (std::size_t i = 0; i < 3; ++i)
    expect(("no field '" + good.fields[i].name + "'").c_str(), [i](auto& message) { message.fields[i].name = "_"; });
  expect("must be one FLOAT32", [](auto& message) { message.fields[1].datatype = PCLPointField::INT32; });
  expect("must be one FLOAT32", [](auto& message) { message.fields[1].count = 2; });
  expect("unknown type 99", [](auto& message) { message.fields[2].datatype = 99; });
  expect("unknown type 0", [](auto& message) { message.fields[4].datatype = 0; });
  expect("'ring' has 2 elements", [](auto& message) { message.fields[4].count = 2; });
  expect("Field 'time' (4 bytes at offset 19) reaches beyond a point_step of 22",
         [](auto& message) { message.fields[5].offset = 19; });
  expect("beyond", [](auto& message) { message.fields[0].offset = std::numeric_limits<pcl::uindex_t>::max(); });
  expect("beyond", [](auto& message) { message.fields[3].count = std::numeric_limits<pcl::uindex_t>::max(); });
  expect("not this machine's", [](auto& message) { message.is_bigendian = message.is_bigendian ? 0 : 1; });
  expect("not what 126719 bytes of data hold", [](auto& message) { message.data.pop_back(); });
  expect("not what 0 bytes", [](auto& message) { message.data.clear(); });
  expect("not what", [](auto& message) { message.point_step = 0; });
  expect("not what", [](auto& message) { message.point_step = std::numeric_limits<pcl::uindex_t>::max(); });
  expect("no points (0 x 1)", [](auto& message) { message.width = 0; });
  expect("no points (5760 x 0)", [](auto& message) { message.height = 0; });
  expect("more than pcl::index_t", [](auto& message) { message.width = std::numeric_limits<pcl::uindex_t>::max(); });
  expect("more than pcl::index_t", [](auto& message) { message.height = message.width = 1U << 16; });
  const auto two_rows = [](auto& message) {
    message.height = 2;
    message.width = 2880;
  };
  expect("not what", [&](auto& message) {
    two_rows(message);
    message.row_step = 63361;
  });
  expect("do not fit into a row_step of 63359", [&](auto& message) {
    two_rows(message);
    message.row_step = 63359;
  });
  expect("do not fit into a row_step of 0", [&](auto& message) {
    two_rows(message);
    message.row_step = 0;
  });
}

// Any bytes give an error or a cloud that fits the message; the sanitizers check that no read is beyond the data.
TEST(PointCloud2, AcceptsAnyBytes) {
  const std::vector<Shot> shots = [] {
    Random random(5);
    return shotsOf(boxesAround(random, 12, 4));
  }();
  std::size_t read = 0;
  testing::internal::CaptureStderr();
  for (std::uint64_t seed = 1; seed <= 20000; ++seed) {
    Random random(seed);
    PCLPointCloud2 message = messageOf(shots, random.chance(0.5) ? kVelodyne : kHesaiPacked, 26);
    const auto number = [&]() -> std::uint32_t {
      const auto any = static_cast<std::uint32_t>(random.below(std::size_t{1} << 32));
      return random.chance(0.7) ? any % 64 : any >> random.below(32);
    };
    for (std::size_t changes = 1 + random.below(4); changes > 0; --changes) {
      PCLPointField& field = message.fields[random.below(message.fields.size())];
      switch (random.below(10)) {
        case 0:
          field.offset = number();
          break;
        case 1:
          field.datatype = static_cast<std::uint8_t>(number());
          break;
        case 2:
          field.count = number();
          break;
        case 3:
          field.name = random.oneOf(std::array{"x", "ring", "time", "t", "rgb", "", "intensity"});
          break;
        case 4:
          message.width = number();
          break;
        case 5:
          message.height = number();
          break;
        case 6:
          message.point_step = number();
          break;
        case 7:
          message.row_step = number();
          break;
        case 8:
          message.data.resize(number() % 3000);
          break;
        case 9:
          for (std::uint8_t& byte : message.data)
            if (random.chance(0.2)) byte = static_cast<std::uint8_t>(random.below(256));
          break;
      }
    }
    pcl::PointCloud<PointXYZI> cloud;
    pcl::Indices point_of_cell;
    if (pcl::organizeLiscoCloud(message, cloud, point_of_cell)) {
      ++read;
      ASSERT_EQ(cloud.size(), point_of_cell.size()) << seed;
      ASSERT_EQ(cloud.size(), static_cast<std::size_t>(cloud.width) * cloud.height) << seed;
      std::set<pcl::index_t> points;
      for (const pcl::index_t point : point_of_cell)
        if (point != pcl::UNAVAILABLE) {
          ASSERT_LT(static_cast<std::size_t>(point), static_cast<std::size_t>(message.width) * message.height) << seed;
          ASSERT_TRUE(points.insert(point).second) << seed;
        }
    }
  }
  testing::internal::GetCapturedStderr();
  EXPECT_GT(read, 2000U);
  EXPECT_LT(read, 18000U);
}

TEST(PointCloud2, RejectsClustersOfOtherCells) {
  const pcl::Indices point_of_cell{5, pcl::UNAVAILABLE, 3, 4};
  Clusters good(2);
  good[0].indices = {0};
  good[1].indices = {2, 3};
  EXPECT_TRUE(pcl::mapLiscoClusters(point_of_cell, good));
  ASSERT_EQ(good.size(), 2U);
  EXPECT_EQ(good[0].indices, (pcl::Indices{3, 4}));
  EXPECT_EQ(good[1].indices, (pcl::Indices{5}));
  for (const pcl::index_t bad : {-1, 0, 1, 4, std::numeric_limits<pcl::index_t>::max()}) {  // 0 twice
    Clusters clusters(1);
    clusters[0].indices = {0, bad};
    testing::internal::CaptureStderr();
    EXPECT_FALSE(pcl::mapLiscoClusters(point_of_cell, clusters));
    EXPECT_NE(testing::internal::GetCapturedStderr().find("Index " + std::to_string(bad)), std::string::npos);
    EXPECT_TRUE(clusters.empty());
  }
}

}  // namespace
}  // namespace lisco_test
