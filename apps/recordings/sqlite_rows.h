// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "recordings/bytes.h"

namespace lisco_apps {

/// A column of a row.
struct SqliteValue {
  enum class Kind { kNull, kInteger, kBlob, kOther };
  Kind kind = Kind::kNull;
  std::int64_t number = 0;
  const std::uint8_t* data = nullptr;  ///< of a blob, valid until the next row
  std::size_t size = 0;
};

/// The rows of all tables of an SQLite database (https://www.sqlite.org/fileformat2.html), read page by page from its
/// leaves: of a truncated database, in which the way from the root of a table to its first rows may be lost.
class SqliteRows {
 public:
  /// \throws Broken if the file is no SQLite database
  explicit SqliteRows(const BinaryFile& file);

  /// Pages that the database had, by its header; 0 if the header does not say.
  std::uint64_t pages() const { return pages_; }
  std::uint64_t pageBytes() const { return page_bytes_; }

  /// Reads the next row that is whole. \return false at the end of the file
  bool next(std::vector<SqliteValue>& row);

  /// Bytes read.
  std::uint64_t at() const { return page_ * page_bytes_; }

 private:
  bool readLeaf();
  void readCell(std::size_t at, std::vector<SqliteValue>& row);
  void gather(ByteCursor local, std::uint64_t wanted, std::uint32_t overflow);

  const BinaryFile& file_;
  std::uint64_t page_bytes_ = 0, pages_ = 0;
  std::size_t usable_ = 0;          ///< bytes of a page
  std::uint64_t page_ = 0;          ///< number of the next one, from 0
  std::vector<std::uint8_t> leaf_;  ///< the current page
  std::vector<std::size_t> cells_;  ///< of the page, places that are left, in reverse
  std::vector<std::uint8_t> payload_;
};

}  // namespace lisco_apps
