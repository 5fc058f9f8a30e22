// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "sensors/hesai_decoder.h"

#include <cmath>

#include <boost/endian/conversion.hpp>

namespace lisco_apps {
namespace {

constexpr std::size_t kPositionBytes = 512;
constexpr unsigned kTurn = 36000;    ///< hundredths of a degree
constexpr unsigned kMaxStep = 300;   ///< larger ones have packets missing
constexpr double kMaxSteps = 16384;  ///< counted; then all counts are halved
constexpr std::uint32_t kHourUs = 3600U * 1000000U;

constexpr auto& u16 = boost::endian::load_little_u16;
constexpr auto& u32 = boost::endian::load_little_u32;

/// Returns of a laser by the mode of returns; 0 if it is unknown.
std::size_t returnsOfMode(unsigned mode) {
  constexpr unsigned kFirstSingle = 0x33, kLastSingle = 0x38, kLastDual = 0x3C, kTriple = 0x3D;
  if (mode >= kFirstSingle && mode <= kLastSingle) return 1;
  if (mode > kLastSingle && mode <= kLastDual) return 2;
  return mode == kTriple ? 3 : 0;
}

}  // namespace

HesaiDecoder::HesaiDecoder(HesaiModel model, ReturnChoice returns)
    : Decoder(model.name, elevationsOf(model.lasers), staggerOf(model.lasers)),
      model_(std::move(model)),
      returns_choice_(returns),
      cells_(model_.laserCount()),
      form_(model_.forms.front()) {
  cells_.reserve(kMaxEchoes * model_.laserCount());
  for (const Laser& laser : model_.lasers) {
    const double elevation = laser.elevation * kRadiansPerDegree, offset = laser.azimuth_offset * kRadiansPerDegree;
    rows_.push_back({laser.number, std::cos(elevation), std::sin(elevation), std::cos(offset), std::sin(offset)});
  }
}

double HesaiDecoder::packetPeriodUs() const {
  return model_.firing_period_us * static_cast<double>(form_.blocks / returns_);
}

/// From the azimuth on.
const std::uint8_t* HesaiDecoder::block(const std::uint8_t* packet, const HesaiModel::Form& form, std::size_t i) const {
  const std::size_t flag = model_.header == HesaiModel::Header::kNone ? 2 : 0;
  return packet + model_.headerBytes() + i * model_.blockBytes(form) + flag;
}

bool HesaiDecoder::isOurs(const Packet& packet, const HesaiModel::Form& form) const {
  if (model_.header != HesaiModel::Header::kNone) {
    const std::uint8_t* const counts = packet.data + (model_.header == HesaiModel::Header::kLong ? 6 : 2);
    const std::uint8_t distance_unit = counts[3];
    if (packet.data[0] != 0xEE || packet.data[1] != 0xFF || counts[0] != model_.laserCount() ||
        counts[1] != form.blocks || distance_unit == 0 || distance_unit > 100)
      return false;
  }
  for (std::size_t i = 0; i < form.blocks; ++i) {
    const std::uint8_t* const azimuth = block(packet.data, form, i);
    if (u16(azimuth) > kTurn) return false;
    if (model_.header == HesaiModel::Header::kNone && (azimuth[-2] != 0xFF || azimuth[-1] != 0xEE)) return false;
  }
  return true;
}

/// By the mode of returns; if that is unknown, by the blocks of the same azimuth.
std::size_t HesaiDecoder::returnsOf(const std::uint8_t* packet) const {
  std::size_t returns = returnsOfMode(packet[model_.tailAt(form_) + model_.tail.mode]);
  if (returns == 0)
    for (returns = 1; returns < kMaxEchoes; ++returns)
      if (returns == form_.blocks || u16(block(packet, form_, returns)) != u16(block(packet, form_, 0))) break;
  return form_.blocks % returns == 0 ? returns : 1;
}

/// Microseconds past the hour, of the end of the packet. The date is six bytes, or zero and the seconds since 1970.
std::uint32_t HesaiDecoder::timeOf(const std::uint8_t* packet) const {
  const std::uint8_t* const date = packet + model_.tailAt(form_) + model_.tail.date;
  const bool is_since_1970 = date[0] == 0 && model_.header == HesaiModel::Header::kLong;
  const std::uint32_t seconds = is_since_1970 ? boost::endian::load_big_u32(date + 2) : date[4] * 60U + date[5];
  return (seconds % 3600 * 1000000U + u32(packet + model_.tailAt(form_) + model_.tail.time) % kHourUs) % kHourUs;
}

void HesaiDecoder::measureStep(const std::uint8_t* packet, bool is_next) {
  if (!is_next) last_azimuth_.reset();
  for (std::size_t i = 0; i < form_.blocks; i += returns_) {
    const unsigned azimuth = u16(block(packet, form_, i)) % kTurn;
    const unsigned step = last_azimuth_ ? (azimuth + kTurn - *last_azimuth_) % kTurn : 0;
    last_azimuth_ = azimuth;
    if (step == 0 || step > kMaxStep) continue;
    step_sum_ += step;
    if (++step_count_ < kMaxSteps) continue;
    step_sum_ /= 2;
    step_count_ /= 2;
  }
}

void HesaiDecoder::decodeFiring(const std::uint8_t* first_block, double distance_unit) {
  const double azimuth = u16(first_block) / 100. * kRadiansPerDegree;
  const double cosine = std::cos(azimuth), sine = std::sin(azimuth);
  const std::size_t cells_per_laser = cells_.size() / rows_.size();
  Echoes echoes;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Row& row = rows_[i];
    echoes.clear();
    for (std::size_t j = 0; j < returns_; ++j) {
      const std::uint8_t* const measured =
          first_block + j * model_.blockBytes(form_) + 2 + form_.unit_bytes * row.number;
      echoes.add({u16(measured), static_cast<float>(measured[2]), measured[2]});
    }
    echoes.choose(returns_choice_);
    for (std::size_t j = 0; j < cells_per_laser; ++j) {
      Cell& cell = cells_[i * cells_per_laser + j];
      cell = kNoCell;
      if (echoes[j].distance == 0) continue;
      const double distance = echoes[j].distance * distance_unit;
      const double across = distance * row.elevation_cosine;
      cell = {static_cast<float>(across * (sine * row.offset_cosine + cosine * row.offset_sine)),
              static_cast<float>(across * (cosine * row.offset_cosine - sine * row.offset_sine)),
              static_cast<float>(distance * row.elevation_sine), echoes[j].intensity};
    }
  }
}

