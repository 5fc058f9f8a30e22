// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// ROS 2 bags in SQLite: a table `topics` (id, name, type, serialization_format) and a table `messages` (topic_id,
// timestamp in nanoseconds, data). A truncated bag is read row by row, without the tables' indexes.
#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string>

#include "io/time_limits.h"
#include "recordings/bytes.h"
#include "recordings/compression.h"
#include "recordings/recording.h"
#include "recordings/sqlite_rows.h"

namespace lisco_apps {
namespace {

/// A query of a database, row by row.
class Query {
 public:
  /// \throws Broken
  Query(sqlite3* database, const std::string& text) {
    if (sqlite3_prepare_v2(database, text.c_str(), -1, &statement_, nullptr) != SQLITE_OK) {
      const std::string why = sqlite3_errmsg(database);
      sqlite3_finalize(statement_);
      throw Broken(why);
    }
  }
  ~Query() { sqlite3_finalize(statement_); }
  Query(const Query&) = delete;
  Query& operator=(const Query&) = delete;

  /// \return false at the end. \throws Broken if the database is damaged there
  bool next() {
    const int status = sqlite3_step(statement_);
    if (status != SQLITE_ROW && status != SQLITE_DONE) throw Broken(sqlite3_errmsg(sqlite3_db_handle(statement_)));
    return status == SQLITE_ROW;
  }
  std::int64_t number(int column) const { return sqlite3_column_int64(statement_, column); }
  std::string text(int column) const {
    const auto* const text = reinterpret_cast<const char*>(sqlite3_column_text(statement_, column));
    return text == nullptr ? "" : text;
  }
  const std::uint8_t* blob(int column) const {
    return static_cast<const std::uint8_t*>(sqlite3_column_blob(statement_, column));
  }
  std::size_t size(int column) const { return static_cast<std::size_t>(sqlite3_column_bytes(statement_, column)); }

