// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "io/cloud_file.h"

namespace lisco_benchmarks {

/// The whole rotations of a capture, the first ones, organized: a row per laser from top to bottom.
/// \param model as makeVelodyneModel takes it
/// \param most the number of rotations
/// \param overlap first columns of the next rotation that follow each, as a share of its own columns
/// \throws std::runtime_error with one line if the file cannot be read or holds no whole rotation
std::vector<lisco_apps::Cloud::Ptr> readRotations(const std::filesystem::path& file, const std::string& model,
                                                  std::size_t most, double overlap = 0);

}  // namespace lisco_benchmarks
