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

// Up to here, numbers computed in float are good enough; see kSide.
constexpr float kSafeNumbers = 1 << 20;

}  // namespace
}  // namespace lisco
#endif

HWY_BEFORE_NAMESPACE();
namespace lisco {
namespace HWY_NAMESPACE {

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
    FloatMask changed = hn::Lt(farthest, farthest);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const FloatVector number = hn::Mul(hn::LoadU(kFloats, coordinates[axis] + k), scale);
      farthest = hn::Max(farthest, hn::IfThenElseZero(returned, hn::Abs(number)));
      std::uint32_t* const own = numbers.of[axis] + 1 + k;
      hn::StoreU(hn::BitCast(kWords, hn::ConvertTo(signed_words, hn::Floor(number))), kWords, own);
      changed = hn::Or(changed, differ(own, hn::LoadU(kWords, own - 1)));
    }
    changes |= std::uint64_t{bitsOf(changed)} << k;
  }
  return hn::GetLane(hn::MaxOfLanes(kFloats, farthest)) <= kSafeNumbers;
}

/// Whether any two points of two lists are neighbours.
bool anyNeighbours(const VoxelPoints& a, VoxelPoints& b, float squared_tolerance) {
  const FloatVector r2 = hn::Set(kFloats, squared_tolerance);
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

}  // namespace HWY_NAMESPACE
}  // namespace lisco
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace lisco {
namespace {

HWY_EXPORT(numberCubes);
HWY_EXPORT(anyNeighbours);

// A little less than eps / sqrt (3). Rounding moves a return by less than an eighth of a cube, so that
// neighbours, which are 1.7323 sides apart at most, lie in cubes whose numbers differ by 2 at most.
constexpr double kSide = 0.9999 / 1.7320508075688772;
constexpr double kMostNumber = 2251799813685248.0;  // 2^51: up to here, numbers computed in double are that good
constexpr std::uint32_t kBlockMask = (std::uint32_t{1} << 30) - 1;
constexpr std::size_t kFewestSlots = 256;
constexpr std::size_t kNeighbourBlocks = 27;

/// masks[cube][i]: those cubes of neighbour block i whose numbers differ by 2 at most from the cube's.
struct Neighbourhood {
  std::uint64_t all[64][kNeighbourBlocks] = {};
  std::uint64_t later[64][kNeighbourBlocks] = {};  ///< half of them: each pair once

  Neighbourhood() {
    for (int cube = 0; cube < 64; ++cube)
      for (int dz = -2; dz <= 2; ++dz)
        for (int dy = -2; dy <= 2; ++dy)
          for (int dx = -2; dx <= 2; ++dx) {
            const int x = (cube & 3) + dx;
            const int y = (cube >> 2 & 3) + dy;
            const int z = (cube >> 4) + dz;
            const auto block = [](int number) { return number < 0 ? 0 : number > 3 ? 2 : 1; };
            const std::size_t i = static_cast<std::size_t>(block(z) * 9 + block(y) * 3 + block(x));
            const std::uint64_t bit = std::uint64_t{1} << ((x & 3) | (y & 3) << 2 | (z & 3) << 4);
            all[cube][i] |= bit;
            if (dz > 0 || (dz == 0 && (dy > 0 || (dy == 0 && dx > 0)))) later[cube][i] |= bit;
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
  for (auto* coordinate : {&x_, &y_, &z_}) coordinate->clear();
  pieces_.clear();
  units_.clear();
  blocks_.clear();
  first_units_.clear();
  new_blocks_.clear();
  latest_block_ = kNone;
  bounds_ = Box::nothing();
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
  }
  // A piece goes on where the return before is there, in the same run and in the same cube.
  const std::uint64_t begins = which & ~(which << 1 & ~measured.starts & ~changes);
  const std::uint64_t ends = ~which | begins;
  std::size_t point = x_.size();
  for (auto* coordinate : {&x_, &y_, &z_}) coordinate->resize(point + static_cast<std::size_t>(countBits(which)));
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

void Voxels::addPiece(const Key& cube, const Box& box, std::uint32_t piece, std::uint32_t element,
                      DisjointSets& subclusters) {
  const Key key{cube[0] >> 2, cube[1] >> 2, cube[2] >> 2};
  if (latest_block_ == kNone || !sameKey(blocks_[latest_block_].key, key)) latest_block_ = makeBlock(key);
  Block& block = blocks_[latest_block_];
  if (!block.is_new) {
    block.is_new = true;
    new_blocks_.push_back(latest_block_);
  }
  bounds_.add(box);
  std::uint32_t& first = firstUnit(block, (cube[0] & 3U) | (cube[1] & 3U) << 2 | (cube[2] & 3U) << 4);
  for (std::uint32_t i = first; i != kNone; i = units_[i].next_in_cube) {
    Unit& unit = units_[i];
    if (!(Box::squaredSpan(unit.box, box) < tolerance_.squared())) continue;
    unit.box.add(box);
    unit.is_new = true;
    pieces_[unit.last_piece].next_in_unit = piece;
    unit.last_piece = piece;
    if (unit.head != element) unit.head = subclusters.merge(unit.head, element);
    return;
  }
  const auto number = static_cast<std::uint32_t>(units_.size());
  units_.push_back({box, element, piece, piece, first, true});
  first = number;
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
  blocks_.push_back({key, 0, 0, 0, false});
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

void Voxels::absorb(Voxels& other, DisjointSets& subclusters) {
  const auto points = static_cast<std::uint32_t>(x_.size());
  const auto pieces = static_cast<std::uint32_t>(pieces_.size());
  x_.insert(x_.end(), other.x_.begin(), other.x_.end());
  y_.insert(y_.end(), other.y_.begin(), other.y_.end());
  z_.insert(z_.end(), other.z_.begin(), other.z_.end());
  for (Piece piece : other.pieces_) {
    piece.first_point += points;
    if (piece.next_in_unit != kNone) piece.next_in_unit += pieces;
    pieces_.push_back(piece);
  }
  bounds_.add(other.bounds_);
  for (const Block& block : other.blocks_) {
    const std::uint32_t own_number = makeBlock(block.key);
    Block& own = blocks_[own_number];
    if (!own.is_new) {
      own.is_new = true;
      new_blocks_.push_back(own_number);
    }
    std::uint32_t rank = 0;
    for (std::uint64_t left = block.occupied; left != 0; left &= left - 1, ++rank)
      for (std::uint32_t i = other.first_units_[block.units + rank]; i != kNone;) {
        Unit unit = other.units_[i];
        i = unit.next_in_cube;
        unit.first_piece += pieces;
        unit.last_piece += pieces;
        std::uint32_t& first = firstUnit(own, static_cast<std::uint32_t>(__builtin_ctzll(left)));
        Unit* like = nullptr;
        for (std::uint32_t j = first; j != kNone && like == nullptr; j = units_[j].next_in_cube)
          if (Box::squaredSpan(units_[j].box, unit.box) < tolerance_.squared()) like = &units_[j];
        if (like != nullptr) {
          like->box.add(unit.box);
          like->is_new = true;
          pieces_[like->last_piece].next_in_unit = unit.first_piece;
          like->last_piece = unit.last_piece;
          like->head = subclusters.merge(like->head, unit.head);
        } else {
          unit.next_in_cube = first;
          first = static_cast<std::uint32_t>(units_.size());
          units_.push_back(unit);
        }
      }
  }
  other.prepare(tolerance_);
}

void Voxels::link(DisjointSets& subclusters) {
  for (const std::uint32_t block : new_blocks_) linkBlock(blocks_[block], !anything_linked_, subclusters);
  for (const std::uint32_t block : new_blocks_) {
    blocks_[block].is_new = false;
    const auto used = countBits(blocks_[block].occupied);
    for (std::uint32_t rank = 0; rank < used; ++rank)
      for (std::uint32_t i = first_units_[blocks_[block].units + rank]; i != kNone; i = units_[i].next_in_cube)
        units_[i].is_new = false;
  }
  anything_linked_ = anything_linked_ || !new_blocks_.empty();
  new_blocks_.clear();
}

/// Finds the blocks around one that hold anything.
/// \param first the first of the 27 to look at
std::size_t Voxels::findNear(const Key& key, std::size_t first, Near* near) const {
  std::size_t count = 0;
  for (std::size_t i = first; i < kNeighbourBlocks; ++i) {
    const auto step = [](std::size_t which) { return static_cast<std::uint32_t>(which) - 1U; };
    const std::uint32_t number =
        findBlock({(key[0] + step(i % 3)) & kBlockMask, (key[1] + step(i / 3 % 3)) & kBlockMask,
                   (key[2] + step(i / 9)) & kBlockMask});
    if (number != kNone) near[count++] = {i, blocks_[number].occupied, blocks_[number].units};
  }
  return count;
}

/// Calls visit(unit) for all units of some cubes of a block.
template <typename Visit>
void Voxels::forEachUnitNear(const Near& near, std::uint64_t cubes, Visit&& visit) const {
  for (std::uint64_t left = near.occupied & cubes; left != 0; left &= left - 1) {
    const auto rank = countBits(near.occupied & ((left & -left) - 1));
    for (std::uint32_t unit = first_units_[near.units + rank]; unit != kNone; unit = units_[unit].next_in_cube)
      visit(unit);
  }
}

/// Compares the new units of a block with all units around them; each pair of new ones once.
void Voxels::linkBlock(const Block& block, bool all_new, DisjointSets& subclusters) {
  const auto& masks = all_new ? kNeighbourhood.later : kNeighbourhood.all;
  Near near[kNeighbourBlocks];
  const std::size_t count = findNear(block.key, all_new ? kNeighbourBlocks / 3 : 0, near);

  const auto compare = [&](std::uint32_t a_number, std::uint32_t b_number) {
    Unit& a = units_[a_number];
    Unit& b = units_[b_number];
    if (a.head == b.head || (!all_new && b.is_new && b_number > a_number)) return;
    a.head = subclusters.head(a.head);
    b.head = subclusters.head(b.head);
    if (a.head != b.head && haveNeighbours(a, *this, b)) a.head = b.head = subclusters.merge(a.head, b.head);
  };

  std::uint32_t rank = 0;
  for (std::uint64_t left = block.occupied; left != 0; left &= left - 1, ++rank) {
    const auto cube = static_cast<std::size_t>(__builtin_ctzll(left));
    for (std::uint32_t unit = first_units_[block.units + rank]; unit != kNone; unit = units_[unit].next_in_cube) {
      if (!units_[unit].is_new) continue;
      for (std::uint32_t other = all_new ? units_[unit].next_in_cube : first_units_[block.units + rank]; other != kNone;
           other = units_[other].next_in_cube)
        compare(unit, other);
      for (std::size_t i = 0; i < count; ++i) {
        std::uint64_t around = masks[cube][near[i].place];
        if (near[i].place == kNeighbourBlocks / 2) around &= ~(std::uint64_t{1} << cube);
        forEachUnitNear(near[i], around, [&](std::uint32_t other) { compare(unit, other); });
      }
    }
  }
}

void Voxels::linkTo(const Voxels& other, Part part, Joiner& joiner) const {
  if (part == Part::kNew) {
    for (const std::uint32_t block : new_blocks_) linkBlockTo(blocks_[block], other, part, joiner);
  } else {
    for (const Block& block : blocks_) linkBlockTo(block, other, part, joiner);
  }
}

void Voxels::linkBlockTo(const Block& block, const Voxels& other, Part part, Joiner& joiner) const {
  const auto mayBeNeighbours = [this](const Box& a, const Box& b) {
    return Box::squaredGap(a, b) < tolerance_.squared();
  };
  Near near[kNeighbourBlocks];
  std::size_t count = kNeighbourBlocks + 1;  // not looked for yet
  std::uint32_t rank = 0;
  for (std::uint64_t left = block.occupied; left != 0; left &= left - 1, ++rank) {
    const auto cube = static_cast<std::size_t>(__builtin_ctzll(left));
    for (std::uint32_t i = first_units_[block.units + rank]; i != kNone; i = units_[i].next_in_cube) {
      const Unit& unit = units_[i];
      if ((part == Part::kNew && !unit.is_new) || !mayBeNeighbours(unit.box, other.bounds_)) continue;
      if (count > kNeighbourBlocks) count = other.findNear(block.key, 0, near);
      for (std::size_t k = 0; k < count; ++k)
        other.forEachUnitNear(near[k], kNeighbourhood.all[cube][near[k].place], [&](std::uint32_t j) {
          const Unit& others = other.units_[j];
          if (mayBeNeighbours(unit.box, others.box) && joiner.areApart(unit.head, others.head) &&
              haveNeighbours(unit, other, others))
            joiner.join(unit.head, others.head);
        });
    }
  }
}

/// Gathers the points of a unit, from the cursor on, that may be neighbours of something in a box.
void Voxels::gather(Cursor& cursor, const Box& box, VoxelPoints& points) const {
  const float squared_tolerance = tolerance_.squared();
  points.count = 0;
  for (; cursor.piece != kNone && points.count < VoxelPoints::kMost; ++cursor.point) {
    if (cursor.point == pieces_[cursor.piece].count) {
      cursor = {pieces_[cursor.piece].next_in_unit, ~std::uint32_t{0}};
      continue;
    }
    const std::size_t i = pieces_[cursor.piece].first_point + cursor.point;
    points.x[points.count] = x_[i];
    points.y[points.count] = y_[i];
    points.z[points.count] = z_[i];
    points.count += Box::squaredGap(Box::around(x_[i], y_[i], z_[i]), box) < squared_tolerance ? 1 : 0;
  }
}

/// Whether any return of one unit is a neighbour of any return of another one's.
bool Voxels::haveNeighbours(const Unit& own, const Voxels& other, const Unit& others) const {
  const float squared_tolerance = tolerance_.squared();
  if (!(Box::squaredGap(own.box, others.box) < squared_tolerance)) return false;
  if (Box::squaredSpan(own.box, others.box) < squared_tolerance) return true;
  VoxelPoints some;
  VoxelPoints some_others;
  for (Cursor at{own.first_piece, 0}; at.piece != kNone;) {
    gather(at, others.box, some);
    if (some.count == 0) continue;
    for (Cursor at_others{others.first_piece, 0}; at_others.piece != kNone;) {
      other.gather(at_others, own.box, some_others);
      if (HWY_DYNAMIC_DISPATCH(anyNeighbours)(some, some_others, squared_tolerance)) return true;
    }
  }
  return false;
}

}  // namespace lisco
#endif
