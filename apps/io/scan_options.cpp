// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "io/scan_options.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>

#include <boost/algorithm/string/predicate.hpp>

namespace lisco_apps {

namespace po = boost::program_options;

namespace {

constexpr const char* kHeightPrefix = "height:";

GroundChoice atHeight(const std::string& text, const char* option) {
  return {GroundChoice::Method::kHeight, heightOf(text, option)};
}

Region::Box boxOf(const std::string& text) {
  const std::vector<std::string> items = itemsOf(text);
  Region::Box box{};
  if (items.size() != 6)
    throw std::runtime_error("--ignore-box takes six numbers, X,Y,Z of two corners, not '" + text + "'");
  for (std::size_t i = 0; i < 6; ++i)
    (i < 3 ? box.min : box.max)[i % 3] = static_cast<float>(numberOf(items[i], "--ignore-box"));
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (!(box.min[axis] <= box.max[axis]))
      throw std::runtime_error("--ignore-box takes the lower corner first, not '" + text + "'");
  return box;
}

/// The NAME of "NAME=VALUE"; empty if there is none.
std::string nameOf(const std::string& item) {
  const std::size_t equals = item.rfind('=');
  return equals == std::string::npos ? "" : item.substr(0, equals);
}

OptionValue* rangeOption(const char* option, double& range) {
  return textOption("M", [option, &range](const std::string& text) {
    range = numberOf(text, option);
    if (range < 0) throw std::runtime_error(std::string(option) + " must not be negative");
  });
}

}  // namespace

GroundChoice groundChoiceOf(const std::string& text) {
  if (text == "none") return {};
  if (text == "slope") return {GroundChoice::Method::kSlope};
  if (text.rfind(kHeightPrefix, 0) == 0) return atHeight(text.substr(std::string(kHeightPrefix).size()), "--ground");
  throw std::runtime_error("--ground must be slope, height:Z or none, not '" + text + "'");
}

std::string groundTextOf(const GroundChoice& ground) {
  if (ground.method == GroundChoice::Method::kNone) return "none";
  if (ground.method == GroundChoice::Method::kSlope) return "slope";
  return kHeightPrefix + formatted("%.9g", static_cast<double>(ground.height));
}

bool Region::isEverything() const {
  return min_range <= 0 && std::isinf(max_range) && ignored.empty();
}

bool Region::isOutsideOfBoxes(float x, float y, float z) const {
  const auto within = [](float value, float min, float max) { return min <= value && value <= max; };
  return std::none_of(ignored.begin(), ignored.end(), [&](const Box& box) {
    return within(x, box.min[0], box.max[0]) && within(y, box.min[1], box.max[1]) && within(z, box.min[2], box.max[2]);
  });
}

bool Region::contains(float x, float y, float z, const std::array<float, 3>& sensor) const {
  if (isEverything()) return true;
  const double range = std::hypot(static_cast<double>(x) - static_cast<double>(sensor[0]),
                                  static_cast<double>(y) - static_cast<double>(sensor[1]),
                                  static_cast<double>(z) - static_cast<double>(sensor[2]));
  return min_range <= range && range <= max_range && isOutsideOfBoxes(x, y, z);
}

ScanOptions::ScanOptions(const std::string& standard, bool by_name)
    : ground(groundChoiceOf(standard)), standard_(standard), by_name_(by_name) {}

void ScanOptions::addTo(po::options_description& shown) {
  const std::string named = by_name_ ? "; NAME=METHOD: of the input with this file name (without ending) only, may be "
                                       "given several times"
                                     : "";
  const std::string method =
      "which returns are ground and left out: slope (found column by column, where the scan is that of a rotating "
      "sensor), height:Z (those below Z metres, in the input's coordinates) or none (default " +
      standard_ + ")" + named;
  const std::string height = std::string("the same as --ground height:M") + (by_name_ ? "; NAME=M likewise" : "");
  using Texts = std::vector<std::string>;
  // clang-format off
  shown.add_options()
    ("ground", po::value<Texts>(&methods_)->value_name("METHOD"), method.c_str())
    ("ground-z", po::value<Texts>(&heights_)->value_name("M"), height.c_str())
    ("min-range", rangeOption("--min-range", region.min_range),
     "leave out returns nearer to the sensor (a cloud's VIEWPOINT, usually (0, 0, 0)) than this many metres")
    ("max-range", rangeOption("--max-range", region.max_range), "leave out returns farther away than this")
    ("ignore-box", po::value<Texts>(&boxes_)->value_name("X,Y,Z,X,Y,Z"),
     "leave out returns in the box between a lower and an upper corner, such as the sensor's own vehicle; may be given "
     "several times");
  // clang-format on
}

void ScanOptions::check() {
  const auto set = [this](const std::vector<std::string>& items, const char* option, const auto& read) {
    for (const std::string& item : items) {
      const bool is_named = item.find('=') != std::string::npos;
      if (is_named && !by_name_)
        throw std::runtime_error(std::string(option) + " applies to all: NAME= is not taken here, '" + item + "'");
      if (is_named && nameOf(item).empty())
        throw std::runtime_error(std::string(option) + ": NAME is empty in '" + item + "'");
      if (!ground.set(item, read))
        throw std::runtime_error(std::string(option) + ": the ground is given twice" +
                                 (is_named ? " for one input" : ""));
    }
  };
  set(methods_, "--ground", groundChoiceOf);
  set(heights_, "--ground-z", [](const std::string& text) { return atHeight(text, "--ground-z"); });
  for (const std::string& box : boxes_) region.ignored.push_back(boxOf(box));
  if (!(region.min_range <= region.max_range)) throw std::runtime_error("--max-range is smaller than --min-range");
}

std::vector<std::string> ScanOptions::unknownNames(const std::vector<fs::path>& inputs) const {
  std::vector<std::string> lines;
  const auto add = [&](const std::vector<std::string>& items, const char* option) {
    for (const std::string& item : items) {
      const std::string name = nameOf(item);
      const auto is_named = [&name](const fs::path& input) { return input.stem().string() == name; };
      if (name.empty() || std::any_of(inputs.begin(), inputs.end(), is_named)) continue;
      const auto ends_name = [&name](const fs::path& input) {
        return input.has_extension() && boost::ends_with(name, input.extension().string());
      };
      const auto like = std::find_if(inputs.begin(), inputs.end(), ends_name);
      lines.push_back(std::string(option) + " names '" + name + "', which is no input" +
                      (like == inputs.end() ? "" : ": NAME is given without " + like->extension().string()));
    }
  };
  add(methods_, "--ground");
  add(heights_, "--ground-z");
  return lines;
}

}  // namespace lisco_apps
