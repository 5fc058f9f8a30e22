// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "recordings/recording.h"

namespace lisco_apps {

/// A part of a recording.
struct TimeSpan {
  double from = 0;                                      ///< seconds after the recording's first message
  double to = std::numeric_limits<double>::infinity();  ///< the same, inclusive
  bool holds(double seconds) const { return seconds >= from && seconds <= to; }
};

/// The messages of one topic, within a time span.
class TopicReader {
 public:
  /// \param every gives the first of so many messages
  TopicReader(std::unique_ptr<Recording> recording, std::size_t topic, const TimeSpan& span = {}, unsigned every = 1)
      : recording_(std::move(recording)), topic_(topic), span_(span), every_(every) {
    recording_->select({topic_});
  }

  /// Valid until next (), which may find further topics.
  const Topic& topic() const { return recording_->topics()[topic_]; }
  const std::string& error() const { return recording_->error(); }
  double share() const { return recording_->share(); }
  /// Number of the last message in its topic, from 1.
  std::uint64_t number() const { return number_; }

  /// Reads the next message. \return false at the end
  bool next(Message& message) {
    while (recording_->next(message)) {
      ++number_;
      const double seconds = 1e-9 * static_cast<double>(message.time_ns - recording_->startNs());
      if (span_.holds(seconds) && in_span_++ % every_ == 0) return true;
      if (seconds > span_.to + kMaxDisorder) return false;
    }
    return false;
  }

 private:
  static constexpr double kMaxDisorder = 10;  ///< seconds by which a message may be recorded too late

  std::unique_ptr<Recording> recording_;
  std::size_t topic_;
  TimeSpan span_;
  unsigned every_;
  std::uint64_t number_ = 0, in_span_ = 0;  ///< messages so far
};

}  // namespace lisco_apps
