// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstdio>
#include <exception>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <boost/program_options.hpp>

#include "io/text.h"

namespace lisco_apps {

// Errors of the command line are std::runtime_error with one line.

using OptionValue = boost::program_options::typed_value<std::string>;

/// Reads a whole number from `min` to `max`; boost would also accept "-1" (as a huge one).
/// \param option named in the error
unsigned countOf(const std::string& text, const char* option, int min, int max = std::numeric_limits<int>::max());
/// Reads a finite number.
double numberOf(const std::string& text, const char* option);
/// Reads a --tolerance: a positive number.
double toleranceOf(const std::string& text);
/// Reads a --ground-z: a finite number.
float heightOf(const std::string& text);
/// Splits "a,b,c" at its commas.
std::vector<std::string> itemsOf(const std::string& text);

/// An option whose text is passed to `read` by readCommandLine (), unless --help or --version is given.
OptionValue* textOption(const char* value_name, const std::function<void(const std::string& text)>& read);
/// An option with a path, which must not be empty.
OptionValue* pathOption(const char* value_name, const char* option, fs::path& path);
/// An option with a number, see numberOf ().
OptionValue* numberOption(const char* value_name, const char* option, double& number);
/// An option with a whole number, see countOf ().
template <typename Count>
OptionValue* countOption(const char* option, Count& count, int min, int max = std::numeric_limits<int>::max()) {
  return textOption(
      "N", [=, &count](const std::string& text) { count = static_cast<Count>(countOf(text, option, min, max)); });
}

/// Reads a command line, including --help and --version.
/// \param shown the other options, as --help shows them
/// \param inputs receives the positional arguments; nullptr: there must be none
/// \param hidden options that --help does not show
/// \return false if --help or --version was given
bool readCommandLine(int argc, char** argv, const char* program, boost::program_options::options_description& shown,
                     std::vector<std::string>* inputs, boost::program_options::variables_map& given,
                     const boost::program_options::options_description& hidden = {});

/// The options --tolerance, --min-size, --max-size and --ground-z.
struct ClusterOptions {
  double tolerance = 0;  ///< metres
  unsigned min_size = 10;
  unsigned max_size = std::numeric_limits<int>::max();
  float ground_z = -std::numeric_limits<float>::infinity();  ///< metres

  void addTo(boost::program_options::options_description& shown);
  /// To be called once the command line has been read.
  void check() const;
};

/// Heights of the ground: of all inputs, or of each by its name.
class GroundHeights {
 public:
  /// \param items "M" for all inputs, "NAME=M" for the input of this name, metres
  explicit GroundHeights(const std::vector<std::string>& items = {});

  /// \param name file name without ending
  /// \return minus infinity if no height applies
  float of(const std::string& name) const;
  /// The names given that are none of these.
  std::vector<std::string> namesNotIn(const std::vector<std::string>& names) const;

 private:
  std::map<std::string, float> of_name_;  ///< "": all others
};

/// The body of main (): turns an exception into one line on stderr and exit code 2.
template <typename Run>
int runProgram(const char* name, Run&& run) {
  try {
    return run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", name, error.what());
    return 2;
  }
}

}  // namespace lisco_apps
