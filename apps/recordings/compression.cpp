// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "recordings/compression.h"

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <memory>

#include "recordings/bytes.h"

namespace lisco_apps {
namespace {

constexpr std::size_t kGrowth = std::size_t{1} << 20;  ///< bytes by which a result grows: lengths are not trusted

/// The result, extended while data come. Once it is full, a byte beside it shows whether more data come.
class Output {
 public:
  Output(std::vector<std::uint8_t>& result, std::size_t expected)
      : result_(result), limit_(expected != 0 ? expected : kMaxChunkBytes) {
    result_.clear();
  }

  /// Where the next bytes go; room () of them, at least one.
  std::uint8_t* next() {
    if (used_ == result_.size() && used_ < limit_) result_.resize(std::min(limit_, used_ + std::max(used_, kGrowth)));
    return used_ < result_.size() ? result_.data() + used_ : &beyond_;
  }
  std::size_t room() const { return std::max<std::size_t>(result_.size() - used_, 1); }

  void advance(std::size_t count) {
    if (count > result_.size() - used_) throw Broken("a chunk holds more than it says");
    used_ += count;
  }

  void finish(std::size_t expected) {
    if (expected != 0 && used_ != expected) throw Broken("a chunk holds less than it says");
    result_.resize(used_);
  }

 private:
  std::vector<std::uint8_t>& result_;
  std::size_t limit_, used_ = 0;
  std::uint8_t beyond_ = 0;
};

void decompressLz4(const std::uint8_t* data, std::size_t size, Output& output) {
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION)) != 0) throw std::bad_alloc();
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context(raw,
                                                                                     LZ4F_freeDecompressionContext);
  std::size_t hint = 1;  // 0: the frame is complete
  while (size > 0 || hint != 0) {
    std::uint8_t* const into = output.next();
    std::size_t taken = size;
    std::size_t made = output.room();
    hint = LZ4F_decompress(context.get(), into, &made, data, &taken, nullptr);
    if (LZ4F_isError(hint) != 0) throw Broken(std::string("damaged lz4 data: ") + LZ4F_getErrorName(hint));
    if (taken == 0 && made == 0) throw Broken("damaged lz4 data: they end too early");
    output.advance(made);
    data += taken;
    size -= taken;
  }
}

void decompressZstd(const std::uint8_t* data, std::size_t size, Output& output) {
  const std::unique_ptr<ZSTD_DStream, decltype(&ZSTD_freeDStream)> context(ZSTD_createDStream(), ZSTD_freeDStream);
  if (!context) throw std::bad_alloc();
  ZSTD_inBuffer input{data, size, 0};
  std::size_t hint = 1;  // 0: the frame is complete
  while (input.pos < input.size || hint != 0) {
    ZSTD_outBuffer made{output.next(), output.room(), 0};
    const std::size_t before = input.pos;
    hint = ZSTD_decompressStream(context.get(), &made, &input);
    if (ZSTD_isError(hint) != 0) throw Broken(std::string("damaged zstd data: ") + ZSTD_getErrorName(hint));
    if (input.pos == before && made.pos == 0) throw Broken("damaged zstd data: they end too early");
    output.advance(made.pos);
  }
}

void decompressBz2(const std::uint8_t* data, std::size_t size, Output& output) {
  bz_stream stream{};
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) throw std::bad_alloc();
  const std::unique_ptr<bz_stream, decltype(&BZ2_bzDecompressEnd)> end(&stream, BZ2_bzDecompressEnd);
  stream.next_in = const_cast<char*>(reinterpret_cast<const char*>(data));  // not written to
  stream.avail_in = static_cast<unsigned>(size);
  int status = BZ_OK;
  while (status != BZ_STREAM_END) {
    stream.next_out = reinterpret_cast<char*>(output.next());
    const std::size_t room = std::min(output.room(), kMaxChunkBytes);
    stream.avail_out = static_cast<unsigned>(room);
    const unsigned before = stream.avail_in;
    status = BZ2_bzDecompress(&stream);
    if (status != BZ_OK && status != BZ_STREAM_END) throw Broken("damaged bz2 data");
    const std::size_t made = room - stream.avail_out;
    if (status == BZ_OK && made == 0 && stream.avail_in == before) throw Broken("damaged bz2 data: they end too early");
    output.advance(made);
  }
}

}  // namespace

void decompress(const std::string& method, const std::uint8_t* data, std::size_t size, std::size_t expected,
                std::vector<std::uint8_t>& result) {
  if (expected > kMaxChunkBytes || size > kMaxChunkBytes)
    throw Broken("a chunk of more than " + std::to_string(kMaxChunkBytes) + " bytes");
  if (method.empty() || method == "none") {
    if (expected != 0 && expected != size) throw Broken("a chunk of another size than it says");
    result.assign(data, data + size);
    return;
  }
  Output output(result, expected);
  if (method == "lz4")
    decompressLz4(data, size, output);
  else if (method == "zstd")
    decompressZstd(data, size, output);
  else if (method == "bz2")
    decompressBz2(data, size, output);
  else
    throw Broken("a chunk compressed by an unknown method");
  output.finish(expected);
}

bool isZstd(const std::uint8_t* data, std::size_t size) {
  return size >= 4 && ByteCursor(data, size).number<std::uint32_t>() == 0xFD2FB528U;
}

}  // namespace lisco_apps
