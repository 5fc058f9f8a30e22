// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Point types that the library holds compiled.
#include "pcl_client.h"
#include "pcl_clouds.h"

namespace lisco_test {
namespace {

template <typename PointT>
class PclPointTypes : public testing::Test {};
using PointTypes = testing::Types<pcl::PointXYZ, pcl::PointXYZI, pcl::PointXYZRGB, pcl::PointXYZL, pcl::PointNormal>;
TYPED_TEST_SUITE(PclPointTypes, PointTypes);

TYPED_TEST(PclPointTypes, EqualPcl) {
  Random random(1);
  const auto cloud = cloudOf<TypeParam>(boxesAround(random, 120, 8));
  EXPECT_GT((expectSameAsPcl<TypeParam>(cloud, nullptr, {0.5, 3}).size()), 3U);
  expectSameAsPcl<TypeParam>(cloud, shuffledIndices(random, cloud->size()), {0.5});
  expectSameAsPcl<TypeParam>(unorganized(*cloud), nullptr, {0.5});
}

TYPED_TEST(PclPointTypes, FreeFunctions) {
  Random random(2);
  const auto cloud = cloudOf<TypeParam>(boxesAround(random, 60, 4));
  Clusters whole;
  Clusters some;
  pcl::extractLiscoClusters(*cloud, 0.5F, whole);
  pcl::extractLiscoClusters(*cloud, *returnsOf(*cloud), 0.5F, some);
  EXPECT_FALSE(whole.empty());
  expectSame(whole, some);
}

}  // namespace
}  // namespace lisco_test
