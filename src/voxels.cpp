// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "lisco/voxels.h"

#include <algorithm>
#include <cmath>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "voxels.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "lanes-inl.h"

#ifndef LISCO_CUBE_NUMBERS
#define LISCO_CUBE_NUMBERS
namespace lisco {
namespace {

/// Of a row's returns, along each axis; the first place is empty. Modulo 2^32: cubes that share numbers cost time,
/// nothing else.
struct CubeNumbers {
  std::uint32_t of[3][1 + Row::kColumns];
};

/// The points of a unit, side by side.
struct PointsOfUnit {
  const float* x;
  const float* y;
  const float* z;
  std::size_t count;
};

/// Some of a unit's.
struct GatheredPoints {
  static constexpr std::size_t kMost = 64;
  float x[kMost], y[kMost], z[kMost];
  std::size_t count = 0;
};

// Up to here, numbers computed in float are good enough; see kSide.
constexpr float kSafeNumbers = 1 << 20;

}  // namespace
}  // namespace lisco
#endif

HWY_BEFORE_NAMESPACE();
namespace lisco {
namespace HWY_NAMESPACE {

/// Numbers that may be converted to integers: what is no return, or too far away, counts for nothing. Instructions make
/// something of any number, but C++ does not.
HWY_INLINE FloatVector convertible(FloatVector number) {
#if HWY_TARGET == HWY_EMU128 || HWY_TARGET == HWY_SCALAR
  return hn::IfThenElseZero(hn::Le(hn::Abs(number), hn::Set(kFloats, kSafeNumbers)), number);
#else
  return number;
#endif
}

/// The numbers of each return's cube along the axes.
/// \param which bit i: return i
/// \param changes bit i is set if return i lies in another cube than return i - 1
/// \return whether all are at most kSafeNumbers; if not, they are of no use
bool numberCubes(const Row& row, std::uint64_t which, float per_metre, CubeNumbers& numbers, std::uint64_t& changes) {
  const hn::RebindToSigned<Floats> signed_words;
  const FloatVector scale = hn::Set(kFloats, per_metre);
  FloatVector farthest = hn::Zero(kFloats);
  const float* const coordinates[3] = {row.x + Row::kMargin, row.y + Row::kMargin, row.z + Row::kMargin};
  changes = 0;
  for (std::size_t k = 0; k < Row::kColumns; k += kLanes) {
    if ((which >> k & ((std::uint64_t{1} << kLanes) - 1)) == 0) continue;
    const FloatVector x = hn::LoadU(kFloats, coordinates[0] + k);
    const FloatMask returned = hn::Eq(x, x);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const FloatVector number = hn::Mul(hn::LoadU(kFloats, coordinates[axis] + k), scale);
      farthest = hn::Max(farthest, hn::IfThenElseZero(returned, hn::Abs(number)));
      hn::StoreU(hn::BitCast(kWords, hn::ConvertTo(signed_words, convertible(hn::Floor(number)))), kWords,
                 numbers.of[axis] + 1 + k);
    }
  }
  // Not at once: what has just been stored is slow to be read at another offset.
  for (std::size_t k = 0; k < Row::kColumns; k += kLanes) {
    if ((which >> k & ((std::uint64_t{1} << kLanes) - 1)) == 0) continue;
    const auto changed = [&](std::size_t axis) {
      return differ(numbers.of[axis] + k, hn::LoadU(kWords, numbers.of[axis] + k + 1));
    };
    changes |= std::uint64_t{bitsOf(hn::Or(changed(0), hn::Or(changed(1), changed(2))))} << k;
  }
  return hn::GetLane(hn::MaxOfLanes(kFloats, farthest)) <= kSafeNumbers;
}

/// Gathers the points of a unit, from one on, that may be neighbours of something in a box.
/// \return where to go on
std::size_t gather(const PointsOfUnit& unit, std::size_t from, const Box& box, float squared_tolerance,
                   GatheredPoints& points) {
  const FloatVector r2 = hn::Set(kFloats, squared_tolerance);
  const auto gap = [](FloatVector coordinate, float lo, float hi) {
    const FloatVector outside =
        hn::Max(hn::Sub(coordinate, hn::Set(kFloats, hi)), hn::Sub(hn::Set(kFloats, lo), coordinate));
    return hn::Max(outside, hn::Zero(kFloats));
  };
  points.count = 0;
  for (; from < unit.count && points.count <= GatheredPoints::kMost - kLanes; from += kLanes) {
    const FloatVector x = hn::LoadU(kFloats, unit.x + from);
    const FloatVector y = hn::LoadU(kFloats, unit.y + from);
    const FloatVector z = hn::LoadU(kFloats, unit.z + from);
    // Box::squaredGap, lane by lane
    const FloatMask near =
        areNeighbours(gap(x, box.lo[0], box.hi[0]), gap(y, box.lo[1], box.hi[1]), gap(z, box.lo[2], box.hi[2]), r2);
    const FloatMask chosen = hn::And(near, hn::FirstN(kFloats, unit.count - from));
    hn::CompressStore(x, chosen, kFloats, points.x + points.count);
    hn::CompressStore(y, chosen, kFloats, points.y + points.count);
    points.count += hn::CompressStore(z, chosen, kFloats, points.z + points.count);
  }
  return from;
}

/// Whether any two points of two lists are neighbours.
bool anyNeighbours(const GatheredPoints& a, GatheredPoints& b, FloatVector r2) {
  for (std::size_t i = b.count; i % kLanes != 0; ++i) b.x[i] = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t i = 0; i < a.count; ++i) {
    const FloatVector x = hn::Set(kFloats, a.x[i]);
    const FloatVector y = hn::Set(kFloats, a.y[i]);
    const FloatVector z = hn::Set(kFloats, a.z[i]);
    FloatMask any = hn::Lt(r2, hn::Zero(kFloats));
    for (std::size_t k = 0; k < b.count; k += kLanes)
      any = hn::Or(any, areNeighbours(hn::Sub(x, hn::LoadU(kFloats, b.x + k)), hn::Sub(y, hn::LoadU(kFloats, b.y + k)),
                                      hn::Sub(z, hn::LoadU(kFloats, b.z + k)), r2));
    if (!hn::AllFalse(kFloats, any)) return true;
  }
  return false;
}

