// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "stream/ground_stage.h"

namespace lisco_apps {

/// All but the slope.
void GroundStage::decideByPlace(PreparedColumn& column) const {
  column.uses.resize(column.cells.size());
  for (std::size_t i = 0; i < column.cells.size(); ++i) {
    const Cell& cell = column.cells[i];
    if (!lisco::isReturn(cell.x, cell.y, cell.z) || !region_.contains(cell.x, cell.y, cell.z, sensor_.stated))
      column.uses[i] = CellUse::kNothing;
    else
      column.uses[i] = cell.z < ground_.height ? CellUse::kGround : CellUse::kClustered;
  }
}

void GroundStage::decideBySlope(const std::uint8_t* ground) {
  std::vector<CellUse>& uses = waiting_[first_].uses;
  for (std::size_t i = 0; i < uses.size(); ++i)
    if (ground[i] != 0 && uses[i] == CellUse::kClustered) uses[i] = CellUse::kGround;
}

/// The filter sees the returns beyond the range limits, too: the ground goes on there.
void GroundStage::fillReturns(const PreparedColumn& column) {
  returns_.clear();
  for (const Cell& cell : column.cells)
    returns_.push_back(region_.isOutsideOfBoxes(cell.x, cell.y, cell.z) ? lisco::Return{cell.x, cell.y, cell.z, 0}
                                                                        : lisco::kNoReturn);
}

}  // namespace lisco_apps
