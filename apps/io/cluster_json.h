// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "lisco/cluster_features.h"

namespace lisco_apps {

using Json = nlohmann::ordered_json;

/// Rounded to 1 / per_unit, without a negative zero.
double rounded(double value, double per_unit);
constexpr double kPerMetre = 1e4, kPerDegree = 1e3;

/// Degrees counterclockwise from the x axis, -90 to 90, as tables and JSON give the yaw.
double yawDegrees(const lisco::OrientedBox& box);

/// Adds size, centroid, box (min and max), oriented_box (center, yaw, length, width, height), nearest_range and density
/// to an object. Metres, degrees.
void addFeatures(Json& json, const lisco::ClusterFeatures& features);

/// The JSON on one line. Replaces bytes (of file names) that are not UTF-8.
std::string lineOf(const Json& json);

}  // namespace lisco_apps
