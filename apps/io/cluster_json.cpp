// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "io/cluster_json.h"

#include <array>
#include <cmath>

#include "io/point_geometry.h"

namespace lisco_apps {
namespace {

template <typename Number>
Json jsonOf(const std::array<Number, 3>& point) {
  Json json = Json::array();
  for (const Number value : point) json.push_back(rounded(static_cast<double>(value), kPerMetre));
  return json;
}

}  // namespace

double rounded(double value, double per_unit) {
  const double scaled = std::round(value * per_unit);
  return std::isfinite(scaled) ? scaled / per_unit + 0. : value;
}

double yawDegrees(const lisco::OrientedBox& box) {
  return box.yaw * 180 / kPi;
}

std::string lineOf(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

void addFeatures(Json& json, const lisco::ClusterFeatures& features) {
  const lisco::OrientedBox& box = features.box;
  json["size"] = features.size;
  json["centroid"] = jsonOf(features.centroid);
  json["box"] = {{"min", jsonOf(features.min)}, {"max", jsonOf(features.max)}};
  json["oriented_box"] = {{"center", jsonOf(box.center)},
                          {"yaw", rounded(yawDegrees(box), kPerDegree)},
                          {"length", rounded(box.length, kPerMetre)},
                          {"width", rounded(box.width, kPerMetre)},
                          {"height", rounded(box.height, kPerMetre)}};
  json["nearest_range"] = rounded(features.nearest_range, kPerMetre);
  json["density"] = rounded(features.density, kPerMetre);
}

}  // namespace lisco_apps
