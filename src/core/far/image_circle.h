// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/far/range_image.h"

namespace lisco {

/// The range images of a rotation, ordered around the turn: finds those in each other's reach without comparing each
/// with each.
class ImageCircle {
 public:
  /// Takes those images that have returns in bins; all of one origin, number of steps and sense of rotation.
  /// \param image_at callable as const RangeImage& (std::size_t number)
  template <typename ImageAt>
  void assign(std::size_t count, ImageAt&& image_at) {
    arcs_.clear();
    for (std::size_t number = 0; number < count; ++number)
      if (image_at(number).placed > 0) add(image_at(number), number);
    sort();
  }

  /// Calls visit(later, earlier) once for each two images whose bins may be in each other's reach, by their numbers.
  /// Takes O(images + visits).
  template <typename Visit>
  void forEachPair(Visit&& visit) const {
    const std::size_t count = arcs_.size();
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t step = 1; step < count; ++step) {
        const std::size_t k = (i + step) % count;
        if (ahead(arcs_[i], arcs_[k]) > arcs_[i].reach) break;
        // Two that reach each other both ways around are visited from the first.
        if (k < i && ahead(arcs_[k], arcs_[i]) <= arcs_[k].reach) continue;
        visit(std::max(arcs_[i].number, arcs_[k].number), std::min(arcs_[i].number, arcs_[k].number));
      }
  }

  /// Calls visit(number) for each image whose bins may be in the reach of a far return.
  template <typename Visit>
  void forEachAround(const RangeImage::Unplaced& point, Visit&& visit) const {
    if (arcs_.empty()) return;
    const Arc end{positionOf(point), 0, 0};
    const auto after = static_cast<std::size_t>(std::upper_bound(arcs_.begin(), arcs_.end(), end) - arcs_.begin());
    for (std::size_t step = 1; step <= arcs_.size(); ++step) {
      const Arc& arc = arcs_[(after + arcs_.size() - step) % arcs_.size()];
      if (ahead(arc, end) > farthest_ + margin_) return;
      if (ahead(arc, end) <= arc.reach + margin_) visit(arc.number);
    }
  }

 private:
  /// From bin 0 of an image to the farthest bin that a mask in its last one covers, turns.
  struct Arc {
    double start, reach;
    std::size_t number;
    bool operator<(const Arc& other) const { return start < other.start; }
  };
  /// From the start of an arc on to that of another, in the sense of rotation, 0 to 1 turns.
  static double ahead(const Arc& from, const Arc& to) { return to.start - from.start + (to < from ? 1.0 : 0.0); }

  void add(const RangeImage& image, std::size_t number);
  void sort();
  double positionOf(const RangeImage::Unplaced& point) const;

  std::vector<Arc> arcs_;       ///< by start
  double farthest_ = 0;         ///< reach
  double margin_ = 0;           ///< more than a mask covers, turns
  double direction_ = 1;        ///< of rotation
  float east_ = 0, north_ = 0;  ///< of the sensor, metres
};

}  // namespace lisco
