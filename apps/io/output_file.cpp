// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "io/output_file.h"

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <system_error>
#include <utility>

#include <boost/algorithm/string/replace.hpp>

#include "io/text.h"

namespace lisco_apps {

namespace {

// Names of files and folders made aside end with these and the number of the process that makes them.
constexpr const char* kFilePartial = ".partial";
constexpr const char* kFolderPartial = ".lisco_partial_";
constexpr std::size_t kSignatureBytes = 1024;  ///< the beginning of a file, which holds its signature

/// Removes the leftovers of killed processes: entries of a folder whose names are `prefix` and the number of no running
/// process.
void removeAbandoned(const fs::path& folder, const std::string& prefix) {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.size() <= prefix.size() || name.compare(0, prefix.size(), prefix) != 0) continue;
    char* end = nullptr;
    const long process = std::strtol(name.c_str() + prefix.size(), &end, 10);
    if (*end == '\0' && process > 0 && kill(static_cast<pid_t>(process), 0) != 0 && errno == ESRCH)
      fs::remove_all(entry.path(), ignored);
  }
}

/// The hidden file that lists what the programs have written into a folder: after a line for people, in each line a
/// program, a blank, and a file's path in the folder.
constexpr const char* kList = ".lisco_results";
using Listed = std::pair<std::string, std::string>;  ///< program and file

std::set<Listed> listedIn(const fs::path& folder) {
  std::set<Listed> listed;
  std::ifstream stream(folder / kList);
  std::string line;
  std::getline(stream, line);
  while (std::getline(stream, line)) {
    const std::size_t blank = line.find(' ');
    if (blank == std::string::npos) continue;
    const fs::path file = line.substr(blank + 1);
    // Others may have made the list: no path leads out of the folder, or to itself.
    const bool is_below = !file.empty() && std::all_of(file.begin(), file.end(), [](const fs::path& name) {
      return name != "/" && name != "." && name != ".." && !name.empty();
    });
    if (!is_below) continue;
    listed.emplace(line.substr(0, blank), file.string());
  }
  return listed;
}

void writeList(const fs::path& file, const std::set<Listed>& listed) {
  std::ofstream stream(file);
  stream << "The programs have written these files, and may replace or remove them:\n";
  for (const auto& [program, name] : listed) stream << program << ' ' << name << '\n';
  stream.close();
  if (!stream) failToWrite(file);
}

std::set<std::string> filesOf(const std::string& program, const std::set<Listed>& listed) {
  std::set<std::string> files;
  for (const auto& [owner, file] : listed)
    if (owner == program) files.insert(file);
  return files;
}

/// The paths of files in a folder and the folders in it.
std::vector<std::string> filesBelow(const fs::path& folder) {
  std::vector<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (!entry.is_directory()) files.push_back(entry.path().lexically_relative(folder).generic_string());
  std::sort(files.begin(), files.end());
  return files;
}

/// Checks that entries can be made in an existing folder.
/// \param wanted named in the error
void checkWritable(const fs::path& folder, const fs::path& wanted) {
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    fail(wanted, "cannot be written: " + std::generic_category().message(errno));
}

}  // namespace

