// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Streams allocate no memory once their buffers have grown. A program for itself, since it replaces malloc (), which
// operator new and Eigen call, too.
#include <malloc.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstddef>

#include "lisco/column_clusterer.h"
#include "pcl_stream.h"

extern "C" {
// The C library's own functions, which it offers to those that replace malloc ().
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
}

namespace {

std::atomic<std::size_t> allocation_count{0};

void* counted(void* memory) {
  allocation_count.fetch_add(1, std::memory_order_relaxed);
  return memory;
}

}  // namespace

extern "C" {

void* malloc(std::size_t size) noexcept {
  return counted(__libc_malloc(size));
}
void* calloc(std::size_t count, std::size_t size) noexcept {
  return counted(__libc_calloc(count, size));
}
void* realloc(void* memory, std::size_t size) noexcept {
  return counted(__libc_realloc(memory, size));
}
void* memalign(std::size_t alignment, std::size_t size) noexcept {
  return counted(__libc_memalign(alignment, size));
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  return counted(__libc_memalign(alignment, size));
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
  *memory = counted(__libc_memalign(alignment, size));
  return *memory == nullptr ? ENOMEM : 0;
}

}  // extern "C"

namespace lisco_test {
namespace {

using pcl::PointXYZ;

Columns<PointXYZ> columnsOfBoxes(std::uint64_t seed) {
  Random random(seed);
  return columnsOf(*cloudOf(boxesAround(random, 600, 16)));
}

template <typename Action>
std::size_t allocationsOf(Action&& action) {
  const std::size_t before = allocation_count;
  action();
  return allocation_count - before;
}

TEST(PclStreamMemory, CountsAllocations) {
  EXPECT_GT(allocationsOf([] { EXPECT_FALSE(columnsOfBoxes(1).empty()); }), 600U);
}

TEST(PclStreamMemory, RotationsAllocateOnlyTheClusters) {
  const Columns<PointXYZ> columns = columnsOfBoxes(1);
  pcl::LiscoStreamExtraction<PointXYZ> stream;
  set(stream, {0.5, 3});
  Clusters clusters;
  std::vector<pcl::uindex_t> sizes;
  pcl::PointCloud<PointXYZ> cloud;
  const auto rotate = [&] {
    clusters.clear();
    stream.beginRotation();
    for (const auto& column : columns) {
      stream.addColumn(column);
      if (stream.getNumberOfColumns() % 100 != 0) continue;
      stream.getSubclusterSizes(sizes);
      stream.getSubcluster(3, stream.getNumberOfColumns() / 2);
    }
    stream.endRotation(clusters, cloud);
  };
  for (int turn = 0; turn < 3; ++turn) rotate();  // the first one has no hints
  EXPECT_GT(clusters.size(), 3U);
  const std::size_t of_clusters = clusters.size();  // for their indices; the vector of clusters has its capacity
  EXPECT_EQ(allocationsOf(rotate), of_clusters);
}

// The first columns of a rotation come at once, for which the engine has other paths than for those that follow.
TEST(PclStreamMemory, RotationsInBatchesAllocateNothing) {
  const Columns<PointXYZ> columns = columnsOfBoxes(1);
  lisco::Parameters parameters;
  parameters.tolerance = 0.3F;
  parameters.sensor.steps_per_turn = 600;
  parameters.sensor.clockwise = true;
  parameters.sensor.elevation_step = 0.03F;
  lisco::ColumnClusterer clusterer;
  const auto rotate = [&](std::size_t lasers) {
    clusterer.begin(parameters);
    constexpr std::array<std::size_t, 4> kFirst{0, 300, 310, 600};
    for (std::size_t i = 0; i + 1 < kFirst.size(); ++i)
      clusterer.addColumns(kFirst[i + 1] - kFirst[i], lasers, [&](std::size_t laser, std::size_t column) {
        const PointXYZ& point = columns[kFirst[i] + column][laser];
        return lisco::Return{point.x, point.y, point.z, 0};
      });
    clusterer.update();
  };
  for (const std::size_t lasers : {std::size_t{1}, columns[0].size()}) {
    for (int turn = 0; turn < 2; ++turn) rotate(lasers);
    EXPECT_EQ(allocationsOf([&] { rotate(lasers); }), 0U) << lasers;
  }
  EXPECT_GT(clusterer.subclusterCount(), 3U);
}

TEST(PclStreamMemory, WindowsAllocateOnlyTheClusters) {
  const Columns<PointXYZ> columns = columnsOfBoxes(1);
  pcl::LiscoWindowExtraction<PointXYZ> windows;
  set(windows, {0.5, 3});
  windows.setWindowSize(300);
  windows.setHop(50);
  ASSERT_TRUE(windows.beginStream());
  Clusters clusters;
  pcl::PointCloud<PointXYZ> cloud;
  std::size_t of_clusters = 0;
  const auto turn = [&] {
    for (const auto& column : columns) {
      if (!windows.addColumn(column)) continue;
      clusters.clear();
      windows.extract(clusters);
      windows.getWindow(cloud);
      of_clusters += clusters.size();
    }
  };
  for (int i = 0; i < 8; ++i) turn();  // until each of the engine's 7 panes has held each of the 12 hops
  of_clusters = 0;
  const std::size_t allocations = allocationsOf(turn);
  EXPECT_GT(of_clusters, 12U);
  EXPECT_EQ(allocations, of_clusters);
}

TEST(PclStreamMemory, EndlessStreamsAllocateNothing) {
  const Columns<PointXYZ> columns = columnsOfBoxes(1);
  pcl::LiscoEndlessExtraction<PointXYZ> endless;
  set(endless, {0.5, 3});
  endless.setClockwise(true);
  endless.setColumnsPerTurn(600);
  std::size_t delivered = 0;
  endless.setClusterCallback(
      [&](const pcl::LiscoEndlessCluster<PointXYZ>& cluster) { delivered += cluster.cloud.size(); });
  ASSERT_TRUE(endless.beginStream());
  const auto turn = [&] {
    for (const auto& column : columns) endless.addColumn(column);
  };
  for (int i = 0; i < 6; ++i) turn();
  delivered = 0;
  EXPECT_EQ(allocationsOf(turn), 0U);
  EXPECT_GT(delivered, 1000U);
  EXPECT_LE(endless.getNumberOfColumnsHeld(), 901U);
}

}  // namespace
}  // namespace lisco_test
