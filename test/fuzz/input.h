// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace lisco_test {

/// Bytes that are turned into decisions; zeros when they are used up.
class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}

  std::size_t left() const { return left_; }
  unsigned byte() {
    if (left_ == 0) return 0;
    --left_;
    return *data_++;
  }
  std::size_t below(std::size_t count) { return byte() % count; }
  bool chance() { return (byte() & 1U) != 0; }
  template <typename Item, std::size_t count>
  const Item& oneOf(const std::array<Item, count>& choices) {
    return choices[byte() % count];
  }
  /// Any float, finite or not.
  float rawFloat() {
    std::uint32_t bits = 0;
    for (int i = 0; i < 4; ++i) bits = bits << 8 | byte();
    float number;
    std::memcpy(&number, &bits, sizeof number);
    return number;
  }

 private:
  const std::uint8_t* data_;
  std::size_t left_;
};

}  // namespace lisco_test
