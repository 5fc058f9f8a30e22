// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// MCAP (https://mcap.dev/spec): a magic, then records of a byte of kind, their length (8 bytes) and content. Messages
// stand among the records of the file, or in chunks, which are records of compressed records. A summary at the end,
// which a truncated file lacks, repeats the channels and counts their messages.
#include <array>
#include <cstring>
#include <map>

#include "io/time_limits.h"
#include "recordings/bytes.h"
#include "recordings/chunked_recording.h"
#include "recordings/compression.h"
#include "recordings/mcap_format.h"
#include "recordings/recording.h"

namespace lisco_apps {
namespace {

constexpr std::uint64_t kMaxSummaryBytes = std::uint64_t{1} << 28;

struct Record {
  mcap::Kind kind{};
  ByteCursor content{nullptr, 0};
};

/// The next record of a chunk or of the summary.
Record nextRecord(ByteCursor& records) {
  const auto kind = static_cast<mcap::Kind>(records.number<std::uint8_t>());
  const auto length = records.number<std::uint64_t>();
  if (length > records.left()) throw Broken("a record reaches beyond its chunk");
  return {kind, records.part(static_cast<std::size_t>(length))};
}

class Mcap : public ChunkedRecording {
 public:
  explicit Mcap(const fs::path& file) : ChunkedRecording(file, mcap::kMagic.size()) {
    std::array<std::uint8_t, mcap::kMagic.size()> magic{};
    if (file_.size() < magic.size()) fail(file, "is no mcap file");
    file_.read(0, magic.size(), magic.data());
    if (magic != mcap::kMagic) fail(file, "is no mcap file");
    if (!readSummary()) scan();
    rewind();
  }

 private:
  void forget() override {
    schemas_.clear();
    channels_.clear();
  }

  bool takeFromChunk(Message& message) override { return take(nextRecord(*chunk_), message); }

  bool takeFromFile(Message& message) override {
    constexpr std::size_t kHeader = 9;
    std::array<std::uint8_t, kHeader> header{};
    file_.read(record_at_, kHeader, header.data());
    ByteCursor cursor(header.data(), kHeader);
    const auto kind = static_cast<mcap::Kind>(cursor.number<std::uint8_t>());
    const auto length = cursor.number<std::uint64_t>();
    const std::uint64_t content = record_at_ + kHeader;
    if (kind == mcap::Kind::kDataEnd || kind == mcap::Kind::kFooter) {
      ended_ = true;
      return false;
    }
    if (length > file_.size() - content) throw Broken("the file ends within a record");
    next_at_ = content + length;
    const bool is_read = kind == mcap::Kind::kSchema || kind == mcap::Kind::kChannel || kind == mcap::Kind::kMessage ||
                         kind == mcap::Kind::kChunk;
    if (!is_read) return false;
    if (length > kMaxChunkBytes) throw Broken("a record of more than " + std::to_string(kMaxChunkBytes) + " bytes");
    file_.read(content, static_cast<std::size_t>(length), buffer_);
    const ByteCursor whole(buffer_.data(), buffer_.size());
    if (kind != mcap::Kind::kChunk) return take({kind, whole}, message);
    openChunk(whole);
    return false;
  }

  void openChunk(ByteCursor content) {
    content.bytes(16);  // times of the first and last message
    const auto size = content.number<std::uint64_t>();
    const auto sum = content.number<std::uint32_t>();
    const std::string method = content.text();
    const auto stored = content.number<std::uint64_t>();
    if (stored > content.left()) throw Broken("a chunk reaches beyond its record");
    if (size > kMaxChunkBytes) throw Broken("a chunk of more than " + std::to_string(kMaxChunkBytes) + " bytes");
    if (size == 0) return;
    decompress(method, content.data(), static_cast<std::size_t>(stored), static_cast<std::size_t>(size), decompressed_);
    if (sum != 0 && sum != mcap::checkSum(decompressed_.data(), decompressed_.size()))
      throw Broken("a chunk whose check sum is wrong");
    chunk_.emplace(decompressed_.data(), decompressed_.size());
  }

