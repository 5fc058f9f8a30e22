// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstdio>
#include <exception>
#include <map>
#include <string>
#include <vector>

namespace lisco_apps {

/// Reads a whole number from `least` to 2147483647; boost would also accept "-1" (as a huge one).
/// \param option named in the error
/// \throws std::runtime_error with one line that says what is wrong
unsigned countOf(const std::string& text, const char* option, int least);

/// Reads a finite number. \throws std::runtime_error with one line that says what is wrong
double numberOf(const std::string& text, const char* option);

/// Splits "a,b,c" at its commas.
std::vector<std::string> itemsOf(const std::string& text);

/// Heights below which the ground lies: of all inputs, or of each by its name.
class GroundHeights {
 public:
  /// \param items "M" for all inputs, "NAME=M" for the input of this name, metres
  /// \throws std::runtime_error with one line that says what is wrong
  explicit GroundHeights(const std::vector<std::string>& items = {});

  /// \param name file name without ending
  /// \return minus infinity if nothing was said of this input
  float of(const std::string& name) const;

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
