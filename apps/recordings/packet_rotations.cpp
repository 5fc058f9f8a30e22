// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "recordings/packet_rotations.h"

#include <utility>

namespace lisco_apps {

PacketRotations::PacketRotations(PacketInput input)
    : input_(std::move(input)), cutter_(input_.decoder->rotationStart()) {}

std::optional<PacketRotation> PacketRotations::next() {
  const Decoder::Visitor visit = [this](const Column& column) { add(column); };
  Packet packet;
  while (ended_.empty() && !is_over_) {
    const PacketSource::Arrival arrival = input_.source->next(packet);
    if (arrival == PacketSource::Arrival::kPacket) {
      packet_us_ = packet.time_us;
      input_.decoder->decode(packet, visit);
    } else if (arrival == PacketSource::Arrival::kEnd) {
      is_over_ = true;
      input_.decoder->flush(visit);
      end();
    }
  }
  if (ended_.empty()) return std::nullopt;
  PacketRotation first = std::move(ended_.front());
  ended_.pop_front();
  return first;
}

void PacketRotations::add(const Column& column) {
  if (cutter_.startsRotation(column.azimuth, column.after_break) || rotation_.columns.size() == kMaxColumns ||
      column.cells.size() != rotation_.rows) {
    end();
    rotation_.rows = column.cells.size();
    rotation_.first_packet_us = packet_us_;
  }
  rotation_.cells.insert(rotation_.cells.end(), column.cells.begin(), column.cells.end());
  rotation_.columns.push_back({column.azimuth, column.time_us, column.after_break});
  rotation_.last_packet_us = packet_us_;
}

void PacketRotations::end() {
  PacketRotation ended = std::exchange(rotation_, PacketRotation());
  if (!ended.cells.empty()) ended_.push_back(std::move(ended));
}

}  // namespace lisco_apps
