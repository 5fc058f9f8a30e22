// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <type_traits>

#include <boost/endian/conversion.hpp>

namespace lisco_apps {

/// Appends a number to a string or vector of bytes, the lowest byte first.
template <typename Bytes, typename Number>
void putNumber(Bytes& text, Number number) {
  static_assert(std::is_arithmetic_v<Number>);
  std::array<unsigned char, sizeof(Number)> bytes{};
  boost::endian::endian_store<Number, sizeof(Number), boost::endian::order::little>(bytes.data(), number);
  for (const unsigned char byte : bytes) text.push_back(static_cast<typename Bytes::value_type>(byte));
}

/// Appends a text after its length, of four bytes.
inline void putText(std::string& text, const std::string& part) {
  putNumber(text, static_cast<std::uint32_t>(part.size()));
  text += part;
}

}  // namespace lisco_apps
