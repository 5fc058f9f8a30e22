// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <random>
#include <set>

#include "../sensors/temporary_folder.h"
#include "bags.h"
#include "io/little_endian.h"
#include "io/scan_file.h"
#include "recordings/bytes.h"
#include "recordings/cdr_text.h"
#include "recordings/point_cloud2.h"

namespace lisco_test {
namespace {

using lisco_apps::readScan;
using lisco_apps::Scan;
using lisco_apps::Serialization;
using lisco_apps::Topic;

class Clouds : public FolderTest {
 protected:
  void write(const std::string& name, const std::string& content) const {
    std::ofstream(file(name), std::ios::binary) << content;
  }
  std::string refusal(const std::string& name, unsigned bin_fields = 0) const {
    try {
      readScan(file(name), {bin_fields});
    } catch (const std::runtime_error& why) {
      return why.what();
    }
    ADD_FAILURE() << name << " is not refused";
    return {};
  }
};

/// Points of a sensor of 32 lasers in a yard of 20 m, firing by firing, with intensity, ring and more fields.
std::string firings(std::size_t fields, std::size_t columns = 400) {
  std::mt19937 random(5);
  std::string content;
  for (std::size_t column = 0; column < columns; ++column)
    for (unsigned laser = 0; laser < 32; ++laser) {
      const double azimuth = 2 * M_PI * static_cast<double>(column) / static_cast<double>(columns);
      const double elevation = (-30 + laser * 41. / 31) * M_PI / 180;
      const double range = std::min(elevation < 0 ? 1.8 / std::sin(-elevation) : 1e3,
                                    10 / std::max(std::fabs(std::cos(azimuth)), std::fabs(std::sin(azimuth))));
      const std::vector<double> values{range * std::cos(elevation) * std::cos(azimuth),
                                       range * std::cos(elevation) * std::sin(azimuth),
                                       range * std::sin(elevation),
                                       static_cast<double>(random() % 256),
                                       static_cast<double>(laser),
                                       static_cast<double>(column) * 1e-4,
                                       0.5 * static_cast<double>(random() % 1000)};
      for (std::size_t field = 0; field < fields; ++field)
        lisco_apps::putNumber(content, static_cast<float>(values[field]));
    }
  return content;
}

TEST_F(Clouds, OfFloatsShowTheirFields) {
  for (const std::size_t fields : {3U, 4U, 5U, 6U, 7U}) {
    SCOPED_TRACE(fields);
    write("a.bin", firings(fields));
    const Scan scan = readScan(file("a.bin"));
    EXPECT_EQ(scan.cloud->size(), 32U * 400U);
    EXPECT_NE(scan.note.find(std::to_string(fields) + " floats a point"), std::string::npos) << scan.note;
    if (fields < 5) continue;
    ASSERT_NE(scan.arranged, nullptr);
    EXPECT_EQ(scan.arranged->height, 32U);
    EXPECT_NEAR(scan.arranged->width, 400, 4);
  }
}

TEST_F(Clouds, OfFloatsAreReadAsTold) {
  write("a.bin", firings(4, 500));  // a multiple of 5 floats as well
  EXPECT_EQ(readScan(file("a.bin"), {5}).cloud->size(), 32U * 500U * 4 / 5);
  EXPECT_NE(refusal("a.bin", 7).find("no multiple of 28"), std::string::npos);
}

TEST_F(Clouds, OfFloatsInAnyOrder) {
  const std::string content = firings(5);
  std::vector<std::size_t> order(content.size() / 20);
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), std::mt19937(3));
  std::string shuffled;
  for (const std::size_t i : order) shuffled += content.substr(20 * i, 20);
  write("a.bin", shuffled);
  EXPECT_EQ(readScan(file("a.bin")).cloud->size(), order.size());
}

TEST_F(Clouds, RefuseWhatIsNone) {
  std::mt19937 random(7);
  std::string noise;
  for (int i = 0; i < 60000; ++i) lisco_apps::putNumber(noise, static_cast<std::uint32_t>(random()));
  write("noise.bin", noise);
  EXPECT_NE(refusal("noise.bin").find("plausible"), std::string::npos);
  // A packet dump: flags, azimuths, distances of two bytes with intensities of one.
  std::string packets;
  for (int i = 0; i < 2400; ++i) {
    packets += "\xFF\xEE";
    lisco_apps::putNumber(packets, static_cast<std::uint16_t>(i * 20 % 36000));
    for (int laser = 0; laser < 32; ++laser) {
      lisco_apps::putNumber(packets, static_cast<std::uint16_t>(2000 + random() % 9000));
      packets += static_cast<char>(random() % 100);
    }
  }
  write("packets.bin", packets);
  EXPECT_NE(refusal("packets.bin").find("plausible"), std::string::npos);
  write("truncated.bin", firings(5).substr(0, 20 * 7001 + 8));
  refusal("truncated.bin");
}

