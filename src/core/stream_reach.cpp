// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/stream_reach.h"

#include <algorithm>
#include <cmath>

#include "core/pi.h"

namespace lisco {

namespace {

// Horizontal distances, metres, between which squares neither underflow nor overflow a float.
constexpr float kMinFloatRho = 1e-18F;
constexpr float kMaxFloatRho = 1e18F;

}  // namespace

void StreamReach::begin(const EndlessParameters& parameters) {
  tolerance_ = Tolerance(parameters.tolerance);
  origin_ = parameters.origin;
  start_azimuth_ = parameters.start_azimuth;
  direction_ = parameters.clockwise ? -1 : 1;
  constexpr double kCosineRounding = 1e-6;
  const double cosine = std::cos(parameters.stagger) - kCosineRounding;
  cos_stagger_ = static_cast<float>(cosine);
  turns_of_stagger_ = 2 * (std::acos(cosine - kCosineRounding) / (2 * kPi));
  constexpr double kUnderflow = 1e-22;  // metres, as in Tolerance::reach ()
  near_rho_ = std::sqrt(static_cast<double>(tolerance_.squared())) * (1 + kNearMargin) + kUnderflow;
}

double StreamReach::azimuthOf(double turns) const {
  return start_azimuth_ + direction_ * 2 * kPi * turns;
}

void StreamReach::setColumn(std::size_t column, double position) {
  const double azimuth = azimuthOf(position - std::floor(position));
  cosines_[column] = static_cast<float>(std::cos(azimuth));
  sines_[column] = static_cast<float>(std::sin(azimuth));
}

ColumnBits StreamReach::findOutliers(const RingBlock& block, const RingBlockInfo& info, double* rho) const {
  ColumnBits outliers = 0;
  forEachBit(info.returns, [&](std::size_t i) {
    const float x = block.x[RingBlock::kMargin + i];
    const float y = block.y[RingBlock::kMargin + i];
    bool is_inlier;
    if (info.rho[i] > kMinFloatRho && info.rho[i] < kMaxFloatRho) {
      rho[i] = static_cast<double>(info.rho[i]);
      is_inlier = (x - origin_[0]) * cosines_[i] + (y - origin_[1]) * sines_[i] >= cos_stagger_ * info.rho[i];
    } else {
      const double east = static_cast<double>(x) - static_cast<double>(origin_[0]);
      const double north = static_cast<double>(y) - static_cast<double>(origin_[1]);
      rho[i] = std::hypot(east, north);
      is_inlier = east * static_cast<double>(cosines_[i]) + north * static_cast<double>(sines_[i]) >=
                  static_cast<double>(cos_stagger_) * rho[i];
    }
    if (!is_inlier) outliers |= ColumnBits{1} << i;
  });
  return outliers;
}

Ticks StreamReach::endOf(Ticks column, std::int64_t pane, double rho, Ticks known) const {
  const Ticks latest = (pane + kComparablePanes) * kTicksPerPane;
  if (!(rho > near_rho_)) return latest;
  constexpr double kRhoRounding = 1 + 1e-6;
  constexpr double kRadiansToTicks = static_cast<double>(kTicksPerTurn) / (2 * kPi);
  const double sine = std::min(tolerance_.reach() * kRhoRounding / rho, 1.0);
  const double stagger = turns_of_stagger_ * static_cast<double>(kTicksPerTurn);
  const auto end = [&](double asine) {
    // The column's position was rounded down by less than a tick.
    return std::min(column + 1 + static_cast<Ticks>(std::ceil(stagger + asine * kRadiansToTicks)), latest);
  };
  // asin (t) <= t + (pi / 2 - 1) t^3 for t in 0..1
  if (end(sine + (kPi / 2 - 1) * sine * sine * sine) <= known) return known;
  return std::max(known, end(std::asin(sine)));
}

StreamReach::Ray StreamReach::rayAfter(std::int64_t pane) const {
  const double azimuth =
      azimuthOf(static_cast<double>(paneInTurn(pane + 1)) / static_cast<double>(kPanesPerTurn) + turns_of_stagger_ / 2);
  return {{-direction_ * std::sin(azimuth), direction_ * std::cos(azimuth)}};
}

bool StreamReach::reaches(const Box& box, const Ray& ray) const {
  double least = 0;
  double largest = 0;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double origin = static_cast<double>(origin_[axis]);
    const double lo = static_cast<double>(box.lo[axis]) - origin;
    const double hi = static_cast<double>(box.hi[axis]) - origin;
    least += std::min(ray.across[axis] * lo, ray.across[axis] * hi);
    largest = std::max({largest, std::fabs(lo), std::fabs(hi)});
  }
  constexpr double kRounding = 1e-5;
  return !(least > tolerance_.reach() * (1 + kRounding) + largest * kRounding);
}

}  // namespace lisco
