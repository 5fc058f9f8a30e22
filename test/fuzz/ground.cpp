// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <vector>

#include "bodies.h"
#include "input.h"
#include "lisco/ground_filter.h"
#include "lisco/label_ground.h"

namespace lisco_test {
namespace {

constexpr std::size_t kMaxLasers = 40, kMaxColumns = 100;

/// An organized scan: cell (laser, column) is cells[laser * columns + column].
struct Scan {
  std::size_t lasers, columns;
  std::vector<lisco::Return> cells;

  lisco::Return& at(std::size_t laser, std::size_t column) { return cells[laser * columns + column]; }
};

float numberFrom(Input& input, float scale) {
  const unsigned how = input.byte();
  return how == 255 ? input.rawFloat() : scale * (static_cast<float>(how) - 128.0F) / 128.0F;
}

/// Rows of a rotating sensor on a slope, with steps, among which are cells of any value.
Scan scanFrom(Input& input) {
  Scan scan{1 + input.below(kMaxLasers), 1 + input.below(kMaxColumns), {}};
  scan.cells.assign(scan.lasers * scan.columns, lisco::kNoReturn);
  const float height = numberFrom(input, 3.0F), rise = numberFrom(input, 0.4F), step = numberFrom(input, 1.0F);
  const float turn = numberFrom(input, 0.05F), stagger = numberFrom(input, 0.05F);
  const std::size_t step_at = input.below(kMaxColumns);
  for (std::size_t laser = 0; laser < scan.lasers; ++laser) {
    const float rho = 1.5F + 60.0F / static_cast<float>(1 + (laser * 7) % scan.lasers);  // rows in no order
    for (std::size_t column = 0; column < scan.columns; ++column) {
      const float azimuth = turn * static_cast<float>(column) + stagger * static_cast<float>(laser % 4);
      const float x = rho * std::cos(azimuth), y = rho * std::sin(azimuth);
      scan.at(laser, column) = {x, y, rise * x - height + (column > step_at ? step : 0.0F), 0};
    }
  }
  while (input.left() > 0) {
    lisco::Return& cell = scan.at(input.below(scan.lasers), input.below(scan.columns));
    switch (input.below(4)) {
      case 0:
        cell = lisco::kNoReturn;
        break;
      case 1:
        cell = {numberFrom(input, 30.0F), numberFrom(input, 30.0F), numberFrom(input, 5.0F), 0};
        break;
      case 2:
        cell.z = numberFrom(input, 3.0F);
        break;
      default:
        cell.x *= numberFrom(input, 2.0F);
    }
  }
  return scan;
}

/// Column by column; a copy goes on from anywhere, and columns may have fewer cells.
std::vector<std::uint8_t> filterByColumns(Scan& scan, const lisco::GroundParameters& parameters, std::size_t copy_at) {
  std::vector<std::uint8_t> ground(scan.cells.size(), 7);
  std::size_t decided = 0;
  const auto visit = [&](std::size_t column, const std::uint8_t* decisions, std::size_t lasers) {
    hold(column == decided++, "columns out of order");
    hold(lasers == scan.lasers, "the number of cells");
    for (std::size_t laser = 0; laser < lasers; ++laser) ground[laser * scan.columns + column] = decisions[laser];
  };
  std::optional<lisco::GroundFilter> filter(std::in_place);
  filter->begin(parameters, scan.lasers);
  std::vector<lisco::Return> cells(scan.lasers);
  for (std::size_t column = 0; column < scan.columns; ++column) {
    for (std::size_t laser = 0; laser < scan.lasers; ++laser) cells[laser] = scan.at(laser, column);
    filter->addColumn(cells.data(), cells.size(), visit);
    hold(column <= decided + lisco::GroundFilter::kMaxDelay, "a decision is late");
    if (column == copy_at) {
      const lisco::GroundFilter copy(*filter);
      filter.reset();
      filter.emplace(copy);
    }
  }
  filter->finish(visit);
  hold(decided == scan.columns, "columns are missing");
  return ground;
}

}  // namespace

void fuzzGround(const std::uint8_t* data, std::size_t size) {
  Input input(data, size);
  lisco::GroundParameters parameters;
  const unsigned flags = input.byte();
  if ((flags & 1U) != 0) parameters.sensor_height = numberFrom(input, 3.0F);
  if ((flags & 2U) != 0) parameters.slope = {numberFrom(input, 0.3F), numberFrom(input, 0.3F)};
  if ((flags & 4U) != 0) parameters.max_slope = input.rawFloat();
  if ((flags & 8U) != 0) parameters.sensor.origin = {numberFrom(input, 9.0F), numberFrom(input, 9.0F), 1.0F};
  const bool estimates = (flags & 16U) != 0;
  const std::size_t copy_at = input.below(kMaxColumns);
  Scan scan = scanFrom(input);

  const auto is_slope = [](float slope) { return std::fabs(slope) <= 10.0F; };
  const bool is_bad = std::isinf(parameters.sensor_height) ||
                      !(parameters.max_slope >= 1.0F && parameters.max_slope <= 60.0F) ||
                      !is_slope(parameters.slope[0]) || !is_slope(parameters.slope[1]);
  const auto cells = [&](std::size_t laser, std::size_t column) { return scan.at(laser, column); };
  std::vector<std::uint8_t> ground(scan.cells.size(), 7);
  lisco::GroundFilter filter;
  if (is_bad) {
    try {
      filter.filter(parameters, scan.columns, scan.lasers, cells, ground.data());
    } catch (const std::invalid_argument&) {
      return;
    }
    throw Finding("bad parameters are taken");
  }
  if (estimates) {
    const float max_slope = parameters.max_slope;
    parameters = lisco::estimateGround(scan.columns, scan.lasers, {0.0F, 0.0F, 0.0F}, lisco::CellSource(cells));
    parameters.max_slope = max_slope;
  }
  filter.filter(parameters, scan.columns, scan.lasers, cells, ground.data());
  for (std::size_t i = 0; i < ground.size(); ++i) {
    const lisco::Return& cell = scan.cells[i];
    hold(ground[i] == 0 || (ground[i] == 1 && lisco::isReturn(cell.x, cell.y, cell.z)), "ground that is no return");
  }
  hold(filterByColumns(scan, parameters, copy_at) == ground, "a whole scan and its columns differ");

  lisco::LabelGroundParameters labels;
  labels.sensor_height = parameters.sensor_height;
  labels.max_slope = parameters.max_slope;
  if ((flags & 32U) != 0) labels.lasers = scan.lasers;
  std::vector<std::uint8_t> labelled(scan.cells.size(), 7);
  lisco::labelGround(scan.cells.data(), scan.cells.size(), sizeof scan.cells[0], labels, labelled.data());
  for (const std::uint8_t label : labelled) hold(label <= 1, "a label that is none");
}

}  // namespace lisco_test
