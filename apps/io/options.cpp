// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "io/options.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <stdexcept>

#include "lisco/version.h"

namespace lisco_apps {

namespace po = boost::program_options;

unsigned countOf(const std::string& text, const char* option, int least, int most) {
  std::size_t end = 0;
  long long value = -1;
  try {
    value = std::stoll(text, &end);
  } catch (const std::exception&) {
  }
  if (end != text.size() || value < least || value > most)
    throw std::runtime_error(std::string(option) + " must be a whole number from " + std::to_string(least) + " to " +
                             std::to_string(most) + ", not '" + text + "'");
  return static_cast<unsigned>(value);
}

double numberOf(const std::string& text, const char* option) {
  std::size_t end = 0;
  double value = std::numeric_limits<double>::quiet_NaN();
  try {
    value = std::stod(text, &end);
  } catch (const std::exception&) {
  }
  if (end != text.size() || !std::isfinite(value))
    throw std::runtime_error(std::string(option) + " must be a number, not '" + text + "'");
  return value;
}

double toleranceOf(const std::string& text) {
  double tolerance = 0;
  try {
    tolerance = numberOf(text, "--tolerance");
  } catch (const std::runtime_error&) {
  }
  if (!(tolerance > 0)) throw std::runtime_error("--tolerance must be a positive number of metres, not '" + text + "'");
  return tolerance;
}

float heightOf(const std::string& text) {
  const auto height = static_cast<float>(numberOf(text, "--ground-z"));
  if (!std::isfinite(height)) throw std::runtime_error("--ground-z must be a number of metres, not '" + text + "'");
  return height;
}

std::vector<std::string> itemsOf(const std::string& text) {
  std::vector<std::string> items(1);
  for (const char c : text)
    if (c == ',')
      items.emplace_back();
    else
      items.back() += c;
  return items;
}

std::string listOf(const std::vector<std::string>& items) {
  std::string list;
  for (const std::string& item : items) list += (list.empty() ? "" : ", ") + item;
  return list;
}

bool readCommandLine(int argc, char** argv, const char* program, po::options_description& shown,
                     std::vector<std::string>* inputs, po::variables_map& given) {
  shown.add_options()("help,h", "print this and exit")("version", "print the version and exit");
  po::options_description all;
  all.add(shown);
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

GroundHeights::GroundHeights(const std::vector<std::string>& items) {
  for (const std::string& item : items) {
    const std::size_t equals = item.rfind('=');
    const std::string name = equals == std::string::npos ? "" : item.substr(0, equals);
    const std::string height = equals == std::string::npos ? item : item.substr(equals + 1);
    of_name_[name] = heightOf(height);
  }
}

std::vector<std::string> GroundHeights::namesNotIn(const std::vector<std::string>& names) const {
  std::vector<std::string> unknown;
  for (const auto& [name, height] : of_name_)
    if (!name.empty() && std::find(names.begin(), names.end(), name) == names.end()) unknown.push_back(name);
  return unknown;
}

float GroundHeights::of(const std::string& name) const {
  for (const std::string& key : {name, std::string()}) {
    const auto found = of_name_.find(key);
    if (found != of_name_.end()) return found->second;
  }
  return -std::numeric_limits<float>::infinity();
}

}  // namespace lisco_apps
