// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "recordings/recording.h"

namespace lisco_apps {

/// The topics of a recording while they become known, and which of them are read.
class TopicTable {
 public:
  explicit TopicTable(std::vector<Topic>& topics) : topics_(topics) {}

  /// The index of a topic, by its name and type, which is added if it is new.
  std::size_t indexOf(const Topic& topic);

  void select(const std::vector<std::size_t>& topics);
  bool isSelected(std::size_t topic) const;

 private:
  std::vector<Topic>& topics_;
  bool all_ = true;
  std::vector<std::size_t> selected_;
};

/// Counts the messages of a recording without an index, by reading it to its end.
/// \param topics its topics
/// \return the earliest time of a message, nanoseconds since 1970; 0 if there is none
/// \throws std::runtime_error with one line if it breaks off before the first one
std::int64_t countMessages(Recording& recording, std::vector<Topic>& topics);

}  // namespace lisco_apps
