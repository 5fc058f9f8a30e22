// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "sensors/fragment_assembler.h"

#include <algorithm>
#include <cstdlib>

namespace lisco_apps {

void FragmentAssembler::giveUp(Incomplete& packet) {
  lost_ += packet.fragments;
  packet.fragments = packet.size = packet.units = 0;
  packet.received.reset();
}

void FragmentAssembler::clear() {
  for (Incomplete& packet : packets_) giveUp(packet);
}

/// The fragment's packet; a new one takes the place of the oldest.
FragmentAssembler::Incomplete& FragmentAssembler::packetOf(const Fragment& fragment) {
  for (Incomplete& packet : packets_) {
    if (packet.fragments == 0) continue;
    if (std::abs(fragment.time_us - packet.begun_us) > kMaxAgeUs)
      giveUp(packet);
    else if (packet.key == fragment.key)
      return packet;
  }
  const auto oldest = std::min_element(packets_.begin(), packets_.end(), [](const Incomplete& a, const Incomplete& b) {
    return a.fragments == 0 || b.fragments == 0 ? a.fragments == 0 && b.fragments != 0 : a.begun_us < b.begun_us;
  });
  giveUp(*oldest);
  oldest->key = fragment.key;
  oldest->begun_us = fragment.time_us;
  return *oldest;
}

std::string_view FragmentAssembler::add(const Fragment& fragment) {
  const std::size_t end = fragment.offset + fragment.content.size();
  // Only the last fragment may end elsewhere than at a multiple of the unit.
  if (fragment.content.empty() || end > kUnits * kUnit || (!fragment.is_last && end % kUnit != 0)) {
    ++lost_;
    return {};
  }
  Incomplete& packet = packetOf(fragment);
  ++packet.fragments;
  if (packet.content.size() < end) packet.content.resize(end);
  std::copy(fragment.content.begin(), fragment.content.end(),
            packet.content.begin() + static_cast<std::ptrdiff_t>(fragment.offset));
  for (std::size_t unit = fragment.offset / kUnit; unit * kUnit < end; ++unit) {
    if (packet.received[unit]) continue;
    packet.received[unit] = true;
    ++packet.units;
  }
  if (fragment.is_last) packet.size = end;
  const std::size_t wanted = (packet.size + kUnit - 1) / kUnit;
  if (packet.size == 0 || packet.units < wanted) return {};
  const bool is_consistent = packet.units == wanted;  // none lies beyond the last one
  if (is_consistent) packet.fragments = 0;
  const std::size_t size = packet.size;
  giveUp(packet);
  return is_consistent ? std::string_view(packet.content.data(), size) : std::string_view();
}

}  // namespace lisco_apps