void checkMayWrite(const fs::path& file, const std::string& signature) {
  std::error_code error;
  const fs::path folder = fs::absolute(file).parent_path();
  if (!fs::exists(file, error)) {
    if (!fs::is_directory(folder, error)) fail(file, "cannot be written: there is no folder " + folder.string());
    checkWritable(folder, file);
    return;
  }
  if (!fs::is_regular_file(file, error)) fail(file, "is no file");
  checkWritable(folder, file);
  std::string beginning(kSignatureBytes, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
  beginning.resize(static_cast<std::size_t>(stream.gcount()));
  if (beginning.find(signature) == std::string::npos)
    fail(file, "exists and was not written by this program; choose another name");
}

void failToWrite(const fs::path& file) {
  fail(file, "cannot be written" + (errno != 0 ? ": " + std::generic_category().message(errno) : ""));
}

OwnFile::OwnFile(const fs::path& file, const std::string& signature)
    : file_(file), aside_(file.string() + kFilePartial + std::to_string(getpid())) {
  checkMayWrite(file, signature);
  removeAbandoned(fs::absolute(file).parent_path(), file.filename().string() + kFilePartial);
  errno = 0;
  stream_.open(aside_, std::ios::binary);
  if (!stream_) refuse();
}

OwnFile::~OwnFile() {
  if (aside_.empty()) return;
  stream_.close();
  std::error_code ignored;
  fs::remove(aside_, ignored);
}

void OwnFile::refuse() const {
  failToWrite(file_);
}

void OwnFile::write(std::string_view content) {
  errno = 0;
  if (!stream_.write(content.data(), static_cast<std::streamsize>(content.size()))) refuse();
}

void OwnFile::finish() {
  errno = 0;
  stream_.close();
  if (!stream_) refuse();
  std::error_code error;
  fs::rename(aside_, file_, error);
  if (error) fail(file_, "cannot be written: " + error.message());
  aside_.clear();
}

void writeOwnFile(const fs::path& file, const std::string& content, const std::string& signature) {
  OwnFile own(file, signature);
  own.write(content);
  own.finish();
}

MadeFolders::MadeFolders(const fs::path& folder) {
  if (folder.empty()) return;
  std::error_code error;
  for (fs::path p = fs::absolute(folder).lexically_normal(); fs::status(p, error).type() == fs::file_type::not_found;
       p = p.parent_path())
    made_.push_back(p);
  fs::create_directories(folder, error);
  if (!error) return;
  removeEmpty();
  fail(folder, "cannot be written: " + error.message());
}

void MadeFolders::removeEmpty() const {
  std::error_code ignored;
  for (const fs::path& folder : made_) fs::remove(folder, ignored);  // only if empty
}

std::set<std::string> ownFilesIn(const fs::path& folder, const std::string& program) {
  return filesOf(program, listedIn(folder));
}

void checkMayWriteInto(const fs::path& folder, const std::string& program, const std::vector<std::string>& names) {
  std::error_code error;
  fs::path existing = fs::absolute(folder).lexically_normal();
  while (!fs::exists(existing, error) && existing.has_relative_path()) existing = existing.parent_path();
  if (!fs::is_directory(existing, error)) fail(folder, "cannot be written: " + existing.string() + " is no folder");
  checkWritable(existing, folder);
  const std::set<std::string> own = ownFilesIn(folder, program);
  for (const std::string& name : names) {
    const auto first_in = own.lower_bound(name + "/");
    const bool is_own = own.count(name) > 0 || (first_in != own.end() && first_in->rfind(name + "/", 0) == 0);
    const bool is_empty_folder = fs::is_directory(folder / name) && fs::is_empty(folder / name);
    if (!is_own && !is_empty_folder && fs::exists(folder / name))
      fail(folder / name, "exists and was not written by this program; choose another folder");
  }
}

void writeOwnFolder(const fs::path& folder, const std::string& program, const std::vector<std::string>& names,
                    const std::function<void(const fs::path&)>& make) {
  std::error_code ignored;
  const MadeFolders made(folder);
  const fs::path aside = folder / (kFolderPartial + std::to_string(getpid()));
  const auto undo = [&] { fs::remove_all(aside, ignored); };
  try {
    checkMayWriteInto(folder, program, names);
    removeAbandoned(folder, kFolderPartial);
    fs::create_directory(aside);
    make(aside);
    const std::vector<std::string> files = filesBelow(aside);
    checkMayWriteInto(folder, program, files);
    std::set<Listed> listed = listedIn(folder);
    const std::set<std::string> before = filesOf(program, listed);
    for (const std::string& file : before) listed.erase({program, file});
    for (const std::string& file : files) listed.insert({program, file});
    writeList(aside / kList, listed);
    for (const std::string& file : before) {
      fs::remove(folder / file);
      fs::remove((folder / file).parent_path(), ignored);  // a folder of files, if it is empty
    }
    fs::rename(aside / kList, folder / kList);
    for (const std::string& file : files) {
      fs::create_directories((folder / file).parent_path());
      fs::rename(aside / file, folder / file);
    }
    fs::remove_all(aside, ignored);
  } catch (const fs::filesystem_error& error) {
    undo();
    fs::path path = error.path2().empty() ? error.path1() : error.path2();
    if (path.filename().string().rfind(kFolderPartial, 0) == 0) path = folder;  // the user's name for it
    fail(path, "cannot be written: " + error.code().message());
  } catch (const std::runtime_error& error) {
    undo();
    const std::string partial = (aside / "").string();
    const std::string named = (folder / "").string();
    throw std::runtime_error(boost::replace_all_copy(std::string(error.what()), partial, named));  // likewise
  } catch (...) {
    undo();
    throw;
  }
}

std::vector<fs::path> filesIn(const fs::path& folder, const std::string& prefix, const std::string& ending) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().filename().string().rfind(prefix, 0) == 0 && entry.path().extension() == ending)
      files.push_back(entry.path());
  return files;
}

std::string pcdHeader(const std::string& comment, const std::vector<PcdField>& fields, std::size_t columns,
                      std::size_t rows) {
  std::string names = "\nFIELDS", sizes = "\nSIZE", types = "\nTYPE", counts = "\nCOUNT";
  for (const PcdField& field : fields) {
    names += std::string(" ") + field.name;
    sizes += " " + std::to_string(field.bytes);
    types += std::string(" ") + field.type;
    counts += " 1";
  }
  return comment + "\n# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7" + names + sizes + types + counts +
         "\nWIDTH " + std::to_string(columns) + "\nHEIGHT " + std::to_string(rows) +
         "\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + std::to_string(columns * rows) + "\nDATA binary\n";
}

}  // namespace lisco_apps
