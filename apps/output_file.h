// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace lisco_apps {

/// Name of the file by which a folder with results of these programs is known.
inline constexpr const char* kResultMarker = ".lisco_results";

/// Looks whether a file may be written: its folder is there and may be written to, and the file does not exist, or these
/// programs have written it.
/// \param signature what a file of this kind has near its beginning if these programs have written it
/// \throws std::runtime_error with one line if it exists and was written by somebody else, or is no file, or has no
/// folder, or one that may not be written to
void checkMayWrite(const std::filesystem::path& file, const std::string& signature);

/// Writes a file, all or nothing: beside its place first, then moved there. Checks as checkMayWrite () does. Folders
/// are not made.
/// \param content must hold `signature` within its first kilobyte
/// \throws std::runtime_error with one line that says why it cannot be written
void writeOwnFile(const std::filesystem::path& file, const std::string& content, const std::string& signature);

/// Looks whether things of these names may be written into a folder: these programs have written there before, or it
/// has nothing of these names, or can be made.
/// \throws std::runtime_error with one line that names what would be overwritten, what is no folder, or which one may not
/// be written to
void checkMayWriteInto(const std::filesystem::path& folder, const std::vector<std::string>& names);

/// Writes files and folders of files into a folder, all or nothing: they are made aside and moved into place at the
/// end. The folder and those above it are made, and gone again if this fails. Checks as checkMayWriteInto () does.
/// \param make writes all, or some, of `names` into the folder it is given
/// \param tidy called before things are moved into place, to remove what an earlier run has left
/// \throws std::runtime_error with one line that says what cannot be written
void writeOwnFolder(
    const std::filesystem::path& folder, const std::vector<std::string>& names,
    const std::function<void(const std::filesystem::path& aside)>& make, const std::function<void()>& tidy = [] {});

}  // namespace lisco_apps
