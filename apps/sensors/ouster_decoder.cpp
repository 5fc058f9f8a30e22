// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "sensors/ouster_decoder.h"

#include <algorithm>
#include <cmath>

#include <boost/endian/conversion.hpp>

#include "sensors/laser.h"
#include "sensors/packet_order.h"

namespace lisco_apps {
namespace {

using Profile = OusterMetadata::Profile;

constexpr std::size_t kImuBytes = 48;
constexpr std::size_t kMeasurementAt = 8, kStatusAt = 10, kLegacyFrameAt = 10, kLegacyFooter = 4;
constexpr unsigned kLidarType = 1;
constexpr double kMetresPerMillimetre = 0.001;
constexpr double kFullStagger = 3.2;  ///< radians: no bound

constexpr auto& u16 = boost::endian::load_little_u16;
constexpr auto& u32 = boost::endian::load_little_u32;

double azimuthOf(double x, double y) {
  const double azimuth = std::fmod(std::atan2(-y, x) / kRadiansPerDegree + 720, 360.);
  return azimuth < 360 ? azimuth : 0;
}

std::vector<double> sortedAltitudes(const OusterMetadata& metadata) {
  std::vector<double> altitudes = metadata.altitudes;
  std::stable_sort(altitudes.begin(), altitudes.end(), [](double a, double b) { return a > b; });
  return altitudes;
}

/// See Decoder::stagger ().
double staggerOf(const OusterMetadata& metadata) {
  constexpr double kMargin = 1, kMinRange = 500;  // degrees, millimetres
  const Transform& t = metadata.lidar_to_sensor;
  const bool turns_about_z = std::fabs(t[2]) + std::fabs(t[6]) + std::fabs(t[8]) + std::fabs(t[9]) < 1e-6 && t[10] > 0;
  const double beside = std::hypot(t[3], t[7]) / kMinRange;
  if (!turns_about_z || beside >= 1) return kFullStagger;
  double most = 0;
  for (const double azimuth : metadata.azimuths) most = std::max(most, std::fabs(azimuth));
  return (most + kMargin) * kRadiansPerDegree + std::asin(beside);
}

std::string sensorNameOf(const OusterMetadata& metadata) {
  return metadata.product.empty() ? "ouster" : "ouster " + metadata.product;
}

}  // namespace

OusterDecoder::Layout OusterDecoder::layoutOf(const OusterMetadata& metadata) {
  const bool is_legacy = metadata.profile == Profile::kLegacy;
  const bool is_fusa = metadata.has_safety_header;
  Layout layout;
  layout.header = is_legacy ? 0 : 32;
  layout.column_header = is_legacy ? 16 : 12;
  layout.column = layout.column_header + metadata.pixels() * pixelLayoutOf(metadata.profile).bytes +
                  (is_legacy ? kLegacyFooter : 0);
  layout.packet = 2 * layout.header + metadata.columns_per_packet * layout.column;
  layout.frame_id = is_legacy ? kLegacyFrameAt : is_fusa ? 4 : 2;
  layout.frame_id_bytes = is_fusa ? 4 : 2;
  if (is_legacy) return layout;
  layout.type_bytes = is_fusa ? 1 : 2;
  layout.initialization = is_fusa ? 1 : 4;
  layout.serial_number = is_fusa ? 11 : 7;
  return layout;
}

OusterDecoder::PixelLayout OusterDecoder::pixelLayoutOf(Profile profile) {
  constexpr std::uint32_t k20Bits = 0xFFFFF, k19Bits = 0x7FFFF, k15Bits = 0x7FFF;
  switch (profile) {
    case Profile::kLegacy:
      return {12, 1, k20Bits, 0, {{0, 4, 0}, {}}, 2};
    case Profile::kSingle:
      return {12, 1, k19Bits, 0, {{0, 4, 0}, {}}, 1};
    case Profile::kSingleColour:
      return {16, 1, k19Bits, 0, {{0, 3, 4}, {}}, 1};
    case Profile::kDual:
      return {16, 2, k19Bits, 0, {{0, 3, 8}, {4, 7, 10}}, 1};
    case Profile::kFiveWords:
      return {20, 2, k19Bits, 0, {{0, 3, 8}, {4, 7, 10}}, 1};
    case Profile::kLowBandwidthDual:
      return {8, 2, k15Bits, 3, {{0, 2, 0}, {4, 6, 0}}, 1};
    case Profile::kLowBandwidthZones:
      return {8, 1, k15Bits, 3, {{0, 2, 0}, {}}, 1};
    case Profile::kLowBandwidth:
      break;
  }
  return {4, 1, k15Bits, 3, {{0, 2, 0}, {}}, 1};
}

OusterDecoder::OusterDecoder(const OusterMetadata& metadata, ReturnChoice returns)
    : Decoder(sensorNameOf(metadata), sortedAltitudes(metadata), staggerOf(metadata)),
      metadata_(metadata),
      returns_(returns),
      layout_(layoutOf(metadata)),
      pixel_layout_(pixelLayoutOf(metadata.profile)),
      cells_per_pixel_(returns == ReturnChoice::kBoth ? pixel_layout_.returns : 1),
      cells_(metadata.pixels() * cells_per_pixel_),
      held_(kMaxHeld + 1) {
  for (Held& held : held_) held.bytes.resize(layout_.packet);

  std::vector<std::size_t> pixels(metadata.pixels());
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels[i] = i;
  std::stable_sort(pixels.begin(), pixels.end(),
                   [&](std::size_t a, std::size_t b) { return metadata.altitudes[a] > metadata.altitudes[b]; });
  for (const std::size_t pixel : pixels) {
    const double altitude = metadata.altitudes[pixel] * kRadiansPerDegree;
    const double azimuth = metadata.azimuths[pixel] * kRadiansPerDegree;
    beams_.push_back(
        {pixel, std::cos(altitude) * std::cos(azimuth), -std::cos(altitude) * std::sin(azimuth), std::sin(altitude)});
  }
  beam_length_ = std::hypot(metadata.beam_to_lidar[3], metadata.beam_to_lidar[11]);

  const Transform& t = metadata.lidar_to_sensor;
  for (std::size_t i = 0; i < metadata.columns_per_frame; ++i) {
    const double angle =
        -360 * kRadiansPerDegree * static_cast<double>(i) / static_cast<double>(metadata.columns_per_frame);
    Direction direction{std::cos(angle), std::sin(angle), 0};
    direction.azimuth =
        azimuthOf(t[0] * direction.cosine + t[1] * direction.sine, t[4] * direction.cosine + t[5] * direction.sine);
    directions_.push_back(direction);
  }

  const std::size_t packets =
      (metadata.columns_per_frame + metadata.columns_per_packet - 1) / metadata.columns_per_packet;
  std::vector<bool> is_sent(packets, false);
  for (std::size_t column = metadata.first_column;; column = (column + 1) % metadata.columns_per_frame) {
    is_sent[column / metadata.columns_per_packet] = true;
    if (column == metadata.last_column) break;
  }
  for (const bool sent : is_sent) {
    ranks_.push_back(packets_per_frame_);
    if (sent) ++packets_per_frame_;
  }
}

double OusterDecoder::packetPeriodUs() const {
  return turnUs() * static_cast<double>(metadata_.columns_per_packet) / columnsPerTurn();
}

bool OusterDecoder::isValid(const std::uint8_t* column) const {
  if (layout_.header == 0) return u32(column + layout_.column - kLegacyFooter) == 0xFFFFFFFF;
  return (u16(column + kStatusAt) & 1U) != 0;
}

/// Motions and zones.
bool OusterDecoder::isOfSensorsState(const Packet& packet) const {
  constexpr unsigned kImuType = 2, kZoneType = 3;
  if (layout_.header == 0) return packet.size == kImuBytes;
  if (packet.size == kImuBytes) return true;
  if (packet.size < 2 * layout_.header || packet.size == layout_.packet) return false;
  const unsigned type = layout_.type_bytes == 1 ? packet.data[0] : u16(packet.data);
  return type == kImuType || type == kZoneType;
}

bool OusterDecoder::isOurs(const Packet& packet) const {
  if (packet.size != layout_.packet) return false;
  if (layout_.type_bytes == 1 && packet.data[0] != kLidarType) return false;
  if (layout_.type_bytes == 2 && u16(packet.data) != kLidarType) return false;
  std::size_t next = 0;
  for (std::size_t i = 0; i < metadata_.columns_per_packet; ++i) {
    const std::uint8_t* const column = packet.data + layout_.header + i * layout_.column;
    if (!isValid(column)) continue;
    const std::size_t number = u16(column + kMeasurementAt);
    if (number < next || number >= metadata_.columns_per_frame) return false;
    next = number + 1;
  }
  return true;
}

bool OusterDecoder::isFromAny(const Packet& packet) {
  // Those of further profiles are as long as these, and the type of both headers begins with the same byte.
  OusterMetadata metadata;
  for (const Profile profile : {Profile::kLegacy, Profile::kSingle, Profile::kSingleColour, Profile::kDual,
                                Profile::kFiveWords, Profile::kLowBandwidth, Profile::kLowBandwidthZones})
    for (const std::size_t pixels : {16U, 32U, 64U, 128U}) {
      metadata.profile = profile;
      metadata.altitudes.resize(pixels);
      const Layout layout = layoutOf(metadata);
      if (packet.size == layout.packet && (profile == Profile::kLegacy || packet.data[0] == kLidarType)) return true;
    }
  return false;
}

std::optional<std::size_t> OusterDecoder::firstColumn(const std::uint8_t* packet) const {
  for (std::size_t i = 0; i < metadata_.columns_per_packet; ++i) {
    const std::uint8_t* const column = packet + layout_.header + i * layout_.column;
    if (isValid(column)) return u16(column + kMeasurementAt);
  }
  return std::nullopt;
}

OusterDecoder::Place OusterDecoder::placeOf(const std::uint8_t* packet, std::size_t first_column) const {
  Place place;
  if (layout_.frame_id_bytes == 4) {
    const std::uint32_t frame = u32(packet + layout_.frame_id);
    place.frame =
        started_ ? last_.frame + static_cast<std::int32_t>(frame - static_cast<std::uint32_t>(last_.frame)) : frame;
  } else {
    const std::uint16_t frame = u16(packet + layout_.frame_id);
    const auto ahead = static_cast<std::uint16_t>(frame - static_cast<std::uint16_t>(last_.frame));
    place.frame = started_ ? last_.frame + static_cast<std::int16_t>(ahead) : frame;
  }
  place.packet = static_cast<std::int64_t>(first_column / metadata_.columns_per_packet);
  place.order = place.frame * packets_per_frame_ + ranks_[static_cast<std::size_t>(place.packet)];
  return place;
}

Decoder::Kind OusterDecoder::decode(const Packet& packet, const Visitor& visit) {
  if (isOfSensorsState(packet)) {
    ++counts_.position;
    return Kind::kPosition;
  }
  if (!isOurs(packet)) {
    ++counts_.foreign;
    return Kind::kForeign;
  }
  const auto says_other = [&] {
    std::uint64_t serial_number = 0;
    for (std::size_t i = 5; i > 0; --i)
      serial_number = serial_number << 8U | packet.data[layout_.serial_number + i - 1];
    return serial_number != metadata_.serial_number;
  };
  if (layout_.serial_number > 0 && metadata_.serial_number > 0 && says_other()) ++counts_.says_other_model;

  const std::optional<std::size_t> first_column = firstColumn(packet.data);
  if (!first_column) {
    ++counts_.data;
    return Kind::kData;
  }
  const std::uint32_t initialization =
      layout_.initialization > 0 ? u32(packet.data + layout_.initialization) & 0xFFFFFFU : 0;
  if (started_ && initialization != initialization_) startAgain(visit);
  initialization_ = initialization;

  Place place = placeOf(packet.data, *first_column);
  if (started_ && static_cast<double>(place.frame - last_.frame) * turnUs() > PacketOrder::kMaxGapUs) {
    startAgain(visit);
    place = placeOf(packet.data, *first_column);
  }
  const auto held_end = held_.begin() + static_cast<std::ptrdiff_t>(held_count_);
  const auto behind =
      std::find_if(held_.begin(), held_end, [&](const Held& h) { return h.place.order >= place.order; });
  const bool is_copy = behind != held_end && behind->place.order == place.order;
  if ((started_ && place.order <= last_.order) || is_copy) {
    if (++late_in_a_row_ <= PacketOrder::kMaxLate) {
      ++counts_.late;
      return Kind::kLate;
    }
    startAgain(visit);
    place = placeOf(packet.data, *first_column);
  }
  late_in_a_row_ = 0;
  ++counts_.data;
  if (pixel_layout_.returns > 1) ++counts_.dual;
  if (!started_ || place.order == last_.order + 1) {
    deliver(packet.data, place, visit);
  } else {
    // The unused one behind the held ones moves into its place.
    std::rotate(behind, held_end, held_end + 1);
    behind->place = place;
    std::copy_n(packet.data, packet.size, behind->bytes.begin());
    if (++held_count_ <= kMaxHeld) return Kind::kData;
    deliverHeld(visit);
  }
  while (held_count_ > 0 && held_.front().place.order == last_.order + 1) deliverHeld(visit);
  return Kind::kData;
}

/// Delivers the first of the held packets.
void OusterDecoder::deliverHeld(const Visitor& visit) {
  deliver(held_.front().bytes.data(), held_.front().place, visit);
  std::rotate(held_.begin(), held_.begin() + 1, held_.begin() + static_cast<std::ptrdiff_t>(held_count_));
  --held_count_;
}

void OusterDecoder::flush(const Visitor& visit) {
  while (held_count_ > 0) deliverHeld(visit);
}

/// What comes now is of another recording, or the sensor has been started again.
void OusterDecoder::startAgain(const Visitor& visit) {
  flush(visit);
  started_ = false;
  is_new_clock_ = true;
  late_in_a_row_ = 0;
  ++counts_.clock_jumps;
}

void OusterDecoder::deliver(const std::uint8_t* packet, const Place& place, const Visitor& visit) {
  gap_us_ = 0;
  bool after_break = is_new_clock_;
  if (started_) {
    const double packets_of_turn = columnsPerTurn() / static_cast<double>(metadata_.columns_per_packet);
    gap_us_ = turnUs() * (static_cast<double>(place.frame - last_.frame) +
                          static_cast<double>(place.packet - last_.packet) / packets_of_turn);
    counts_.missing += static_cast<std::uint64_t>(place.order - last_.order - 1);
    after_break = place.order - last_.order > packets_per_frame_;
  }
  started_ = true;
  is_new_clock_ = false;
  last_ = place;
  for (std::size_t i = 0; i < metadata_.columns_per_packet; ++i) {
    const std::uint8_t* const column = packet + layout_.header + i * layout_.column;
    if (!isValid(column)) continue;
    const Direction& direction = directions_[u16(column + kMeasurementAt)];
    decodePixels(column + layout_.column_header, direction);
    constexpr std::uint64_t kHourNs = 3600ULL * 1000000000;
    const double time_us = static_cast<double>(boost::endian::load_little_u64(column) % kHourNs) / 1000;
    ++counts_.columns;
    visit({cells_, direction.azimuth, time_us, after_break});
    after_break = false;
  }
}

void OusterDecoder::decodePixels(const std::uint8_t* pixels, const Direction& direction) {
  Echoes echoes;
  auto cell = cells_.begin();
  for (const Beam& beam : beams_) {
    const std::uint8_t* const pixel = pixels + beam.pixel * pixel_layout_.bytes;
    echoes.clear();
    for (std::size_t i = 0; i < pixel_layout_.returns; ++i) {
      const PixelLayout::At& at = pixel_layout_.at[i];
      Echo echo;
      echo.distance = (u32(pixel + at.range) & pixel_layout_.range_mask) << pixel_layout_.range_shift;
      const unsigned reflectivity =
          pixel_layout_.reflectivity_bytes == 2 ? u16(pixel + at.reflectivity) : pixel[at.reflectivity];
      echo.intensity = static_cast<float>(reflectivity);
      echo.strength = at.signal > 0 ? u16(pixel + at.signal) : reflectivity;
      echoes.add(echo);
    }
    echoes.choose(returns_);
    for (std::size_t i = 0; i < cells_per_pixel_; ++i, ++cell)
      *cell = echoes[i].distance > 0 ? cellOf(echoes[i], beam, direction) : kNoCell;
  }
}

/// As the maker computes it: the range counts from the sensor's axis to the beam's origin, and on along the beam.
Cell OusterDecoder::cellOf(const Echo& echo, const Beam& beam, const Direction& direction) const {
  const double length = echo.distance - beam_length_;
  const double along = length * beam.along + metadata_.beam_to_lidar[3], across = length * beam.across;
  const double x = along * direction.cosine - across * direction.sine;
  const double y = along * direction.sine + across * direction.cosine;
  const double z = length * beam.up + metadata_.beam_to_lidar[11];
  const Transform& t = metadata_.lidar_to_sensor;
  const auto metres = [&](std::size_t row) {
    const double value = t[4 * row] * x + t[4 * row + 1] * y + t[4 * row + 2] * z + t[4 * row + 3];
    return static_cast<float>(kMetresPerMillimetre * value);
  };
  return {metres(0), metres(1), metres(2), echo.intensity};
}

}  // namespace lisco_apps