  bool take(const Record& record, Message& message) {
    ByteCursor content = record.content;
    if (record.kind == mcap::Kind::kSchema) {
      addSchema(content);
    } else if (record.kind == mcap::Kind::kChannel) {
      addChannel(content);
    } else if (record.kind == mcap::Kind::kMessage) {
      const auto channel = content.number<std::uint16_t>();
      content.bytes(4);  // sequence number
      const auto time = content.number<std::uint64_t>();
      content.bytes(8);  // time of publishing
      const auto found = channels_.find(channel);
      if (found == channels_.end()) throw Broken("a message of an unknown channel");
      if (!isSelected(found->second)) return false;
      message = {found->second, limitedTime(static_cast<std::int64_t>(time)), content.data(), content.left()};
      return true;
    }
    return false;
  }

  void addSchema(ByteCursor content) {
    const auto id = content.number<std::uint16_t>();
    schemas_[id] = content.text();
  }

  void addChannel(ByteCursor content) {
    const auto id = content.number<std::uint16_t>();
    const auto schema = content.number<std::uint16_t>();
    const std::string topic = content.text();
    const std::string encoding = content.text();
    const auto found = schemas_.find(schema);
    const std::string type = found == schemas_.end() ? "" : plainType(found->second);
    channels_[id] = indexOf({topic, type, serializationOf(encoding), 0});
  }

  /// The topics by the summary. \return false if the file has none
  bool readSummary() try {
    constexpr std::size_t kFooter = 9 + 20;
    const std::size_t tail = kFooter + mcap::kMagic.size();
    if (file_.size() < mcap::kMagic.size() + tail) return false;
    const std::uint64_t footer_at = file_.size() - tail;
    file_.read(footer_at, tail, buffer_);
    ByteCursor footer(buffer_.data(), buffer_.size());
    if (std::memcmp(buffer_.data() + kFooter, mcap::kMagic.data(), mcap::kMagic.size()) != 0 ||
        static_cast<mcap::Kind>(footer.number<std::uint8_t>()) != mcap::Kind::kFooter)
      return false;
    footer.bytes(8);
    const auto start = footer.number<std::uint64_t>();
    if (start == 0 || start > footer_at || footer_at - start > kMaxSummaryBytes) return false;
    file_.read(start, static_cast<std::size_t>(footer_at - start), buffer_);
    ByteCursor summary(buffer_.data(), buffer_.size());
    bool has_statistics = false;
    Message none;
    while (summary.left() > 0) {
      const Record record = nextRecord(summary);
      if (record.kind == mcap::Kind::kStatistics) {
        readStatistics(record.content);
        has_statistics = true;
      } else if (record.kind != mcap::Kind::kMessage) {
        take(record, none);
      }
    }
    if (!has_statistics) return false;
    for (const auto& [channel, messages] : messages_) {
      const auto found = channels_.find(channel);
      if (found == channels_.end()) return false;
      topics_[found->second].messages += messages;
    }
    return true;
  } catch (const Broken&) {
    return false;
  }

  void readStatistics(ByteCursor content) {
    content.bytes(8 + 2 + 4 + 4 + 4 + 4);  // counts of messages, schemas, channels, attachments, metadata, chunks
    start_ns_ = limitedTime(static_cast<std::int64_t>(content.number<std::uint64_t>()));
    content.bytes(8);
    ByteCursor counts = content.part(content.number<std::uint32_t>());
    while (counts.left() > 0) {
      const auto channel = counts.number<std::uint16_t>();
      messages_[channel] = counts.number<std::uint64_t>();
    }
  }

  std::map<std::uint16_t, std::string> schemas_;
  std::map<std::uint16_t, std::size_t> channels_;    ///< to topics
  std::map<std::uint16_t, std::uint64_t> messages_;  ///< of channels, by the summary
};

}  // namespace

std::unique_ptr<Recording> openMcap(const fs::path& file) {
  return std::make_unique<Mcap>(file);
}

}  // namespace lisco_apps
