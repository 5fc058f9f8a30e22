// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "sensors/ouster_metadata.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <initializer_list>
#include <map>
#include <system_error>

#include <nlohmann/json.hpp>

namespace lisco_apps {
namespace {

using Json = nlohmann::json;
using Profile = OusterMetadata::Profile;

constexpr std::size_t kMaxPixels = 256, kMaxColumns = 16384, kMaxColumnsPerPacket = 256;
constexpr Transform kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
/// By the manual of the gen 1 sensors, whose metadata lacks it: half a turn, and 36.18 mm up.
constexpr Transform kDefaultLidarToSensor{-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 36.18, 0, 0, 0, 1};

const std::map<std::string, Profile>& profiles() {
  static const std::map<std::string, Profile> all{{"LEGACY", Profile::kLegacy},
                                                  {"RNG19_RFL8_SIG16_NIR16", Profile::kSingle},
                                                  {"RNG19_RFL8_SIG16_NIR16_ZONE16", Profile::kSingle},
                                                  {"RNG19_RFL8_SIG16_NIR16_RGB16", Profile::kSingleColour},
                                                  {"RNG19_RFL8_SIG16_NIR16_DUAL", Profile::kDual},
                                                  {"RNG19_RFL8_SIG16_ZONE16_DUAL", Profile::kDual},
                                                  {"RNG19_RFL8_SIG16_NIR16_RGB16_DUAL", Profile::kFiveWords},
                                                  {"FIVE_WORD_PIXEL", Profile::kFiveWords},
                                                  {"RNG15_RFL8_NIR8", Profile::kLowBandwidth},
                                                  {"RNG15_RFL8_WIN8", Profile::kLowBandwidth},
                                                  {"RNG15_RFL8_NIR8_ZONE16", Profile::kLowBandwidthZones},
                                                  {"RNG15_RFL8_NIR8_DUAL", Profile::kLowBandwidthDual},
                                                  {"FUSA_RNG15_RFL8_NIR8_DUAL", Profile::kLowBandwidthDual}};
  return all;
}

/// Values by name, in whichever section they are.
class Reader {
 public:
  Reader(const Json& root, const fs::path& source) : root_(root), source_(source) {}

  [[noreturn]] void refuse(const std::string& why) const { fail(source_, why); }

  /// \return nullptr if there is none
  const Json* find(const char* name) const {
    static constexpr std::initializer_list<const char*> kSections{"lidar_data_format", "data_format", "beam_intrinsics",
                                                                  "lidar_intrinsics",  "sensor_info", "config_params"};
    for (const char* const section : kSections) {
      const auto found = root_.find(section);
      if (found != root_.end() && found->is_object() && found->contains(name)) return &found->at(name);
    }
    const auto found = root_.find(name);
    return found == root_.end() || found->is_null() ? nullptr : &*found;
  }

  std::string text(const char* name) const {
    const Json* const found = find(name);
    return found != nullptr && found->is_string() ? found->get<std::string>() : std::string();
  }

  double number(const char* name, double otherwise, double lo, double hi) const {
    const Json* const found = find(name);
    if (found == nullptr) return otherwise;
    if (!found->is_number() || !(found->get<double>() >= lo && found->get<double>() <= hi))
      refuse(formatted("%s is not a number from %g to %g", name, lo, hi));
    return found->get<double>();
  }

  std::size_t count(const char* name, std::size_t otherwise, std::size_t lo, std::size_t hi) const {
    const double read = number(name, static_cast<double>(otherwise), static_cast<double>(lo), static_cast<double>(hi));
    if (read != std::floor(read)) refuse(std::string(name) + " is not a whole number");
    return static_cast<std::size_t>(read);
  }

  std::vector<double> numbers(const char* name, double limit) const {
    const Json* const found = find(name);
    if (found == nullptr) return {};
    std::vector<double> read;
    bool all = found->is_array();
    for (const Json& value : *found) {
      all = all && value.is_number() && std::fabs(value.get<double>()) <= limit;
      if (all) read.push_back(value.get<double>());
    }
    if (!all) refuse(formatted("%s is not a list of numbers within +-%g", name, limit));
    return read;
  }

  Transform transform(const char* name, const Transform& otherwise) const {
    const std::vector<double> read = numbers(name, 1e6);
    if (read.empty()) return otherwise;
    Transform transform{};
    if (read.size() != transform.size()) refuse(std::string(name) + " has not 16 numbers");
    std::copy(read.begin(), read.end(), transform.begin());
    return transform;
  }

