// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// Puts returns into azimuth bins: several at once where they continue a laser's sequence of bins.
#include <algorithm>
#include <cmath>

#include "core/far/range_image.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/far/placement.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "core/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace lisco {
namespace HWY_NAMESPACE {

/// Lanes whose azimuth is that of their bin, within the image's deviation.
/// \param bin of the first lane
HWY_INLINE FloatMask areInBins(const RangeImage& image, std::int64_t bin, FloatVector u, FloatVector v,
                               FloatVector rho) {
  const auto index = static_cast<std::size_t>(bin + static_cast<std::int64_t>(RangeImage::kMargin));
  const FloatVector cosine = hn::LoadU(kFloats, &image.cosine[index]);
  const FloatVector sine = hn::LoadU(kFloats, &image.sine[index]);
  const FloatVector across = hn::Abs(hn::Sub(hn::Mul(u, sine), hn::Mul(v, cosine)));
  const FloatVector along = hn::Add(hn::Mul(u, cosine), hn::Mul(v, sine));
  const FloatVector deviation = hn::Set(kFloats, image.deviation_sine);
  return hn::And(hn::Le(across, hn::Mul(rho, deviation)), hn::Gt(along, hn::Zero(kFloats)));
}

/// Places one ring block.
class Placement {
 public:
  Placement(RangeImage& image, const RingBlock& block, const RingBlockInfo& info, std::size_t laser,
            std::uint32_t first_column)
      : image_(image), block_(block), info_(info), laser_(laser), first_column_(first_column) {}

  /// \return the returns that are unplaced
  ColumnBits run() {
    turnToStart();
    // The bin of the block's first cell if the laser's returns go on as before.
    const RangeImage::Row& row = firstRow();
    first_bin_ = row.next_bin == RangeImage::kNoBin ? static_cast<std::int64_t>(RangeImage::kMargin) + first_column_ -
                                                          std::int64_t{image_.first_column}
                                                    : row.next_bin + first_column_ - std::int64_t{row.next_column};
    ColumnBits left = info_.far;
    while (left != 0) {
      const ColumnBits together = left & before(firstOffBin(left));
      if (together != 0) placeTogether(together);
      left &= ~together;
      if (left == 0) break;
      const auto i = static_cast<std::size_t>(__builtin_ctzll(left));
      if (!realignTo(i)) left &= left - 1;
    }
    return unplaced_;
  }

 private:
  /// All bits before the one that is set; all of them if none is.
  static ColumnBits before(ColumnBits bit) { return bit != 0 ? bit - 1 : ~ColumnBits{0}; }

  /// Of the laser; it keeps the laser's latest bin and column.
  RangeImage::Row& firstRow() { return image_.rows[image_.firstRowOf(laser_)]; }
  /// Expects the laser's next return behind a column of the block.
  void expectAfter(std::size_t i) {
    firstRow().next_bin = first_bin_ + static_cast<std::int64_t>(i) + 1;
    firstRow().next_column = first_column_ + static_cast<std::uint32_t>(i) + 1;
  }

  std::int64_t bins() const { return static_cast<std::int64_t>(image_.bins); }

  /// Horizontal vectors as seen from bin 0.
  void turnToStart() {
    const FloatVector cosine = hn::Set(kFloats, image_.start_cosine);
    const FloatVector sine = hn::Set(kFloats, image_.start_sine);
    const FloatVector direction = hn::Set(kFloats, image_.direction);
    for (std::size_t k = 0; k < RingBlock::kColumns; k += kLanes) {
      if (bitsAt(info_.far, k) == 0) continue;
      const FloatVector east =
          hn::Sub(hn::LoadU(kFloats, block_.x + RingBlock::kMargin + k), hn::Set(kFloats, image_.range.origin[0]));
      const FloatVector north =
          hn::Sub(hn::LoadU(kFloats, block_.y + RingBlock::kMargin + k), hn::Set(kFloats, image_.range.origin[1]));
      hn::StoreU(hn::Add(hn::Mul(east, cosine), hn::Mul(north, sine)), kFloats, u_ + k);
      hn::StoreU(hn::Mul(direction, hn::Sub(hn::Mul(north, cosine), hn::Mul(east, sine))), kFloats, v_ + k);
    }
  }

