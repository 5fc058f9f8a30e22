// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "recordings/bytes.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace lisco_apps {

BinaryFile::BinaryFile(const fs::path& file) : path_(file), descriptor_(open(file.c_str(), O_RDONLY | O_CLOEXEC)) {
  if (descriptor_ < 0) fail(file, "cannot be read: " + std::string(std::strerror(errno)));
  struct stat about {};
  if (fstat(descriptor_, &about) != 0 || !S_ISREG(about.st_mode)) {
    close(descriptor_);
    fail(file, "is no file");
  }
  size_ = static_cast<std::uint64_t>(about.st_size);
}

BinaryFile::~BinaryFile() {
  close(descriptor_);
}

void BinaryFile::read(std::uint64_t from, std::size_t count, std::uint8_t* into) const {
  if (from > size_ || count > size_ - from) throw Broken("the file ends within a record");
  while (count > 0) {
    const ssize_t got = pread(descriptor_, into, count, static_cast<off_t>(from));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) throw Broken(got < 0 ? std::strerror(errno) : "the file ends within a record");
    from += static_cast<std::uint64_t>(got);
    into += got;
    count -= static_cast<std::size_t>(got);
  }
}

void BinaryFile::read(std::uint64_t from, std::size_t count, std::vector<std::uint8_t>& into) const {
  if (from > size_ || count > size_ - from) throw Broken("the file ends within a record");
  into.resize(count);
  read(from, count, into.data());
}

std::string breakLine(const fs::path& file, std::uint64_t at, const std::string& why) {
  return file.string() + ": breaks off at byte " + std::to_string(at) + ": " + why;
}

}  // namespace lisco_apps
