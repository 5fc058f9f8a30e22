// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include "lisco/box.h"
#include "lisco/tolerance.h"
#include "lisco/view_angle.h"

namespace lisco {

/// What a mask may know beforehand about a scan. It decides the speed, never the result.
struct ViewHints {
  std::array<float, 3> origin{0.0F, 0.0F, 0.0F};  ///< where the sensor stands, metres
  float azimuth_step = 0.0035F;                   ///< typical angle between columns, radians
  float elevation_step = 0.0087F;                 ///< typical angle between lasers, radians
  int steps_per_turn = 0;                         ///< columns of a whole turn; 0: unknown
  bool clockwise = false;                         ///< seen from above; of no use without steps_per_turn
  float far_distance = 1e30F;                     ///< few returns are further away horizontally, metres
};

/// The neighbour mask of a rotating scan (getNeighborMask, Algorithm 2 of the paper), on measured angles.
///
/// The paper counts sigma = ceil(asin(eps/d)/dAlpha) steps and lambda = ceil(asin(eps/d)/dTheta) lasers,
/// which holds only for ideal columns and rings. Here the view is cut into tiles by the azimuth, elevation
/// and range *measured on each return*, and a tile is about as wide as eps is seen from its range: the layer
/// of range [2^k, 2^(k+1)) * first range has tiles of asin(eps/range), down to a few columns and one laser.
/// So a mask is a handful of tiles at any range, whichever way the sensor turns and however its lasers are
/// staggered, and the seam of the rotation is no seam. Rows of tiles have as many tiles as the cosine of
/// their elevation asks for.
class ViewMask {
 public:
  /// The least size of a tile, in columns and lasers, and the most tiles around the turn and from straight down to
  /// straight up. A view with finer steps than these allow has too much in a tile to be fast.
  static constexpr double kColumnsPerTile = 4.0;
  static constexpr double kLasersPerTile = 1.0;
  static constexpr double kMostSectors = 4096.0;
  static constexpr double kMostRows = 4096.0;

  /// Lays out the tiles, and the table for about `expected_returns` returns. Keeps its memory when called again.
  void prepare(const Tolerance& tolerance, const ViewHints& hints, std::size_t expected_returns);

  std::size_t tileCount() const { return std::size_t{tile_mask_} + 1; }

  /// tiles[i] = number of the tile that the return (x[i], y[i], z[i]) lies in.
  void tilesOf(const float* x, const float* y, const float* z, std::size_t count, std::uint32_t* tiles) const;

  /// Calls visit(tile) for every tile that may hold a neighbour of any return within the box.
  template <typename Visit>
  void forEachTile(const Box& box, Visit&& visit) const;

 private:
  static constexpr float kSlicesPerFirstRange = 0.25F;
  struct Row {
    std::uint32_t first_tile;
    float sectors;  ///< number of tiles around the turn, a whole number
  };
  struct Layer {
    float near_end;  ///< in units of the first range
    std::uint32_t first_row;
    float rows;  ///< number of rows from straight down to straight up, a whole number
  };

  /// 0 for ranges (in units of the first range) below 1, then 1 more with every doubling.
  std::int32_t layerOf(float range) const {
    std::int32_t bits;
    std::memcpy(&bits, &range, sizeof bits);
    return std::clamp((bits >> 23) - 126, 0, last_layer_);
  }
  /// Slices of equal depth, from 0.
  static std::int32_t sliceOf(float range) {
    return static_cast<std::int32_t>(std::min(range * kSlicesPerFirstRange, 1e9F));
  }
  std::uint32_t slotOf(std::uint32_t tile, std::int32_t slice) const {
    return (tile + static_cast<std::uint32_t>(slice) * 40503U) & tile_mask_;
  }
  static std::uint32_t cellOf(double fraction, float cells) {
    return static_cast<std::uint32_t>(std::clamp(fraction * cells, 0.0, cells - 1.0));
  }

