// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "recordings/mcap_writer.h"

#include <zstd.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include "io/little_endian.h"
#include "lisco/version.h"

namespace lisco_apps {
namespace {

constexpr std::size_t kChunkBytes = std::size_t{1} << 20;
constexpr const char* kCompression = "zstd";
const std::string_view kMagic{reinterpret_cast<const char*>(mcap::kMagic.data()), mcap::kMagic.size()};

std::string recordOf(mcap::Kind kind, const std::string& content) {
  std::string record;
  putNumber(record, static_cast<std::uint8_t>(kind));
  putNumber(record, std::uint64_t{content.size()});
  return record + content;
}

std::string schemaOf(std::uint16_t id, const McapWriter::Channel& channel) {
  std::string content;
  putNumber(content, id);
  putText(content, channel.type);
  putText(content, "ros2msg");
  putText(content, channel.schema);
  return recordOf(mcap::Kind::kSchema, content);
}

std::string channelOf(std::uint16_t id, const McapWriter::Channel& channel) {
  std::string content;
  putNumber(content, id);
  putNumber(content, static_cast<std::uint16_t>(id + 1));  // of its schema; 0 would be none
  putText(content, channel.topic);
  putText(content, "cdr");
  putText(content, "");  // no metadata
  return recordOf(mcap::Kind::kChannel, content);
}

/// All schemas and channels.
std::string descriptionsOf(const std::vector<McapWriter::Channel>& channels) {
  std::string records;
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const auto id = static_cast<std::uint16_t>(i);
    records += schemaOf(static_cast<std::uint16_t>(id + 1), channels[i]) + channelOf(id, channels[i]);
  }
  return records;
}

std::uint64_t unsignedOf(std::int64_t time_ns) {
  return static_cast<std::uint64_t>(std::max<std::int64_t>(time_ns, 0));
}

}  // namespace

McapWriter::McapWriter(const fs::path& file, const std::string& program, std::vector<Channel> channels)
    : file_(file, "made by " + program + " "),
      channels_(std::move(channels)),
      entries_(channels_.size()),
      messages_(channels_.size(), 0) {
  put(kMagic);
  std::string header;
  putText(header, "ros2");
  putText(header, "made by " + program + " " + LISCO_VERSION);
  put(mcap::Kind::kHeader, header);
  chunk_ = descriptionsOf(channels_);
}

void McapWriter::put(std::string_view bytes) {
  file_.write(bytes);
  written_ += bytes.size();
}

void McapWriter::put(mcap::Kind kind, const std::string& content) {
  put(recordOf(kind, content));
}

void McapWriter::write(std::size_t channel, std::int64_t time_ns, const std::string& data) {
  std::string content;
  putNumber(content, static_cast<std::uint16_t>(channel));
  putNumber(content, static_cast<std::uint32_t>(messages_[channel]));
  putNumber(content, unsignedOf(time_ns));
  putNumber(content, unsignedOf(time_ns));
  const bool is_first = std::accumulate(messages_.begin(), messages_.end(), std::uint64_t{0}) == 0;
  first_ns_ = is_first ? time_ns : std::min(first_ns_, time_ns);
  last_ns_ = is_first ? time_ns : std::max(last_ns_, time_ns);
  ++messages_[channel];
  entries_[channel].push_back({time_ns, chunk_.size()});
  chunk_ += recordOf(mcap::Kind::kMessage, content + data);
  if (chunk_.size() >= kChunkBytes) putChunk();
}

