// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "sensors/hesai_model.h"

#include <array>
#include <cmath>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <system_error>

#include <boost/algorithm/string/split.hpp>
#include <boost/algorithm/string/trim.hpp>
#include <boost/lexical_cast/try_lexical_convert.hpp>

namespace lisco_apps {
namespace {

// Angles by laser number, degrees, as in the manuals and in the maker's software.

constexpr std::array<double, 40> kPandar40Elevations{
    15,    11,    8,     5,  3,     2,     1.67, 1.33,  1,     0.67, 0.33,  0,     -0.33, -0.67,
    -1,    -1.33, -1.67, -2, -2.33, -2.67, -3,   -3.33, -3.67, -4,   -4.33, -4.67, -5,    -5.33,
    -5.67, -6,    -7,    -8, -9,    -10,   -11,  -12,   -13,   -14,  -19,   -25};
constexpr std::array<double, 64> kPandar64Elevations{
    14.882, 11.032, 8.059,  5.057,  3.04,   2.028,  1.86,    1.688,   1.522,   1.351,  1.184,   1.013,  0.846,
    0.675,  0.508,  0.337,  0.169,  0,      -0.169, -0.337,  -0.508,  -0.675,  -0.845, -1.013,  -1.184, -1.351,
    -1.522, -1.688, -1.86,  -2.028, -2.198, -2.365, -2.536,  -2.7,    -2.873,  -3.04,  -3.21,   -3.375, -3.548,
    -3.712, -3.884, -4.05,  -4.221, -4.385, -4.558, -4.72,   -4.892,  -5.057,  -5.229, -5.391,  -5.565, -5.726,
    -5.898, -6.061, -7.063, -8.059, -9.06,  -9.885, -11.032, -12.006, -12.974, -13.93, -18.889, -24.897};
/// Of the lower half; the upper one is nearly its mirror image.
constexpr std::array<double, 64> kQt64Elevations{
    -52.121, -49.785, -47.577, -45.477, -43.465, -41.528, -39.653, -37.831, -36.055, -34.32, -32.619, -30.95,  -29.308,
    -27.69,  -26.094, -24.517, -22.964, -21.42,  -19.889, -18.372, -16.865, -15.368, -13.88, -12.399, -10.925, -9.457,
    -7.994,  -6.535,  -5.079,  -3.626,  -2.175,  -0.725,  0.725,   2.175,   3.626,   5.079,  6.534,   7.993,   9.456,
    10.923,  12.397,  13.877,  15.365,  16.861,  18.368,  19.885,  21.415,  22.959,  24.524, 26.101,  27.697,  29.315,
    30.957,  32.627,  34.328,  36.064,  37.84,   39.662,  41.537,  43.475,  45.487,  47.587, 49.795,  52.133};
constexpr std::array<double, 64> kQt64Offsets{
    8.736,  8.314, 7.964,  7.669,  7.417,  7.198,  7.007,  6.838,  6.688,  6.554,  6.434,  6.326,  6.228,
    6.14,   6.059, 5.987,  -5.27,  -5.216, -5.167, -5.123, -5.083, -5.047, -5.016, -4.988, -4.963, -4.942,
    -4.924, -4.91, -4.898, -4.889, -4.884, -4.881, 5.493,  5.496,  5.502,  5.512,  5.525,  5.541,  5.561,
    5.584,  5.611, 5.642,  5.676,  5.716,  5.759,  5.808,  5.862,  5.921,  -5.33,  -5.396, -5.469, -5.55,
    -5.64,  -5.74, -5.85,  -5.974, -6.113, -6.269, -6.447, -6.651, -6.887, -7.163, -7.493, -7.892};

/// Of lasers 1 to 96; each of the other 32 is the mirror image of one of the first 32.
constexpr std::array<double, 96> kQt128Elevations{
    -52.627, -51.028, -49.515, -48.074, -46.695, -45.369, -44.09,  -42.852, -41.651, -40.482, -39.343, -38.231,
    -37.143, -36.076, -35.03,  -34.002, -32.992, -31.996, -31.015, -30.048, -29.093, -28.149, -27.216, -26.292,
    -25.378, -24.473, -23.575, -22.685, -21.802, -20.926, -20.056, -19.191, -18.331, -17.477, -16.627, -15.781,
    -14.94,  -14.102, -13.268, -12.436, -11.608, -10.783, -9.96,   -9.139,  -8.32,   -7.503,  -6.688,  -5.874,
    -5.061,  -4.25,   -3.439,  -2.63,   -1.82,   -1.012,  -0.203,  0.606,   1.414,   2.223,   3.033,   3.843,
    4.654,   5.466,   6.279,   7.094,   7.91,    8.728,   9.547,   10.369,  11.194,  12.02,   12.85,   13.683,
    14.519,  15.359,  16.202,  17.05,   17.902,  18.759,  19.621,  20.488,  21.362,  22.241,  23.128,  24.022,
    24.923,  25.833,  26.751,  27.679,  28.618,  29.567,  30.528,  31.502,  32.49,   33.493,  34.512,  35.549};
constexpr std::array<double, 96> kQt128Offsets{
    10.108, 9.72,   9.384,  9.091,  8.833,  8.603,  8.396,  8.209,  8.04,   7.885,  7.743,  7.612,  7.492,  7.38,
    7.277,  7.18,   7.09,   7.006,  6.928,  6.854,  6.785,  6.721,  6.66,   6.602,  6.549,  6.498,  6.45,   6.405,
    6.363,  6.323,  6.285,  6.25,   -6.217, -6.186, -6.157, -6.129, -6.104, -6.08,  -6.057, -6.037, -6.018, -6,
    -5.984, -5.969, -5.955, -5.943, -5.927, -5.923, -5.915, -5.908, -5.902, -5.897, -5.894, -5.892, -5.891, -5.891,
    -5.893, -5.896, -5.899, -5.905, -5.911, -5.919, -5.927, -5.938, 5.949,  5.962,  5.976,  5.992,  6.008,  6.027,
    6.047,  6.068,  6.091,  6.116,  6.143,  6.171,  6.201,  6.233,  6.267,  6.304,  6.343,  6.384,  6.427,  6.474,
    6.523,  6.575,  6.631,  6.69,   6.752,  6.819,  6.89,   6.966,  7.047,  7.134,  7.227,  7.327};

/// Where three lasers, or six, look in turns; the others look straight on.
constexpr double kStraight = -1.042;
constexpr std::array<double, 3> kPandar40Offsets{3.125, -5.208, kStraight};
constexpr std::array<double, 6> kPandar64Offsets{1.042, 3.125, 5.208, -5.208, -3.125, kStraight};

/// \param first, count of the lasers that look in turns
template <std::size_t kLasers, std::size_t kTurns>
std::vector<Laser> lasersInTurns(const std::array<double, kLasers>& elevations,
                                 const std::array<double, kTurns>& offsets, std::size_t first, std::size_t count) {
  std::vector<Laser> lasers;
  for (std::size_t i = 0; i < kLasers; ++i)
    lasers.push_back({i, elevations[i], i >= first && i < first + count ? offsets[(i - first) % kTurns] : kStraight});
  return lasers;
}

std::vector<Laser> evenLasers(std::size_t count, double top, double step) {
  std::vector<Laser> lasers;
  for (std::size_t i = 0; i < count; ++i) lasers.push_back({i, top - step * static_cast<double>(i)});
  return lasers;
}

template <std::size_t kCount>
std::vector<Laser> lasersAt(const std::array<double, kCount>& elevations, const std::array<double, kCount>& offsets) {
  std::vector<Laser> lasers;
  for (std::size_t i = 0; i < kCount; ++i) lasers.push_back({i, elevations[i], offsets[i]});
  return lasers;
}

std::vector<Laser> qt128Lasers() {
  constexpr std::size_t kLasers = 128;
  std::vector<Laser> lasers = lasersAt(kQt128Elevations, kQt128Offsets);
  for (std::size_t i = lasers.size(); i < kLasers; ++i) {
    const Laser& mirrored = lasers[kLasers - 1 - i];
    lasers.push_back({i, -mirrored.elevation, -mirrored.azimuth_offset});
  }
  return lasers;
}

using Header = HesaiModel::Header;

constexpr HesaiModel::Tail kEarlyTail{22, 14, 16, 10}, kQt64Tail{24, 16, 18, 12}, kXtTail{24, 10, 13, 19},
    kQt128Tail{26, 12, 15, 21};

}  // namespace

std::optional<HesaiModel::Shape> HesaiModel::shapeOf(std::size_t bytes) const {
  for (const Form& form : forms)
    for (const End& end : ends)
      if (bytes == leastBytes(form) + end.bytes) return Shape{&form, end.has_number};
  return std::nullopt;
}

HesaiModel hesaiLayout(const std::string& name) {
  if (name == "pandar40p")
    return {name, lasersInTurns(kPandar40Elevations, kPandar40Offsets, 6, 24), Header::kNone, {{10, 3}}, kEarlyTail,
            55.56};
  if (name == "pandar64")
    return {name,           lasersInTurns(kPandar64Elevations, kPandar64Offsets, 6, 48),
            Header::kShort, {{6, 3}, {7, 3}},
            kEarlyTail,     55.56};
  if (name == "pandarqt64")
    return {name, lasersAt(kQt64Elevations, kQt64Offsets), Header::kLong, {{4, 4}}, kQt64Tail, 500. / 3};
  if (name == "pandarxt16") return {name, evenLasers(16, 15, 2), Header::kLong, {{8, 4}}, kXtTail, 50};
  if (name == "pandarxt32") return {name, evenLasers(32, 15, 1), Header::kLong, {{8, 4}}, kXtTail, 50};
  if (name == "pandarxt32m") return {name, evenLasers(32, 19.5, 1.3), Header::kLong, {{6, 4}}, kXtTail, 50};
  if (name == "pandarqt128") {
    // A measurement may lack its confidence. After the blocks come a check sum and, if it is on, the functional safety;
    // after the tail the number, a check sum and a signature, each of which may be missing.
    constexpr std::size_t kSum = 4, kSafety = 17, kNumber = 4, kSignature = 32;
    return {name,
            qt128Lasers(),
            Header::kLong,
            {{2, 4, kSum + kSafety}, {2, 4, kSum}, {2, 3, kSum + kSafety}, {2, 3, kSum}},
            kQt128Tail,
            111.11,
            {{kNumber + kSum + kSignature, true},
             {kNumber + kSum, true},
             {kSum + kSignature, false},
             {kSum, false},
             {0, false}}};
  }
  throw std::runtime_error("there is no sensor '" + name + "'");
}

std::vector<std::string> hesaiModelNames() {
  return {"pandar40p", "pandar64", "pandarqt64", "pandarxt16", "pandarxt32", "pandarxt32m", "pandarqt128"};
}

HesaiModel makeHesaiModel(const std::string& name, const fs::path& calibration_file) {
  HesaiModel model = hesaiLayout(name);
  if (!calibration_file.empty()) model.lasers = readHesaiCalibration(calibration_file, model.lasers.size());
  sortByElevation(model.lasers);
  return model;
}

std::vector<Laser> readHesaiCalibration(const fs::path& file, std::size_t lasers) {
  std::error_code unknown;
  if (fs::is_directory(file, unknown)) fail(file, "is no calibration file: it is a folder");
  std::ifstream stream(file);
  if (!stream) fail(file, "is no calibration file: cannot open file");
  std::vector<std::optional<Laser>> found(lasers);
  const auto read = [](std::string text, double& number) {
    boost::trim(text);
    return boost::conversion::try_lexical_convert(text, number);
  };
  for (std::string line; std::getline(stream, line);) {
    std::vector<std::string> fields;
    boost::split(fields, line, [](char c) { return c == ',' || c == ';'; });
    double number = 0, elevation = 0, offset = 0;
    if (fields.size() < 3 || !read(fields[0], number)) continue;
    if (!(number >= 1 && number <= static_cast<double>(lasers)) || number != std::floor(number))
      fail(file, "there is no laser " + fields[0] + formatted(" of %zu", lasers));
    const bool is_angle =
        read(fields[1], elevation) && std::fabs(elevation) <= 90 && read(fields[2], offset) && std::fabs(offset) <= 180;
    if (!is_angle) fail(file, "the angles of laser " + fields[0] + " are not two numbers of degrees");
    const auto index = static_cast<std::size_t>(number) - 1;
    found[index] = Laser{index, elevation, offset};
  }
  return allOf(found, file, 1);
}

}  // namespace lisco_apps
