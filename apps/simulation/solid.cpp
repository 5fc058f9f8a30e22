// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "simulation/solid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lisco_simulation {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Interval kEmpty{kInfinity, -kInfinity};

}  // namespace

Solid Solid::block(const Rectangle& bottom, const Rectangle& top) {
  Solid solid;
  solid.addPlane({0, 0, -1}, {0, 0, bottom.z});
  solid.addPlane({0, 0, 1}, {0, 0, top.z});
  const double height = top.z - bottom.z;
  // The normal of a side is perpendicular to its horizontal edge and to its slope.
  solid.addPlane({height, 0, bottom.front - top.front}, {bottom.front, 0, bottom.z});
  solid.addPlane({-height, 0, top.back - bottom.back}, {bottom.back, 0, bottom.z});
  solid.addPlane({0, height, bottom.left - top.left}, {0, bottom.left, bottom.z});
  solid.addPlane({0, -height, top.right - bottom.right}, {0, bottom.right, bottom.z});

  const Vector low{std::min(bottom.back, top.back), std::min(bottom.right, top.right), bottom.z};
  const Vector high{std::max(bottom.front, top.front), std::max(bottom.left, top.left), top.z};
  solid.bounds_ = {0.5 * (low + high), 0.5 * length(high - low)};
  return solid;
}

Solid Solid::box(const Vector& low, const Vector& high) {
  return block({low.x, high.x, low.y, high.y, low.z}, {low.x, high.x, low.y, high.y, high.z});
}

Solid Solid::cylinder(const Vector& from, const Vector& to, double radius) {
  Solid solid;
  const double whole = length(to - from);
  const Vector axis = (1 / whole) * (to - from);
  const Vector aside = std::fabs(axis.z) < 0.9 ? Vector{0, 0, 1} : Vector{1, 0, 0};
  const Vector first = cross(axis, aside);
  const Vector row = (1 / (radius * length(first))) * first;
  solid.rows_ = {row, cross(axis, row)};
  solid.centre_ = 0.5 * (from + to);
  solid.addPlane(axis, to);
  solid.addPlane(-1 * axis, from);
  solid.bounds_ = {solid.centre_, std::hypot(whole / 2, radius)};
  return solid;
}

Solid Solid::ellipsoid(const Vector& centre, const Vector& radii) {
  Solid solid;
  solid.rows_ = {{1 / radii.x, 0, 0}, {0, 1 / radii.y, 0}, {0, 0, 1 / radii.z}};
  solid.centre_ = centre;
  solid.bounds_ = {centre, std::max({radii.x, radii.y, radii.z})};
  return solid;
}

Solid Solid::ofLeaves(double mean_depth) const {
  Solid solid = *this;
  solid.mean_depth_ = mean_depth;
  return solid;
}

Solid Solid::rotated(double angle) const {
  Solid solid = *this;
  for (Vector& row : solid.rows_) row = lisco_simulation::rotated(row, angle);
  solid.centre_ = lisco_simulation::rotated(centre_, angle);
  for (Plane& plane : solid.planes_) plane.normal = lisco_simulation::rotated(plane.normal, angle);
  solid.bounds_.centre = lisco_simulation::rotated(bounds_.centre, angle);
  return solid;
}

Solid Solid::moved(const Vector& by) const {
  Solid solid = *this;
  solid.centre_ = centre_ + by;
  for (Plane& plane : solid.planes_) plane.limit += dot(plane.normal, by);
  solid.bounds_.centre = bounds_.centre + by;
  return solid;
}

Solid Solid::sheared(const Vector& slope) const {
  Solid solid = *this;
  const auto lifted = [&slope](const Vector& place) {
    return Vector{place.x, place.y, place.z + slope.x * place.x + slope.y * place.y};
  };
  // A normal n of the positions p is n - n.z * slope of the lifted ones.
  const auto against = [&slope](const Vector& normal) {
    return Vector{normal.x - normal.z * slope.x, normal.y - normal.z * slope.y, normal.z};
  };
  for (Vector& row : solid.rows_) row = against(row);
  solid.centre_ = lifted(centre_);
  for (Plane& plane : solid.planes_) {
    const Vector normal = against(plane.normal);
    const double scale = 1 / length(normal);
    plane = {scale * normal, scale * plane.limit};
  }
  solid.bounds_ = {lifted(bounds_.centre), (1 + std::hypot(slope.x, slope.y)) * bounds_.radius};
  return solid;
}

Interval Solid::along(const Vector& direction, const Vector& from) const {
  Interval inside{-kInfinity, kInfinity};
  for (const Plane& plane : planes_) {
    const double towards = dot(plane.normal, direction);
    const double limit = plane.limit - dot(plane.normal, from);
    if (towards == 0) {
      if (limit < 0) return kEmpty;
    } else if (towards > 0) {
      inside.leave = std::min(inside.leave, limit / towards);
    } else {
      inside.enter = std::max(inside.enter, limit / towards);
    }
  }
  if (inside.enter > inside.leave || rows_.empty()) return inside;

  // |A (from + t direction - centre)|^2 <= 1, that is a t^2 - 2 b t + c <= 0.
  double a = 0;
  double b = 0;
  double c = -1;
  for (const Vector& row : rows_) {
    const double along_row = dot(row, direction);
    const double centre = dot(row, centre_ - from);
    a += along_row * along_row;
    b += along_row * centre;
    c += centre * centre;
  }
  const double discriminant = b * b - a * c;
  if (discriminant < 0) return kEmpty;
  if (a == 0) return c <= 0 ? inside : kEmpty;  // along the axis of a cylinder
  const double half = std::sqrt(discriminant);
  return {std::max(inside.enter, (b - half) / a), std::min(inside.leave, (b + half) / a)};
}

bool Solid::contains(const Vector& place, double margin) const {
  for (const Plane& plane : planes_)
    if (dot(plane.normal, place) > plane.limit + margin) return false;
  double square = 0;
  double steepest = 0;
  for (const Vector& row : rows_) {
    const double across = dot(row, place - centre_);
    square += across * across;
    steepest = std::max(steepest, length(row));
  }
  return std::sqrt(square) <= 1 + margin * steepest;
}

void Solid::addPlane(const Vector& normal, const Vector& through) {
  const Vector unit = (1 / length(normal)) * normal;
  planes_.push_back({unit, dot(unit, through)});
}

}  // namespace lisco_simulation
