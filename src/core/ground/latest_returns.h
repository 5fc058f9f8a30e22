// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/aligned_vector.h"
#include "core/ground/block.h"

namespace lisco::ground {

/// How the rows have turned from one block to the next.
struct Turned {
  std::array<float, Block::kColumns> angles{};  ///< sums of the changes of azimuth, each of every eighth row
  std::size_t rows = 0;                         ///< number of rows in the sums
  bool has_new = false;                         ///< a row has its first return
};

/// The latest return of each row. Arrays are by row, and longer than there are rows.
struct LatestReturns {
  AlignedVector<float> x, y, rho, height;  ///< as in Block
  AlignedVector<float> azimuth;            ///< radians, 0 to 2 pi, within 0.004
  AlignedVector<std::int32_t> sector;      ///< of the azimuth
  AlignedVector<std::uint32_t> block;      ///< number of the block with the return; 0: none yet

  /// Forgets all returns. Allocates only if there are more lasers than ever before.
  void begin(std::size_t lasers);
  /// Enters a block's returns.
  /// \param number of the block, from 1 on
  Turned update(const Block& block, std::uint32_t number);

 private:
  std::size_t lasers_ = 0;
};

}  // namespace lisco::ground
