// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <array>
#include <bitset>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace lisco_apps {

/// A part of an IP packet's content.
struct Fragment {
  std::array<std::uint8_t, 40> key{};  ///< of its packet: addresses and identification
  std::size_t offset = 0;              ///< bytes, a multiple of 8
  bool is_last = false;
  std::string_view content;
  std::int64_t time_us = 0;  ///< of its capture
};

/// Puts IP packets together from their fragments, which may come in any order, twice, or not at all. Holds at most 16
/// incomplete packets, each for two seconds.
class FragmentAssembler {
 public:
  /// \return the whole content of the fragment's packet if it is the last one missing, otherwise empty; valid until the
  ///         next call
  std::string_view add(const Fragment& fragment);

  /// Fragments of packets that were given up.
  std::uint64_t lost() const { return lost_; }
  /// Gives up all incomplete packets.
  void clear();

 private:
  static constexpr std::size_t kMaxIncomplete = 16;
  static constexpr std::size_t kUnit = 8;                   ///< bytes: offsets are its multiples
  static constexpr std::size_t kUnits = 65536 / kUnit;      ///< of the longest packet
  static constexpr std::int64_t kMaxAgeUs = 2LL * 1000000;  ///< identifications come again after a while

  struct Incomplete {
    std::array<std::uint8_t, 40> key{};
    std::int64_t begun_us = 0;
    std::uint64_t fragments = 0;  ///< 0: unused
    std::size_t size = 0;         ///< bytes; 0 before the last fragment
    std::size_t units = 0;        ///< received
    std::bitset<kUnits> received;
    std::vector<char> content;
  };

  Incomplete& packetOf(const Fragment& fragment);
  void giveUp(Incomplete& packet);

  std::vector<Incomplete> packets_{kMaxIncomplete};
  std::uint64_t lost_ = 0;
};

}  // namespace lisco_apps