/// Whether any point of one unit is a neighbour of any point of another.
bool comparePoints(const PointsOfUnit& a, const Box& a_box, const PointsOfUnit& b, const Box& b_box,
                   float squared_tolerance) {
  GatheredPoints some_of_a;
  GatheredPoints some_of_b;
  for (std::size_t at_a = 0; at_a < a.count;) {
    at_a = gather(a, at_a, b_box, squared_tolerance, some_of_a);
    if (some_of_a.count == 0) continue;
    for (std::size_t at_b = 0; at_b < b.count;) {
      at_b = gather(b, at_b, a_box, squared_tolerance, some_of_b);
      if (anyNeighbours(some_of_a, some_of_b, hn::Set(kFloats, squared_tolerance))) return true;
    }
  }
  return false;
}

}  // namespace HWY_NAMESPACE
}  // namespace lisco
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lisco {
namespace {

HWY_EXPORT(numberCubes);
HWY_EXPORT(comparePoints);

// A little less than eps / sqrt (3). Rounding moves a return by less than an eighth of a cube, so that
// neighbours, which are 1.7323 sides apart at most, lie in cubes whose numbers differ by 2 at most.
constexpr double kSide = 0.9999 / 1.7320508075688772;
constexpr double kMostNumber = 2251799813685248.0;  // 2^51: up to here, numbers computed in double are that good
constexpr std::uint32_t kBlockMask = (std::uint32_t{1} << 30) - 1;
constexpr std::size_t kFewestSlots = 256;
constexpr std::size_t kNeighbourBlocks = 27;
constexpr unsigned kOrderBits = 21;     // of a block's number along an axis; safe ones have less
constexpr std::size_t kMostLanes = 16;  // read behind the last point

/// masks[cube][i]: those cubes of neighbour block i whose numbers differ by 2 at most from the cube's.
struct Neighbourhood {
  std::uint64_t all[64][kNeighbourBlocks] = {};

  Neighbourhood() {
    for (int cube = 0; cube < 64; ++cube)
      for (int dz = -2; dz <= 2; ++dz)
        for (int dy = -2; dy <= 2; ++dy)
          for (int dx = -2; dx <= 2; ++dx) {
            const int x = (cube & 3) + dx;
            const int y = (cube >> 2 & 3) + dy;
            const int z = (cube >> 4) + dz;
            const auto block = [](int number) -> std::size_t { return number < 0 ? 0 : number > 3 ? 2 : 1; };
            const std::size_t i = block(z) * 9 + block(y) * 3 + block(x);
            const std::uint64_t bit = std::uint64_t{1} << ((x & 3) | (y & 3) << 2 | (z & 3) << 4);
            all[cube][i] |= bit;
          }
  }
};

const Neighbourhood kNeighbourhood;

/// How many bits are set, without the instruction for it, which the oldest processors do not have.
std::uint32_t countBits(std::uint64_t bits) {
  bits -= bits >> 1 & 0x5555555555555555U;
  bits = (bits & 0x3333333333333333U) + (bits >> 2 & 0x3333333333333333U);
  bits = (bits + (bits >> 4)) & 0x0F0F0F0F0F0F0F0FU;
  return static_cast<std::uint32_t>(bits * 0x0101010101010101U >> 56);
}

std::uint32_t hashOf(const std::array<std::uint32_t, 3>& key) {
  // Teschner et al. 2003, with a final mix so that flat scenes use the whole table.
  std::uint32_t hash = key[0] * 73856093U ^ key[1] * 19349663U ^ key[2] * 83492791U;
  hash ^= hash >> 15;
  return hash;
}

bool sameKey(const std::array<std::uint32_t, 3>& a, const std::array<std::uint32_t, 3>& b) {
  return ((a[0] ^ b[0]) | (a[1] ^ b[1]) | (a[2] ^ b[2])) == 0;
}

}  // namespace

void Voxels::prepare(const Tolerance& tolerance) {
  tolerance_ = tolerance;
  cubes_per_metre_ = 1.0 / (kSide * std::max(tolerance.reach(), 1e-22));
  safe_ = cubes_per_metre_ > 1e-30 && cubes_per_metre_ < 1e30;
  points_ = 0;
  pieces_.clear();
  units_.clear();
  blocks_.clear();
  first_units_.clear();
  new_blocks_.clear();
  footprint_.clear();
  recent_units_.fill({Key{}, kNone});
  all_safe_ = true;
  anything_linked_ = false;
  if (slots_.size() < kFewestSlots)
    slots_.assign(kFewestSlots, kNone);
  else
    std::fill(slots_.begin(), slots_.end(), kNone);
}

void Voxels::add(const Row& row, const MeasuredRow& measured, std::uint64_t which, DisjointSets& subclusters) {
  if (!tolerance_.joinsAnything()) return;
  const float* const x = row.x + Row::kMargin;
  const float* const y = row.y + Row::kMargin;
  const float* const z = row.z + Row::kMargin;
  CubeNumbers numbers;
  std::uint64_t changes = 0;
  if (!safe_ ||
      !HWY_DYNAMIC_DISPATCH(numberCubes)(row, which, static_cast<float>(cubes_per_metre_), numbers, changes)) {
    for (std::uint64_t left = which; left != 0; left &= left - 1) {
      const auto i = static_cast<std::size_t>(__builtin_ctzll(left));
      const float point[3] = {x[i], y[i], z[i]};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double number =
            std::clamp(static_cast<double>(point[axis]) * cubes_per_metre_, -kMostNumber, kMostNumber);
        numbers.of[axis][1 + i] = static_cast<std::uint32_t>(static_cast<std::int64_t>(std::floor(number)));
      }
    }
    changes = ~std::uint64_t{0};
    all_safe_ = false;
  }
  // A piece goes on where the return before is there, in the same run and in the same cube.
  const std::uint64_t begins = which & ~(which << 1 & ~measured.starts & ~changes);
  const std::uint64_t ends = ~which | begins;
  std::size_t point = newPoints(countBits(which));
  for (std::uint64_t left = begins; left != 0; left &= left - 1) {
    const auto begin = static_cast<std::size_t>(__builtin_ctzll(left));
    const std::uint64_t after = begin == Row::kColumns - 1 ? 0 : ends & ~std::uint64_t{0} << (begin + 1);
    const std::size_t end = after != 0 ? static_cast<std::size_t>(__builtin_ctzll(after)) : Row::kColumns;
    const auto piece = static_cast<std::uint32_t>(pieces_.size());
    pieces_.push_back({static_cast<std::uint32_t>(point), static_cast<std::uint32_t>(end - begin), kNone});
    Box box = Box::around(x[begin], y[begin], z[begin]);
    for (std::size_t i = begin; i < end; ++i, ++point) {
      x_[point] = x[i];
      y_[point] = y[i];
      z_[point] = z[i];
      box.add(Box::around(x[i], y[i], z[i]));
    }
    addPiece({numbers.of[0][1 + begin], numbers.of[1][1 + begin], numbers.of[2][1 + begin]}, box, piece,
             measured.run[begin], subclusters);
  }
}

