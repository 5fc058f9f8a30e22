// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <cstddef>

namespace lisco {

/// Whether far returns were worth range images in the rotations before. A whole rotation tells it better than the first
/// columns of the next one (FarTrial): where three in turn were not worth it, images are left out of those that follow,
/// until these hold other returns, or some have passed. Each layout starts anew: an object that is given clouds of
/// several sensors in turn has no history.
class FarHistory {
 public:
  struct Layout {
    std::size_t columns, lasers;
    int steps_per_turn;
    float tolerance;  ///< metres
  };
  /// What a rotation holds.
  struct Content {
    std::size_t returns;
    std::size_t runs;  ///< 0 if not counted
  };

  /// Begins a rotation. \return false if images are left out
  bool begin(const Layout& layout) {
    if (!isLike(layout.columns, layout_.columns) || layout.lasers != layout_.lasers ||
        !isLike(layout.steps_per_turn, layout_.steps_per_turn) || layout.tolerance != layout_.tolerance)
      forget();
    layout_ = layout;
    if (left_out_ == 0) return true;
    --left_out_;
    return false;
  }

  /// Ends a rotation that had range images, or whose trial refused them.
  void recordTried(bool are_worthwhile, const Content& content) {
    content_ = content;
    if (are_worthwhile) return forget();
    refused_ = std::min(refused_ + 1, kRefusals);
    if (refused_ < kRefusals) return;
    left_out_ = next_left_out_;
    next_left_out_ = std::min(2 * next_left_out_, kMostLeftOut);
  }

  /// Ends a rotation for which begin () returned false.
  void recordLeftOut(const Content& content) {
    const bool has_runs = content.runs != 0 && content_.runs != 0;
    if (!isLike(content.returns, content_.returns) || (has_runs && !isLike(content.runs, content_.runs))) forget();
  }

 private:
  /// Rotations in turn that decide. Fewer: the second or third call of an object would take more memory.
  static constexpr std::size_t kRefusals = 3;
  /// Rotations without images until one is tried again, at first and at most: 1.6 and 6.4 s at 10 Hz.
  static constexpr std::size_t kFirstLeftOut = 16, kMostLeftOut = 64;

  /// Whether two numbers differ by a quarter or less.
  template <typename Number>
  static bool isLike(Number a, Number b) {
    return std::max(a, b) - std::min(a, b) <= std::max(a, b) / 4;
  }

  void forget() {
    refused_ = left_out_ = 0;
    next_left_out_ = kFirstLeftOut;
  }

  Layout layout_{};
  Content content_{};         ///< of the latest rotation that was tried
  std::size_t refused_ = 0;   ///< rotations in turn, up to kRefusals
  std::size_t left_out_ = 0;  ///< rotations to come
  std::size_t next_left_out_ = kFirstLeftOut;
};

}  // namespace lisco
