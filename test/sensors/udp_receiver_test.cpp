// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "sensors/udp_receiver.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <string>
#include <vector>

#include "packets.h"
#include "random.h"
#include "sensors/velodyne_decoder.h"
#include "temporary_folder.h"

namespace lisco_test {
namespace {

using lisco_apps::Cell;
using lisco_apps::Column;
using lisco_apps::makeVelodyneModel;
using lisco_apps::Packet;
using lisco_apps::UdpReceiver;
using lisco_apps::VelodyneDecoder;
using Arrival = lisco_apps::PacketSource::Arrival;
using Clock = std::chrono::steady_clock;

void send(const Bytes& payload, std::uint16_t port) {
  const int out = ::socket(AF_INET, SOCK_DGRAM, 0);
  ASSERT_GE(out, 0);
  sockaddr_in to{};
  to.sin_family = AF_INET;
  to.sin_port = htons(port);
  to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT_EQ(::sendto(out, payload.data(), payload.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to),
            static_cast<ssize_t>(payload.size()));
  ::close(out);
}

TEST(UdpReceiver, GivesPackets) {
  UdpReceiver receiver(0);
  ASSERT_NE(receiver.port(), 0);
  const auto before = std::chrono::system_clock::now().time_since_epoch();
  for (const std::size_t size : {1206U, 512U, 0U, 33000U}) send(Bytes(size, 7), receiver.port());
  for (const std::size_t size : {1206U, 512U, 0U, 33000U}) {
    Packet packet;
    ASSERT_EQ(receiver.next(packet), Arrival::kPacket);
    EXPECT_EQ(Bytes(packet.data, packet.data + packet.size), Bytes(size, 7));
    EXPECT_GE(packet.time_us, std::chrono::duration_cast<std::chrono::microseconds>(before).count());
  }
  EXPECT_EQ(receiver.packets(), 4U);
}

TEST(UdpReceiver, GivesTheColumnsSent) {
  UdpReceiver receiver(0);
  VelodyneDecoder live(makeVelodyneModel("vls128")), direct(makeVelodyneModel("vls128"));
  std::vector<float> came, sent;
  const auto saveIn = [](std::vector<float>& cells) {
    return [&cells](const Column& column) {
      for (const Cell& cell : column.cells) cells.insert(cells.end(), {cell.x, cell.y, cell.z, cell.intensity});
    };
  };
  PacketEncoder encoder("vls128");
  Random random(4);
  for (int i = 0; i < 600; ++i) {  // a turn
    const Bytes payload = encoder.next([&](std::size_t, std::size_t, bool) {
      return Measured{static_cast<std::uint16_t>(1 + random.below(60000)), 1};
    });
    direct.decode(asPacket(payload), saveIn(sent));
    send(payload, receiver.port());
    Packet packet;
    ASSERT_EQ(receiver.next(packet), Arrival::kPacket);
    live.decode(packet, saveIn(came));
  }
  EXPECT_EQ(came, sent);
  EXPECT_EQ(came.size(), 600U * 3 * 128 * 4);
  EXPECT_EQ(live.counts().missing + live.counts().late, 0U);
}

TEST(UdpReceiver, ReturnsWithin100Milliseconds) {
  UdpReceiver receiver(0);
  Packet packet;
  const auto start = Clock::now();
  EXPECT_EQ(receiver.next(packet), Arrival::kNothing);
  // 100 ms by contract; a busy machine may take longer.
  EXPECT_LT(Clock::now() - start, std::chrono::seconds(2));
}

TEST(UdpReceiver, RefusesAPortInUse) {
  const UdpReceiver first(0);
  const std::string port = std::to_string(first.port());
  EXPECT_EQ(refusalOf([&] { UdpReceiver second(first.port()); }),
            "cannot receive on UDP port " + port + ": Address already in use");
}

}  // namespace
}  // namespace lisco_test
