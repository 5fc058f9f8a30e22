// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <utility>

namespace lisco {

/// The time that each column should take, so that all take about the same, though parts of a scene differ several times
/// in cost. Work of several kinds comes in parts. The time of a part is unknown until it is done, and taken for the
/// average of those before. Short columns, which looks at the clock would prolong, are timed now and then only; their
/// time is estimated from work that is counted.
template <typename Clock = std::chrono::steady_clock>
class ColumnBudget {
 public:
  enum Kind : std::size_t { kReading, kFar, kNear, kKinds };

  /// Starts a rotation. What was measured in those before counts less and less.
  void begin() {
    for (Tasks& tasks : tasks_) {
      tasks.measured.halve();
      tasks.estimate();
      tasks.per_column = tasks.due = 0;
    }
    due_ = 0;
    short_count_ = 0;
    last_ = Clock::now();
    look_ = std::min(look_, lap());
  }
  /// Sets the number of parts of a kind left from now on, to be done in a number of columns.
  void plan(Kind kind, std::size_t parts, std::size_t columns) {
    Tasks& tasks = tasks_[kind];
    tasks.estimate();
    tasks.per_column = static_cast<double>(parts) * tasks.part / static_cast<double>(columns);
    tasks.due = 0;
  }
  /// Some columns have come, and their work begins.
  void addColumns(std::size_t columns) {
    double per_column = 0;
    for (Tasks& tasks : tasks_) {
      tasks.due += tasks.per_column * static_cast<double>(columns);
      per_column += tasks.per_column;
    }
    due_ += per_column * static_cast<double>(columns);
    is_timed_ = per_column > std::max(kShort, kLooksOfShort * look_) || short_count_++ % kTimedOfShort == 0;
    if (is_timed_) last_ = Clock::now();
  }

  /// Whether one more part, of any kind, should be done now.
  bool isBehind() const { return due_ > 0; }
  /// Whether a kind comes before another one: until it is no longer behind, so that its data stay in the cache, or if
  /// it is ahead by less.
  bool isBefore(Kind kind, Kind other) const { return tasks_[kind].due > 0 || tasks_[kind].due >= tasks_[other].due; }
  /// Records the time since addColumns () or the record before as that of some work of a kind. The thread may have
  /// waited for its processor: no more than a multiple of what is usual counts.
  /// \param parts that it has completed
  /// \param work in any unit
  void record(Kind kind, std::size_t parts, std::size_t work) {
    Tasks& tasks = tasks_[kind];
    double seconds = static_cast<double>(work) * tasks.unit;
    if (is_timed_) {
      seconds = std::min(lap(), kMostOfUsual * std::max(seconds, tasks.part));
      tasks.measured.parts += static_cast<double>(parts);
      tasks.measured.work += static_cast<double>(work);
      tasks.measured.seconds += seconds;
    }
    tasks.due -= seconds;
    due_ -= seconds;
  }
  /// Drops what is due, where no part is left. Later columns do not make up for it.
  void drop() { due_ = std::min(due_, 0.0); }

 private:
  static constexpr double kShort = 2.5e-6;          ///< seconds of a column up to which it is short
  static constexpr double kLooksOfShort = 150;      ///< the same in looks at the clock, where these take long
  static constexpr std::size_t kTimedOfShort = 13;  ///< one in so many is timed: at no fixed place of a block
  static constexpr double kMostOfUsual = 16;        ///< what a record counts at most: as much as scans' longest parts

  struct Measured {
    double parts = 0;
    double work = 0;
    double seconds = 0;

    /// With a guess, which counts as much as a part that was measured.
    void halve() { *this = {1 + parts / 2, 100 + work / 2, 5e-7 + seconds / 2}; }
  };
  struct Tasks {
    Measured measured;
    double part = 0;  ///< seconds of a part
    double unit = 0;  ///< seconds of a unit of work
    double per_column = 0;
    double due = 0;

    void estimate() {
      part = measured.seconds / measured.parts;
      unit = measured.seconds / measured.work;
    }
  };

  /// Seconds since last_, which becomes now.
  double lap() {
    const typename Clock::time_point now = Clock::now();
    return std::chrono::duration<double>(now - std::exchange(last_, now)).count();
  }

  std::array<Tasks, kKinds> tasks_{};
  double due_ = 0;               ///< seconds, of all kinds
  std::size_t short_count_ = 0;  ///< calls of addColumns () for short ones
  double look_ = 1;              ///< seconds of a look at the clock, at most
  bool is_timed_ = false;
  typename Clock::time_point last_{};
};

}  // namespace lisco
