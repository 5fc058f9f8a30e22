// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "lisco/tolerance.h"
#include "lisco/view_mask.h"

namespace lisco {

/// Far returns, each in a place of its own: the sensor's view unrolled, a row per laser and a place per step of the
/// turn.
///
/// Where the tolerance is seen under few steps and lasers, the paper's mask is a few places, and what lies there is
/// compared place by place, sixteen neighbouring places of a laser at a time. The mask is measured: a return stands at
/// the place of its *azimuth*, whatever its column, and lasers are reached by the elevations *measured* on them.
///
/// A return is far if its horizontal distance is at least a certain multiple of the tolerance. Neighbours that are both
/// far are found here, but for those with a loose one: a far return that found its place taken. Loose returns must be
/// kept elsewhere as well.
class ViewStrip {
 public:
  static constexpr std::size_t kMostInRow = 64;  ///< returns per call of place (), which has a bit for each

  /// Called for two elements whose returns are neighbours. \return the head both have now
  using Merge = std::uint32_t (*)(void* context, std::uint32_t a, std::uint32_t b);

  /// Starts a rotation. Keeps its memory.
  void prepare(const Tolerance& tolerance, const ViewHints& hints);

  /// False if the hints give no steps, or the tolerance joins nothing: then no return is far.
  bool inUse() const { return steps_ > 0; }
  /// Whether a return at this horizontal distance has no neighbour that is not far itself.
  bool amongFar(float rho) const { return rho >= far_enough_ && rho < not_too_far_; }

  /// Some returns of one laser, in the order of their columns.
  struct Row {
    std::size_t laser = 0;
    std::size_t count = 0;
    const float *x = nullptr, *y = nullptr, *z = nullptr;
    const std::uint32_t* column = nullptr;   ///< counted from the first of the rotation
    const std::uint32_t* element = nullptr;  ///< what is merged when two returns are neighbours
  };
  /// Puts the far ones of these returns in their places.
  /// \param rho horizontal distance of each from the sensor, as computed by horizontalDistances ()
  /// \return bit i is set if return i is loose
  std::uint64_t place(const Row& row, const float* rho);
  void horizontalDistances(const Row& row, float* rho) const;

  /// Compares what has come since the last call, as far as all lasers have passed it.
  void link(Merge merge, void* context);
  /// Compares all that has not been compared, the seam included. More returns may follow.
  void linkAll(Merge merge, void* context);

 private:
  static constexpr std::size_t kLanes = 16;
  static constexpr std::size_t kMargin = 64;  ///< places before the first return's, for staggered lasers
  static constexpr int kMostReach = 48;       ///< places; far returns never reach further
  static constexpr std::int64_t kNowhere = std::numeric_limits<std::int64_t>::min();

  /// What is known of a laser.
  struct Laser {
    float lowest, highest;    ///< slopes (z / rho) measured so far
    std::int64_t next_place;  ///< after its last return, not wrapped; kNowhere: none yet
    std::uint32_t next_column;
  };
  struct Loose {
    float x, y, z;
    std::uint32_t element;
  };

  std::size_t at(std::size_t laser, std::size_t place) const { return laser * stride_ + kMargin + place; }
  /// A return as it lies seen from the strip's start, turning with time.
  struct Seen {
    float u, v;  ///< metres, towards place 0 and across
  };

  bool isFar(float rho) const;
  Seen seenFromStart(float x, float y) const;
  std::int64_t placeOf(const Seen& seen) const;
  void addLasers(std::size_t lasers);
  void updateElevations();
  void linkPlaces(std::size_t begin, std::size_t end, Merge merge, void* context);
  void linkGroup(std::size_t laser, std::size_t place, Merge merge, void* context);
  void search(const Loose& loose, Merge merge, void* context);

  Tolerance tolerance_;
  std::array<float, 3> origin_{};
  float near_end_ = 0;
  float far_enough_ = 0;
  float not_too_far_ = 0;
  float reach_ = 0;
  std::size_t steps_ = 0;   ///< places in a turn
  std::size_t stride_ = 0;  ///< floats per laser
  float direction_ = 1;     ///< +1: azimuth grows with time
  float radians_per_place_ = 0;
  float start_cosine_ = 1;
  float start_sine_ = 0;
  std::uint32_t first_column_ = 0;
  bool started_ = false;
  std::vector<float> cosine_, sine_;  ///< of each place
  std::vector<float> rho_, x_, y_, z_;
  std::vector<std::uint32_t> element_;
  std::vector<Laser> lasers_;
  bool elevations_changed_ = false;
  bool upside_down_ = false;                         ///< the lasers come from bottom to top
  std::vector<float> lowest_, highest_;              ///< radians, of each laser; turned over if upside down
  std::vector<float> lowest_above_, highest_below_;  ///< of all lasers up to, and from, each one
  std::vector<int> above_, below_;                   ///< lasers reached by the last group
  std::size_t linked_ = 0;                           ///< places before this are compared
  std::size_t end_ = 0;                              ///< after the last place taken
  std::size_t placed_ = 0;
  bool full_ = false;  ///< too many were loose: all that follow are, too
  std::vector<Loose> loose_;
  std::vector<Loose> late_;  ///< placed where all had been compared
};

}  // namespace lisco
