// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <limits>
#include <string>
#include <vector>

#include <boost/program_options.hpp>

#include "io/options.h"

namespace lisco_apps {

/// How the ground is found.
struct GroundChoice {
  enum class Method { kNone, kHeight, kSlope };
  Method method = Method::kNone;
  float height = -std::numeric_limits<float>::infinity();  ///< for kHeight: what lies below is ground, metres
};

/// Reads slope, height:Z or none.
GroundChoice groundChoiceOf(const std::string& text);

/// As --ground names it, with a height of up to nine digits.
std::string groundTextOf(const GroundChoice& ground);

/// The returns that are looked at, by their range from the sensor and their place.
struct Region {
  struct Box {
    std::array<float, 3> min, max;  ///< metres; its sides belong to it
  };
  double min_range = 0;                                        ///< metres
  double max_range = std::numeric_limits<double>::infinity();  ///< the same
  std::vector<Box> ignored;

  bool isEverything() const;
  /// \return false in an ignored box
  bool isOutsideOfBoxes(float x, float y, float z) const;
  /// Whether a return is clustered, ground or not.
  /// \param sensor where it is, metres
  bool contains(float x, float y, float z, const std::array<float, 3>& sensor = {}) const;
};

/// Which returns are clustered: the options --ground, --ground-z, --min-range, --max-range and --ignore-box.
struct ScanOptions {
  PerInput<GroundChoice> ground;
  Region region;

  /// \param standard as --ground has it if it is not given
  /// \param by_name whether the ground may differ from input to input
  ScanOptions(const std::string& standard, bool by_name);

  void addTo(boost::program_options::options_description& shown);
  /// To be called once the command line has been read.
  void check();
  /// A line for each NAME given that is that of no input.
  std::vector<std::string> unknownNames(const std::vector<fs::path>& inputs) const;

 private:
  std::string standard_;
  bool by_name_;
  std::vector<std::string> methods_, heights_, boxes_;  ///< as given
};

}  // namespace lisco_apps
