// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "sensors/rotation_cutter.h"

#include <algorithm>
#include <cmath>

namespace lisco_apps {
namespace {

constexpr std::int64_t kDegree = 1000000;
constexpr std::int64_t kTurn = 360 * kDegree;
constexpr std::int64_t kMaxStepBack = 10 * kDegree;
constexpr std::int64_t kMaxDriftStep = kDegree;  ///< change of the drift by one column
constexpr std::int64_t kMaxDrift = 20 * kDegree;

std::int64_t angleOf(double degrees) {
  return std::llround(std::fmod(degrees, 360.) * static_cast<double>(kDegree));
}
/// 0 <= angle < a turn
std::int64_t wrapped(std::int64_t angle) {
  return (angle % kTurn + kTurn) % kTurn;
}

}  // namespace

RotationCutter::RotationCutter(std::optional<double> cut) {
  if (cut) cut_ = angleOf(*cut);
}

void RotationCutter::placeFromCut(Angle azimuth) {
  turned_ = wrapped(azimuth - *cut_);
  if (!isClockwise() && turned_ > 0) turned_ -= kTurn;
}

bool RotationCutter::startsRotation(double azimuth, bool after_break) {
  const Angle now = angleOf(azimuth);
  const Angle ahead = wrapped(now - last_);
  last_ = now;
  if (!started_ || after_break) {
    started_ = true;
    if (!cut_) cut_ = now;
    placeFromCut(now);
    return true;
  }
  const Angle shorter_way = ahead > kTurn / 2 ? ahead - kTurn : ahead;
  const bool was_clockwise = isClockwise();
  drift_ = std::clamp(drift_ + std::clamp(shorter_way, -kMaxDriftStep, kMaxDriftStep), -kMaxDrift, kMaxDrift);
  if (isClockwise())
    turned_ += ahead > kTurn - kMaxStepBack ? ahead - kTurn : ahead;
  else
    turned_ += ahead < kMaxStepBack ? ahead : ahead - kTurn;
  if (isClockwise() != was_clockwise && (was_clockwise ? turned_ > 0 : turned_ < 0))
    turned_ += was_clockwise ? -kTurn : kTurn;
  if (std::abs(turned_) < kTurn) return false;
  turned_ += turned_ > 0 ? -kTurn : kTurn;
  return true;
}

}  // namespace lisco_apps
