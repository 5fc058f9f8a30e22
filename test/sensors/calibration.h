// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <functional>
#include <map>
#include <sstream>
#include <string>

namespace lisco_test {

/// A calibration file of an HDL-64E.
/// \param values values by name of a laser's number
inline std::string calibrationXml(const std::function<std::map<std::string, double>(int)>& values, int lasers = 64) {
  std::ostringstream xml;
  xml << R"(<?xml version="1.0" encoding="UTF-8" standalone="yes" ?><!DOCTYPE boost_serialization>
<boost_serialization signature="serialization::archive" version="4"><DB class_id="0"><distLSB_>0.2</distLSB_>
<points_ class_id="7"><count>)"
      << lasers << "</count><item_version>1</item_version>\n";
  for (int i = 0; i < lasers; ++i) {
    xml << "<item class_id=\"8\"><px class_id=\"9\"><id_>" << i << "</id_>";
    for (const auto& [name, value] : values(i)) xml << '<' << name << '>' << value << "</" << name << '>';
    xml << "<focalDistance_>1500</focalDistance_></px></item>\n";
  }
  xml << "</points_></DB></boost_serialization>\n";
  return xml.str();
}

/// Realistic values, different for each laser and not sorted by elevation.
inline std::map<std::string, double> usualCalibration(int laser) {
  const double upper = laser < 32 ? 0 : 1;
  return {{"rotCorrection_", -5.3 + 1.3 * (laser % 8) + 0.01 * laser},
          {"vertCorrection_", 2. - (laser * 11 % 32) * (1 + upper) / 3. - 10.6 * upper},
          {"distCorrection_", 95. + laser},
          {"vertOffsetCorrection_", 20. - 0.1 * laser},
          {"horizOffsetCorrection_", laser % 2 == 0 ? 2.6 : -2.6}};
}

}  // namespace lisco_test
