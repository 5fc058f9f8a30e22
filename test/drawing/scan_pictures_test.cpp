// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "drawing/scan_pictures.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <ostream>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <pcl/features/lisco_cluster_features.h>
#include <pcl/segmentation/lisco_cluster_extraction.h>

#include "io/point_geometry.h"
#include "io/scan_file.h"
#include "lab.h"

namespace lisco_apps {
namespace {

using lisco_test::labDistance;
using lisco_test::labOf;

constexpr double kClearlyDifferent = 19.5;  ///< least CIEDE2000 between neighbours
// Pixels between the middles of neighbours' cells, along both axes.
constexpr int kNear = 12;
constexpr int kTouching = 4;

/// A PNG file.
class Picture {
 public:
  explicit Picture(const fs::path& png)
      : surface_(cairo_image_surface_create_from_png(png.c_str()), cairo_surface_destroy) {}

  int width() const { return cairo_image_surface_get_width(surface_.get()); }
  int height() const { return cairo_image_surface_get_height(surface_.get()); }
  std::uint32_t at(int x, int y) const {
    const unsigned char* const row =
        cairo_image_surface_get_data(surface_.get()) + y * cairo_image_surface_get_stride(surface_.get());
    std::uint32_t pixel;
    std::memcpy(&pixel, row + 4 * static_cast<std::ptrdiff_t>(x), 4);
    return pixel | 0xFF000000U;
  }

 private:
  std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface_;
};

/// A folder for pictures, removed at the end.
class ScanPictures : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "lisco_drawing_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }

  void draw(const ClusteredScan& scan) const { drawPictures(scan, rangeImage(), topView()); }
  fs::path rangeImage() const { return folder_ / "range_image.png"; }
  fs::path topView() const { return folder_ / "top_view.png"; }
  void expectNeighboursInDifferentColors(const ClusteredScan& scan, int reach = kNear) const;

 private:
  fs::path folder_;
};

/// How a pixel shows a point of a cluster: 2 in a colour of the palette, 1 in a darker one, 0 not (a line or letter).
int showsCluster(std::uint32_t pixel) {
  const auto channel = [](std::uint32_t argb, int shift) { return static_cast<double>(argb >> shift & 0xFF); };
  int shows = 0;
  for (const Color& color : kPalette) {
    const std::uint32_t full = color.argb();
    if (pixel == full) return 2;
    const double most = std::max({channel(full, 16), channel(full, 8), channel(full, 0)});
    const double factor = std::max({channel(pixel, 16), channel(pixel, 8), channel(pixel, 0)}) / most;
    bool is_darker = factor > 0.49 && factor <= 1;
    for (const int shift : {16, 8, 0})
      is_darker = is_darker && std::fabs(channel(pixel, shift) - factor * channel(full, shift)) <= 1.5;
    shows = is_darker ? 1 : shows;
  }
  return shows;
}

/// Pixels in darker colours that show a cluster: blends of its lines may look like fewer.
constexpr std::size_t kLeastShaded = 10;

/// The colour in which a picture shows each cluster: the middle one by channels, of its pixels in full colour if there
/// are any; 0: covered by lines and letters.
/// \param shown cluster of each cell of the map, 0: none
std::vector<std::uint32_t> colorsShown(const Picture& picture, const PointMap& map,
                                       const std::vector<std::uint32_t>& shown, std::size_t clusters) {
  const auto width = static_cast<int>(map.cell_width), height = static_cast<int>(map.cell_height);
  const int left = (picture.width() - map.columns * width) / 2;
  std::vector<std::vector<std::uint32_t>> pixels(clusters);
  std::vector<int> shows(clusters, 1);
  for (int row = 0; row < map.rows; ++row)
    for (int column = 0; column < map.columns; ++column) {
      const std::uint32_t cluster = shown[map.cellAt(row, column)];
      if (cluster == 0) continue;
      for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
          const std::uint32_t pixel = picture.at(left + column * width + x, kHeaderHeight + row * height + y);
          const int how = showsCluster(pixel);
          if (how < shows[cluster - 1]) continue;
          if (how > shows[cluster - 1]) pixels[cluster - 1].clear();
          shows[cluster - 1] = how;
          pixels[cluster - 1].push_back(pixel);
        }
    }
  std::vector<std::uint32_t> colors(clusters, 0);
  for (std::size_t i = 0; i < clusters; ++i) {
    if (pixels[i].size() < (shows[i] == 2 ? 1U : kLeastShaded)) continue;
    colors[i] = 0xFF000000U;
    for (const int shift : {16, 8, 0}) {
      std::vector<std::uint32_t> values;
      for (const std::uint32_t pixel : pixels[i]) values.push_back(pixel >> shift & 0xFF);
      const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
      std::nth_element(values.begin(), middle, values.end());
      colors[i] |= *middle << shift;
    }
  }
  return colors;
}