/// Makes room for so many points more. \return the first of them
std::size_t Voxels::newPoints(std::size_t count) {
  const std::size_t first = points_;
  points_ += count;
  const std::size_t size = points_ + kMostLanes;
  if (x_.size() < size)
    for (auto* coordinate : {&x_, &y_, &z_}) {
      coordinate->reserve(size + size / 4);  // or it would double
      coordinate->resize(size + size / 4);
    }
  return first;
}

void Voxels::addPiece(const Key& cube, const Box& box, std::uint32_t piece, std::uint32_t element,
                      DisjointSets& subclusters) {
  // Most cubes have been met a little before.
  RecentUnit& recent = recent_units_[hashOf(cube) % kRecentUnits];
  if (recent.unit != kNone && sameKey(recent.cube, cube)) {
    Unit& unit = units_[recent.unit];
    if (unit.is_new && Box::squaredSpan(unit.box, box) < tolerance_.squared()) {
      addTo(unit, box, piece, element, subclusters);
      return;
    }
  }
  const Key key{cube[0] >> 2, cube[1] >> 2, cube[2] >> 2};
  const std::uint32_t block_number = makeBlock(key);
  Block& block = blocks_[block_number];
  if (!block.is_new) {
    block.is_new = true;
    new_blocks_.push_back(block_number);
  }
  std::uint32_t& first = firstUnit(block, (cube[0] & 3U) | (cube[1] & 3U) << 2 | (cube[2] & 3U) << 4);
  for (std::uint32_t i = first; i != kNone; i = units_[i].next_in_cube) {
    Unit& unit = units_[i];
    if (!(Box::squaredSpan(unit.box, box) < tolerance_.squared())) continue;
    addTo(unit, box, piece, element, subclusters);
    recent = {cube, i};
    return;
  }
  const auto number = static_cast<std::uint32_t>(units_.size());
  units_.push_back({box, element, piece, first, true});
  first = number;
  recent = {cube, number};
}

