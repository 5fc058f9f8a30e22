// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "recordings/sqlite_rows.h"

#include <algorithm>
#include <array>
#include <cstring>

#include <boost/endian/conversion.hpp>

#include "recordings/compression.h"

namespace lisco_apps {
namespace {

constexpr std::size_t kFileHeader = 100;
constexpr std::uint8_t kTableLeaf = 13;
constexpr std::size_t kLeafHeader = 8;

constexpr auto& u16 = boost::endian::load_big_u16;
constexpr auto& u32 = boost::endian::load_big_u32;

/// A number of one to nine bytes: seven bits of each, eight of the ninth.
std::uint64_t varint(ByteCursor& bytes) {
  std::uint64_t number = 0;
  for (int i = 0; i < 8; ++i) {
    const auto byte = bytes.number<std::uint8_t>();
    number = number << 7U | (byte & 0x7FU);
    if (byte < 0x80) return number;
  }
  return number << 8U | bytes.number<std::uint8_t>();
}

/// Big-endian, signed, of one to eight bytes.
std::int64_t integer(const std::uint8_t* bytes, std::size_t size) {
  std::uint64_t number = (bytes[0] & 0x80U) != 0 ? ~std::uint64_t{0} : 0;
  for (std::size_t i = 0; i < size; ++i) number = number << 8U | bytes[i];
  return static_cast<std::int64_t>(number);
}

/// \param type serial type of the column
SqliteValue valueOf(std::uint64_t type, ByteCursor& content) {
  using Kind = SqliteValue::Kind;
  constexpr std::array<std::size_t, 8> kBytes{0, 1, 2, 3, 4, 6, 8, 8};
  SqliteValue value;
  if (type >= 12) {
    value.kind = type % 2 == 0 ? Kind::kBlob : Kind::kOther;
    value.size = static_cast<std::size_t>((type - 12) / 2);
    value.data = content.bytes(value.size);
  } else if (type == 8 || type == 9) {
    value.kind = Kind::kInteger;
    value.number = static_cast<std::int64_t>(type - 8);
  } else if (type == 7) {
    value.kind = Kind::kOther;  // a float
    content.bytes(kBytes[type]);
  } else if (type >= 1 && type <= 6) {
    value.kind = Kind::kInteger;
    value.number = integer(content.bytes(kBytes[type]), kBytes[type]);
  } else if (type != 0) {
    throw Broken("a column of an unknown type");
  }
  return value;
}

}  // namespace

SqliteRows::SqliteRows(const BinaryFile& file) : file_(file) {
  constexpr std::array<char, 16> kMagic{"SQLite format 3"};
  std::array<std::uint8_t, kFileHeader> header{};
  file.read(0, header.size(), header.data());
  if (std::memcmp(header.data(), kMagic.data(), kMagic.size()) != 0) throw Broken("no SQLite database");
  page_bytes_ = u16(header.data() + 16) == 1 ? 65536 : u16(header.data() + 16);
  const std::size_t reserved = header[20];
  if (page_bytes_ < 512 || (page_bytes_ & (page_bytes_ - 1)) != 0 || page_bytes_ - reserved < 480)
    throw Broken("pages of no sensible size");
  usable_ = static_cast<std::size_t>(page_bytes_) - reserved;
  // The number is valid if the counters of changes agree.
  if (u32(header.data() + 24) == u32(header.data() + 92)) pages_ = u32(header.data() + 28);
}

bool SqliteRows::readLeaf() {
  while ((page_ + 1) * page_bytes_ <= file_.size()) {
    file_.read(page_ * page_bytes_, static_cast<std::size_t>(page_bytes_), leaf_);
    const std::size_t begin = page_ == 0 ? kFileHeader : 0;
    ++page_;
    if (leaf_[begin] != kTableLeaf) continue;
    const std::size_t count = u16(leaf_.data() + begin + 3), pointers = begin + kLeafHeader;
    if (pointers + 2 * count > usable_) continue;
    for (std::size_t i = count; i-- > 0;) cells_.push_back(u16(leaf_.data() + pointers + 2 * i));
    if (!cells_.empty()) return true;
  }
  return false;
}

bool SqliteRows::next(std::vector<SqliteValue>& row) {
  while (!cells_.empty() || readLeaf()) {
    const std::size_t at = cells_.back();
    cells_.pop_back();
    try {
      readCell(at, row);
      return true;
    } catch (const Broken&) {  // malformed, or beyond the end of the file
    }
  }
  return false;
}

void SqliteRows::readCell(std::size_t at, std::vector<SqliteValue>& row) {
  row.clear();
  if (at >= usable_) throw Broken("a cell beyond its page");
  ByteCursor cell(leaf_.data() + at, usable_ - at);
  const std::uint64_t size = varint(cell);
  varint(cell);  // number of the row
  if (size > kMaxChunkBytes || size > file_.size()) throw Broken("a row of no sensible size");
  // How many bytes are in the page, and how many in a chain of others.
  const std::size_t most = usable_ - 35, least = (usable_ - 12) * 32 / 255 - 23;
  std::size_t local = static_cast<std::size_t>(size);
  if (size > most) {
    local = least + (local - least) % (usable_ - 4);
    if (local > most) local = least;
  }
  const ByteCursor inside = cell.part(local);
  gather(inside, size, size > most ? u32(cell.bytes(4)) : 0);

  ByteCursor record(payload_.data(), payload_.size());
  const std::uint64_t header_bytes = varint(record);
  const std::size_t before = payload_.size() - record.left();
  if (header_bytes < before || header_bytes > payload_.size()) throw Broken("a row of no sensible header");
  ByteCursor types = record.part(static_cast<std::size_t>(header_bytes) - before);
  while (types.left() > 0) row.push_back(valueOf(varint(types), record));
}

/// \param overflow number of the next page of the row, from 1; 0: none
void SqliteRows::gather(ByteCursor local, std::uint64_t wanted, std::uint32_t overflow) {
  payload_.assign(local.data(), local.data() + local.left());
  while (payload_.size() < wanted) {
    if (overflow == 0) throw Broken("a row that ends early");
    const std::uint64_t page_at = (overflow - std::uint64_t{1}) * page_bytes_;
    const std::size_t have = payload_.size();
    const std::size_t more = std::min(usable_ - 4, static_cast<std::size_t>(wanted) - have);
    std::array<std::uint8_t, 4> following{};
    file_.read(page_at, following.size(), following.data());
    payload_.resize(have + more);
    file_.read(page_at + following.size(), more, payload_.data() + have);
    overflow = u32(following.data());
  }
}

}  // namespace lisco_apps
