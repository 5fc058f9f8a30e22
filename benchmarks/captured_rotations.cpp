// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "captured_rotations.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <stdexcept>

#include "sensors/capture_file.h"
#include "sensors/rotation_cutter.h"
#include "sensors/velodyne_decoder.h"

namespace lisco_benchmarks {
namespace {

using namespace lisco_apps;

/// \param cells column by column
Cloud::Ptr organized(const std::vector<Cell>& cells, std::size_t lasers) {
  const std::size_t columns = cells.size() / lasers;
  auto cloud = std::make_shared<Cloud>(static_cast<std::uint32_t>(columns), static_cast<std::uint32_t>(lasers));
  cloud->is_dense = false;
  for (std::size_t i = 0; i < cells.size(); ++i)
    cloud->points[i % lasers * columns + i / lasers] = {cells[i].x, cells[i].y, cells[i].z};
  return cloud;
}

}  // namespace

std::vector<Cloud::Ptr> readRotations(const std::filesystem::path& file, const std::string& model_name,
                                      std::size_t most, double overlap) {
  const VelodyneModel model = makeVelodyneModel(model_name);
  VelodyneDecoder decoder(model);
  CaptureFile first_pass(file);
  decoder.prepare(first_pass);
  CaptureFile capture(file);
  RotationCutter cutter;
  const std::size_t lasers = model.lasers.size();
  std::vector<std::vector<Cell>> rotations;  // the last one is not whole
  const auto cells_after = [&](std::size_t rotation) {
    const auto columns = static_cast<double>(rotations[rotation].size() / lasers);
    return static_cast<std::size_t>(overlap * columns) * lasers;
  };
  const auto is_enough = [&] {
    return rotations.size() > most && rotations.back().size() >= cells_after(rotations.size() - 2);
  };
  Packet packet{};
  while (!is_enough() && capture.next(packet) == PacketSource::Arrival::kPacket)
    decoder.decode(packet, [&](const Column& column) {
      if (cutter.startsRotation(column.azimuth, column.after_break)) rotations.emplace_back();
      rotations.back().insert(rotations.back().end(), column.cells.begin(), column.cells.end());
    });
  if (rotations.size() < 2) throw std::runtime_error(file.string() + ": no whole rotation");

  std::vector<Cloud::Ptr> clouds;
  for (std::size_t i = 0; i < std::min(most, rotations.size() - 1); ++i) {
    const std::vector<Cell>& next = rotations[i + 1];
    const auto after = static_cast<std::ptrdiff_t>(std::min(cells_after(i), next.size()));
    std::vector<Cell> cells = rotations[i];
    cells.insert(cells.end(), next.begin(), next.begin() + after);
    clouds.push_back(organized(cells, lasers));
  }
  return clouds;
}

}  // namespace lisco_benchmarks