  /// The bit of the first of some returns that does not belong into its expected bin: that is outside the image, or not
  /// the one of its azimuth; 0 if there is none.
  ColumnBits firstOffBin(ColumnBits left) const {
    // Bins in the margins hold no returns, but have a cosine and a sine, which a block may need.
    constexpr auto kMostOutside = static_cast<std::int64_t>(RangeImage::kMargin) - 1;
    if (first_bin_ < -kMostOutside || first_bin_ > bins() - 1 + kMostOutside) return left & -left;
    const ColumnBits outside = left & ~insideOf();
    const ColumnBits off = firstOffAzimuth(outside != 0 ? left & before(outside & -outside) : left);
    return off != 0 ? off : outside & -outside;
  }

  /// The columns of the block whose expected bins are within the image.
  ColumnBits insideOf() const {
    ColumnBits inside = ~ColumnBits{0};
    if (first_bin_ < 0) inside &= bitsFrom(static_cast<std::size_t>(-first_bin_));
    if (first_bin_ + static_cast<std::int64_t>(RingBlock::kColumns) > bins())
      inside &= ~bitsFrom(static_cast<std::size_t>(std::max<std::int64_t>(0, bins() - first_bin_)));
    return inside;
  }

  ColumnBits firstOffAzimuth(ColumnBits left) const {
    if (left == 0) return 0;
    const auto next = static_cast<std::size_t>(__builtin_ctzll(left));
    for (std::size_t k = next / kLanes * kLanes; k < RingBlock::kColumns; k += kLanes) {
      const std::uint64_t here = bitsAt(left, k);
      if (here == 0) continue;
      const FloatMask in_bins = areInBins(image_, first_bin_ + static_cast<std::int64_t>(k), hn::LoadU(kFloats, u_ + k),
                                          hn::LoadU(kFloats, v_ + k), hn::LoadU(kFloats, info_.rho + k));
      const ColumnBits off = (here & ~std::uint64_t{bitsOf(in_bins)}) << k;
      if (off != 0) return off & -off;
    }
    return 0;
  }

  /// Stores returns in their expected bins, which are within the image, where these are free in a row of the laser.
  void placeTogether(ColumnBits together) {
    const ColumnBits placed = store(together);
    unplaced_ |= together & ~placed;
    const auto last = static_cast<std::size_t>(63 - __builtin_clzll(together));
    image_.placed += countBits(placed);
    image_.begin = std::min(image_.begin, static_cast<std::size_t>(first_bin_ + __builtin_ctzll(together)));
    image_.end = std::max(image_.end, static_cast<std::size_t>(first_bin_ + static_cast<std::int64_t>(last) + 1));
    noteLate(placed);
    expectAfter(last);
  }

  /// \return the returns that are stored; the bins of the others are taken in all rows
  ColumnBits store(ColumnBits which) {
    ColumnBits left = which;
    for (std::size_t layer = 0; left != 0; ++layer) {
      if (layer == image_.layers) {
        if (!image_.isLayerWorthwhile()) break;
        image_.addLayer();
      }
      const std::size_t number = image_.firstRowOf(laser_) + layer;
      if (!image_.rows[number].is_open) image_.openRow(number);
      left &= ~storeInRow(number, left);
    }
    return which & ~left;
  }

  /// \return the returns that are stored
  ColumnBits storeInRow(std::size_t row, ColumnBits which) {
    ColumnBits stored = 0;
    const WritableRowBins bins = image_.at(row, first_bin_);
    for (std::size_t k = 0; k < RingBlock::kColumns; k += kLanes) {
      const std::uint64_t here = bitsAt(which, k);
      if (here == 0) continue;
      const std::uint64_t free = bitsOf(hn::IsNaN(hn::LoadU(kFloats, bins.x() + k))) & here;
      stored |= free << k;
      const FloatMask mask = lanesOf(free);
      // Not hn::BlendedStore (), which AVX2 executes slowly on AMD's processors.
      const auto storeFree = [mask, k](auto lanes, const auto* from, auto* to) {
        const auto chosen = hn::RebindMask(lanes, mask);
        hn::StoreU(hn::IfThenElse(chosen, hn::LoadU(lanes, from + k), hn::LoadU(lanes, to + k)), lanes, to + k);
      };
      storeFree(kFloats, block_.x + RingBlock::kMargin, bins.x());
      storeFree(kFloats, block_.y + RingBlock::kMargin, bins.y());
      storeFree(kFloats, block_.z + RingBlock::kMargin, bins.z());
      storeFree(kWords, info_.run, bins.element());
    }
    return stored;
  }

