// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "stream/stream.h"

namespace lisco_apps {

bool Stream::add(const Column& column, const Origin& origin) {
  auto start = Clock::now();
  const bool starts_turn = column.starts_rotation.has_value()
                               ? *column.starts_rotation || column.after_break
                               : cutter_.startsRotation(column.azimuth, column.after_break);
  if (starts_turn) {
    turnIsOver(start);
    start = Clock::now();
    stage_.setSensor(decoder_.sensorPlace(), [this](const PreparedColumn& decided) { pass(decided); });
  }
  const bool is_beyond = starts_turn && options_.rotations != 0 && received_turns_ == options_.rotations;
  is_open_ = is_open_ && takes_ && !(is_beyond && endsWithTurns());
  if (!is_open_) return false;
  received_turns_ += starts_turn ? 1 : 0;

  PreparedColumn& prepared = stage_.next();
  prepared.cells.assign(column.cells.begin(), column.cells.end());
  prepared.azimuth = column.azimuth;
  prepared.position = positionOf(column);
  prepared.starts_turn = starts_turn;
  prepared.origin = origin;
  stage_.add([this](const PreparedColumn& decided) { pass(decided); });
  last_column_took_ = Clock::now() - start;
  column_latency_.add(last_column_took_);
  return takes_;
}

void Stream::finishGround() {
  stage_.finish([this](const PreparedColumn& decided) { pass(decided); });
}

void Stream::pass(const PreparedColumn& column) {
  takes_ = takes_ && take(column);
}

}  // namespace lisco_apps