/// Pairs of clusters with cells at most `reach` pixels apart, or side by side.
std::set<std::pair<std::uint32_t, std::uint32_t>> neighboursIn(const PointMap& map,
                                                               const std::vector<std::uint32_t>& shown, int reach) {
  const int reach_x = std::max(1, static_cast<int>(reach / map.cell_width));
  const int reach_y = std::max(1, static_cast<int>(reach / map.cell_height));
  std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (int row = 0; row < map.rows; ++row)
    for (int column = 0; column < map.columns; ++column) {
      const std::uint32_t cluster = shown[map.cellAt(row, column)];
      if (cluster == 0) continue;
      for (int y = row; y <= std::min(map.rows - 1, row + reach_y); ++y)
        for (int x = std::max(0, column - reach_x); x <= std::min(map.columns - 1, column + reach_x); ++x)
          if (const std::uint32_t other = shown[map.cellAt(y, x)]; other != 0 && other != cluster)
            pairs.emplace(std::min(cluster, other), std::max(cluster, other));
    }
  return pairs;
}

std::vector<std::uint32_t> clustersIn(const PointMap& map, const ClusteredScan& scan) {
  const std::vector<std::uint32_t> labels = labelsOf(scan.clusters, scan.cloud->size());
  std::vector<std::uint32_t> shown;
  for (const std::int64_t point : map.points)
    shown.push_back(point == PointMap::kNoPoint ? 0 : labels[static_cast<std::size_t>(point)]);
  return shown;
}

void ScanPictures::expectNeighboursInDifferentColors(const ClusteredScan& scan, int reach) const {
  draw(scan);
  for (const bool from_above : {false, true}) {
    SCOPED_TRACE(from_above ? "top view" : "range image");
    const Picture picture(from_above ? topView() : rangeImage());
    const PointMap map = from_above ? topViewOf(scan) : rangeImageOf(scan);
    const std::vector<std::uint32_t> shown = clustersIn(map, scan);
    const std::vector<std::uint32_t> colors = colorsShown(picture, map, shown, scan.clusters.size());
    double least = std::numeric_limits<double>::infinity();
    std::size_t alike = 0, pairs = 0;
    std::string worst;
    for (const auto& [a, b] : neighboursIn(map, shown, reach)) {
      if (colors[a - 1] == 0 || colors[b - 1] == 0) continue;  // covered by an id
      ++pairs;
      const double distance = labDistance(labOf(colors[a - 1]), labOf(colors[b - 1]));
      alike += distance < kClearlyDifferent ? 1 : 0;
      if (distance >= least) continue;
      least = distance;
      worst = std::to_string(a) + " and " + std::to_string(b);
    }
    EXPECT_EQ(alike, 0U) << "of " << pairs << " pairs of neighbours; closest: " << worst << ", " << least;
    if (scan.clusters.size() > 50) {
      EXPECT_GT(pairs, 10U);
    }
  }
}

