// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "sensors/velodyne_calibration.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <boost/algorithm/string/trim.hpp>
#include <boost/lexical_cast/try_lexical_convert.hpp>
#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>

namespace lisco_apps {
namespace {

/// The texts of a laser's values by their names.
using Values = std::map<std::string, std::string>;

/// How a format names and measures the values.
struct Format {
  const char *number, *rotation, *elevation, *distance, *height, *side;
  double degree, metre;  ///< its units
};
constexpr Format kXml{
    "id_", "rotCorrection_", "vertCorrection_", "distCorrection_", "vertOffsetCorrection_", "horizOffsetCorrection_", 1,
    0.01};
constexpr Format kYaml{"laser_id",
                       "rot_correction",
                       "vert_correction",
                       "dist_correction",
                       "vert_offset_correction",
                       "horiz_offset_correction",
                       1 / kRadiansPerDegree,
                       1};

// PCL's HDLGrabber uses uninitialized numbers if the file is missing, and writes out of bounds for a laser number of 64
// or more.
std::vector<Values> readXml(const fs::path& file) {
  namespace tree = boost::property_tree;
  std::vector<Values> lasers;
  try {
    tree::ptree document;
    tree::read_xml(file.string(), document, tree::xml_parser::trim_whitespace);
    for (const auto& [kind, item] : document.get_child("boost_serialization.DB.points_")) {
      if (kind != "item") continue;
      Values values;
      for (const auto& [name, value] : item.get_child("px")) values.emplace(name, value.data());
      lasers.push_back(std::move(values));
    }
  } catch (const tree::xml_parser_error& error) {
    fail(file, "is no calibration file: " + error.message());
  } catch (const tree::ptree_error& error) {
    fail(file, std::string("is no calibration file of an HDL-64E: ") + error.what());
  }
  return lasers;
}

/// The list below "lasers:", whose items are mappings in braces, or a name and a value in a line. Nothing else of YAML
/// occurs in these files.
std::vector<Values> readYaml(const fs::path& file) {
  std::ifstream stream(file);
  if (!stream) fail(file, "is no calibration file: cannot open file");
  std::vector<Values> lasers;
  bool is_list = false;
  for (std::string line; std::getline(stream, line);) {
    line = line.substr(0, line.find('#'));
    if (line.rfind("lasers:", 0) == 0) {
      is_list = true;
      line.erase(0, line.find(':') + 1);
    } else if (!line.empty() && (std::isalpha(static_cast<unsigned char>(line[0])) != 0)) {
      is_list = false;
    }
    if (!is_list) continue;
    boost::trim(line);
    if (line.rfind("- ", 0) == 0 || line == "-") {
      lasers.emplace_back();
      line.erase(0, 1);
    }
    for (char& c : line)
      if (c == '{' || c == '}') c = ' ';
    while (!lasers.empty() && line.find(':') != std::string::npos) {
      const std::size_t end = std::min(line.find(','), line.size());
      std::string pair = line.substr(0, end);
      line.erase(0, end + 1);
      const std::size_t colon = std::min(pair.find(':'), pair.size());
      std::string name = pair.substr(0, colon), value = colon < pair.size() ? pair.substr(colon + 1) : "";
      boost::trim(name);
      boost::trim(value);
      lasers.back().emplace(std::move(name), std::move(value));
    }
  }
  if (lasers.empty()) fail(file, "is no calibration file: it has no list of lasers");
  return lasers;
}

Laser laserOf(const fs::path& file, const Values& values, const Format& format, std::size_t lasers) {
  const auto value = [&](const char* name) {
    const auto found = values.find(name);
    if (found == values.end()) fail(file, std::string("is no calibration file: a laser has no ") + name);
    double read = 0;
    if (!boost::conversion::try_lexical_convert(found->second, read) || !std::isfinite(read))
      fail(file, std::string(name) + " is no number: '" + found->second + "'");
    return read;
  };
  const double number = value(format.number);
  if (!(number >= 0 && number < static_cast<double>(lasers)) || number != std::floor(number))
    fail(file, "there is no laser " + values.at(format.number));
  Laser laser;
  laser.number = static_cast<std::size_t>(number);
  laser.elevation = format.degree * value(format.elevation);
  laser.azimuth_offset = -format.degree * value(format.rotation);
  laser.distance_offset = format.metre * value(format.distance);
  laser.height = format.metre * value(format.height);
  laser.side = format.metre * value(format.side);
  return laser;
}

}  // namespace

std::vector<Laser> readCalibration(const fs::path& file, std::size_t lasers) {
  const std::string extension = file.extension().string();
  const bool is_yaml = extension == ".yaml" || extension == ".yml";
  std::vector<std::optional<Laser>> found(lasers);
  for (const Values& values : is_yaml ? readYaml(file) : readXml(file)) {
    const Laser laser = laserOf(file, values, is_yaml ? kYaml : kXml, lasers);
    found[laser.number] = laser;
  }
  return allOf(found, file, 0);
}

}  // namespace lisco_apps
