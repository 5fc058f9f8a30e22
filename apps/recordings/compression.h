// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lisco_apps {

/// Bytes of the largest chunk or message that is read.
inline constexpr std::size_t kMaxChunkBytes = std::size_t{1} << 30;

/// Decompresses one chunk.
/// \param method "lz4" (frames), "zstd" or "bz2"; "" and "none" copy
/// \param expected bytes of the result; 0: unknown
/// \throws Broken if the method is unknown, the data are damaged, of another size, or beyond kMaxChunkBytes
void decompress(const std::string& method, const std::uint8_t* data, std::size_t size, std::size_t expected,
                std::vector<std::uint8_t>& result);

/// Whether data begin as a zstd frame does; no serialized message begins so.
bool isZstd(const std::uint8_t* data, std::size_t size);

}  // namespace lisco_apps
