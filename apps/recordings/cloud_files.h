// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "io/scan_file.h"
#include "sensors/packet_source.h"

namespace lisco_apps {

/// The clouds of files, each as one packet without data: take () gives its cloud. Their times are 0.1 s apart. Files
/// that cannot be read are left out; error () tells their number.
class CloudFiles : public PacketSource {
 public:
  /// \param every takes the first of so many files
  /// \param note receives a line about a file that is left out or arranged
  CloudFiles(std::vector<fs::path> files, unsigned every, const ReadOptions& options,
             std::function<void(const std::string&)> note)
      : files_(std::move(files)), every_(every), options_(options), note_(std::move(note)) {}

  /// \throws std::runtime_error with one line if the only file cannot be read
  Arrival next(Packet& packet) override;
  double share() const override { return static_cast<double>(at_) / static_cast<double>(files_.size()); }

  /// The cloud of the last packet.
  Scan take() { return std::move(scan_); }

 private:
  std::vector<fs::path> files_;
  unsigned every_;
  ReadOptions options_;
  std::function<void(const std::string&)> note_;
  std::size_t at_ = 0, unreadable_ = 0;
  Scan scan_;
};

}  // namespace lisco_apps
