// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// ROS 1 bags, version 2.0: a line of text, then records of a header (4 bytes of length, then fields `name=value`, each
// after its length) and data (4 bytes of length). Connections (topics) and messages stand in chunks, which are
// compressed records; an index at the end, which an unfinished bag lacks, counts the messages of each chunk.
#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <string_view>

#include "recordings/bytes.h"
#include "recordings/chunked_recording.h"
#include "recordings/compression.h"
#include "recordings/recording.h"

namespace lisco_apps {
namespace {

constexpr std::string_view kFirstLine = "#ROSBAG V2.0\n";
constexpr std::size_t kMaxHeaderBytes = std::size_t{1} << 20;

enum class Op : std::uint8_t {
  kMessage = 2,
  kBagHeader = 3,
  kIndex = 4,
  kChunk = 5,
  kChunkInfo = 6,
  kConnection = 7,
};

/// The fields of a header.
class Header {
 public:
  explicit Header(ByteCursor bytes) {
    while (bytes.left() > 0) {
      const std::string field = bytes.text();
      const std::size_t equals = field.find('=');
      if (equals == std::string::npos) throw Broken("a record's header has no '='");
      fields_[field.substr(0, equals)] = field.substr(equals + 1);
    }
  }

  template <typename Number>
  Number number(const char* name) const {
    const std::string& value = text(name);
    return ByteCursor(reinterpret_cast<const std::uint8_t*>(value.data()), value.size()).number<Number>();
  }
  const std::string& text(const char* name) const {
    const auto found = fields_.find(name);
    if (found == fields_.end()) throw Broken(std::string("a record without '") + name + "'");
    return found->second;
  }
  Op op() const { return static_cast<Op>(number<std::uint8_t>("op")); }
  /// Seconds and nanoseconds, four bytes each.
  std::int64_t timeNs(const char* name) const {
    const auto time = number<std::uint64_t>(name);
    return std::int64_t{1000000000} * static_cast<std::int64_t>(time & 0xFFFFFFFFU) +
           static_cast<std::int64_t>(time >> 32U);
  }

 private:
  std::map<std::string, std::string> fields_;
};

class Ros1Bag : public ChunkedRecording {
 public:
  explicit Ros1Bag(const fs::path& file) : ChunkedRecording(file, kFirstLine.size()) {
    std::array<char, kFirstLine.size()> line{};
    const bool is_long_enough = file_.size() >= line.size();
    if (is_long_enough) file_.read(0, line.size(), reinterpret_cast<std::uint8_t*>(line.data()));
    if (!is_long_enough || std::string_view(line.data(), line.size()) != kFirstLine)
      fail(file, "is no ROS 1 bag of version 2.0");
    if (!readIndex()) scan();
    rewind();
  }

 private:
  /// A record of the file: its header, and where its data are.
  struct Place {
    Header header;
    std::uint64_t data_at;
    std::uint32_t data_size;
  };

  void forget() override { connections_.clear(); }

  Place recordAt(std::uint64_t at) {
    std::array<std::uint8_t, 4> length{};
    file_.read(at, length.size(), length.data());
    const auto header_size = ByteCursor(length.data(), length.size()).number<std::uint32_t>();
    if (header_size > kMaxHeaderBytes) throw Broken("a record's header of no sensible size");
    file_.read(at + 4, header_size, buffer_);
    Header header(ByteCursor(buffer_.data(), buffer_.size()));
    file_.read(at + 4 + header_size, length.size(), length.data());
    const auto data_size = ByteCursor(length.data(), length.size()).number<std::uint32_t>();
    return {std::move(header), at + 8 + header_size, data_size};
  }

  bool takeFromFile(Message& message) override {
    ended_ = record_at_ >= file_.size();
    if (ended_) return false;
    const Place record = recordAt(record_at_);
    if (record.data_size > file_.size() - record.data_at) throw Broken("the file ends within a record");
    next_at_ = record.data_at + record.data_size;
    const Op op = record.header.op();
    if (op != Op::kChunk && op != Op::kConnection && op != Op::kMessage) return false;
    file_.read(record.data_at, record.data_size, buffer_);
    if (op != Op::kChunk) return take(record.header, ByteCursor(buffer_.data(), buffer_.size()), message);
    const auto size = record.header.number<std::uint32_t>("size");
    if (size == 0) return false;
    decompress(record.header.text("compression"), buffer_.data(), buffer_.size(), size, decompressed_);
    chunk_.emplace(decompressed_.data(), decompressed_.size());
    return false;
  }

  bool takeFromChunk(Message& message) override {
    const Header header(chunk_->part(chunk_->number<std::uint32_t>()));
    return take(header, chunk_->part(chunk_->number<std::uint32_t>()), message);
  }

  bool take(const Header& header, ByteCursor data, Message& message) {
    const Op op = header.op();
    if (op == Op::kConnection) {
      addConnection(header, data);
    } else if (op == Op::kMessage) {
      const auto found = connections_.find(header.number<std::uint32_t>("conn"));
      if (found == connections_.end()) throw Broken("a message of an unknown connection");
      if (!isSelected(found->second)) return false;
      message = {found->second, header.timeNs("time"), data.data(), data.left()};
      return true;
    }
    return false;
  }

  void addConnection(const Header& header, ByteCursor data) {
    const Header about(data);
    connections_[header.number<std::uint32_t>("conn")] =
        indexOf({header.text("topic"), about.text("type"), Serialization::kRos1, 0});
  }

  /// The topics by the index. \return false if the bag has none
  bool readIndex() try {
    const Header bag = recordAt(kFirstLine.size()).header;
    if (bag.op() != Op::kBagHeader) throw Broken("no header of a bag");
    std::uint64_t at = bag.number<std::uint64_t>("index_pos");
    if (at < kFirstLine.size() || at >= file_.size()) return false;
    bool is_first = true;
    while (at < file_.size()) {
      const Place record = recordAt(at);
      if (record.data_size > file_.size() - record.data_at) return false;
      file_.read(record.data_at, record.data_size, buffer_);
      at = record.data_at + record.data_size;
      ByteCursor data(buffer_.data(), buffer_.size());
      const Op op = record.header.op();
      if (op == Op::kConnection) addConnection(record.header, data);
      if (op != Op::kChunkInfo) continue;
      while (data.left() > 0) {
        const auto found = connections_.find(data.number<std::uint32_t>());
        const auto messages = data.number<std::uint32_t>();
        if (found == connections_.end()) return false;
        topics_[found->second].messages += messages;
      }
      const std::int64_t start = record.header.timeNs("start_time");
      start_ns_ = is_first ? start : std::min(start_ns_, start);
      is_first = false;
    }
    return true;
  } catch (const Broken&) {
    return false;
  }

  std::map<std::uint32_t, std::size_t> connections_;  ///< to topics
};

}  // namespace

std::unique_ptr<Recording> openRos1Bag(const fs::path& file) {
  return std::make_unique<Ros1Bag>(file);
}

}  // namespace lisco_apps
