// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <fstream>
#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "io/text.h"

namespace lisco_apps {

inline constexpr const char* kClusterProgram = "lisco_cluster";  ///< whose results are no scans

/// The files that a program has written into a folder, by their paths there.
std::set<std::string> ownFilesIn(const fs::path& folder, const std::string& program);

/// Checks that a file may be written: its folder exists and is writable, and the file does not exist or was written by
/// these programs.
/// \param signature text near the beginning of every file of this kind that these programs write
/// \throws std::runtime_error with one line: why not
void checkMayWrite(const fs::path& file, const std::string& signature);

/// Throws std::runtime_error with one line: that a file cannot be written, and what errno says of it if it is not 0.
[[noreturn]] void failToWrite(const fs::path& file);

/// Writes a file, all or nothing: beside its place first, moved there by finish (). Makes no folders. All functions
/// throw std::runtime_error with one line if the file cannot be written.
class OwnFile {
 public:
  /// Checks as checkMayWrite () does.
  OwnFile(const fs::path& file, const std::string& signature);
  /// Removes the file, if finish () has not been called.
  ~OwnFile();
  OwnFile(const OwnFile&) = delete;
  OwnFile& operator=(const OwnFile&) = delete;

  void write(std::string_view content);
  void finish();

 private:
  [[noreturn]] void refuse() const;

  fs::path file_, aside_;
  std::ofstream stream_;
};

/// Writes an OwnFile at once.
/// \param content must hold `signature` within its first kilobyte
void writeOwnFile(const fs::path& file, const std::string& content, const std::string& signature);

/// Makes a folder and those above it; removes those of them that are still empty at its end.
class MadeFolders {
 public:
  /// \param folder empty: none
  /// \throws std::runtime_error with one line if it cannot be made
  explicit MadeFolders(const fs::path& folder);
  ~MadeFolders() { removeEmpty(); }
  MadeFolders(const MadeFolders&) = delete;
  MadeFolders& operator=(const MadeFolders&) = delete;

 private:
  void removeEmpty() const;

  std::vector<fs::path> made_;  ///< innermost first
};

/// Checks that files of these names, or folders of files, may be written into a folder: the program has written those
/// that are there, or the folder can be made.
/// \param names may be empty: checks the folder only
/// \throws std::runtime_error with one line that names what would be overwritten, is no folder, or is not writable
void checkMayWriteInto(const fs::path& folder, const std::string& program, const std::vector<std::string>& names);

/// Writes files and folders of files into a folder, all or nothing: they are made aside and moved into place at the
/// end. Makes the folder and those above it, and removes them again on failure. Checks as checkMayWriteInto () does.
/// Removes what the program has written there before. A hidden file lists what it has written.
/// \param make writes all, or some, of `names` into the folder it is given
/// \throws std::runtime_error with one line: what cannot be written
void writeOwnFolder(const fs::path& folder, const std::string& program, const std::vector<std::string>& names,
                    const std::function<void(const fs::path& aside)>& make);

/// The files of a folder whose names begin with `prefix` and have this ending.
/// \throws fs::filesystem_error if it cannot be read
std::vector<fs::path> filesIn(const fs::path& folder, const std::string& prefix, const std::string& ending);

/// A field of a PCD that holds one value.
struct PcdField {
  const char* name;
  char type;  ///< F, U or I
  int bytes;
};

/// The header of an organized binary PCD.
/// \param comment first line, begins with '#'
std::string pcdHeader(const std::string& comment, const std::vector<PcdField>& fields, std::size_t columns,
                      std::size_t rows);

}  // namespace lisco_apps
