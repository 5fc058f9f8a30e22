// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <cstddef>

namespace lisco {

/// Whether far returns were worth range images in the rotations before. A whole rotation tells it better than the first
/// columns of the next one (FarTrial): where three in turn were not worth it, those that follow are read without
/// images, until their returns change or some have passed. Fewer: an object's second and third call would take more
/// memory.
class FarHistory {
 public:
  struct Layout {
    std::size_t columns, lasers;
    float tolerance;  ///< metres
  };
  /// What a rotation holds.
  struct Content {
    std::size_t returns;
    std::size_t runs;  ///< 0 if not counted
  };

  /// Begins a rotation. \return whether range images may be worthwhile; one of another layout starts a new history
  bool begin(const Layout& layout) {
    if (!isLike(layout.columns, layout_.columns) || layout.lasers != layout_.lasers ||
        layout.tolerance != layout_.tolerance)
      forget();
    layout_ = layout;
    if (rest_ == 0) return true;
    --rest_;
    return false;
  }

  /// Ends a rotation that had range images, or whose trial refused them.
  void recordImages(bool are_worthwhile, const Content& content) {
    content_ = content;
    if (are_worthwhile) return forget();
    refused_ = std::min(refused_ + 1, kRefusals);
    if (refused_ < kRefusals) return;
    rest_ = next_rest_;
    next_rest_ = std::min(2 * next_rest_, kMaxRest);
  }

  /// Ends a rotation for which begin () returned false.
  void recordRest(const Content& content) {
    const bool has_runs = content.runs != 0 && content_.runs != 0;
    if (!isLike(content.returns, content_.returns) || (has_runs && !isLike(content.runs, content_.runs))) forget();
  }

 private:
  static constexpr std::size_t kRefusals = 3;
  /// Rotations without range images, before one shows again whether they are worth it: about a second's and some.
  static constexpr std::size_t kFirstRest = 16, kMaxRest = 64;

  /// Whether two numbers differ by a quarter or less.
  static bool isLike(std::size_t a, std::size_t b) { return std::max(a, b) - std::min(a, b) <= std::max(a, b) / 4; }

  void forget() {
    refused_ = rest_ = 0;
    next_rest_ = kFirstRest;
  }

  Layout layout_{};
  Content content_{};        ///< of the latest rotation that had range images, or a trial
  std::size_t refused_ = 0;  ///< rotations in turn, up to kRefusals
  std::size_t rest_ = 0;     ///< rotations left without
  std::size_t next_rest_ = kFirstRest;
};

}  // namespace lisco
