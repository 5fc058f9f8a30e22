// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstdio>
#include <exception>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include <boost/program_options.hpp>

namespace lisco_apps {

/// Reads a whole number from `least` to `most`; boost would also accept "-1" (as a huge one).
/// \param option named in the error
/// \throws std::runtime_error with one line that says what is wrong
unsigned countOf(const std::string& text, const char* option, int least, int most = std::numeric_limits<int>::max());

/// Reads a finite number. \throws std::runtime_error with one line that says what is wrong
double numberOf(const std::string& text, const char* option);

/// Reads a --tolerance: a positive number. \throws std::runtime_error with one line that says what is wrong
double toleranceOf(const std::string& text);

/// Reads a --ground-z: a finite number. \throws std::runtime_error with one line that says what is wrong
float heightOf(const std::string& text);

/// Splits "a,b,c" at its commas.
std::vector<std::string> itemsOf(const std::string& text);
/// "a, b, c", for people.
std::string listOf(const std::vector<std::string>& items);

/// Reads a command line, and does what --help and --version ask for, which every program has.
/// \param shown the options that --help shows, --help and --version excepted
/// \param inputs receives what is no option; nullptr: there must be nothing else
/// \return false if there is nothing left to do
/// \throws std::runtime_error with one line that says what is wrong
bool readCommandLine(int argc, char** argv, const char* program, boost::program_options::options_description& shown,
                     std::vector<std::string>* inputs, boost::program_options::variables_map& given);

/// Heights below which the ground lies: of all inputs, or of each by its name.
class GroundHeights {
 public:
  /// \param items "M" for all inputs, "NAME=M" for the input of this name, metres
  /// \throws std::runtime_error with one line that says what is wrong
  explicit GroundHeights(const std::vector<std::string>& items = {});

  /// \param name file name without ending
  /// \return minus infinity if nothing was said of this input
  float of(const std::string& name) const;
  /// The names of which something was said and that are none of these.
  std::vector<std::string> namesNotIn(const std::vector<std::string>& names) const;

 private:
  std::map<std::string, float> of_name_;  ///< "": of all others
};

/// The whole of a program: runs it, and turns an exception into one line on stderr and exit code 2.
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