 private:
  sqlite3_stmt* statement_ = nullptr;
};

struct CloseDatabase {
  void operator()(sqlite3* database) const { sqlite3_close(database); }
};

/// Makes reading beyond the end of a truncated database an error: SQLite reads zeros there. To be called for a database
/// that lacks pages, as others end within a page, too.
void refuseMissingPages(sqlite3* database) {
  sqlite3_file* file = nullptr;
  if (sqlite3_file_control(database, "main", SQLITE_FCNTL_FILE_POINTER, &file) != SQLITE_OK || file == nullptr ||
      file->pMethods == nullptr)
    return;
  static const sqlite3_io_methods* const original = file->pMethods;  // of the only kind of files that are opened
  static const sqlite3_io_methods strict = [] {
    sqlite3_io_methods methods = *original;
    methods.xRead = [](sqlite3_file* from, void* into, int count, sqlite3_int64 at) {
      const int status = original->xRead(from, into, count, at);
      return status == SQLITE_IOERR_SHORT_READ ? SQLITE_CORRUPT : status;
    };
    return methods;
  }();
  if (file->pMethods == original) file->pMethods = &strict;
}

class SqliteBag : public Recording {
 public:
  explicit SqliteBag(const fs::path& file) : file_(file), bytes_(file) {
    std::string name = "file:";
    for (const char c : fs::absolute(file).string())
      name += isPlain(c) ? std::string(1, c) : formatted("%%%02X", static_cast<unsigned char>(c));
    // "immutable" needs no lock file beside the database; a journal of an unfinished recording would be ignored.
    std::error_code error;
    if (!fs::exists(file.string() + "-wal", error) && !fs::exists(file.string() + "-journal", error))
      name += "?immutable=1";
    sqlite3* opened = nullptr;
    const int status = sqlite3_open_v2(name.c_str(), &opened, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr);
    database_.reset(opened);
    if (status != SQLITE_OK) fail(file, std::string("cannot be read: ") + sqlite3_errmsg(opened));
    sqlite3_db_config(opened, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_limit(opened, SQLITE_LIMIT_LENGTH, static_cast<int>(kMaxChunkBytes));
    readTopics();
  }

  void select(const std::vector<std::size_t>& topics) override {
    Recording::select(topics);
    query_.reset();
  }

  bool next(Message& message) override {
    if (ended_) return false;
    if (rows_of_pages_) return nextOfPages(message);
    try {
      if (!query_) begin();
      while (query_->next()) {
        const auto topic = topic_of_id_.find(query_->number(0));
        ++rows_;
        if (topic == topic_of_id_.end() || !isSelected(topic->second)) continue;
        message = {topic->second, query_->number(1), query_->blob(2), query_->size(2)};
        decompressIfNeeded(message);
        return true;
      }
    } catch (const Broken& why) {
      error_ = file_.string() +
               formatted(": breaks off after %llu messages: ", static_cast<unsigned long long>(rows_)) + why.what();
    }
    ended_ = true;
    query_.reset();
    return false;
  }

  double share() const override {
    if (rows_of_pages_)
      return std::min(1., static_cast<double>(rows_of_pages_->at()) / static_cast<double>(bytes_.size()));
    return selected_rows_ == 0 ? 1 : std::min(1., static_cast<double>(rows_) / static_cast<double>(selected_rows_));
  }

 private:
  void decompressIfNeeded(Message& message) {
    if (!isZstd(message.data, message.size)) return;
    decompress("zstd", message.data, message.size, 0, decompressed_);
    message.data = decompressed_.data();
    message.size = decompressed_.size();
  }

  /// Of a truncated bag.
  bool nextOfPages(Message& message) {
    using Kind = SqliteValue::Kind;
    while (rows_of_pages_->next(row_)) {
      if (row_.size() <= *std::max_element(columns_.begin(), columns_.end())) continue;
      const SqliteValue &topic = row_[columns_[0]], &time = row_[columns_[1]], &data = row_[columns_[2]];
      const auto found = topic_of_id_.find(topic.number);
      if (topic.kind != Kind::kInteger || time.kind != Kind::kInteger || data.kind != Kind::kBlob ||
          found == topic_of_id_.end())
        continue;
      ++rows_;
      if (!isSelected(found->second)) continue;
      message = {found->second, limitedTime(time.number), data.data, data.size};
      try {
        decompressIfNeeded(message);
      } catch (const Broken&) {
        continue;
      }
      return true;
    }
    error_ = file_.string() +
             formatted(": breaks off after %llu messages: the file has %llu of %llu bytes",
                       static_cast<unsigned long long>(rows_), static_cast<unsigned long long>(bytes_.size()),
                       static_cast<unsigned long long>(rows_of_pages_->pages() * rows_of_pages_->pageBytes()));
    ended_ = true;
    return false;
  }

  bool isTruncated() const {
    const SqliteRows rows(bytes_);
    return bytes_.size() < rows.pages() * rows.pageBytes();
  }

  /// Where in a row of the table of messages are the topic, the time and the data.
  void findColumns() {
    constexpr std::array kNames{"topic_id", "timestamp", "data"};
    Query columns(database_.get(), "SELECT cid, name FROM pragma_table_info('messages')");
    std::size_t found = 0;
    while (columns.next())
      for (std::size_t i = 0; i < kNames.size(); ++i)
        if (columns.text(1) == kNames[i]) {
          columns_[i] = static_cast<std::size_t>(columns.number(0));
          ++found;
        }
    if (found != kNames.size()) throw Broken("its messages have no topic_id, timestamp and data");
  }

  static bool isPlain(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '/' || c == '.' ||
           c == '_' || c == '-';
  }

  void readTopics() {
    try {
      findTopics();
    } catch (const Broken&) {
      // SQLite refuses a file shorter than it says, unless told that the schema may be inconsistent.
      sqlite3_exec(database_.get(), "PRAGMA writable_schema=ON", nullptr, nullptr, nullptr);
      refuseMissingPages(database_.get());
      topics_.clear();
      try {
        findTopics();
      } catch (const Broken& why) {
        fail(file_, std::string("is no ROS 2 bag: ") + why.what());
      }
    }
    try {
      countTopics();
    } catch (const Broken&) {
      has_time_index_ = false;
      for (Topic& topic : topics_) topic.messages = 0;
      try {
        const bool is_truncated = isTruncated();
        if (is_truncated) findColumns();
        if (is_truncated) rows_of_pages_.emplace(bytes_);
      } catch (const Broken& why) {
        fail(file_, std::string("is no ROS 2 bag: ") + why.what());
      }
      countMessages();
      if (rows_of_pages_) rows_of_pages_.emplace(bytes_);
      ended_ = false;
      rows_ = 0;
      error_.clear();
    }
  }

  void findTopics() {
    Query tables(database_.get(),
                 "SELECT COUNT(*) FROM sqlite_master WHERE type = 'table' AND name IN ('topics', 'messages')");
    if (!tables.next() || tables.number(0) != 2) throw Broken("it has no tables of topics and messages");
    Query topics(database_.get(), "SELECT id, name, type, serialization_format FROM topics ORDER BY id");
    while (topics.next())
      topic_of_id_[topics.number(0)] =
          indexOf({topics.text(1), plainType(topics.text(2)), serializationOf(topics.text(3)), 0});
  }

  void countTopics() {
    Query indexes(database_.get(),
                  "SELECT COUNT(*) FROM sqlite_master WHERE type = 'index' AND tbl_name = 'messages' AND "
                  "sql LIKE '%(timestamp%'");
    has_time_index_ = indexes.next() && indexes.number(0) > 0;
    Query counts(database_.get(), "SELECT topic_id, COUNT(*), MIN(timestamp) FROM messages GROUP BY topic_id");
    bool is_first = true;
    while (counts.next()) {
      const auto topic = topic_of_id_.find(counts.number(0));
      if (topic == topic_of_id_.end()) continue;
      topics_[topic->second].messages += static_cast<std::uint64_t>(counts.number(1));
      start_ns_ = limitedTime(is_first ? counts.number(2) : std::min(start_ns_, counts.number(2)));
      is_first = false;
    }
  }

  void begin() {
    std::string ids;
    selected_rows_ = 0;
    for (const auto& [id, topic] : topic_of_id_) {
      if (!isSelected(topic)) continue;
      ids += (ids.empty() ? "" : ",") + std::to_string(id);
      selected_rows_ += topics_[topic].messages;
    }
    // Without an index of times, as of a damaged bag, in the order of writing: sorting would copy the bag.
    query_ =
        std::make_unique<Query>(database_.get(), "SELECT topic_id, timestamp, data FROM messages WHERE topic_id IN (" +
                                                     ids + ") ORDER BY " + (has_time_index_ ? "timestamp" : "rowid"));
  }

  fs::path file_;
  BinaryFile bytes_;  // says why it cannot be read
  std::unique_ptr<sqlite3, CloseDatabase> database_;
  std::map<std::int64_t, std::size_t> topic_of_id_;
  std::unique_ptr<Query> query_;
  bool has_time_index_ = false, ended_ = false;
  std::uint64_t rows_ = 0, selected_rows_ = 0;
  std::optional<SqliteRows> rows_of_pages_;  ///< of a truncated bag
  std::array<std::size_t, 3> columns_{};     ///< of the topic, the time and the data in a row
  std::vector<SqliteValue> row_;
  std::vector<std::uint8_t> decompressed_;
};

}  // namespace

std::unique_ptr<Recording> openSqliteBag(const fs::path& file) {
  return std::make_unique<SqliteBag>(file);
}

}  // namespace lisco_apps
