// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Packets of Hesai's and Ouster's sensors.
#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include "bodies.h"
#include "columns.h"
#include "input.h"
#include "sensors/hesai_decoder.h"
#include "sensors/ouster_decoder.h"
#include "sensors/rotation_cutter.h"

namespace lisco_test {
namespace {

using lisco_apps::Decoder;
using lisco_apps::HesaiModel;
using lisco_apps::OusterMetadata;
using lisco_apps::ReturnChoice;

constexpr std::array kChoices{ReturnChoice::kStrongest, ReturnChoice::kLast, ReturnChoice::kBoth};
constexpr std::uint64_t kMaxPackets = 20;

void put16(std::vector<std::uint8_t>& packet, std::size_t at, unsigned value) {
  packet[at] = static_cast<std::uint8_t>(value & 255U);
  packet[at + 1] = static_cast<std::uint8_t>(value >> 8U & 255U);
}

/// Decodes packets that make_packet () changes, or any bytes, and checks what comes of them.
template <typename MakePacket>
void decodeAll(Input& input, Decoder& decoder, std::size_t packet_bytes, std::size_t most_cells,
               MakePacket&& make_packet) {
  lisco_apps::RotationCutter cutter(decoder.rotationStart());
  std::vector<std::uint8_t> bytes(packet_bytes);
  std::uint64_t packets = 0, columns = 0;
  std::size_t cells_before = 0;
  const auto visit = [&](const lisco_apps::Column& column) {
    ++columns;
    hold(!column.cells.empty() && column.cells.size() <= most_cells, "the cells of a column");
    hold(cells_before == 0 || column.cells.size() == cells_before || column.after_break, "cells without a break");
    cells_before = column.cells.size();
    holdColumn(column);
    cutter.startsRotation(column.azimuth, column.after_break);
  };
  while (input.left() > 0 && packets < kMaxPackets) {
    const unsigned how = input.byte();
    if (how % 16 == 0) {
      const std::array<std::size_t, 4> sizes{packet_bytes, 512, 48, input.left()};
      bytes.assign(sizes[how / 16 % 4], 0);
      for (std::size_t i = 0; i < bytes.size() && input.left() > 0; ++i)
        bytes[i] = static_cast<std::uint8_t>(input.byte());
      bytes.shrink_to_fit();
    } else if (how % 16 != 1) {
      bytes.resize(packet_bytes);
      bytes.shrink_to_fit();
      make_packet(bytes);
      for (unsigned i = 0; i < how / 32; ++i)
        bytes[(input.byte() << 8U | input.byte()) % bytes.size()] = static_cast<std::uint8_t>(input.byte());
    }  // or the last one again
    ++packets;
    decoder.decode({bytes.data(), bytes.size(), 0}, visit);
    holdCounts(decoder, packets, columns);
  }
  decoder.flush(visit);
  holdCounts(decoder, packets, columns);
}

const std::vector<HesaiModel>& hesaiModels() {
  static const std::vector<HesaiModel> all = [] {
    std::vector<HesaiModel> models;
    for (const std::string& name : lisco_apps::hesaiModelNames()) models.push_back(lisco_apps::hesaiLayout(name));
    return models;
  }();
  return all;
}

/// The same with few lasers, which takes a fraction of the time.
const std::vector<HesaiModel>& smallHesaiModels() {
  static const std::vector<HesaiModel> all = [] {
    constexpr std::size_t kLasers = 6;
    std::vector<HesaiModel> small = hesaiModels();
    for (HesaiModel& model : small) model.lasers.resize(kLasers);
    return small;
  }();
  return all;
}

OusterMetadata ousterOf(unsigned what) {
  using Profile = OusterMetadata::Profile;
  constexpr std::array kProfiles{Profile::kLegacy,       Profile::kSingle,           Profile::kDual,
                                 Profile::kLowBandwidth, Profile::kLowBandwidthDual, Profile::kFiveWords,
                                 Profile::kSingleColour};
  OusterMetadata metadata;
  metadata.profile = kProfiles[what % 8 % kProfiles.size()];
  metadata.has_safety_header = metadata.profile == Profile::kLowBandwidthDual;
  metadata.columns_per_frame = 64;
  metadata.columns_per_packet = 8;
  metadata.last_column = 63;
  metadata.serial_number = 5;
  if (what / 8 % 2 == 1) metadata.first_column = 40, metadata.last_column = 9;
  for (std::size_t i = 0; i < 8; ++i) {
    metadata.altitudes.push_back(10 - 3. * static_cast<double>(i));
    metadata.azimuths.push_back(i % 2 == 0 ? 3 : -3);
  }
  metadata.beam_to_lidar = {1, 0, 0, 15.806, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  metadata.lidar_to_sensor = {-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 36.18, 0, 0, 0, 1};
  return metadata;
}

/// Bytes of a packet of ousterOf ().
std::size_t ousterBytes(OusterMetadata::Profile profile) {
  using Profile = OusterMetadata::Profile;
  switch (profile) {
    case Profile::kLegacy:
      return 8 * (16 + 8 * 12 + 4);
    case Profile::kSingle:
      return 64 + 8 * (12 + 8 * 12);
    case Profile::kDual:
      return 64 + 8 * (12 + 8 * 16);
    case Profile::kLowBandwidth:
      return 64 + 8 * (12 + 8 * 4);
    case Profile::kLowBandwidthDual:
    case Profile::kLowBandwidthZones:
      return 64 + 8 * (12 + 8 * 8);
    case Profile::kSingleColour:
      return 64 + 8 * (12 + 8 * 16);
    case Profile::kFiveWords:
      break;
  }
  return 64 + 8 * (12 + 8 * 20);
}

}  // namespace

void fuzzHesai(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return;
  Input input(data + 1, size - 1);
  const bool has_all_lasers = data[0] / 64 == 3 && input.byte() == 0;
  const std::vector<HesaiModel>& models = has_all_lasers ? hesaiModels() : smallHesaiModels();
  const HesaiModel& model = models[data[0] % 8 % models.size()];
  lisco_apps::HesaiDecoder decoder(model, kChoices[data[0] / 8 % 3]);
  const unsigned shape = input.byte();
  const HesaiModel::Form& form = model.forms[shape % model.forms.size()];
  const HesaiModel::End& end = model.ends[shape / 8 % model.ends.size()];
  const std::size_t tail = model.tailAt(form), most = model.leastBytes(form) + end.bytes;
  unsigned azimuth = 0;
  std::uint32_t number = 0;
  decodeAll(input, decoder, most, 3 * model.laserCount(), [&](std::vector<std::uint8_t>& packet) {
    constexpr std::array<std::uint8_t, 6> kModes{0x37, 0x38, 0x39, 0x3B, 0x3D, 0};
    const unsigned how = input.byte(), filling = input.byte();
    for (std::size_t i = 0; i < packet.size(); ++i) packet[i] = static_cast<std::uint8_t>(filling * i);
    if (model.header != HesaiModel::Header::kNone) {
      const std::size_t counts = model.header == HesaiModel::Header::kLong ? 6 : 2;
      packet[0] = 0xEE;
      packet[1] = 0xFF;
      packet[counts] = static_cast<std::uint8_t>(model.laserCount());
      packet[counts + 1] = static_cast<std::uint8_t>(form.blocks);
      packet[counts + 3] = static_cast<std::uint8_t>(1 + how % 4);
    }
    for (std::size_t block = 0; block < form.blocks; ++block) {
      const std::size_t at = model.headerBytes() + block * model.blockBytes(form);
      const bool has_flag = model.header == HesaiModel::Header::kNone;
      if (has_flag) put16(packet, at, 0xEEFF);
      put16(packet, at + (has_flag ? 2 : 0), azimuth);
      azimuth = (azimuth + 10 * (how / 4 % 8)) % 36000;
    }
    packet[tail + model.tail.mode] = kModes[how / 32 % kModes.size()];
    number += input.byte() % 4;
    if (end.has_number) put16(packet, tail + model.tail.size, number);
  });
}

void fuzzOuster(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return;
  if (data[0] % 8 == 7) {
    const std::string json(data + 1, data + size);
    try {
      const OusterMetadata metadata = lisco_apps::parseOusterMetadata(json, "json");
      hold(metadata.pixels() > 0 && metadata.columns_per_frame > 0, "metadata of nothing");
      lisco_apps::OusterDecoder decoder(metadata, ReturnChoice::kBoth);
      hold(decoder.lasers() == metadata.pixels(), "the number of lasers");
    } catch (const std::runtime_error& refusal) {
      hold(std::string(refusal.what()).find('\n') == std::string::npos, "a refusal of several lines");
    }
    return;
  }
  const OusterMetadata metadata = ousterOf(data[0]);
  const bool is_legacy = metadata.profile == OusterMetadata::Profile::kLegacy;
  Input input(data + 1, size - 1);
  lisco_apps::OusterDecoder decoder(metadata, kChoices[data[0] / 16 % 3]);
  const std::size_t bytes = ousterBytes(metadata.profile), header = is_legacy ? 0 : 32;
  const std::size_t column_bytes = (bytes - 2 * header) / metadata.columns_per_packet;
  unsigned place = 0;  // eight packets a frame
  decodeAll(input, decoder, bytes, 2 * metadata.pixels(), [&](std::vector<std::uint8_t>& packet) {
    const unsigned how = input.byte(), filling = input.byte();
    for (std::size_t i = 0; i < packet.size(); ++i) packet[i] = static_cast<std::uint8_t>(filling * i);
    place += how % 8;
    if (how / 8 % 8 == 0) place -= input.byte() % 8;
    const bool is_fusa = metadata.has_safety_header;
    if (!is_legacy) {
      std::fill(packet.begin(), packet.begin() + 32, std::uint8_t{0});
      packet[0] = 1;
      put16(packet, is_fusa ? 4 : 2, place / 8);
      packet[is_fusa ? 11 : 7] = static_cast<std::uint8_t>(4 + how / 64 % 2);
    }
    for (std::size_t i = 0; i < metadata.columns_per_packet; ++i) {
      const std::size_t at = header + i * column_bytes;
      put16(packet, at + 8, static_cast<unsigned>(place % 8 * 8 + i));
      const unsigned status = how / 128 == 0 || i % 3 != 0 ? 0xFFFF : 0;
      put16(packet, at + 10, is_legacy ? place / 8 : status);
      if (!is_legacy) continue;
      put16(packet, at + column_bytes - 4, status);
      put16(packet, at + column_bytes - 2, status);
    }
  });
}

}  // namespace lisco_test
