// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "io/little_endian.h"

namespace lisco_apps {

/// A message in CDR, little-endian: numbers are aligned to their size.
class CdrText {
 public:
  template <typename Number>
  void number(Number value) {
    constexpr std::size_t kHeader = 4;
    while ((text_.size() - kHeader) % sizeof(Number) != 0) text_ += '\0';
    putNumber(text_, value);
  }
  void text(const std::string& value) {
    number(static_cast<std::uint32_t>(value.size() + 1));
    text_ += value;
    text_ += '\0';
  }
  void time(std::int64_t time_ns) {
    number(static_cast<std::int32_t>(time_ns / 1000000000));
    number(static_cast<std::uint32_t>(time_ns % 1000000000));
  }
  void header(std::int64_t stamp_ns, const std::string& frame) {
    time(stamp_ns);
    text(frame);
  }
  /// Bytes without alignment.
  std::string& bytes() { return text_; }
  const std::string& done() const { return text_; }

 private:
  std::string text_{std::string("\0\1\0\0", 4)};
};

}  // namespace lisco_apps
