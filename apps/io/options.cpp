// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "io/options.h"

#include <cmath>
#include <iostream>
#include <stdexcept>

#include <boost/algorithm/string.hpp>
#include <boost/lexical_cast/try_lexical_convert.hpp>

#include "lisco/version.h"

namespace lisco_apps {

namespace po = boost::program_options;

namespace {

/// The number that a text is; NaN if it is none.
double parsedNumber(const std::string& text) {
  double number;
  return boost::conversion::try_lexical_convert(text, number) ? number : std::nan("");
}

}  // namespace

unsigned countOf(const std::string& text, const char* option, int min, int max) {
  long long value;
  if (!boost::conversion::try_lexical_convert(text, value) || value < min || value > max)
    throw std::runtime_error(std::string(option) + " must be a whole number from " + std::to_string(min) + " to " +
                             std::to_string(max) + ", not '" + text + "'");
  return static_cast<unsigned>(value);
}

double numberOf(const std::string& text, const char* option) {
  const double value = parsedNumber(text);
  if (!std::isfinite(value)) throw std::runtime_error(std::string(option) + " must be a number, not '" + text + "'");
  return value;
}

double toleranceOf(const std::string& text) {
  const double tolerance = parsedNumber(text);
  if (!(tolerance > 0) || !std::isfinite(tolerance))
    throw std::runtime_error("--tolerance must be a positive number of metres, not '" + text + "'");
  return tolerance;
}

float heightOf(const std::string& text, const char* option) {
  const auto height = static_cast<float>(numberOf(text, option));
  if (!std::isfinite(height))
    throw std::runtime_error(std::string(option) + " must be a number of metres, not '" + text + "'");
  return height;
}

std::vector<std::string> itemsOf(const std::string& text) {
  std::vector<std::string> items;
  boost::split(items, text, [](char c) { return c == ','; });
  return items;
}

OptionValue* textOption(const char* value_name, const std::function<void(const std::string&)>& read) {
  return po::value<std::string>()->value_name(value_name)->notifier(read);
}

OptionValue* numberOption(const char* value_name, const char* option, double& number) {
  return textOption(value_name, [option, &number](const std::string& text) { number = numberOf(text, option); });
}

OptionValue* pathOption(const char* value_name, const char* option, fs::path& path) {
  return textOption(value_name, [option, &path](const std::string& text) {
    if (text.empty()) throw std::runtime_error(std::string(option) + " is empty");
    path = text;
  });
}

bool readCommandLine(int argc, char** argv, const char* program, po::options_description& shown,
                     std::vector<std::string>* inputs, po::variables_map& given,
                     const po::options_description& hidden) {
  shown.add_options()("help,h", "print this and exit")("version", "print the version and exit");
  po::options_description all;
  all.add(shown).add(hidden);
  std::vector<std::string> others;
  all.add_options()("input", po::value<std::vector<std::string>>(inputs != nullptr ? inputs : &others));
  po::positional_options_description positional;
  positional.add("input", -1);
  try {
    po::store(po::command_line_parser(argc, argv).options(all).positional(positional).run(), given);
  } catch (const po::error& error) {
    throw std::runtime_error(std::string(error.what()) + "; see --help");
  }
  if (given.count("help") != 0) {
    std::cout << shown;
    return false;
  }
  if (given.count("version") != 0) {
    std::cout << program << ' ' << LISCO_VERSION << '\n';
    return false;
  }
  po::notify(given);
  if (!others.empty()) throw std::runtime_error("'" + others.front() + "' is no option; see --help");
  return true;
}

void ClusterOptions::addTo(po::options_description& shown) {
  // clang-format off
  shown.add_options()
    ("tolerance,t", textOption("M", [this](const std::string& text) { tolerance = toleranceOf(text); }),
     "points nearer to each other than this many metres belong together")
    ("min-size", countOption("--min-size", min_size, 1), "least returns of a cluster (default 10)")
    ("max-size", countOption("--max-size", max_size, 1), "most returns of a cluster (default: no limit)");
  // clang-format on
}

void ClusterOptions::check() const {
  if (tolerance == 0) throw std::runtime_error("--tolerance is missing; see --help");
  if (max_size < min_size) throw std::runtime_error("--max-size is smaller than --min-size");
}

}  // namespace lisco_apps
