// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Copies of the PCL classes, whose state lies behind a pointer, and moved-from objects.
#include <gtest/gtest.h>

#include <type_traits>
#include <utility>
#include <vector>

#include <pcl/segmentation/lisco_cluster_extraction.h>

#include "pcl_client.h"
#include "pcl_clouds.h"
#include "pcl_stream.h"

namespace lisco_test {
namespace {

using pcl::PointXYZ;
using Extraction = pcl::LiscoClusterExtraction<PointXYZ>;
using Stream = pcl::LiscoStreamExtraction<PointXYZ>;
using Windows = pcl::LiscoWindowExtraction<PointXYZ>;

static_assert(std::is_copy_constructible_v<Extraction> && std::is_copy_assignable_v<Extraction>);
static_assert(std::is_copy_constructible_v<Stream> && std::is_copy_assignable_v<Stream>);
static_assert(std::is_copy_constructible_v<Windows> && std::is_copy_assignable_v<Windows>);
static_assert(!std::is_copy_constructible_v<pcl::LiscoEndlessExtraction<PointXYZ>>);

bool areSame(const Clusters& a, const Clusters& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (a[i].indices != b[i].indices) return false;
  return true;
}

Clusters clustersOf(Extraction& extraction) {
  Clusters clusters;
  extraction.extract(clusters);
  return clusters;
}

TEST(PclCopies, OfAnExtractionAreIndependent) {
  Random random(1);
  Extraction extraction;
  extraction.setClusterTolerance(0.5);
  extraction.setMinClusterSize(3);
  extraction.setInputCloud(cloudOf(boxesAround(random, 120, 8)));
  const Clusters expected = clustersOf(extraction);
  ASSERT_GT(expected.size(), 3U);

  Extraction copy = extraction;
  Extraction assigned;
  assigned = extraction;
  extraction.setInputCloud(cloudOf(boxesAround(random, 60, 4)));
  const Clusters others = clustersOf(extraction);
  EXPECT_FALSE(areSame(others, expected));
  EXPECT_TRUE(areSame(clustersOf(copy), expected));
  EXPECT_TRUE(areSame(clustersOf(assigned), expected));
  EXPECT_TRUE(areSame(clustersOf(extraction), others));

  Extraction& same = copy;
  copy = same;
  EXPECT_TRUE(areSame(clustersOf(copy), expected));
}

TEST(PclCopies, OfAnExtractionHaveTheirOwnListsOfPoints) {
  Random random(3);
  const auto small = cloudOf(boxesAround(random, 60, 4)), large = cloudOf(boxesAround(random, 120, 8));
  Extraction extraction;
  extraction.setClusterTolerance(0.5);
  extraction.setInputCloud(small);
  clustersOf(extraction);
  Extraction copy(extraction);
  copy.setInputCloud(large);
  clustersOf(copy);
  EXPECT_NE(copy.getIndices(), extraction.getIndices()) << "threads would change one list";
  EXPECT_EQ(extraction.getIndices()->size(), small->size());
  EXPECT_EQ(copy.getIndices()->size(), large->size());
}

TEST(PclCopies, MovedFromExtractionsWorkAgain) {
  Random random(2);
  const auto cloud = cloudOf(boxesAround(random, 120, 8));
  Extraction extraction;
  extraction.setClusterTolerance(0.5);
  extraction.setInputCloud(cloud);
  const Clusters expected = clustersOf(extraction);
  std::vector<Extraction> extractions;
  extractions.push_back(std::move(extraction));
  extractions.emplace_back();  // moves or copies the first one
  EXPECT_TRUE(areSame(clustersOf(extractions.front()), expected));
  extraction.setInputCloud(cloud);  // NOLINT: a moved-from object can be used again
  extraction.setClusterTolerance(0.5);
  EXPECT_TRUE(areSame(clustersOf(extraction), expected));
}

TEST(PclCopies, OfAStreamContinueFromTheSameColumn) {
  Random random(3);
  const auto columns = columnsOf(*cloudOf(boxesAround(random, 120, 8)));
  Stream stream;
  stream.setClusterTolerance(0.5);
  stream.setSensorOrigin({0.5F, 0, 0, 0});
  stream.setBlockColumns(8);
  stream.beginRotation();
  for (std::size_t i = 0; i < 50; ++i) ASSERT_TRUE(stream.addColumn(columns[i]));
  Stream copy = stream;
  Stream assigned;
  assigned = stream;
  for (Stream* other : {&copy, &assigned}) {
    EXPECT_EQ(other->getClusterTolerance(), 0.5);
    EXPECT_EQ(other->getSensorOrigin(), stream.getSensorOrigin());
    EXPECT_EQ(other->getBlockColumns(), 8U);
    EXPECT_EQ(other->getNumberOfColumns(), 50U);
  }
  for (Stream* each : {&stream, &copy, &assigned})
    for (std::size_t i = 50; i < columns.size(); ++i) ASSERT_TRUE(each->addColumn(columns[i]));
  Clusters expected, found, assigned_found;
  pcl::PointCloud<PointXYZ> cloud, found_cloud;
  EXPECT_TRUE(stream.endRotation(expected, cloud));
  EXPECT_TRUE(copy.endRotation(found, found_cloud));
  EXPECT_TRUE(assigned.endRotation(assigned_found));
  EXPECT_GT(expected.size(), 3U);
  EXPECT_TRUE(areSame(found, expected));
  EXPECT_TRUE(areSame(assigned_found, expected));
  EXPECT_EQ(found_cloud.width, columns.size());
  EXPECT_EQ(found_cloud.size(), cloud.size());

  const Stream moved = std::move(copy);
  EXPECT_EQ(moved.getNumberOfColumns(), columns.size());
  expectRotationSameAsPcl(copy, random, columns, {0.5, 3});  // NOLINT: a moved-from object can be used again
}

TEST(PclCopies, OfWindowsContinueFromTheSameColumn) {
  Random random(4);
  const auto columns = columnsOf(*cloudOf(boxesAround(random, 120, 8)));
  Windows windows;
  windows.setClusterTolerance(0.5);
  windows.setWindowSize(60);
  windows.setHop(20);
  ASSERT_TRUE(windows.beginStream());
  for (std::size_t i = 0; i < 50; ++i) windows.addColumn(columns[i]);
  Windows copy = windows;
  Windows assigned;
  assigned = windows;
  for (Windows* each : {&windows, &copy, &assigned}) {
    EXPECT_EQ(each->getWindowSize(), 60U);
    EXPECT_EQ(each->getHop(), 20U);
    EXPECT_EQ(each->getNumberOfColumns(), 40U);
    for (std::size_t i = 50; i < 100; ++i) each->addColumn(columns[i]);
  }
  Clusters expected, found, assigned_found;
  EXPECT_TRUE(windows.extract(expected));
  EXPECT_TRUE(copy.extract(found));
  EXPECT_TRUE(assigned.extract(assigned_found));
  EXPECT_GT(expected.size(), 1U);
  EXPECT_TRUE(areSame(found, expected));
  EXPECT_TRUE(areSame(assigned_found, expected));

  const Windows moved = std::move(copy);
  EXPECT_EQ(moved.getNumberOfColumns(), 60U);
  expectWindowsSameAsPcl(copy, random, columns, {0.5, 3}, 60, 20);  // NOLINT: a moved-from object can be used again
}

}  // namespace
}  // namespace lisco_test
