// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// UDP packets in IP fragments, as sensors send packets that are larger than an Ethernet frame.
#include <algorithm>
#include <set>
#include <vector>

#include "packets.h"
#include "random.h"
#include "sensors/capture_file.h"
#include "temporary_folder.h"

namespace lisco_test {
namespace {

using lisco_apps::CaptureFile;
using lisco_apps::Packet;
using lisco_apps::PacketSource;

Bytes randomBytes(Random& random, std::size_t size) {
  Bytes bytes(size);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random.below(256));
  return bytes;
}

/// The frames of a UDP packet in fragments of at most 1480 bytes.
std::vector<Frame> fragmentsOf(const Bytes& payload, std::uint16_t identification, bool ipv6, std::int64_t time_us) {
  const Bytes udp = udpOf(payload);
  std::vector<Frame> frames;
  for (std::size_t at = 0; at < udp.size(); at += 1480) {
    const auto begin = udp.begin() + static_cast<std::ptrdiff_t>(at);
    const std::size_t size = std::min<std::size_t>(1480, udp.size() - at);
    const bool more = at + size < udp.size();
    const Bytes part(begin, begin + static_cast<std::ptrdiff_t>(size));
    Bytes frame;
    if (ipv6) {
      const Bytes header{17,
                         0,
                         static_cast<std::uint8_t>(at >> 8U),
                         static_cast<std::uint8_t>((at & 0xF8U) | (more ? 1U : 0U)),
                         0,
                         0,
                         static_cast<std::uint8_t>(identification >> 8U),
                         static_cast<std::uint8_t>(identification)};
      Bytes ip = ipv6Of(header + part);
      ip[6] = 44;
      frame = ethernetOf(ip, 0x86DD);
    } else {
      Bytes ip = ipv4Of(part, 17, static_cast<std::uint16_t>(at / 8 | (more ? 0x2000U : 0U)));
      ip[4] = static_cast<std::uint8_t>(identification >> 8U);
      ip[5] = static_cast<std::uint8_t>(identification);
      frame = ethernetOf(ip);
    }
    frames.push_back({frame, time_us});
  }
  return frames;
}

class Fragments : public InTemporaryFolder {
 protected:
  std::multiset<Bytes> read(const std::vector<Frame>& frames, std::uint64_t& foreign) const {
    writeFile(folder_ / "a.pcap", captureOf(frames));
    CaptureFile file(folder_ / "a.pcap", 2368);
    std::multiset<Bytes> payloads;
    Packet packet;
    while (file.next(packet) == PacketSource::Arrival::kPacket)
      payloads.emplace(packet.data, packet.data + packet.size);
    EXPECT_EQ(file.error(), "");
    EXPECT_EQ(file.packets(), payloads.size());
    foreign = file.foreign();
    return payloads;
  }
};

TEST_F(Fragments, AreAssembledInAnyOrder) {
  Random random(6);
  for (const bool ipv6 : {false, true})
    for (int run = 0; run < 20; ++run) {
      std::multiset<Bytes> sent;
      std::vector<Frame> frames;
      for (std::uint16_t i = 0; i < 5; ++i) {
        const Bytes payload = randomBytes(random, random.chance(0.2) ? 65000 : 1473 + random.below(33000));
        sent.insert(payload);
        for (const Frame& frame : fragmentsOf(payload, i, ipv6, 1000000)) frames.push_back(frame);
      }
      random.shuffle(frames);
      std::uint64_t foreign = 0;
      EXPECT_EQ(read(frames, foreign), sent);
      EXPECT_EQ(foreign, 0U);
    }
}

TEST_F(Fragments, AreForeignIfOthersAreMissing) {
  Random random(7);
  const Bytes payload = randomBytes(random, 8448);
  for (std::size_t missing = 0; missing < 6; ++missing) {
    std::vector<Frame> frames = fragmentsOf(payload, 1, false, 0);
    ASSERT_EQ(frames.size(), 6U);
    frames.erase(frames.begin() + static_cast<std::ptrdiff_t>(missing));
    const Bytes next = randomBytes(random, 5000);
    for (const Frame& frame : fragmentsOf(next, 2, false, 0)) frames.push_back(frame);
    std::uint64_t foreign = 0;
    EXPECT_EQ(read(frames, foreign), std::multiset<Bytes>{next});
    EXPECT_EQ(foreign, 5U);
  }
}

TEST_F(Fragments, MayComeTwice) {
  Random random(8);
  const Bytes payload = randomBytes(random, 8448);
  std::vector<Frame> frames;
  for (const Frame& frame : fragmentsOf(payload, 1, false, 0)) frames.insert(frames.end(), {frame, frame});
  std::uint64_t foreign = 0;
  EXPECT_EQ(read(frames, foreign), std::multiset<Bytes>{payload});
  EXPECT_EQ(foreign, 1U) << "the second copy of the last one";
}

TEST_F(Fragments, OfOldPacketsAreGivenUp) {
  Random random(9);
  const Bytes old = randomBytes(random, 8448), payload = randomBytes(random, 8448);
  std::vector<Frame> frames = fragmentsOf(old, 1, false, 0);
  frames.resize(3);
  // The same identification, a minute later, of which the first fragment is missing.
  std::vector<Frame> later = fragmentsOf(payload, 1, false, 60000000);
  frames.insert(frames.end(), later.begin() + 1, later.end());
  std::uint64_t foreign = 0;
  EXPECT_TRUE(read(frames, foreign).empty());
  EXPECT_EQ(foreign, 8U);
  // Memory is bounded: many incomplete packets.
  frames.clear();
  for (std::uint16_t i = 0; i < 1000; ++i) frames.push_back(fragmentsOf(old, i, false, 0).front());
  for (const Frame& frame : fragmentsOf(payload, 2000, false, 0)) frames.push_back(frame);
  EXPECT_EQ(read(frames, foreign), std::multiset<Bytes>{payload});
  EXPECT_EQ(foreign, 1000U);
}

TEST_F(Fragments, OfAnotherPortAreForeign) {
  std::vector<Frame> frames = fragmentsOf(Bytes(3000, 1), 1, false, 0);
  frames.front().data[14 + 24 + 3] ^= 1;
  std::uint64_t foreign = 0;
  EXPECT_TRUE(read(frames, foreign).empty());
  EXPECT_EQ(foreign, 1U) << "one packet";
}

}  // namespace
}  // namespace lisco_test