/// Measures the clusters and takes all of their points for clustered.
void complete(ClusteredScan& scan, const std::shared_ptr<Cloud>& cloud) {
  scan.name = "scan";
  scan.tolerance = 0.4;
  scan.min_size = 1;
  scan.cloud = cloud;
  pcl::LiscoClusterFeatures<pcl::PointXYZ> estimation;
  estimation.setInputCloud(scan.cloud);
  estimation.compute(scan.clusters, scan.features);
}

/// A turn of `rows` lasers x `columns` steps, clockwise from behind, without returns.
std::shared_ptr<Cloud> emptyTurn(std::uint32_t columns, std::uint32_t rows) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  return std::make_shared<Cloud>(columns, rows, pcl::PointXYZ(nan, nan, nan));
}

/// Sets the return of a cell.
void measure(Cloud& cloud, int row, int column, double range) {
  const double azimuth = kPi * (1 - 2 * (column + 0.5) / static_cast<double>(cloud.width));
  const double elevation = 0.2 - 0.5 * row / static_cast<double>(cloud.height);
  cloud[static_cast<std::size_t>(row) * cloud.width + static_cast<std::size_t>(column)] = {
      static_cast<float>(range * std::cos(elevation) * std::cos(azimuth)),
      static_cast<float>(range * std::cos(elevation) * std::sin(azimuth)),
      static_cast<float>(range * std::sin(elevation))};
}

/// Many patches of returns in each other's way, one cluster each, that overlap in both pictures.
ClusteredScan crowdedScan(unsigned seed, std::uint32_t patches) {
  constexpr int kColumns = 900, kRows = 64;
  std::mt19937 random(seed);
  const auto upTo = [&random](std::uint32_t limit) { return static_cast<int>(random() % limit); };
  const std::shared_ptr<Cloud> cloud = emptyTurn(kColumns, kRows);
  std::vector<double> nearest(cloud->size(), std::numeric_limits<double>::infinity());
  std::vector<std::uint32_t> labels(cloud->size(), 0);
  for (std::uint32_t patch = 1; patch <= patches; ++patch) {
    const double range = 5 + 0.01 * upTo(3000);
    const int left = upTo(kColumns), top = upTo(kRows), width = 2 + upTo(14), height = 2 + upTo(8);
    for (int row = top; row < std::min(kRows, top + height); ++row)
      for (int column = left; column < std::min(kColumns, left + width); ++column) {
        const std::size_t cell = static_cast<std::size_t>(row) * kColumns + static_cast<std::size_t>(column);
        if (range >= nearest[cell]) continue;
        nearest[cell] = range;
        labels[cell] = patch;
        measure(*cloud, row, column, range);
      }
  }
  std::map<std::uint32_t, pcl::PointIndices> clusters;
  ClusteredScan scan;
  for (std::size_t cell = 0; cell < labels.size(); ++cell) {
    if (labels[cell] == 0) continue;
    clusters[labels[cell]].indices.push_back(static_cast<pcl::index_t>(cell));
    scan.returns.clustered.push_back(static_cast<pcl::index_t>(cell));
  }
  for (auto& [patch, cluster] : clusters) scan.clusters.push_back(std::move(cluster));
  complete(scan, cloud);
  return scan;
}

TEST_F(ScanPictures, NeighboursDifferInCrowdedScenes) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE(seed);
    expectNeighboursInDifferentColors(crowdedScan(seed, 400));
  }
}

TEST(LabDistance, IsThatOfThePublishedPairs) {
  EXPECT_NEAR(labDistance({50, 2.6772, -79.7751}, {50, 0, -82.7485}), 2.0425, 1e-4);
  EXPECT_NEAR(labDistance({50, 2.5, 0}, {73, 25, -18}), 27.1492, 1e-4);
  EXPECT_NEAR(labDistance({60.2574, -34.0099, 36.2677}, {60.4626, -34.1751, 39.4387}), 1.2644, 1e-4);
  EXPECT_NEAR(labDistance({22.7233, 20.0904, -46.6940}, {23.0331, 14.9730, -42.5619}), 2.0373, 1e-4);
  EXPECT_NEAR(labDistance({50, -1, 2}, {50, 0, 0}), 2.3669, 1e-4);
}