  /// Notes the returns placed in bins before RangeImage::scheduled, which linking may have passed.
  void noteLate(ColumnBits placed) {
    const std::int64_t first_open = static_cast<std::int64_t>(image_.scheduled) - first_bin_;
    if (first_open <= 0) return;
    forEachBit(placed & ~bitsFrom(static_cast<std::size_t>(first_open)), [&](std::size_t i) {
      image_.late.push_back({block_.x[RingBlock::kMargin + i], block_.y[RingBlock::kMargin + i],
                             block_.z[RingBlock::kMargin + i], info_.run[i]});
    });
  }

  /// Sets the expected bins from the azimuth of a return. \return false if that return is outside the image: unplaced
  bool realignTo(std::size_t i) {
    ++image_.realigned;
    const std::int64_t expected = first_bin_ + static_cast<std::int64_t>(i);
    std::int64_t bin = binBeside(expected, i);
    if (bin < 0 || bin >= bins()) bin = binOf(expected, i);
    first_bin_ = bin - static_cast<std::int64_t>(i);
    if (bin >= 0 && bin < bins()) return true;
    unplaced_ |= ColumnBits{1} << i;
    expectAfter(i);
    return false;
  }

  /// The bin of a return within 0.05 radians of the expected one, perhaps outside the image; -1 if it is further off.
  std::int64_t binBeside(std::int64_t expected, std::size_t i) const {
    constexpr float kSmall = 0.05F;  // tangent, of which two terms of the series give the angle within 1e-7 radians
    if (expected < 0 || expected >= bins()) return -1;
    const auto index = static_cast<std::size_t>(expected) + RangeImage::kMargin;
    const float cosine = image_.cosine[index], sine = image_.sine[index];
    const float across = v_[i] * cosine - u_[i] * sine, along = u_[i] * cosine + v_[i] * sine;
    if (!(std::fabs(across) < kSmall * along)) return -1;
    const float tangent = across / along;
    return expected + std::lrint((tangent - tangent * tangent * tangent / 3.0F) / image_.radians_per_bin);
  }

  /// The bin of a return in the turn of an expected one, or in the turn before if that is not in the image.
  std::int64_t binOf(std::int64_t expected, std::size_t i) const {
    const std::int64_t measured = image_.binOf({u_[i], v_[i]});
    const auto turn = static_cast<std::int64_t>(image_.steps);
    const std::int64_t bin =
        measured + turn * std::llround(static_cast<double>(expected - measured) / static_cast<double>(turn));
    // A scan of more than a turn goes on at the beginning of the image.
    return bin < bins() ? bin : bin - turn * ((bin - bins()) / turn + 1);
  }

  RangeImage& image_;
  const RingBlock& block_;
  const RingBlockInfo& info_;
  std::size_t laser_;
  std::uint32_t first_column_;
  std::int64_t first_bin_ = 0;
  ColumnBits unplaced_ = 0;
  float u_[RingBlock::kColumns];
  float v_[RingBlock::kColumns];
};

ColumnBits placeBlock(RangeImage& image, const RingBlock& block, const RingBlockInfo& info, std::size_t laser,
                      std::uint32_t first_column) {
  return Placement(image, block, info, laser, first_column).run();
}

}  // namespace HWY_NAMESPACE
}  // namespace lisco
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lisco {

HWY_EXPORT(placeBlock);

ColumnBits placeReturns(RangeImage& image, const RingBlock& block, const RingBlockInfo& info, std::size_t laser,
                        std::uint32_t first_column) {
  return HWY_DYNAMIC_DISPATCH(placeBlock)(image, block, info, laser, first_column);
}

}  // namespace lisco
#endif
