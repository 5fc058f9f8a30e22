// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

#include <boost/endian/conversion.hpp>

#include "recordings/bytes.h"
#include "recordings/recording.h"

namespace lisco_apps {

/// The fields of a serialized message, in the order of its definition.
/// - CDR (ROS 2): four bytes that name the byte order; numbers aligned to their size, of XCDR2 at most to 4; strings
///   end with a zero that their length counts.
/// - ROS 1: little-endian without padding.
class MessageFields {
 public:
  struct Span {
    const std::uint8_t* data;
    std::size_t size;
  };

  /// \throws Broken if it is of another serialization
  MessageFields(const Message& message, Serialization serialization)
      : data_(message.data), size_(message.size), is_cdr_(serialization == Serialization::kCdr) {
    if (serialization == Serialization::kOther) throw Broken("a message of an unknown serialization");
    if (!is_cdr_) return;
    const std::uint8_t* const head = take(4);
    if (head[0] != 0 || head[1] > 0x0B || (head[1] > 1 && head[1] < 6)) throw Broken("a message that is no CDR");
    is_big_endian_ = (head[1] & 1U) == 0;
    max_alignment_ = head[1] >= 6 ? 4 : 8;
    data_ += at_;
    size_ -= at_;
    at_ = 0;
  }

  template <typename Number>
  Number number() {
    if (is_cdr_) {
      const std::size_t alignment = sizeof(Number) < max_alignment_ ? sizeof(Number) : max_alignment_;
      take((alignment - at_ % alignment) % alignment);
    }
    const std::uint8_t* const from = take(sizeof(Number));
    using boost::endian::endian_load;
    return is_big_endian_ ? endian_load<Number, sizeof(Number), boost::endian::order::big>(from)
                          : endian_load<Number, sizeof(Number), boost::endian::order::little>(from);
  }
  std::string text() {
    const auto length = number<std::uint32_t>();
    const std::uint8_t* const from = take(length);
    const std::size_t end = is_cdr_ && length > 0 && from[length - 1] == 0 ? 1 : 0;
    return {reinterpret_cast<const char*>(from), length - end};
  }
  /// An array of a fixed number of bytes.
  const std::uint8_t* bytes(std::size_t count) { return take(count); }
  /// An array after its length.
  Span array() {
    const auto count = number<std::uint32_t>();
    return {take(count), count};
  }
  /// Nanoseconds.
  std::int64_t time() {
    const std::int64_t seconds = is_cdr_ ? std::int64_t{number<std::int32_t>()} : number<std::uint32_t>();
    return 1000000000 * seconds + number<std::uint32_t>();
  }
  struct Header {
    std::int64_t stamp_ns;
    std::string frame;
  };
  /// A std_msgs/Header.
  Header header() {
    if (!is_cdr_) number<std::uint32_t>();  // sequence number
    const std::int64_t stamp = time();
    return {stamp, text()};
  }

  std::size_t left() const { return size_ - at_; }

 private:
  const std::uint8_t* take(std::size_t count) {
    if (count > size_ - at_) throw Broken("a message that ends too early");
    const std::uint8_t* const from = data_ + at_;
    at_ += count;
    return from;
  }

  const std::uint8_t* data_;
  std::size_t size_, at_ = 0;
  bool is_cdr_;
  bool is_big_endian_ = false;
  std::size_t max_alignment_ = 8;
};

}  // namespace lisco_apps
