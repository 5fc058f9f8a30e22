// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "reference/paper_lisco.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lisco_reference {
namespace {

constexpr std::size_t kArraySize = 64;  // members per array

}  // namespace

NeighborMask getNeighborMask(double distance, double eps, const NominalSensor& sensor) {
  constexpr double kEverything = 2147483648.0;
  if (!(eps <= distance)) return {static_cast<std::size_t>(kEverything), static_cast<std::size_t>(kEverything)};
  const double angle = std::fabs(std::asin(eps / distance));
  // std::min in this order turns 0 / 0 into everything.
  return {static_cast<std::size_t>(std::min(kEverything, std::ceil(angle / sensor.delta_theta))),
          static_cast<std::size_t>(std::min(kEverything, std::ceil(angle / sensor.delta_alpha)))};
}

const std::vector<std::uint32_t>& PaperLisco::cluster(const std::vector<lisco::Return>& matrix, std::size_t lasers,
                                                      const NominalSensor& sensor, float tolerance) {
  matrix_ = matrix.data();
  lasers_ = lasers;
  steps_ = matrix.size() / lasers;
  sensor_ = sensor;
  tolerance_ = lisco::Tolerance(tolerance);
  eps_ = std::fabs(tolerance);
  distance_.assign(matrix.size(), 0.0F);
  head_.assign(matrix.size(), kNoCluster);
  subclusters_.clear();
  work_ = {};

  for (std::size_t step = 0; step < steps_; ++step) receiveStep(step);

  for (Point p = 0; p < matrix.size(); ++p)
    if (distance_[p] > 0 && getH(p) == kNoCluster) head_[p] = p;
  return head_;
}

// Algorithm 3, "upon event reception of step s".
void PaperLisco::receiveStep(std::size_t step) {
  for (std::size_t laser = 0; laser < lasers_; ++laser) {
    const lisco::Return& r = matrix_[step * lasers_ + laser];
    if (!lisco::isReturn(r.x, r.y, r.z)) continue;
    // Squares of floats neither overflow nor vanish in double.
    const double x = static_cast<double>(r.x);
    const double y = static_cast<double>(r.y);
    const double z = static_cast<double>(r.z);
    distance_[step * lasers_ + laser] = static_cast<float>(std::sqrt(x * x + y * y + z * z));
  }
  for (std::size_t laser = 0; laser < lasers_; ++laser) {
    const auto p = static_cast<Point>(step * lasers_ + laser);
    if (distance_[p] > 0)
      cluster(p, getNeighborMask(static_cast<double>(distance_[p]), static_cast<double>(eps_), sensor_));
  }
}

// Algorithm 4, its loop: the steps on p's left, and, near the end of the rotation, the first ones.
void PaperLisco::cluster(Point p, const NeighborMask& mask) {
  const std::size_t p_step = p / lasers_;
  const std::size_t p_laser = p % lasers_;
  const std::size_t first_laser = p_laser - std::min(p_laser, mask.lambda);
  const std::size_t last_laser = std::min(p_laser + mask.lambda, lasers_ - 1);
  const std::size_t sigma = std::min(mask.sigma, steps_);
  constexpr float kRounding = 4e-7F;  // relative, of the distances and of PCL's comparison
  const auto reach = static_cast<float>(tolerance_.reach());
  const float max_difference = reach + kRounding * (distance_[p] + reach);
  const auto visit = [&](std::size_t step) {
    for (std::size_t laser = first_laser; laser <= last_laser; ++laser) {
      const auto other = static_cast<Point>(step * lasers_ + laser);
      if (other == p || distance_[other] == 0) continue;
      if (!(std::fabs(distance_[p] - distance_[other]) > max_difference)) compare(p, other);
    }
  };
  const std::size_t first_step = p_step - std::min(p_step, sigma);
  for (std::size_t step = first_step; step <= p_step; ++step) visit(step);
  const std::size_t around = p_step + sigma + 1 > steps_ ? p_step + sigma + 1 - steps_ : 0;
  for (std::size_t step = 0; step < std::min(around, first_step); ++step) visit(step);
}

// Algorithm 4, its four cases.
void PaperLisco::compare(Point p, Point other) {
  ++work_.pairs;
  const Head h1 = getH(p);
  const Head h2 = getH(other);
  if (h1 == h2 && h1 != kNoCluster) return;
  const lisco::Return& a = matrix_[p];
  const lisco::Return& b = matrix_[other];
  if (!(lisco::squaredDistance(a.x - b.x, a.y - b.y, a.z - b.z) < tolerance_.squared())) return;
  if (h1 == kNoCluster && h2 == kNoCluster) {
    const Head head = createH(p, other);
    setH(p, head);
    setH(other, head);
  } else if (h1 == kNoCluster) {
    setH(p, h2);
  } else if (h2 == kNoCluster) {
    setH(other, h1);
  } else {
    merge(h1, h2);
  }
}

void PaperLisco::setH(Point p, Head head) {
  head_[p] = head;
  Members& members = subclusters_[head];
  if (members.arrays.empty() || members.arrays.back().size() == kArraySize) {
    members.arrays.emplace_back();
    members.arrays.back().reserve(kArraySize);
  }
  members.arrays.back().push_back(p);
  ++members.size;
}

// The head is the point with the lower step, then laser: the order in which cells are numbered.
PaperLisco::Head PaperLisco::createH(Point p, Point other) {
  const Head head = std::min(p, other);
  subclusters_.emplace(head, Members{});
  return head;
}

void PaperLisco::merge(Head a, Head b) {
  Head base = a;
  Head merged = b;
  if (subclusters_.at(base).size < subclusters_.at(merged).size) std::swap(base, merged);
  Members& from = subclusters_.at(merged);
  Members& to = subclusters_.at(base);
  for (const auto& array : from.arrays)
    for (const Point p : array) head_[p] = base;
  to.size += from.size;
  ++work_.merges;
  work_.relabelled += from.size;
  to.arrays.splice(to.arrays.end(), from.arrays);
  subclusters_.erase(merged);
}

}  // namespace lisco_reference
