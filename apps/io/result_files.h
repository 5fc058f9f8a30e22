// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include "io/clusters.h"
#include "io/text.h"

namespace lisco_apps {

/// What writeResults () writes.
struct ResultKinds {
  bool labels = true;          ///< labels.pcd
  bool table = true;           ///< clusters.csv
  bool pictures = true;        ///< range_image.png and top_view.png
  bool view = true;            ///< view.html, a page for browsers
  bool clouds = false;         ///< clusters/cluster_0001.pcd and so on, largest first, with all fields of the input
  bool json = false;           ///< clusters.json
  bool semantickitti = false;  ///< labels.label and labels.npy
};

/// Reads a list such as "labels,table". \throws std::runtime_error with one line if a kind is unknown, or none is given
ResultKinds resultKindsOf(const std::string& text);

/// Writes results into a folder, all or nothing; replaces the files of an earlier run, removes those that are not asked
/// for now, and refuses to replace any other file of these names, see writeOwnFolder ().
/// - labels.pcd: all fields of the input, organized as it is, and the field `label` (uint32): the cluster's id, 0 in
///   none. Where ground was looked for, also `ground` (uint8): 1 for returns left out as ground, else 0. Fields `label`
///   and `ground` of the input are written as `input_label` and `input_ground`.
/// - clusters.csv: a row per cluster.
/// - clusters.json: jsonOf ().
/// - labels.label: SemanticKITTI's labels, a uint32 per point of the input: the id in the upper 16 bits (instance), in
///   the lower ones the class, 49 (other-ground) for returns left out as ground, else 0 (unlabelled). labels.npy: the
///   labels of labels.pcd, uint32, in the input's shape.
/// \return a line on what is left out because the format cannot hold it; empty if nothing is
/// \throws std::runtime_error with one line on what cannot be written, or would be overwritten
std::string writeResults(const ClusteredScan& scan, const fs::path& folder, const ResultKinds& kinds);

/// The scan and its clusters as an object of JSON: scan, rows, columns, returns, ignored, ground, clustered, tolerance,
/// min_size, max_size (if there is a limit), noise, clusters (each with id, see addFeatures ()).
nlohmann::ordered_json jsonOf(const ClusteredScan& scan);

}  // namespace lisco_apps
