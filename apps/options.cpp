// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "options.h"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace lisco_apps {

unsigned countOf(const std::string& text, const char* option, int least) {
  std::size_t end = 0;
  long long value = -1;
  try {
    value = std::stoll(text, &end);
  } catch (const std::exception&) {
  }
  if (end != text.size() || value < least || value > std::numeric_limits<int>::max())
    throw std::runtime_error(std::string(option) + " must be a whole number from " + std::to_string(least) +
                             " to 2147483647, not '" + text + "'");
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

std::vector<std::string> itemsOf(const std::string& text) {
  std::vector<std::string> items(1);
  for (const char c : text)
    if (c == ',')
      items.emplace_back();
    else
      items.back() += c;
  return items;
}

GroundHeights::GroundHeights(const std::vector<std::string>& items) {
  for (const std::string& item : items) {
    const std::size_t equals = item.rfind('=');
    const std::string name = equals == std::string::npos ? "" : item.substr(0, equals);
    const std::string height = equals == std::string::npos ? item : item.substr(equals + 1);
    of_name_[name] = static_cast<float>(numberOf(height, "--ground-z"));
  }
}

float GroundHeights::of(const std::string& name) const {
  for (const std::string& key : {name, std::string()}) {
    const auto found = of_name_.find(key);
    if (found != of_name_.end()) return found->second;
  }
  return -std::numeric_limits<float>::infinity();
}

}  // namespace lisco_apps