TEST(Palette, ColorsDifferClearly) {
  std::vector<std::uint32_t> all{kNoise.argb(), kGround.argb(), kBackground.argb()};
  for (const Color& color : kPalette) all.push_back(color.argb());
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t k = std::max<std::size_t>(i + 1, 3); k < all.size(); ++k)
      EXPECT_GE(labDistance(labOf(all[i]), labOf(all[k])), kClearlyDifferent) << i << " and " << k;
}

/// A wall of rows 2 to 9 and `columns` (modulo a turn), 10 m away.
ClusteredScan wallAt(int first, int last) {
  const std::shared_ptr<Cloud> cloud = emptyTurn(600, 16);
  for (int column = 0; column < 600; ++column) measure(*cloud, 15, column, 20);
  ClusteredScan scan;
  scan.clusters.emplace_back();
  for (int row = 2; row < 10; ++row)
    for (int column = first; column <= last; ++column) {
      measure(*cloud, row, column % 600, 10);
      scan.clusters[0].indices.push_back(row * 600 + column % 600);
    }
  std::sort(scan.clusters[0].indices.begin(), scan.clusters[0].indices.end());
  scan.returns.clustered = scan.clusters[0].indices;
  complete(scan, cloud);
  return scan;
}

/// Where the range image of wallAt () has lines of its box.
class WallBox {
 public:
  WallBox(const fs::path& png, const ClusteredScan& scan)
      : picture_(png), map_(rangeImageOf(scan)), left_((picture_.width() - map_.columns * cellWidth()) / 2) {}

  /// Whether the row of pixels above the wall is a line at a column.
  bool above(int column) const { return isLine(left_ + column * cellWidth() + 1, top() - 1); }
  bool below(int column) const { return isLine(left_ + column * cellWidth() + 1, bottom()); }
  bool leftOf(int column) const { return isLine(left_ + column * cellWidth() - 1, top() + 1); }
  bool rightOf(int column) const { return isLine(left_ + (column + 1) * cellWidth(), top() + 1); }

 private:
  int cellWidth() const { return static_cast<int>(map_.cell_width); }
  int top() const { return kHeaderHeight + 2 * static_cast<int>(map_.cell_height); }
  int bottom() const { return kHeaderHeight + 10 * static_cast<int>(map_.cell_height); }
  bool isLine(int x, int y) const {
    return labDistance(labOf(picture_.at(x, y)), labOf(kPalette[0].brightened().argb())) < 10;
  }

  Picture picture_;
  PointMap map_;
  int left_;
};

TEST_F(ScanPictures, RangeImageHasBoxes) {
  const ClusteredScan scan = wallAt(100, 220);
  draw(scan);
  const WallBox box(rangeImage(), scan);
  for (const int column : {100, 160, 220}) EXPECT_TRUE(box.above(column) && box.below(column)) << column;
  for (const int column : {98, 222, 400}) EXPECT_FALSE(box.above(column) || box.below(column)) << column;
  EXPECT_TRUE(box.leftOf(100));
  EXPECT_TRUE(box.rightOf(220));
  for (const int column : {50, 150, 300}) EXPECT_FALSE(box.leftOf(column)) << column;
}

TEST_F(ScanPictures, BoxesAreDividedAtTheSeam) {
  const ClusteredScan scan = wallAt(560, 640);
  draw(scan);
  const WallBox box(rangeImage(), scan);
  for (const int column : {560, 599, 0, 40}) EXPECT_TRUE(box.above(column) && box.below(column)) << column;
  for (const int column : {42, 300, 558}) EXPECT_FALSE(box.above(column) || box.below(column)) << column;
  EXPECT_TRUE(box.leftOf(560));
  EXPECT_TRUE(box.rightOf(40));
  EXPECT_FALSE(box.leftOf(0));
  EXPECT_FALSE(box.rightOf(599));
}

