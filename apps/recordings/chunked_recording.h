// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "recordings/bytes.h"
#include "recordings/recording.h"

namespace lisco_apps {

/// A file of records, some of them chunks: compressed records.
class ChunkedRecording : public Recording {
 public:
  bool next(Message& message) override {
    while (error_.empty() && !ended_) {
      try {
        while (chunk_ && chunk_->left() > 0)
          if (takeFromChunk(message)) return true;
        chunk_.reset();
        record_at_ = next_at_;
        if (takeFromFile(message)) return true;
      } catch (const Broken& why) {
        error_ = breakLine(file_.path(), record_at_, why.what());
      }
    }
    return false;
  }

  double share() const override {
    return file_.size() == 0 ? 1 : static_cast<double>(record_at_) / static_cast<double>(file_.size());
  }

 protected:
  /// \param first_record its place in the file
  ChunkedRecording(const fs::path& file, std::uint64_t first_record) : file_(file), first_record_(first_record) {}

  /// Reads the record at record_at_: sets next_at_, or ended_, or chunk_. \return whether it is a message to be given
  virtual bool takeFromFile(Message& message) = 0;
  /// Reads the next record of chunk_. \return whether it is a message to be given
  virtual bool takeFromChunk(Message& message) = 0;
  /// Forgets what records have told.
  virtual void forget() = 0;

  void rewind() {
    record_at_ = next_at_ = first_record_;
    chunk_.reset();
    forget();
    ended_ = false;
    error_.clear();
  }

  /// Finds the topics by reading the file, for one without an index.
  void scan() {
    topics_.clear();
    rewind();
    countMessages();
  }

  BinaryFile file_;
  std::uint64_t record_at_ = 0;  ///< of the current record of the file
  std::uint64_t next_at_ = 0;
  bool ended_ = false;
  std::vector<std::uint8_t> buffer_, decompressed_;
  std::optional<ByteCursor> chunk_;  ///< what is left of the current one

 private:
  std::uint64_t first_record_;
};

}  // namespace lisco_apps
