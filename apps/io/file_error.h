// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <filesystem>
#include <stdexcept>
#include <string>

namespace lisco_apps {

/// Throws the one-line error of a file or folder.
[[noreturn]] inline void fail(const std::filesystem::path& file, const std::string& what) {
  throw std::runtime_error(file.string() + ": " + what);
}

}  // namespace lisco_apps