/// Number of points that a picture shows.
std::size_t shownIn(const PointMap& map) {
  std::set<std::int64_t> shown(map.points.begin(), map.points.end());
  shown.erase(PointMap::kNoPoint);
  return shown.size();
}

TEST_F(ScanPictures, TopViewShowsCloudsFarFromTheOrigin) {
  ClusteredScan scan = wallAt(100, 220);
  const auto expected = static_cast<double>(shownIn(topViewOf(scan)));
  EXPECT_GT(expected, 100);
  auto moved = std::make_shared<Cloud>(*scan.cloud);
  for (pcl::PointXYZ& point : *moved) {
    point.x += 4000;
    point.y -= 6000;
  }
  scan.cloud = moved;
  EXPECT_GT(static_cast<double>(shownIn(topViewOf(scan))), expected / 2);
  moved->sensor_origin_ << 4000, -6000, 0, 0;
  EXPECT_NEAR(static_cast<double>(shownIn(topViewOf(scan))), expected, 0.05 * expected);
}

/// A real scan and its tolerance.
struct ScanFile {
  const char* name;
  double tolerance = 0.4;
  int reach = kNear;  ///< of neighbours, pixels
};

void PrintTo(const ScanFile& file, std::ostream* out) {
  *out << file.name;
}

class RealScanPictures : public ScanPictures, public testing::WithParamInterface<ScanFile> {};

TEST_P(RealScanPictures, NeighboursDiffer) {
  const char* const set = std::getenv("LISCO_TEST_DATA");
  const fs::path scans = fs::path(set != nullptr ? set : LISCO_TEST_DATA_DEFAULT) / "scans";
  if (!fs::is_directory(scans))
    GTEST_SKIP() << "no real scans: there is no folder " << scans << "; set LISCO_TEST_DATA to the data folder";
  const auto cloud = readScan(scans / (std::string(GetParam().name) + ".pcd")).clustered();
  ClusteredScan scan;
  scan.returns = returnsOf(*cloud, groundChoiceOf("slope"), Region{});
  pcl::LiscoClusterExtraction<pcl::PointXYZ> extraction;
  extraction.setClusterTolerance(GetParam().tolerance);
  extraction.setMinClusterSize(10);
  extraction.setInputCloud(cloud);
  extraction.setIndices(std::make_shared<const pcl::Indices>(scan.returns.clustered));
  extraction.extract(scan.clusters);
  complete(scan, cloud);
  expectNeighboursInDifferentColors(scan, GetParam().reach);
}

// At 0.1 m, more clusters than there are colours lie within kNear pixels of each other.
INSTANTIATE_TEST_SUITE_P(Files, RealScanPictures,
                         testing::Values(ScanFile{"vls128_street_0"}, ScanFile{"vls128_deskewed_0"},
                                         ScanFile{"os1_128_outdoor_0"}, ScanFile{"os1_64_sparse_0"},
                                         ScanFile{"hdl64e_city_0"}, ScanFile{"hdl64e_kitti_0"},
                                         ScanFile{"hdl32e_outdoor_0"}, ScanFile{"vlp16_street_0"},
                                         ScanFile{"ring64_zeros"}, ScanFile{"vls128_street_0", 0.1, kTouching},
                                         ScanFile{"os1_128_outdoor_0", 0.1}, ScanFile{"rgbd_table_0", 0.005}),
                         [](const auto& instance) {
                           return std::string(instance.param.name) + "_" +
                                  std::to_string(std::lround(1000 * instance.param.tolerance)) + "mm";
                         });

}  // namespace
}  // namespace lisco_apps
