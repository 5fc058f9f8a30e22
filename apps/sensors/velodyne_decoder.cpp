// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "sensors/velodyne_decoder.h"

#include <algorithm>
#include <cmath>

#include <boost/endian/conversion.hpp>

namespace lisco_apps {
namespace {

constexpr std::size_t kDataBytes = 1206, kPositionBytes = 512;
constexpr std::size_t kBlockBytes = 100, kMeasurementsAt = 4, kMeasurementBytes = 3, kLasersPerBlock = 32;
constexpr std::size_t kTimeAt = 1200, kModeAt = 1204, kModelAt = 1205;
constexpr unsigned kDualMode = 0x39;
constexpr unsigned kTurn = 36000;               ///< hundredths of a degree
constexpr std::uint32_t kMaxSteps = 1U << 16U;  ///< counted, a few seconds; then all counts are halved

double radians(double degrees) {
  return degrees * kRadiansPerDegree;
}

constexpr auto& u16 = boost::endian::load_little_u16;

unsigned azimuthOf(const std::uint8_t* block) {
  return u16(block + 2);
}

/// \return radians by which the driver's azimuths may depart from the manual's: a block's period at 20 turns a second
double driverMargin(const VelodyneModel& model) {
  if (!model.driver.one_return && !model.driver.two_returns) return 0.;
  return radians(360 * 20e-6 * static_cast<double>(model.firings) * model.firing_period_us);
}

}  // namespace

VelodyneDecoder::VelodyneDecoder(VelodyneModel model, ReturnChoice returns, Turning turning)
    : Decoder(model.name, elevationsOf(model.lasers), staggerOf(model.lasers) + driverMargin(model)),
      model_(std::move(model)),
      returns_(returns),
      turning_(turning),
      cells_(model_.lasers.size()),
      packet_period_us_(static_cast<double>(kBlocks) * blockPeriodUs() / static_cast<double>(model_.flags.size())) {
  cells_.reserve(2 * model_.lasers.size());
  for (const Laser& laser : model_.lasers) {
    const std::size_t block = laser.number / kLasersPerBlock;
    auto direction = std::find_if(directions_.begin(), directions_.end(), [&](const Direction& d) {
      return d.block == block && d.azimuth_offset == laser.azimuth_offset && d.delay_us == laser.delay_us;
    });
    if (direction == directions_.end())
      direction = directions_.insert(direction, {block, laser.azimuth_offset, laser.delay_us});
    rows_.push_back({static_cast<std::size_t>(direction - directions_.begin()),
                     kMeasurementsAt + kMeasurementBytes * (laser.number % kLasersPerBlock),
                     std::cos(radians(laser.elevation)), std::sin(radians(laser.elevation))});
  }
}

bool VelodyneDecoder::isLaidOut(const std::uint8_t* data, const Layout& layout) const {
  for (std::size_t g = 0; g < layout.groups; ++g)
    for (std::size_t k = 0; k < model_.flags.size(); ++k) {
      const std::uint8_t* const block = data + kBlockBytes * (g * layout.group + k * layout.part);
      const std::uint8_t* const second = block + kBlockBytes * layout.second;
      if (u16(block) != model_.flags[k] || azimuthOf(block) > kTurn) return false;
      if (u16(second) != u16(block) || azimuthOf(second) != azimuthOf(block)) return false;
    }
  return true;
}

std::optional<VelodyneDecoder::Layout> VelodyneDecoder::layoutOf(const std::uint8_t* data) const {
  const std::size_t blocks = model_.flags.size();
  // A second return follows each block, or each firing in packets of the HDL-64E, which do not contain their mode.
  const bool has_mode = !model_.factory_bytes.empty();
  const Layout dual = has_mode ? Layout{kBlocks / (2 * blocks), 2 * blocks, 2, 1}
                               : Layout{kBlocks / (2 * blocks), 2 * blocks, 1, blocks};
  if ((!has_mode || data[kModeAt] == kDualMode) && isLaidOut(data, dual)) return dual;
  const Layout single{kBlocks / blocks, blocks, 1, 0};
  if (isLaidOut(data, single)) return single;
  return std::nullopt;
}

void VelodyneDecoder::measureStep(const std::uint8_t* data, const Layout& layout) {
  for (std::size_t g = 0; g < layout.groups; ++g) {
    const unsigned azimuth = azimuthOf(data + kBlockBytes * g * layout.group) % kTurn;
    const unsigned step = last_azimuth_ ? (azimuth + kTurn - *last_azimuth_) % kTurn : kTurn;
    last_azimuth_ = azimuth;
    if (step >= kStepLimit) continue;  // packets are missing before it
    ++steps_[step];
    ++step_count_;
  }
  if (step_count_ == 0) return;
  std::size_t median = 0;
  for (std::uint32_t up_to = steps_[0]; 2 * up_to < step_count_; up_to += steps_[median]) ++median;
  if (!step_is_set_) step_ = static_cast<double>(median) / 100;
  // The mean is more exact than the median, which is a multiple of a hundredth of a degree.
  double sum = 0, counted = 0;
  for (std::size_t step = median / 2; step < std::min(2 * median, kStepLimit); ++step) {
    sum += static_cast<double>(step) / 100 * steps_[step];
    counted += steps_[step];
  }
  mean_step_ = counted > 0 ? sum / counted : 0;
  if (step_count_ < kMaxSteps) return;
  step_count_ = 0;
  for (std::uint32_t& count : steps_) step_count_ += count /= 2;
}

VelodyneDecoder::Bearing VelodyneDecoder::bearingOf(double degrees) {
  return {std::cos(radians(degrees)), std::sin(radians(degrees))};
}

void VelodyneDecoder::turnByManual(const std::uint8_t* group, const Layout& layout, std::size_t firing) {
  const double delay_us = static_cast<double>(firing) * model_.firing_period_us;
  for (Direction& direction : directions_) {
    const double azimuth =
        azimuthOf(group + kBlockBytes * direction.block * layout.part) / 100. + direction.azimuth_offset;
    direction.bearings.fill(bearingOf(azimuthLater(azimuth, delay_us + direction.delay_us)));
  }
}

bool VelodyneDecoder::isTurnedByDriver(const Layout& layout) const {
  return turning_ == Turning::kDriver && (layout.isDual() ? model_.driver.two_returns : model_.driver.one_return);
}

void VelodyneDecoder::turnByDriver(const std::uint8_t* data, const Layout& layout, std::size_t group,
                                   std::size_t firing) {
  const auto azimuth_of_group = [&](std::size_t g) { return azimuthOf(data + kBlockBytes * g * layout.group) % kTurn; };
  const double azimuth = azimuth_of_group(group) / 100.;
  double turned = 0;
  if (group + 1 < layout.groups) {
    const unsigned step = (azimuth_of_group(group + 1) + kTurn - azimuth_of_group(group)) % kTurn;
    turned = step < kStepLimit ? step / 100. : step_;
  }
  const double delay_us = static_cast<double>(firing) * model_.firing_period_us;
  for (Direction& direction : directions_) {
    const double part = (delay_us + model_.driver.delay_factor * direction.delay_us) / blockPeriodUs();
    direction.bearings = {bearingOf(azimuth + direction.azimuth_offset + turned * part),
                          bearingOf(azimuth + direction.azimuth_offset + turned)};
  }
}

void VelodyneDecoder::decodeFiring(const std::uint8_t* group, const Layout& layout, std::size_t firing) {
  const std::size_t firing_bytes = kMeasurementBytes * (kLasersPerBlock / model_.firings) * firing;
  const std::size_t cells_per_laser = cells_.size() / rows_.size();
  Echoes echoes;
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Row& row = rows_[i];
    const std::uint8_t* const measured =
        group + kBlockBytes * directions_[row.direction].block * layout.part + firing_bytes + row.offset;
    echoes.clear();
    for (std::size_t j = 0; j < (layout.isDual() ? 2U : 1U); ++j) {
      const std::uint8_t* const echo = measured + j * kBlockBytes * layout.second;
      echoes.add({u16(echo), static_cast<float>(echo[2]), echo[2], j});
    }
    echoes.choose(returns_);
    for (std::size_t j = 0; j < cells_per_laser; ++j) cells_[i * cells_per_laser + j] = cellOf(echoes[j], i);
  }
}

