// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "output_file.h"

#include <unistd.h>

#include <fstream>
#include <stdexcept>
#include <system_error>

namespace lisco_apps {

namespace fs = std::filesystem;

void checkMayWrite(const fs::path& file, const std::string& signature) {
  std::error_code error;
  if (!fs::exists(file, error)) return;
  if (!fs::is_regular_file(file, error)) throw std::runtime_error(file.string() + ": is no file");
  std::string beginning(1024, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
  beginning.resize(static_cast<std::size_t>(stream.gcount()));
  if (beginning.find(signature) == std::string::npos)
    throw std::runtime_error(file.string() + ": exists and was not written by this program; choose another name");
}

void writeOwnFile(const fs::path& file, const std::string& content, const std::string& signature) {
  checkMayWrite(file, signature);
  const fs::path aside = file.string() + ".partial" + std::to_string(getpid());
  std::ofstream stream(aside, std::ios::binary);
  stream << content;
  stream.close();
  std::error_code error;
  if (stream) fs::rename(aside, file, error);
  if (!stream || error) {
    std::error_code ignored;
    fs::remove(aside, ignored);
    throw std::runtime_error(file.string() + ": cannot be written");
  }
}

}  // namespace lisco_apps
