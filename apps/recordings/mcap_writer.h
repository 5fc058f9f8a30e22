// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/output_file.h"
#include "recordings/mcap_format.h"

namespace lisco_apps {

/// Writes an MCAP file of CDR messages (profile ros2, chunks compressed by zstd, with summary and index), all or
/// nothing: see OwnFile.
class McapWriter {
 public:
  struct Channel {
    std::string topic;
    std::string type;    ///< such as "sensor_msgs/msg/PointCloud2"
    std::string schema;  ///< its definition, as ros2msg
  };

  /// \param program stands in the file, for checkMayWrite ()
  /// \throws std::runtime_error with one line if the file cannot be written, or is another program's
  McapWriter(const fs::path& file, const std::string& program, std::vector<Channel> channels);
  /// \param channel index in the channels
  /// \throws std::runtime_error with one line if the file cannot be written
  void write(std::size_t channel, std::int64_t time_ns, const std::string& data);
  /// Completes the file and moves it to its place. \throws std::runtime_error as write ()
  void finish();

 private:
  struct Entry {
    std::int64_t time_ns;
    std::uint64_t at;  ///< in its chunk
  };
  struct ChunkPlace {
    std::int64_t first_ns, last_ns;
    std::uint64_t at, size, index_size;
    std::vector<std::uint64_t> index_at;  ///< of each channel; 0: it has no message there
    std::uint64_t stored, content;        ///< bytes with and without compression
  };

  void put(std::string_view bytes);
  void put(mcap::Kind kind, const std::string& content);
  void putChunk();

  OwnFile file_;
  std::uint64_t written_ = 0;
  std::vector<Channel> channels_;
  std::string chunk_;
  std::vector<std::vector<Entry>> entries_;  ///< of the chunk, by channel
  std::vector<std::uint64_t> messages_;      ///< by channel
  std::int64_t first_ns_ = 0, last_ns_ = 0;  ///< of the file
  std::vector<ChunkPlace> chunks_;
};

}  // namespace lisco_apps