TEST_F(Clouds, SortedByLaserAreArrangedInTheirRows) {
  const char* const folder = std::getenv("LISCO_TEST_DATA");
  const std::filesystem::path data = folder != nullptr ? folder : LISCO_TEST_DATA_DEFAULT;
  if (!std::filesystem::exists(data / "kitti/0000000000.bin")) GTEST_SKIP() << "no KITTI scan in " << data;
  const Scan scan = readScan(data / "kitti/0000000000.bin");
  const Scan truth = readScan(data / "scans/hdl64e_kitti_0.pcd");
  ASSERT_NE(scan.arranged, nullptr);
  ASSERT_EQ(scan.arranged->height, truth.cloud->height);
  // The same points in each row, and each point in one cell.
  std::set<pcl::index_t> seen;
  const auto rowOf = [](const lisco_apps::Cloud& cloud, std::size_t row) {
    std::vector<std::array<float, 3>> points;
    for (std::size_t column = 0; column < cloud.width; ++column) {
      const pcl::PointXYZ& p = cloud[row * cloud.width + column];
      if (std::isfinite(p.x)) points.push_back({p.x, p.y, p.z});
    }
    std::sort(points.begin(), points.end());
    return points;
  };
  for (std::size_t row = 0; row < 64; ++row)
    EXPECT_EQ(rowOf(*scan.arranged, row), rowOf(*truth.cloud, row)) << "row " << row;
  for (std::size_t cell = 0; cell < scan.point_of_cell.size(); ++cell)
    if (scan.point_of_cell[cell] >= 0) {
      EXPECT_TRUE(seen.insert(scan.point_of_cell[cell]).second);
    }
  EXPECT_EQ(seen.size(), scan.cloud->size());
}

std::string npy(const std::string& type, bool is_fortran, const std::string& shape, const std::string& data) {
  std::string header =
      "{'descr': '" + type + "', 'fortran_order': " + (is_fortran ? "True" : "False") + ", 'shape': (" + shape + "), }";
  header.resize((header.size() + 10 + 64) / 64 * 64 - 11, ' ');
  header += '\n';
  std::string content = "\x93NUMPY";
  content += '\1';
  content += '\0';
  lisco_apps::putNumber(content, static_cast<std::uint16_t>(header.size()));
  return content + header + data;
}

TEST_F(Clouds, OfNumPy) {
  std::string rows;  // two points of four fields
  for (const float value : {1.F, 2.F, 3.F, 9.F, 4.F, 5.F, 6.F, 9.F}) lisco_apps::putNumber(rows, value);
  std::string columns;
  for (const double value : {1., 4., 2., 5., 3., 6., 9., 9.}) lisco_apps::putNumber(columns, value);
  write("c.npy", npy("<f4", false, "2, 4", rows));
  write("f.npy", npy("<f8", true, "2, 4", columns));
  for (const char* const name : {"c.npy", "f.npy"}) {
    const Scan scan = readScan(file(name));
    ASSERT_EQ(scan.cloud->size(), 2U) << name;
    EXPECT_EQ((*scan.cloud)[1].x, 4) << name;
    EXPECT_EQ((*scan.cloud)[0].z, 3) << name;
  }
  std::string image;
  for (int i = 0; i < 2 * 3 * 3; ++i) lisco_apps::putNumber(image, static_cast<float>(i));
  write("image.npy", npy("<f4", false, "2, 3, 3", image));
  const Scan scan = readScan(file("image.npy"));
  EXPECT_EQ(scan.cloud->height, 2U);
  EXPECT_EQ(scan.cloud->width, 3U);
  EXPECT_EQ((*scan.cloud)[4].y, 13);
}

TEST_F(Clouds, OfNumPyAreRefusedWithTheReason) {
  write("int.npy", npy("<i4", false, "2, 3", std::string(24, 'x')));
  EXPECT_NE(refusal("int.npy").find("neither float32 nor float64"), std::string::npos);
  write("short.npy", npy("<f4", false, "2000, 3", std::string(24, 'x')));
  EXPECT_NE(refusal("short.npy").find("truncated"), std::string::npos);
  write("flat.npy", npy("<f4", false, "6,", std::string(24, 'x')));
  EXPECT_NE(refusal("flat.npy").find("N x 3"), std::string::npos);
  write("none.npy", "no header at all");
  EXPECT_NE(refusal("none.npy").find("is no npy file"), std::string::npos);
}