void Voxels::addTo(Unit& unit, const Box& box, std::uint32_t piece, std::uint32_t element, DisjointSets& subclusters) {
  unit.box.add(box);
  unit.is_new = true;
  pieces_[piece].next_in_unit = unit.first_piece;
  unit.first_piece = piece;
  if (unit.head != element) unit.head = subclusters.merge(unit.head, element);
}

std::uint32_t Voxels::findBlock(const Key& key) const {
  const std::size_t mask = slots_.size() - 1;
  for (std::size_t slot = hashOf(key) & mask;; slot = (slot + 1) & mask)
    if (slots_[slot] == kNone || sameKey(blocks_[slots_[slot]].key, key)) return slots_[slot];
}

std::uint32_t Voxels::makeBlock(const Key& key) {
  const std::uint32_t found = findBlock(key);
  if (found != kNone) return found;
  const auto number = static_cast<std::uint32_t>(blocks_.size());
  blocks_.push_back({key, 0, 0, kNone, 0, false});
  footprint_.add(key);
  if (2 * blocks_.size() > slots_.size())
    rehash(2 * slots_.size());
  else
    takeSlot(number);
  return number;
}

void Voxels::rehash(std::size_t slots) {
  slots_.assign(slots, kNone);
  for (std::size_t block = 0; block < blocks_.size(); ++block) takeSlot(static_cast<std::uint32_t>(block));
}

/// Puts a block that is not in the table where it is looked for.
void Voxels::takeSlot(std::uint32_t block) {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hashOf(blocks_[block].key) & mask;
  while (slots_[slot] != kNone) slot = (slot + 1) & mask;
  slots_[slot] = block;
}

