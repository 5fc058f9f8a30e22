// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "sensors/udp_receiver.h"

#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <stdexcept>

namespace lisco_apps {
namespace {

constexpr int kMaxWaitMs = 50;
constexpr int kBufferBytes = 8 << 20;  ///< of the socket: more than a second of packets; the system may grant less

}  // namespace

UdpReceiver::UdpReceiver(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_ANY);
  socklen_t size = sizeof address;
  if (socket_ < 0 || ::bind(socket_, reinterpret_cast<const sockaddr*>(&address), size) != 0 ||
      ::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    const std::string why = std::strerror(errno);
    if (socket_ >= 0) ::close(socket_);
    throw std::runtime_error("cannot receive on UDP port " + std::to_string(port) + ": " + why);
  }
  port_ = ntohs(address.sin_port);
  ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &kBufferBytes, sizeof kBufferBytes);
}

UdpReceiver::~UdpReceiver() {
  ::close(socket_);
}

PacketSource::Arrival UdpReceiver::next(Packet& packet) {
  pollfd waiting{socket_, POLLIN, 0};
  if (::poll(&waiting, 1, kMaxWaitMs) <= 0) return Arrival::kNothing;
  const ssize_t size = ::recv(socket_, buffer_.data(), buffer_.size(), MSG_DONTWAIT);
  if (size < 0) return Arrival::kNothing;  // for example a wrong checksum
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  ++packets_;
  packet = {buffer_.data(), static_cast<std::size_t>(size),
            std::chrono::duration_cast<std::chrono::microseconds>(now).count()};
  return Arrival::kPacket;
}

}  // namespace lisco_apps