Cell VelodyneDecoder::cellOf(const Echo& echo, std::size_t row) const {
  const Laser& laser = model_.lasers[row];
  const Bearing& bearing = directions_[rows_[row].direction].bearings[echo.number];
  const double distance = echo.distance * model_.distance_unit + laser.distance_offset;
  if (echo.distance == 0 || distance <= 0) return kNoCell;
  const double across = distance * rows_[row].cosine;
  return {static_cast<float>(across * bearing.cosine + laser.side * bearing.sine),
          static_cast<float>(laser.side * bearing.cosine - across * bearing.sine),
          static_cast<float>(distance * rows_[row].sine + laser.height), echo.intensity};
}

bool VelodyneDecoder::isData(const Packet& packet) const {
  return packet.size == kDataBytes && layoutOf(packet.data);
}

Decoder::Kind VelodyneDecoder::decode(const Packet& packet, const Visitor& visit) {
  if (packet.size == kPositionBytes) {
    ++counts_.position;
    return Kind::kPosition;
  }
  const std::optional<Layout> layout = packet.size == kDataBytes ? layoutOf(packet.data) : std::nullopt;
  if (!layout) {
    ++counts_.foreign;
    return Kind::kForeign;
  }
  packet_period_us_ = static_cast<double>(layout->groups) * blockPeriodUs();
  const PacketOrder::Place place =
      order_.place(boost::endian::load_little_u32(packet.data + kTimeAt), packet_period_us_);
  counts_.missing = order_.missing();
  counts_.clock_jumps = order_.clockJumps();
  if (place == PacketOrder::Place::kLate) {
    ++counts_.late;
    return Kind::kLate;
  }
  ++counts_.data;
  if (layout->isDual()) ++counts_.dual;
  const std::vector<std::uint8_t>& known = model_.factory_bytes;
  if (!known.empty() && std::find(known.begin(), known.end(), packet.data[kModelAt]) == known.end())
    ++counts_.says_other_model;

  measureStep(packet.data, *layout);
  const bool misses_turn = turnUs() > 0 && order_.gap() - packet_period_us_ >= turnUs();
  const std::size_t cells = model_.lasers.size() * (layout->isDual() && returns_ == ReturnChoice::kBoth ? 2 : 1);
  const bool is_other_mode = counts_.columns > 0 && cells != cells_.size();
  cells_.resize(cells);
  bool after_break = place == PacketOrder::Place::kNewClock || misses_turn || is_other_mode;
  for (std::size_t g = 0; g < layout->groups; ++g)
    for (std::size_t firing = 0; firing < model_.firings; ++firing) {
      const std::uint8_t* const group = packet.data + kBlockBytes * g * layout->group;
      if (isTurnedByDriver(*layout))
        turnByDriver(packet.data, *layout, g, firing);
      else
        turnByManual(group, *layout, firing);
      decodeFiring(group, *layout, firing);
      const double since_block_us = static_cast<double>(firing) * model_.firing_period_us;
      const double azimuth = azimuthLater(azimuthOf(group) / 100., since_block_us);
      const double time_us = boost::endian::load_little_u32(packet.data + kTimeAt) +
                             static_cast<double>(g) * blockPeriodUs() + since_block_us;
      ++counts_.columns;
      visit({cells_, std::fmod(azimuth, 360.), time_us, after_break});
      after_break = false;
    }
  return Kind::kData;
}

double VelodyneDecoder::columnsPerTurn() const {
  const double step = mean_step_ > 0 ? mean_step_ : step_;
  return step > 0 ? 360. / step * static_cast<double>(model_.firings) : 0.;
}

void VelodyneDecoder::prepare(PacketSource& capture) {
  VelodyneDecoder decoder(model_);
  Packet packet;
  while (capture.next(packet) != PacketSource::Arrival::kEnd) decoder.decode(packet, [](const Column&) {});
  if (decoder.step_ <= 0) return;
  step_ = decoder.step_;
  step_is_set_ = true;
}

}  // namespace lisco_apps
