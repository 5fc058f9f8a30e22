// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <filesystem>
#include <string>

namespace lisco_apps {

/// Looks whether a file may be written: it does not exist, or these programs have written it.
/// \param signature what a file of this kind has near its beginning if these programs have written it
/// \throws std::runtime_error with one line if it exists and was written by somebody else, or is no file
void checkMayWrite(const std::filesystem::path& file, const std::string& signature);

/// Writes a file, all or nothing: beside its place first, then moved there. Checks as checkMayWrite () does. Folders
/// are not made.
/// \param content must hold `signature` within its first kilobyte
/// \throws std::runtime_error with one line that says why it cannot be written
void writeOwnFile(const std::filesystem::path& file, const std::string& content, const std::string& signature);

}  // namespace lisco_apps
