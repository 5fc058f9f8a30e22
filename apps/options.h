// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstdio>
#include <exception>
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
