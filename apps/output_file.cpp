// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "output_file.h"

#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <system_error>

namespace lisco_apps {

namespace fs = std::filesystem;

namespace {

/// What is made aside has this and the number of its process at the end of its name.
constexpr const char* kFilePartial = ".partial";
constexpr const char* kFolderPartial = ".lisco_partial_";

/// Removes what processes that were killed have left aside: things in a folder whose names are `prefix` and the number of no
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

/// A folder that disappears again unless it is kept.
class TemporaryFolder {
 public:
  explicit TemporaryFolder(fs::path path) : path_(std::move(path)) { fs::create_directory(path_); }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// Makes a folder and those above it; unless kept, removes the ones it made.
class MadeFolder {
 public:
  explicit MadeFolder(const fs::path& path) {
    for (fs::path p = fs::absolute(path).lexically_normal(); !p.empty() && !fs::exists(p); p = p.parent_path())
      made_.push_back(p);
    fs::create_directories(path);
  }
  ~MadeFolder() {
    std::error_code ignored;
    if (!kept_)
      for (const fs::path& p : made_) fs::remove(p, ignored);  // innermost first, only if empty
  }
  MadeFolder(const MadeFolder&) = delete;
  MadeFolder& operator=(const MadeFolder&) = delete;
  void keep() { kept_ = true; }

 private:
  std::vector<fs::path> made_;
  bool kept_ = false;
};

/// Looks whether things can be made in a folder that is there.
/// \param wanted named in the error
void checkWritable(const fs::path& folder, const fs::path& wanted) {
  if (access(folder.c_str(), W_OK | X_OK) != 0)
    throw std::runtime_error(wanted.string() + ": cannot be written: " + std::generic_category().message(errno));
}

}  // namespace

void checkMayWrite(const fs::path& file, const std::string& signature) {
  std::error_code error;
  const fs::path folder = fs::absolute(file).parent_path();
  if (!fs::exists(file, error)) {
    if (!fs::is_directory(folder, error))
      throw std::runtime_error(file.string() + ": cannot be written: there is no folder " + folder.string());
    checkWritable(folder, file);
    return;
  }
  if (!fs::is_regular_file(file, error)) throw std::runtime_error(file.string() + ": is no file");
  checkWritable(folder, file);
  std::string beginning(1024, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
  beginning.resize(static_cast<std::size_t>(stream.gcount()));
  if (beginning.find(signature) == std::string::npos)
    throw std::runtime_error(file.string() + ": exists and was not written by this program; choose another name");
}

void writeOwnFile(const fs::path& file, const std::string& content, const std::string& signature) {
  checkMayWrite(file, signature);
  const fs::path aside = file.string() + kFilePartial + std::to_string(getpid());
  removeAbandoned(fs::absolute(file).parent_path(), file.filename().string() + kFilePartial);
  errno = 0;
  std::ofstream stream(aside, std::ios::binary);
  stream << content;
  stream.close();
  std::error_code error(stream ? 0 : errno, std::generic_category());
  if (stream) fs::rename(aside, file, error);
  if (!stream || error) {
    std::error_code ignored;
    fs::remove(aside, ignored);
    throw std::runtime_error(file.string() + ": cannot be written" + (error ? ": " + error.message() : ""));
  }
}

void checkMayWriteInto(const fs::path& folder, const std::vector<std::string>& names) {
  std::error_code error;
  fs::path there = fs::absolute(folder).lexically_normal();
  while (!fs::exists(there, error) && there.has_relative_path()) there = there.parent_path();
  if (!fs::is_directory(there, error))
    throw std::runtime_error(folder.string() + ": cannot be written: " + there.string() + " is no folder");
  checkWritable(there, folder);
  if (fs::exists(folder / kResultMarker)) return;
  for (const std::string& name : names)
    if (fs::exists(folder / name))
      throw std::runtime_error((folder / name).string() +
                               ": exists and was not written by this program; choose another folder");
}

void writeOwnFolder(const fs::path& folder, const std::vector<std::string>& names,
                    const std::function<void(const fs::path&)>& make, const std::function<void()>& tidy) {
  try {
    MadeFolder made(folder);
    checkMayWriteInto(folder, names);
    removeAbandoned(folder, kFolderPartial);
    const TemporaryFolder aside(folder / (kFolderPartial + std::to_string(getpid())));
    make(aside.path());
    std::ofstream marker(folder / kResultMarker);
    marker << "The results in this folder were written by lisco and may be replaced by it.\n";
    marker.close();
    if (!marker) throw std::runtime_error((folder / kResultMarker).string() + ": cannot be written");
    tidy();
    for (const std::string& name : names) {
      if (!fs::is_directory(aside.path() / name)) {
        if (fs::exists(aside.path() / name)) fs::rename(aside.path() / name, folder / name);
        continue;
      }
      fs::create_directory(folder / name);  // it may be there, with things of somebody else
      for (const auto& entry : fs::directory_iterator(aside.path() / name))
        fs::rename(entry.path(), folder / name / entry.path().filename());
    }
    made.keep();
  } catch (const fs::filesystem_error& error) {
    fs::path path = error.path2().empty() ? error.path1() : error.path2();
    if (path.filename().string().rfind(kFolderPartial, 0) == 0) path = folder;  // nobody knows the name of that one
    throw std::runtime_error(path.string() + ": cannot be written: " + error.code().message());
  }
}

}  // namespace lisco_apps
