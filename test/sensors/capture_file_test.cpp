// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "sensors/capture_file.h"

#include <cstring>
#include <string>
#include <vector>

#include "packets.h"
#include "random.h"
#include "temporary_folder.h"

namespace lisco_test {
namespace {

using lisco_apps::CaptureFile;
using lisco_apps::Packet;
using Arrival = lisco_apps::PacketSource::Arrival;

Bytes payload(std::uint8_t number, std::size_t size = 20) {
  return Bytes(size, number);
}
Frame frame(std::uint8_t number, std::int64_t time_us = 0) {
  return {ethernetOf(ipv4Of(udpOf(payload(number)))), time_us};
}

class CaptureFileTest : public InTemporaryFolder {
 protected:
  std::filesystem::path write(const Bytes& capture) const {
    writeFile(folder_ / "a.pcap", capture);
    return folder_ / "a.pcap";
  }
  static std::vector<Bytes> rest(CaptureFile& file) {
    std::vector<Bytes> payloads;
    Packet packet;
    while (file.next(packet) == Arrival::kPacket) payloads.emplace_back(packet.data, packet.data + packet.size);
    return payloads;
  }
};

TEST_F(CaptureFileTest, GivesPayloadsAndTimes) {
  for (const bool nanoseconds : {false, true}) {
    CaptureFile file(write(captureOf({frame(1, 1700000000000007), frame(2, 1700000001999999)}, 1, nanoseconds)));
    Packet packet;
    ASSERT_EQ(file.next(packet), Arrival::kPacket);
    EXPECT_EQ(Bytes(packet.data, packet.data + packet.size), payload(1));
    EXPECT_EQ(packet.time_us, 1700000000000007);
    ASSERT_EQ(file.next(packet), Arrival::kPacket);
    EXPECT_EQ(Bytes(packet.data, packet.data + packet.size), payload(2));
    EXPECT_EQ(packet.time_us, 1700000001999999);
    EXPECT_EQ(file.next(packet), Arrival::kEnd);
    EXPECT_EQ(file.next(packet), Arrival::kEnd);
    EXPECT_EQ(file.packets(), 2U);
    EXPECT_EQ(file.foreign(), 0U);
    EXPECT_EQ(file.error(), "");
  }
}

TEST_F(CaptureFileTest, ReadsSeveralKindsOfNetworks) {
  const Bytes udp = udpOf(payload(1));
  const Bytes v4 = ipv4Of(udp), v6 = ipv6Of(udp), long_v6 = ipv6Of(udp, true);
  struct {
    std::uint32_t link_type;
    Bytes frame;
  } const cases[] = {
      {1, ethernetOf(v4) + Bytes(9)},  // padded
      {1, ethernetOf(v4, 0x0800, 1)},
      {1, ethernetOf(v4, 0x0800, 2)},
      {1, ethernetOf(v6, 0x86DD)},
      {1, ethernetOf(long_v6, 0x86DD)},
      {113, Bytes(14) + Bytes{0x08, 0x00} + v4},  // Linux cooked
      {276, Bytes{0x08, 0x00} + Bytes(18) + v4},  // Linux cooked, version 2
      {101, v4},                                  // raw IP
      {101, v6},
      {228, v4},
      {0, Bytes{2, 0, 0, 0} + v4},  // loopback
  };
  for (const auto& c : cases) {
    CaptureFile file(write(captureOf({{c.frame}}, c.link_type)));
    EXPECT_EQ(rest(file), std::vector<Bytes>{payload(1)}) << c.link_type;
    EXPECT_EQ(file.foreign(), 0U) << c.link_type;
  }
}

TEST_F(CaptureFileTest, ChecksTheLengthOfUdpInsteadOfIp) {
  Bytes packet = ethernetOf(ipv4Of(udpOf(payload(1))));
  packet[14 + 2] = 0x04;  // as the VLP-16 has it in its position packets
  CaptureFile file(write(captureOf({{packet}})));
  EXPECT_EQ(rest(file), std::vector<Bytes>{payload(1)});
}

TEST_F(CaptureFileTest, SkipsForeignFrames) {
  const Bytes udp = udpOf(payload(1));
  Frame cut = frame(1);
  cut.data.pop_back();
  cut.left_out = 1;
  CaptureFile file(write(captureOf({{ethernetOf(Bytes(28), 0x0806)},                // ARP
                                    {ethernetOf(ipv4Of(udp, 6))},                   // TCP
                                    {ethernetOf(ipv4Of(udp, 17, 0x2000))},          // first fragment
                                    {ethernetOf(ipv4Of(udp, 17, 0x0005))},          // last fragment
                                    {ethernetOf(ipv4Of(udpOf(payload(1), 8308)))},  // another port
                                    cut,                                            // not kept whole
                                    {Bytes(5)},
                                    {Bytes{}},
                                    frame(2)})),
                   2368);
  EXPECT_EQ(rest(file), std::vector<Bytes>{payload(2)});
  EXPECT_EQ(file.packets(), 1U);
  EXPECT_EQ(file.foreign(), 8U);
  EXPECT_EQ(file.error(), "");
}

TEST_F(CaptureFileTest, ReadsPcapng) {
  const Bytes packet = ethernetOf(ipv4Of(udpOf(payload(1, 22))));
  ASSERT_EQ(packet.size(), 68U);
  const Bytes section{0x0A, 0x0D, 0x0D, 0x0A, 28,   0,    0,    0,    0x4D, 0x3C, 0x2B, 0x1A, 1, 0,
                      0,    0,    0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 28,   0,    0, 0};
  const Bytes interface { 1, 0, 0, 0, 20, 0, 0, 0, 1, 0, 0, 0, 0, 0, 4, 0, 20, 0, 0, 0 };
  const Bytes block = Bytes{6, 0, 0, 0, 100, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, 5, 0, 0, 0, 68, 0, 0, 0, 68, 0, 0, 0} +
                      packet + Bytes{100, 0, 0, 0};
  CaptureFile file(write(section + interface + block));
  Packet read;
  ASSERT_EQ(file.next(read), Arrival::kPacket) << file.error();
  EXPECT_EQ(read.time_us, (std::int64_t{1} << 32) + 5);
  EXPECT_EQ(Bytes(read.data, read.data + read.size), payload(1, 22));
}

TEST_F(CaptureFileTest, RefusesOtherFiles) {
  const std::string missing = (folder_ / "missing.pcap").string();
  EXPECT_EQ(refusalOf([&] { CaptureFile file(missing); }), missing + ": No such file or directory");
  const auto refusal = [&](const Bytes& content) { return refusalOf([&] { CaptureFile file(write(content)); }); };
  EXPECT_NE(refusal({}).find("a.pcap: is no capture of packets: "), std::string::npos) << refusal({});
  EXPECT_NE(refusal(Bytes(1000, 'x')).find("a.pcap: is no capture of packets: "), std::string::npos);
  EXPECT_NE(refusalOf([&] { CaptureFile file(folder_); }).find(": is no capture of packets: "), std::string::npos);
  EXPECT_NE(refusal(captureOf({}, 105)).find("a.pcap: is a capture of another kind of network: IEEE802_11"),
            std::string::npos);
}

TEST_F(CaptureFileTest, EndsAtTruncation) {
  const Bytes whole = captureOf({frame(1), frame(2), frame(3)});
  const std::size_t record = 16 + frame(1).data.size();
  for (std::size_t size = 24; size <= whole.size(); ++size) {
    CaptureFile file(write(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size))));
    EXPECT_EQ(rest(file).size(), (size - 24) / record) << size;
    const bool is_cut = (size - 24) % record != 0;
    EXPECT_EQ(file.error().empty(), !is_cut) << size << ": " << file.error();
    EXPECT_EQ(file.error().find("a.pcap: breaks off: ") != std::string::npos, is_cut) << file.error();
  }
}

TEST_F(CaptureFileTest, AcceptsAnyBytes) {
  constexpr std::uint64_t kSeed = 11;
  Random random(kSeed);
  const std::vector<Bytes> frames{ethernetOf(ipv4Of(udpOf(payload(1))), 0x0800, 1),
                                  ethernetOf(ipv6Of(udpOf(payload(2)), true), 0x86DD)};
  for (int run = 0; run < 2000; ++run) {
    std::vector<Frame> changed;
    for (Bytes data : frames) {
      for (int i = 0; i < 3; ++i) data[random.below(data.size())] = static_cast<std::uint8_t>(random.below(256));
      data.resize(random.below(data.size() + 1));
      data.shrink_to_fit();
      changed.push_back({data});
    }
    Bytes capture = captureOf(changed);
    if (run % 4 == 0) capture[24 + random.below(capture.size() - 24)] ^= 0xFF;
    CaptureFile file(write(capture));
    EXPECT_LE(rest(file).size(), 2U) << "seed " << kSeed << ", run " << run;
  }
}

}  // namespace
}  // namespace lisco_test
