// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include <boost/endian/conversion.hpp>

#include "io/text.h"

namespace lisco_apps {

/// Content that breaks its format; what () is the reason, without the file's name.
struct Broken : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Little-endian numbers of any alignment, one after the other. \throws Broken beyond the end
class ByteCursor {
 public:
  ByteCursor(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}

  template <typename Number>
  Number number() {
    return boost::endian::endian_load<Number, sizeof(Number), boost::endian::order::little>(bytes(sizeof(Number)));
  }
  const std::uint8_t* bytes(std::size_t count) {
    if (count > left_) throw Broken("a field reaches beyond its record");
    const std::uint8_t* const from = data_;
    data_ += count;
    left_ -= count;
    return from;
  }
  std::string text(std::size_t count) { return {reinterpret_cast<const char*>(bytes(count)), count}; }
  /// A text after its length, of four bytes.
  std::string text() { return text(number<std::uint32_t>()); }
  /// The next bytes, as a cursor.
  ByteCursor part(std::size_t count) { return {bytes(count), count}; }

  const std::uint8_t* data() const { return data_; }
  std::size_t left() const { return left_; }

 private:
  const std::uint8_t* data_;
  std::size_t left_;
};

/// A file read by position.
class BinaryFile {
 public:
  /// \throws std::runtime_error with one line
  explicit BinaryFile(const fs::path& file);
  ~BinaryFile();
  BinaryFile(const BinaryFile&) = delete;
  BinaryFile& operator=(const BinaryFile&) = delete;

  const fs::path& path() const { return path_; }
  std::uint64_t size() const { return size_; }

  /// Reads exactly this part. \throws Broken if it reaches beyond the end, or cannot be read
  void read(std::uint64_t from, std::size_t count, std::vector<std::uint8_t>& into) const;
  void read(std::uint64_t from, std::size_t count, std::uint8_t* into) const;

 private:
  fs::path path_;
  int descriptor_;
  std::uint64_t size_ = 0;
};

/// "FILE: breaks off at byte N: WHY"
std::string breakLine(const fs::path& file, std::uint64_t at, const std::string& why);

}  // namespace lisco_apps
