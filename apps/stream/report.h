// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <unistd.h>

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "io/terminal_line.h"
#include "sensors/decoder.h"
#include "sensors/packet_source.h"
#include "stream/labelled_pcd.h"
#include "stream/stream.h"

namespace lisco_apps {

/// Reports results as they are found: on stdout, as labelled clouds in a folder, and as a status line on the terminal.
class Report : public Listener {
 public:
  enum class Format { kText, kJson };

  /// Of all rotations, windows or turns so far.
  struct Totals {
    std::uint64_t turns = 0, columns = 0, returns = 0, ground = 0;
    std::uint64_t clusters = 0, in_clusters = 0;  ///< and their returns
    std::uint64_t cut = 0, continued = 0;         ///< clusters of an endless stream
  };

  explicit Report(Format format) : format_(format) {}
  /// Writes labelled clouds from now on.
  void writeTo(const LabelledClouds& clouds) { clouds_ = &clouds; }
  /// Called with each rotation or window from now on.
  using OnFound = std::function<void(const Turn& turn, const std::vector<FoundCluster>& clusters)>;
  void callWith(OnFound on_found) { on_found_ = std::move(on_found); }

  void found(const Turn& turn, const std::vector<FoundCluster>& clusters, Clock::duration latency) override;
  void cluster(const DeliveredCluster& cluster) override;
  void turnEnds(const Turn& turn) override;
  void turnIsLabelled(const Turn& turn) override;

  /// Flushes stdout. \throws std::runtime_error if it cannot be written
  void flush();

  /// Updates the status line, at most five times a second.
  /// \param file that is read; nullptr: live
  void showStatus(const Decoder& decoder, const Stream& stream, const PacketSource* file);
  /// Prints a line on stderr.
  void warn(const std::string& text);
  /// Warns of returns that mode endless leaves alone, if these are many: the cloud is not a rotating sensor's, or the
  /// sensor's place or stagger is wrong.
  void warnOfOutliers(const Stream& stream);

  const Totals& totals() const { return totals_; }

  /// Prints the closing table on stdout, or on stderr if stdout is JSON.
  void printStatistics(const PacketSource& source, const Decoder& decoder, const Stream& stream);

 private:
  void count(const FoundCluster& cluster);
  /// Counts a turn. \return its number, columns and returns as text
  std::string countTurn(const char* name, const Turn& turn);
  void print(const std::string& line);

  Format format_;
  const LabelledClouds* clouds_ = nullptr;
  OnFound on_found_;
  TerminalLine status_;
  const bool shares_terminal_ = isatty(STDOUT_FILENO) != 0;  ///< stdout and the status line
  std::string shown_;                                        ///< status
  Clock::time_point shown_at_;
  const Clock::time_point start_ = Clock::now();
  bool unflushed_ = false;
  Totals totals_;
  const char* span_ = "rotation";       ///< what is counted as a turn: a rotation or a window
  std::uint64_t clusters_of_turn_ = 0;  ///< delivered since the turn began
  lisco::ClusterFeatures largest_of_turn_;
};

}  // namespace lisco_apps