TEST_F(Clouds, OfPcdWithRingsAreArranged) {
  std::string lines;
  for (int column = 0; column < 50; ++column)
    for (int ring = 0; ring < 4; ++ring)
      lines += lisco_apps::formatted("%f %f %f %d %f\n", 5 * std::cos(0.1 * column), 5 * std::sin(0.1 * column),
                                     0.1 * ring, ring, 1e-3 * column + 1e-6 * ring);
  write("a.pcd",
        "VERSION 0.7\nFIELDS x y z ring time\nSIZE 4 4 4 2 4\nTYPE F F F U F\nCOUNT 1 1 1 1 1\nWIDTH 200\nHEIGHT 1\n"
        "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 200\nDATA ascii\n" +
            lines);
  const Scan scan = readScan(file("a.pcd"));
  EXPECT_EQ(scan.cloud->height, 1U);
  ASSERT_NE(scan.arranged, nullptr);
  EXPECT_EQ(scan.arranged->height, 4U);
  EXPECT_EQ(scan.arranged->width, 50U);
  std::vector<pcl::PointIndices> clusters(1);
  for (std::size_t cell = 0; cell < scan.point_of_cell.size(); ++cell)
    if (scan.point_of_cell[cell] >= 0) clusters[0].indices.push_back(static_cast<pcl::index_t>(cell));
  scan.toInputOrder(clusters);
  ASSERT_EQ(clusters[0].indices.size(), 200U);
  for (pcl::index_t i = 0; i < 200; ++i) EXPECT_EQ(clusters[0].indices[static_cast<std::size_t>(i)], i);
}

TEST(CloudMessages, AreTheSameInBothSerializations) {
  const std::vector<TestPoint> points{{1, 2, 3, 1, 0}, {4, 5, 6, 0, 0.1F}, {7, 8, 9, 1, 0.2F}, {0, 0, 0, 0, 0.3F}};
  for (const bool is_ros1 : {false, true}) {
    const std::string data = pointCloud2(points, is_ros1);
    const lisco_apps::Message message{0, 1, reinterpret_cast<const std::uint8_t*>(data.data()), data.size()};
    const Topic topic{"/p", "sensor_msgs/PointCloud2", is_ros1 ? Serialization::kRos1 : Serialization::kCdr, 1};
    const pcl::PCLPointCloud2 cloud = lisco_apps::pointCloud2In(message, topic);
    EXPECT_EQ(cloud.width, 4U);
    EXPECT_EQ(cloud.header.frame_id, "lidar");
    EXPECT_EQ(cloud.header.stamp, 12'000'000U);
    const Scan scan = lisco_apps::scanOf(cloud);
    ASSERT_EQ(scan.cloud->size(), 4U);
    EXPECT_EQ((*scan.cloud)[2].y, 8);
    EXPECT_TRUE(std::isnan((*scan.cloud)[3].x)) << "no return";
    ASSERT_NE(scan.arranged, nullptr);
    EXPECT_EQ(scan.arranged->height, 2U);
    for (std::size_t size = 0; size < data.size(); ++size) {
      const lisco_apps::Message part{0, 1, message.data, size};
      EXPECT_THROW(lisco_apps::pointCloud2In(part, topic), std::runtime_error) << size;
    }
  }
}

/// A cloud of three points: a double that is no coordinate, x, y and z, two of which are floats, and an array.
pcl::PCLPointCloud2 mixedCloud(bool is_bigendian) {
  pcl::PCLPointCloud2 cloud;
  cloud.width = 3;
  cloud.height = 1;
  cloud.point_step = 40;
  cloud.row_step = 120;
  cloud.is_bigendian = is_bigendian;
  const auto add = [&](const char* name, std::uint32_t offset, std::uint8_t type, std::uint32_t count) {
    pcl::PCLPointField field;
    field.name = name;
    field.offset = offset;
    field.datatype = type;
    field.count = count;
    cloud.fields.push_back(field);
  };
  add("time", 1, 8, 1);
  add("y", 9, 7, 1);
  add("x", 13, 8, 0);
  add("z", 21, 7, 1);
  add("codes", 26, 4, 3);
  cloud.data.resize(120, 0xAB);
  const auto put = [&](std::size_t at, auto value) {
    std::uint8_t* const to = cloud.data.data() + at;
    std::memcpy(to, &value, sizeof value);
    if (is_bigendian) std::reverse(to, to + sizeof value);
  };
  for (std::size_t i = 0; i < 3; ++i) {
    put(40 * i + 1, 0.5 * static_cast<double>(i));
    put(40 * i + 9, 2.25F * static_cast<float>(i + 1));
    put(40 * i + 13, 1.125 * static_cast<double>(i + 1));
    put(40 * i + 21, -3.5F);
    for (std::size_t code = 0; code < 3; ++code) put(40 * i + 26 + 2 * code, static_cast<std::uint16_t>(0x1234 + code));
  }
  return cloud;
}

