// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "recordings/rotations.h"

namespace lisco_apps {

std::optional<Rotation> Rotations::next() {
  Packet packet;
  while (ended_.empty() && !is_over_) {
    const PacketSource::Arrival arrival = input_.source->next(packet);
    if (arrival == PacketSource::Arrival::kEnd) {
      is_over_ = true;
      input_.decoder->flush([this](const Column& column) { add(column); });
      end();
    } else if (arrival == PacketSource::Arrival::kPacket) {
      packet_time_us_ = packet.time_us;
      input_.decoder->decode(packet, [this](const Column& column) { add(column); });
    }
  }
  if (ended_.empty()) return std::nullopt;
  Rotation rotation = std::move(ended_.front());
  ended_.pop_front();
  return rotation;
}

void Rotations::add(const Column& column) {
  const bool is_full = rows_ != 0 && cells_.size() / rows_ == kMaxColumns;
  if (cutter_.startsRotation(column.azimuth, column.after_break) || is_full || column.cells.size() != rows_) {
    end();
    rows_ = column.cells.size();
  }
  cells_.insert(cells_.end(), column.cells.begin(), column.cells.end());
  time_us_ = packet_time_us_;
}

void Rotations::end() {
  if (cells_.empty()) return;
  const std::size_t columns = cells_.size() / rows_;
  Rotation rotation{++rotations_, std::make_shared<Cloud>(), time_us_};
  rotation.cloud->points.resize(cells_.size());
  rotation.cloud->width = static_cast<std::uint32_t>(columns);
  rotation.cloud->height = static_cast<std::uint32_t>(rows_);
  rotation.cloud->is_dense = false;
  for (std::size_t column = 0; column < columns; ++column)
    for (std::size_t row = 0; row < rows_; ++row) {
      const Cell& cell = cells_[column * rows_ + row];
      (*rotation.cloud)[row * columns + column] = pcl::PointXYZ(cell.x, cell.y, cell.z);
    }
  cells_.clear();
  ended_.push_back(std::move(rotation));
}

}  // namespace lisco_apps