void McapWriter::putChunk() {
  ChunkPlace place{};
  bool is_first = true;
  for (const std::vector<Entry>& entries : entries_)
    for (const Entry& entry : entries) {
      place.first_ns = is_first ? entry.time_ns : std::min(place.first_ns, entry.time_ns);
      place.last_ns = is_first ? entry.time_ns : std::max(place.last_ns, entry.time_ns);
      is_first = false;
    }
  std::string stored(ZSTD_compressBound(chunk_.size()), '\0');
  constexpr int kLevel = 3;  // zstd's default
  stored.resize(ZSTD_compress(stored.data(), stored.size(), chunk_.data(), chunk_.size(), kLevel));
  place.at = written_;
  place.content = chunk_.size();
  place.stored = stored.size();
  std::string content;
  putNumber(content, unsignedOf(place.first_ns));
  putNumber(content, unsignedOf(place.last_ns));
  putNumber(content, place.content);
  putNumber(content, mcap::checkSum(reinterpret_cast<const std::uint8_t*>(chunk_.data()), chunk_.size()));
  putText(content, kCompression);
  putNumber(content, place.stored);
  put(mcap::Kind::kChunk, content + stored);
  place.size = written_ - place.at;

  const std::uint64_t index_at = written_;
  place.index_at.assign(channels_.size(), 0);
  for (std::size_t channel = 0; channel < channels_.size(); ++channel) {
    std::vector<Entry>& entries = entries_[channel];
    if (entries.empty()) continue;
    std::string list;
    for (const Entry& entry : entries) {
      putNumber(list, unsignedOf(entry.time_ns));
      putNumber(list, entry.at);
    }
    std::string index;
    putNumber(index, static_cast<std::uint16_t>(channel));
    putText(index, list);
    place.index_at[channel] = written_;
    put(mcap::Kind::kMessageIndex, index);
    entries.clear();
  }
  place.index_size = written_ - index_at;
  chunks_.push_back(place);
  chunk_.clear();
}

void McapWriter::finish() {
  if (!chunk_.empty()) putChunk();
  put(mcap::Kind::kDataEnd, std::string(sizeof(std::uint32_t), '\0'));  // no checksum

  const std::uint64_t summary_at = written_;
  put(descriptionsOf(channels_));
  std::string statistics;
  putNumber(statistics, std::accumulate(messages_.begin(), messages_.end(), std::uint64_t{0}));
  putNumber(statistics, static_cast<std::uint16_t>(channels_.size()));
  putNumber(statistics, static_cast<std::uint32_t>(channels_.size()));
  putNumber(statistics, std::uint32_t{0});  // attachments
  putNumber(statistics, std::uint32_t{0});  // metadata
  putNumber(statistics, static_cast<std::uint32_t>(chunks_.size()));
  putNumber(statistics, unsignedOf(first_ns_));
  putNumber(statistics, unsignedOf(last_ns_));
  std::string counts;
  for (std::size_t channel = 0; channel < channels_.size(); ++channel) {
    putNumber(counts, static_cast<std::uint16_t>(channel));
    putNumber(counts, messages_[channel]);
  }
  putText(statistics, counts);
  put(mcap::Kind::kStatistics, statistics);
  for (const ChunkPlace& place : chunks_) {
    std::string index;
    putNumber(index, unsignedOf(place.first_ns));
    putNumber(index, unsignedOf(place.last_ns));
    putNumber(index, place.at);
    putNumber(index, place.size);
    std::string offsets;
    for (std::size_t channel = 0; channel < channels_.size(); ++channel) {
      if (place.index_at[channel] == 0) continue;
      putNumber(offsets, static_cast<std::uint16_t>(channel));
      putNumber(offsets, place.index_at[channel]);
    }
    putText(index, offsets);
    putNumber(index, place.index_size);
    putText(index, kCompression);
    putNumber(index, place.stored);
    putNumber(index, place.content);
    put(mcap::Kind::kChunkIndex, index);
  }
  std::string footer;
  putNumber(footer, summary_at);
  putNumber(footer, std::uint64_t{0});  // no offsets of the summary
  putNumber(footer, std::uint32_t{0});  // no checksum
  put(mcap::Kind::kFooter, footer);
  put(kMagic);
  file_.finish();
}

}  // namespace lisco_apps
