// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "sensors/velodyne_model.h"

namespace lisco_benchmarks {

/// The time between two columns where the sensor fires, or turns, as fast as it can, microseconds.
inline double columnPeriodOf(const std::string& model) {
  if (model == "os1") return 1e6 / (20 * 1024);
  if (model == "hdl64e") return 48.0;  // makeVelodyneModel () needs a calibration for it
  return lisco_apps::makeVelodyneModel(model).firing_period_us;
}

/// The sensors that inputs were recorded with, by the beginning of their names.
class SensorNames {
 public:
  /// \param item NAME=MODEL
  void add(const std::string& item) {
    const std::size_t equals = item.find('=');
    if (equals == std::string::npos) throw std::runtime_error("--sensor must be NAME=MODEL, not '" + item + "'");
    models_.emplace_back(item.substr(0, equals), item.substr(equals + 1));
  }

  std::string modelOf(const std::string& name) const {
    for (const auto& [begin, model] : models_)
      if (name.compare(0, begin.size(), begin) == 0) return model;
    throw std::runtime_error("no --sensor says what " + name + " was recorded with");
  }

 private:
  std::vector<std::pair<std::string, std::string>> models_;
};

}  // namespace lisco_benchmarks
