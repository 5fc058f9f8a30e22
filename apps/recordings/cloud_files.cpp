// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "recordings/cloud_files.h"

#include <cstdint>
#include <stdexcept>

namespace lisco_apps {

PacketSource::Arrival CloudFiles::next(Packet& packet) {
  constexpr std::int64_t kApartUs = 100000;
  while (at_ < files_.size()) {
    const fs::path& file = files_[at_];
    const auto time_us = static_cast<std::int64_t>(at_) * kApartUs;
    if (at_++ % every_ != 0) continue;
    try {
      scan_ = readScan(file, options_);
    } catch (const std::runtime_error& why) {
      if (files_.size() == 1) throw;
      note_(why.what());
      ++unreadable_;
      continue;
    }
    if (!scan_.note.empty()) note_(file.string() + ": " + scan_.note);
    if (scan_.clustered()->height < 2 && files_.size() > 1)
      note_(file.string() + ": has neither rows nor a field 'ring'; left out");
    packet = {nullptr, 0, time_us};
    ++packets_;
    return Arrival::kPacket;
  }
  if (unreadable_ > 0) error_ = formatted("%zu of %zu files could not be read", unreadable_, files_.size());
  return Arrival::kEnd;
}

}  // namespace lisco_apps
