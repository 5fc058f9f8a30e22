// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>

namespace lisco_test {

/// A file of this process, in memory where possible; removed with the object.
class ScratchFile {
 public:
  explicit ScratchFile(const std::string& ending) {
    const std::filesystem::path memory = "/dev/shm";
    const std::filesystem::path folder =
        std::filesystem::exists(memory) ? memory : std::filesystem::temp_directory_path();
    path_ = folder / ("lisco_fuzz_" + std::to_string(getpid()) + ending);
  }
  ~ScratchFile() { std::remove(path_.c_str()); }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;

  const std::filesystem::path& holding(const std::uint8_t* data, std::size_t size) const {
    if (std::FILE* const file = std::fopen(path_.c_str(), "wb")) {
      std::fwrite(data, 1, size, file);
      std::fclose(file);
    }
    return path_;
  }

 private:
  std::filesystem::path path_;
};

}  // namespace lisco_test