  std::array<float, 3> origin_{};
  double reach_ = 0.0;
  double per_first_range_ = 1.0;
  std::int32_t last_layer_ = 0;
  std::uint32_t tile_mask_ = 0;
  std::vector<Layer> layers_;
  std::vector<Row> rows_;
};

template <typename Visit>
void ViewMask::forEachTile(const Box& box, Visit&& visit) const {
  // The box as the sensor sees it: nearest and farthest distances per axis.
  std::array<float, 3> lo{};
  std::array<float, 3> hi{};
  std::array<double, 3> near{};
  std::array<double, 3> far{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    lo[axis] = box.lo[axis] - origin_[axis];
    hi[axis] = box.hi[axis] - origin_[axis];
    near[axis] = std::max(0.0F, std::max(lo[axis], -hi[axis]));
    far[axis] = std::max(std::fabs(lo[axis]), std::fabs(hi[axis]));
  }
  const double near_rho = std::sqrt(near[0] * near[0] + near[1] * near[1]);
  const double far_rho = std::sqrt(far[0] * far[0] + far[1] * far[1]);
  const double near_range = std::sqrt(near_rho * near_rho + near[2] * near[2]);
  const double far_range = std::sqrt(far_rho * far_rho + far[2] * far[2]);

  constexpr double kRangeRounding = 1e-5;
  const auto nearest =
      static_cast<float>(std::max(0.0, (near_range - reach_) * (1.0 - kRangeRounding)) * per_first_range_);
  const auto farthest =
      static_cast<float>(std::min((far_range + reach_) * (1.0 + kRangeRounding) * per_first_range_, 1e38));
  const std::int32_t first_layer = layerOf(nearest);
  const std::int32_t last_layer = layerOf(farthest);

  // lambda: the interval of elevations, or all of them where the tolerance surrounds the sensor.
  double elevation_lo = 0.0;
  double elevation_hi = 1.0;
  if (near_range > reach_) {
    const double widest = 2.0 * view_angle::widest(reach_, near_range);
    const auto elevation = [](double rho, float z) {  // quartered, so that rho stays within a float
      return static_cast<double>(view_angle::elevation(static_cast<float>(rho * 0.25), z * 0.25F));
    };
    elevation_lo = elevation(lo[2] <= 0.0F ? near_rho : far_rho, lo[2]) - widest;
    elevation_hi = elevation(hi[2] >= 0.0F ? near_rho : far_rho, hi[2]) + widest;
  }

  // sigma: the interval of azimuths, measured from the first corner; it may reach below 0 or above 1 turn.
  double azimuth_lo = 0.0;
  double azimuth_hi = 1.0;
  if (near_rho > reach_) {
    const float corner = view_angle::azimuth(lo[0], lo[1]);
    float left = 0.0F;
    float right = 0.0F;
    const auto include = [&](float other) {
      float turn = other - corner;
      turn = turn > 0.5F ? turn - 1.0F : (turn < -0.5F ? turn + 1.0F : turn);
      left = std::min(left, turn);
      right = std::max(right, turn);
    };
    include(view_angle::azimuth(lo[0], hi[1]));
    include(view_angle::azimuth(hi[0], lo[1]));
    include(view_angle::azimuth(hi[0], hi[1]));
    if (right - left < 0.499F) {  // else the box spans about half a turn, and rounding hides which half
      const double widest = view_angle::widest(reach_, near_rho);
      azimuth_lo = static_cast<double>(corner) + static_cast<double>(left) - widest;
      azimuth_hi = static_cast<double>(corner) + static_cast<double>(right) + widest;
    }
  }

  azimuth_lo += 1.0;  // now above 0, so that truncation rounds down
  azimuth_hi += 1.0;
  for (std::int32_t k = first_layer; k <= last_layer; ++k) {
    const Layer& layer = layers_[static_cast<std::size_t>(k)];
    const std::int32_t first_slice = sliceOf(k == first_layer ? nearest : layer.near_end);
    const std::int32_t last_slice = sliceOf(k == last_layer ? farthest : 2.0F * layer.near_end);
    const std::uint32_t last_row = layer.first_row + cellOf(elevation_hi, layer.rows);
    for (std::uint32_t r = layer.first_row + cellOf(elevation_lo, layer.rows); r <= last_row; ++r) {
      const Row row = rows_[r];
      const auto sectors = static_cast<std::int32_t>(row.sectors);
      const auto first = static_cast<std::int32_t>(azimuth_lo * static_cast<double>(row.sectors));
      const auto last = static_cast<std::int32_t>(azimuth_hi * static_cast<double>(row.sectors));
      const std::int32_t count = std::min(last - first + 1, sectors);
      for (std::int32_t slice = first_slice; slice <= last_slice; ++slice) {
        std::int32_t sector = first % sectors;
        for (std::int32_t i = 0; i < count; ++i) {
          visit(slotOf(row.first_tile + static_cast<std::uint32_t>(sector), slice));
          if (++sector == sectors) sector = 0;
        }
      }
    }
  }
}

}  // namespace lisco