/// The first unit of a cube, kNone if it is new. The list of a block has one entry for each cube in use, in the
/// order of their bits; it moves to the end when it outgrows its room.
std::uint32_t& Voxels::firstUnit(Block& block, std::uint32_t cube) {
  const std::uint64_t bit = std::uint64_t{1} << cube;
  const auto rank = countBits(block.occupied & (bit - 1));
  if ((block.occupied & bit) != 0) return first_units_[block.units + rank];
  const auto used = countBits(block.occupied);
  if (used == block.room) {
    const auto moved = static_cast<std::uint32_t>(first_units_.size());
    block.room = std::max<std::uint32_t>(4, 2 * block.room);
    first_units_.resize(first_units_.size() + block.room);
    std::copy_n(first_units_.begin() + block.units, used, first_units_.begin() + moved);
    block.units = moved;
  }
  block.occupied |= bit;
  const auto list = first_units_.begin() + block.units;
  std::copy_backward(list + rank, list + used, list + used + 1);
  return *(list + rank) = kNone;
}

/// Calls visit(cube, unit) for all units of a block.
template <typename Visit>
void Voxels::forEachUnit(const Block& block, Visit&& visit) const {
  std::uint32_t rank = 0;
  for (std::uint64_t left = block.occupied; left != 0; left &= left - 1, ++rank)
    for (std::uint32_t unit = first_units_[block.units + rank]; unit != kNone; unit = units_[unit].next_in_cube)
      visit(static_cast<std::size_t>(__builtin_ctzll(left)), unit);
}

void Voxels::link(DisjointSets& subclusters) {
  if (!anything_linked_ && all_safe_) {
    linkInOrder(subclusters);
  } else {
    for (const std::uint32_t block : new_blocks_) blocks_[block].head = commonHead(blocks_[block], subclusters);
    for (const std::uint32_t block : new_blocks_) linkNew(blocks_[block], subclusters);
  }
}

void Voxels::settle() {
  for (const std::uint32_t block : new_blocks_) {
    blocks_[block].is_new = false;
    forEachUnit(blocks_[block], [&](std::size_t, std::uint32_t unit) { units_[unit].is_new = false; });
  }
  anything_linked_ = anything_linked_ || !new_blocks_.empty();
  new_blocks_.clear();
}

/// Compares all with all. Blocks are sorted by z, y and x, so that those around one are found by going along with it in the
/// rows of blocks next to its own, without the hash table.
void Voxels::linkInOrder(DisjointSets& subclusters) {
  constexpr std::uint32_t kMiddle = std::uint32_t{1} << (kOrderBits - 1);
  const auto number = [](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    return (std::uint64_t{z} << kOrderBits | y) << kOrderBits | x;
  };
  ordered_.clear();
  for (std::uint32_t block = 0; block < blocks_.size(); ++block) {
    const auto along = [&](std::size_t axis) { return (blocks_[block].key[axis] + kMiddle) & kBlockMask; };
    ordered_.push_back({number(along(0), along(1), along(2)), block});
  }
  std::sort(ordered_.begin(), ordered_.end(), [](const Ordered& a, const Ordered& b) { return a.number < b.number; });

  constexpr std::size_t kRows = 4;  // in which a block has neighbours behind it, beside its own
  const std::uint64_t row_at[kRows] = {number(0, 1, 0), number(0, 0, 1) - number(0, 1, 0), number(0, 0, 1),
                                       number(0, 1, 1)};
  constexpr std::size_t kFirstMask[kRows] = {15, 18, 21, 24};
  std::size_t cursors[kRows] = {};
  NearBlock near[kNeighbourBlocks];
  for (std::size_t i = 0; i < ordered_.size(); ++i) {
    const Ordered& own = ordered_[i];
    std::size_t count = 0;
    const auto add = [&](std::size_t mask, const Ordered& other) {
      const Block& block = blocks_[other.block];
      near[count++] = {mask, block.occupied, block.units};
    };
    add(kNeighbourBlocks / 2, own);
    if (i + 1 < ordered_.size() && ordered_[i + 1].number == own.number + 1)
      add(kNeighbourBlocks / 2 + 1, ordered_[i + 1]);
    for (std::size_t row = 0; row < kRows; ++row) {
      const std::uint64_t first = own.number + row_at[row] - 1;
      std::size_t& at = cursors[row];
      while (at < ordered_.size() && ordered_[at].number < first) ++at;
      for (std::size_t k = at; k < ordered_.size() && ordered_[k].number <= first + 2; ++k)
        add(kFirstMask[row] + static_cast<std::size_t>(ordered_[k].number - first), ordered_[k]);
    }
    linkBlock(blocks_[own.block], near, count, subclusters);
  }
}