/// As a message.
std::string messageOf(const pcl::PCLPointCloud2& cloud) {
  lisco_apps::CdrText message;
  message.header(0, "lidar");
  for (const auto value : {cloud.height, cloud.width, static_cast<std::uint32_t>(cloud.fields.size())})
    message.number(value);
  for (const pcl::PCLPointField& field : cloud.fields) {
    message.text(field.name);
    message.number(field.offset);
    message.number(field.datatype);
    message.number(field.count);
  }
  message.number(static_cast<std::uint8_t>(cloud.is_bigendian));
  message.number(cloud.point_step);
  message.number(cloud.row_step);
  message.number(static_cast<std::uint32_t>(cloud.data.size()));
  message.bytes().append(cloud.data.begin(), cloud.data.end());
  message.number(std::uint8_t{1});
  return message.done();
}

pcl::PCLPointCloud2 read(const std::string& data) {
  return lisco_apps::pointCloud2In({0, 1, reinterpret_cast<const std::uint8_t*>(data.data()), data.size()},
                                   {"/p", "sensor_msgs/PointCloud2", Serialization::kCdr, 1});
}

TEST(CloudMessages, MayBeBigEndian) {
  const pcl::PCLPointCloud2 little = read(messageOf(mixedCloud(false)));
  const pcl::PCLPointCloud2 big = read(messageOf(mixedCloud(true)));
  EXPECT_EQ(big.data, little.data);
  EXPECT_EQ(big.is_bigendian, 0);
  const Scan scan = lisco_apps::scanOf(big);
  ASSERT_EQ(scan.cloud->size(), 3U);
  EXPECT_EQ((*scan.cloud)[2].x, 3.375F);
  EXPECT_EQ((*scan.cloud)[2].y, 6.75F);
  EXPECT_EQ((*scan.cloud)[2].z, -3.5F);
  // Fields that overlap, or reach beyond a point, cannot be turned.
  for (const auto& [offset, count] : {std::pair(3U, 1U), {37U, 1U}, {21U, 1U << 31U}}) {
    pcl::PCLPointCloud2 wrong = mixedCloud(true);
    wrong.fields[3].offset = offset;
    wrong.fields[3].count = count;
    EXPECT_THROW(lisco_apps::scanOf(read(messageOf(wrong))), lisco_apps::Broken) << offset;
  }
}

TEST(CloudMessages, KeepTheirFieldsWithPaddedRows) {
  const pcl::PCLPointCloud2 dense = mixedCloud(false);
  pcl::PCLPointCloud2 padded = dense;
  padded.row_step = 0;  // of no meaning to a single row
  EXPECT_EQ(lisco_apps::scanOf(padded).fields.data, dense.data);
  padded.width = 1;
  padded.height = 3;
  padded.row_step = 47;
  padded.data.assign(std::size_t{3} * 47, 0xCD);
  for (std::ptrdiff_t row = 0; row < 3; ++row)
    std::copy_n(dense.data.begin() + 40 * row, 40, padded.data.begin() + 47 * row);
  const Scan scan = lisco_apps::scanOf(padded);
  EXPECT_EQ(scan.cloud->height, 3U);
  EXPECT_EQ(scan.fields.row_step, 40U);
  EXPECT_EQ(scan.fields.fields.size(), 5U);
  EXPECT_EQ(scan.fields.data, dense.data);
}

TEST(CloudMessages, OfManyEmptyRowsTakeNoTime) {
  pcl::PCLPointCloud2 cloud = mixedCloud(true);
  cloud.height = 0xFFFFFFFF;
  for (const std::uint32_t width : {0U, 3U}) {
    cloud.width = width;
    cloud.row_step = 0;
    EXPECT_THROW(lisco_apps::scanOf(read(messageOf(cloud))), lisco_apps::Broken) << width;
  }
  cloud.data.clear();
  cloud.width = 0;
  EXPECT_EQ(lisco_apps::scanOf(read(messageOf(cloud))).cloud->height, 0U) << "a row takes memory";
}

TEST(CloudMessages, WithoutCoordinatesAreRefusedWithTheReason) {
  pcl::PCLPointCloud2 cloud = mixedCloud(false);
  cloud.fields[1].name = "Y";
  EXPECT_EQ(lisco_test::refusalOf([&] { lisco_apps::scanOf(cloud); }), "a cloud without a field 'y'");
  cloud = mixedCloud(false);
  cloud.fields[3].datatype = 6;
  EXPECT_EQ(lisco_test::refusalOf([&] { lisco_apps::scanOf(cloud); }),
            "a cloud whose field 'z' is neither FLOAT32 nor FLOAT64");
}

}  // namespace
}  // namespace lisco_test
