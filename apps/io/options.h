// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdio>
#include <exception>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
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
/// Reads a height, metres: a finite float.
float heightOf(const std::string& text, const char* option);
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

/// The options --tolerance, --min-size and --max-size.
struct ClusterOptions {
  static constexpr unsigned kAnySize = std::numeric_limits<int>::max();
  double tolerance = 0;  ///< metres
  unsigned min_size = 10;
  unsigned max_size = kAnySize;

  void addTo(boost::program_options::options_description& shown);
  /// To be called once the command line has been read.
  void check() const;
  /// \return nothing if there is no limit
  std::optional<unsigned> maxSize() const { return max_size == kAnySize ? std::nullopt : std::optional(max_size); }
};

/// Values of an option: for all inputs, or for each by its name (the file name without ending).
template <typename Value>
class PerInput {
 public:
  /// \param otherwise of inputs that no item applies to
  explicit PerInput(Value otherwise) : otherwise_(std::move(otherwise)) {}

  /// \param item "VALUE" for all inputs, "NAME=VALUE" for the input of this name
  /// \param read gives the value of a text
  /// \return false if a value for the same inputs was given before, which is replaced
  template <typename Read>
  bool set(const std::string& item, Read&& read) {
    const std::size_t equals = item.rfind('=');
    const std::string name = equals == std::string::npos ? "" : item.substr(0, equals);
    return of_name_.insert_or_assign(name, read(equals == std::string::npos ? item : item.substr(equals + 1))).second;
  }

  Value of(const std::string& name) const {
    for (const std::string& key : {name, std::string()})
      if (const auto found = of_name_.find(key); found != of_name_.end()) return found->second;
    return otherwise_;
  }

 private:
  std::map<std::string, Value> of_name_;  ///< "": all others
  Value otherwise_;
};

/// Flushes the standard output. \throws std::runtime_error with one line if it, or a part before, cannot be written
inline void flushOutput() {
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
    throw std::runtime_error("the standard output cannot be written");
}

/// The body of main (): flushes the standard output at the end, turns an exception into one line on stderr and exit
/// code 2.
template <typename Run>
int runProgram(const char* name, Run&& run) {
  try {
    const int code = run();
    flushOutput();
    return code;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", name, error.what());
    return 2;
  }
}

}  // namespace lisco_apps