/// Finds the blocks around one that hold anything, and that somebody wants: wanted(block) says which.
template <typename Wanted>
std::size_t Voxels::findNear(const Key& key, NearBlock* near, Wanted&& wanted) const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < kNeighbourBlocks; ++i) {
    const auto step = [](std::size_t which) { return static_cast<std::uint32_t>(which) - 1U; };
    const std::uint32_t number =
        findBlock({(key[0] + step(i % 3)) & kBlockMask, (key[1] + step(i / 3 % 3)) & kBlockMask,
                   (key[2] + step(i / 9)) & kBlockMask});
    if (number != kNone && wanted(blocks_[number]))
      near[count++] = {i, blocks_[number].occupied, blocks_[number].units};
  }
  return count;
}

/// The head of all units of a block, kNone if they have several.
std::uint32_t Voxels::commonHead(const Block& block, DisjointSets& subclusters) {
  std::uint32_t head = kNone;
  bool common = true;
  forEachUnit(block, [&](std::size_t, std::uint32_t number) {
    Unit& unit = units_[number];
    if (unit.head == head || !common) return;
    unit.head = subclusters.head(unit.head);
    common = head == kNone || unit.head == head;
    head = unit.head;
  });
  return common ? head : kNone;
}

/// Compares the new units of a block with all units around them; each pair of new ones once. Most of what has grown belongs
/// together with all around it already: that is seen block by block.
void Voxels::linkNew(const Block& block, DisjointSets& subclusters) {
  NearBlock near[kNeighbourBlocks];
  const std::size_t count = findNear(block.key, near, [&](const Block& other) {
    if (block.head == kNone || other.head == kNone) return true;
    return subclusters.head(block.head) != subclusters.head(other.head);
  });
  if (count == 0) return;
  forEachUnit(block, [&](std::size_t cube, std::uint32_t unit) {
    if (!units_[unit].is_new) return;
    forEachAround(cube, near, count, ~std::uint64_t{0}, [&](std::uint32_t other) {
      if (!units_[other].is_new || other < unit) compare(unit, other, subclusters);
    });
  });
}

/// Compares all units of a block with those that come after them, there and in the blocks given.
void Voxels::linkBlock(const Block& block, const NearBlock* near, std::size_t count, DisjointSets& subclusters) {
  std::uint32_t rank = 0;
  for (std::uint64_t left = block.occupied; left != 0; left &= left - 1, ++rank) {
    const auto cube = static_cast<std::size_t>(__builtin_ctzll(left));
    for (std::uint32_t unit = first_units_[block.units + rank]; unit != kNone; unit = units_[unit].next_in_cube) {
      for (std::uint32_t other = units_[unit].next_in_cube; other != kNone; other = units_[other].next_in_cube)
        compare(unit, other, subclusters);
      forEachAround(cube, near, count, left & (left - 1),
                    [&](std::uint32_t other) { compare(unit, other, subclusters); });
    }
  }
}

/// Calls visit for each unit in the cubes around one, of its own block in some only.
template <typename Visit>
void Voxels::forEachAround(std::size_t cube, const NearBlock* near, std::size_t count, std::uint64_t of_own,
                           Visit&& visit) const {
  for (std::size_t i = 0; i < count; ++i) {
    std::uint64_t around = near[i].occupied & kNeighbourhood.all[cube][near[i].mask];
    if (near[i].mask == kNeighbourBlocks / 2) around &= of_own;
    for (; around != 0; around &= around - 1) {
      const std::uint64_t before = (around & -around) - 1;
      const auto place = countBits(near[i].occupied & before);
      for (std::uint32_t other = first_units_[near[i].units + place]; other != kNone;
           other = units_[other].next_in_cube)
        visit(other);
    }
  }
}

void Voxels::compare(std::uint32_t a_number, std::uint32_t b_number, DisjointSets& subclusters) {
  Unit& a = units_[a_number];
  Unit& b = units_[b_number];
  if (a.head == b.head) return;
  a.head = subclusters.head(a.head);
  b.head = subclusters.head(b.head);
  if (a.head != b.head && haveNeighbours(a, *this, b)) a.head = b.head = subclusters.merge(a.head, b.head);
}