 private:
  const Json& root_;
  const fs::path& source_;
};

/// By the sensor's data sheet, millimetres: from the axis to where the beams start.
double defaultBeamOrigin(const std::string& product) {
  const auto is = [&](const char* begin) { return product.rfind(begin, 0) == 0; };
  return is("OS-0-") ? 27.67 : is("OS-1-") ? 15.806 : is("OS-2-") ? 13.762 : 12.163;
}

/// Columns of a frame and frames of a second, for example of "1024x10".
void readMode(const Reader& reader, OusterMetadata& metadata) {
  const std::string mode = reader.text("lidar_mode");
  std::size_t columns = 0;
  double rate = 10;
  if (!mode.empty()) {
    char* end = nullptr;
    columns = std::strtoul(mode.c_str(), &end, 10);
    const std::string rest = end;
    const double read = rest.size() > 1 && rest[0] == 'x' ? std::strtod(rest.c_str() + 1, &end) : 0;
    if (columns == 0 || columns > kMaxColumns || !(read > 0 && read <= 1000) || *end != '\0')
      reader.refuse("lidar_mode is '" + mode + "', not columns x frames per second, as in 1024x10");
    rate = read;
  }
  if (columns == 0 && reader.find("columns_per_frame") == nullptr)
    reader.refuse("is no metadata of an Ouster sensor: it has neither lidar_mode nor columns_per_frame");
  metadata.columns_per_frame = reader.count("columns_per_frame", columns, 1, kMaxColumns);
  metadata.frames_per_second = reader.number("fps", rate, 0.1, 1000);
}

OusterMetadata metadataOf(const Reader& reader) {
  OusterMetadata metadata;
  metadata.product = reader.text("prod_line");
  metadata.serial_number = std::strtoull(reader.text("prod_sn").c_str(), nullptr, 10);
  metadata.altitudes = reader.numbers("beam_altitude_angles", 90);
  metadata.azimuths = reader.numbers("beam_azimuth_angles", 180);
  const std::size_t pixels = metadata.altitudes.size();
  if (pixels == 0 || pixels > kMaxPixels || metadata.azimuths.size() != pixels)
    reader.refuse(
        formatted("is no metadata of an Ouster sensor: it has %zu beam_altitude_angles and %zu "
                  "beam_azimuth_angles",
                  pixels, metadata.azimuths.size()));
  if (reader.count("pixels_per_column", pixels, 1, kMaxPixels) != pixels)
    reader.refuse(formatted("pixels_per_column is not %zu, the number of beam_altitude_angles", pixels));

  readMode(reader, metadata);
  metadata.columns_per_packet = reader.count("columns_per_packet", 16, 1, kMaxColumnsPerPacket);
  metadata.last_column = metadata.columns_per_frame - 1;
  const std::vector<double> window = reader.numbers("column_window", static_cast<double>(kMaxColumns));
  if (!window.empty()) {
    const auto is_column = [&](double column) {
      return column >= 0 && column < static_cast<double>(metadata.columns_per_frame);
    };
    if (window.size() != 2 || !is_column(window[0]) || !is_column(window[1]))
      reader.refuse("column_window is not the first and the last column of a frame");
    metadata.first_column = static_cast<std::size_t>(window[0]);
    metadata.last_column = static_cast<std::size_t>(window[1]);
  }
  if (const std::string profile = reader.text("udp_profile_lidar"); !profile.empty()) {
    const auto known = profiles().find(profile);
    if (known == profiles().end()) {
      std::string names;
      for (const auto& [name, number] : profiles()) names += (names.empty() ? "" : ", ") + name;
      reader.refuse("udp_profile_lidar is " + profile + ", which cannot be read; it must be one of " + names);
    }
    metadata.profile = known->second;
    const std::string header = reader.text("header_type");
    metadata.has_safety_header =
        metadata.profile != Profile::kLegacy && (header.empty() ? profile.rfind("FUSA_", 0) == 0 : header == "FUSA");
  }

  Transform beam = kIdentity;
  beam[3] = reader.number("lidar_origin_to_beam_origin_mm", defaultBeamOrigin(metadata.product), -1000, 1000);
  metadata.beam_to_lidar = reader.transform("beam_to_lidar_transform", beam);
  metadata.lidar_to_sensor = reader.transform("lidar_to_sensor_transform", kDefaultLidarToSensor);
  return metadata;
}

}  // namespace

OusterMetadata parseOusterMetadata(const std::string& json, const fs::path& source) {
  const Json root = Json::parse(json, nullptr, false);
  if (root.is_discarded()) fail(source, "is no metadata of an Ouster sensor: it is not JSON");
  if (!root.is_object()) fail(source, "is no metadata of an Ouster sensor");
  return metadataOf(Reader(root, source));
}

OusterMetadata readOusterMetadata(const fs::path& file) {
  std::error_code unknown;
  if (fs::is_directory(file, unknown)) fail(file, "is no metadata of an Ouster sensor: it is a folder");
  return parseOusterMetadata(wholeContentOf(file), file);
}

}  // namespace lisco_apps
