// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "decoder.h"

#include "velodyne_decoder.h"
#include "velodyne_model.h"

namespace lisco_apps {

std::vector<std::string> sensorNames() {
  return velodyneModelNames();
}

std::unique_ptr<Decoder> makeDecoder(const DecoderOptions& options) {
  return std::make_unique<VelodyneDecoder>(makeVelodyneModel(options.sensor, options.calibration));
}

}  // namespace lisco_apps