Decoder::Kind HesaiDecoder::decode(const Packet& packet, const Visitor& visit) {
  if (packet.size == kPositionBytes) {
    ++counts_.position;
    return Kind::kPosition;
  }
  const std::optional<HesaiModel::Shape> shape = model_.shapeOf(packet.size);
  if (!shape || !isOurs(packet, *shape->form)) {
    ++counts_.foreign;
    return Kind::kForeign;
  }
  const HesaiModel::Form form_before = std::exchange(form_, *shape->form);
  const std::size_t returns_before = std::exchange(returns_, returnsOf(packet.data));
  const std::uint32_t time_us = timeOf(packet.data);
  const PacketOrder::Place place = shape->has_number
                                       ? order_.placeByNumber(u32(packet.data + model_.leastBytes(form_)), time_us)
                                       : order_.place(time_us, packetPeriodUs());
  counts_.missing = order_.missing();
  counts_.clock_jumps = order_.clockJumps();
  if (place == PacketOrder::Place::kLate) {
    form_ = form_before;
    returns_ = returns_before;
    ++counts_.late;
    return Kind::kLate;
  }
  ++counts_.data;
  if (returns_ > 1) ++counts_.dual;
  measureStep(packet.data, place == PacketOrder::Place::kNext);

  const std::size_t cells = model_.laserCount() * (returns_choice_ == ReturnChoice::kBoth ? returns_ : 1);
  const bool is_other_mode = counts_.columns > 0 && cells != cells_.size();
  cells_.resize(cells);
  const bool misses_turn = turnUs() > 0 && order_.gap() - packetPeriodUs() >= turnUs();
  bool after_break = place == PacketOrder::Place::kNewClock || misses_turn || is_other_mode;

  constexpr double kMillimetre = 0.001, kPandar40Unit = 0.004;
  const std::size_t unit_at = model_.header == HesaiModel::Header::kLong ? 9 : 5;
  const double distance_unit =
      model_.header == HesaiModel::Header::kNone ? kPandar40Unit : packet.data[unit_at] * kMillimetre;
  for (std::size_t i = 0; i < form_.blocks; i += returns_) {
    const std::uint8_t* const first = block(packet.data, form_, i);
    decodeFiring(first, distance_unit);
    const double azimuth = std::fmod(u16(first) / 100. + 270, 360.);  // from +x, which is to the right
    const auto later = static_cast<double>((form_.blocks - i) / returns_ - 1) * model_.firing_period_us;
    const double since_hour_us = time_us - later;
    ++counts_.columns;
    visit({cells_, azimuth, since_hour_us < 0 ? since_hour_us + kHourUs : since_hour_us, after_break});
    after_break = false;
  }
  return Kind::kData;
}

}  // namespace lisco_apps