bool Voxels::Footprint::isNear(const Key& block) const {
  // Three blocks in a row lie in two pairs at most.
  for (const std::uint32_t x : {((block[0] - 1) & kBlockMask) / 2, ((block[0] + 1) & kBlockMask) / 2})
    for (const std::uint32_t y : {((block[1] - 1) & kBlockMask) / 2, ((block[1] + 1) & kBlockMask) / 2})
      if ((bits_[wordOf(x, y)] & bitOf(x, y)) != 0) return true;
  return false;
}

void Voxels::linkTo(Voxels& other, Part part, Joiner& joiner) {
  const auto link = [&](const Block& block) {
    if (other.footprint_.isNear(block.key)) linkBlockTo(block, other, part, joiner);
  };
  if (part == Part::kAll)
    std::for_each(blocks_.begin(), blocks_.end(), link);
  else
    for (const std::uint32_t block : new_blocks_) link(blocks_[block]);
}

void Voxels::linkBlockTo(const Block& block, Voxels& other, Part part, Joiner& joiner) {
  NearBlock near[kNeighbourBlocks];
  std::size_t count = 0;
  bool searched = false;
  forEachUnit(block, [&](std::size_t cube, std::uint32_t number) {
    Unit& unit = units_[number];
    if ((part == Part::kNew && !unit.is_new) || !joiner.reaches(unit.box)) return;
    if (!searched)
      count = other.findNear(block.key, near, [&](const Block& others) {
        return block.head == kNone || others.head == kNone || joiner.areApart(block.head, others.head);
      });
    searched = true;
    other.forEachAround(cube, near, count, ~std::uint64_t{0}, [&](std::uint32_t j) {
      Unit& others = other.units_[j];
      if (Box::squaredGap(unit.box, others.box) < tolerance_.squared() && joiner.areApart(unit.head, others.head) &&
          haveNeighbours(unit, other, others))
        joiner.join(unit.head, others.head);
    });
  });
}

/// Makes few pieces of the many that a unit may have, so that points lie side by side: the newest is joined with those that
/// are not more than twice as large, so that each of the others is more than twice as large as the one before, and
/// no point moves often.
void Voxels::unite(Unit& unit) {
  std::uint32_t count = pieces_[unit.first_piece].count;
  std::uint32_t end = pieces_[unit.first_piece].next_in_unit;
  if (end == kNone || pieces_[end].count > 2 * count) return;
  for (; end != kNone && pieces_[end].count <= 2 * count; end = pieces_[end].next_in_unit) count += pieces_[end].count;
  const std::size_t first = newPoints(count);
  std::size_t point = first;
  for (std::uint32_t i = unit.first_piece; i != end; i = pieces_[i].next_in_unit)
    for (std::uint32_t k = pieces_[i].first_point; k < pieces_[i].first_point + pieces_[i].count; ++k, ++point) {
      x_[point] = x_[k];
      y_[point] = y_[k];
      z_[point] = z_[k];
    }
  pieces_[unit.first_piece] = {static_cast<std::uint32_t>(first), count, end};
}

/// Whether any return of one unit is a neighbour of any return of another one's.
bool Voxels::haveNeighbours(Unit& own, Voxels& other, Unit& others) {
  const float squared_tolerance = tolerance_.squared();
  if (!(Box::squaredGap(own.box, others.box) < squared_tolerance)) return false;
  if (Box::squaredSpan(own.box, others.box) < squared_tolerance) return true;
  unite(own);
  other.unite(others);
  const auto pointsOf = [](const Voxels& voxels, const Piece& piece) {
    const std::size_t first = piece.first_point;
    return PointsOfUnit{&voxels.x_[first], &voxels.y_[first], &voxels.z_[first], piece.count};
  };
  for (std::uint32_t i = own.first_piece; i != kNone; i = pieces_[i].next_in_unit)
    for (std::uint32_t k = others.first_piece; k != kNone; k = other.pieces_[k].next_in_unit)
      if (HWY_DYNAMIC_DISPATCH(comparePoints)(pointsOf(*this, pieces_[i]), own.box, pointsOf(other, other.pieces_[k]),
                                              others.box, squared_tolerance))
        return true;
  return false;
}

}  // namespace lisco
#endif
