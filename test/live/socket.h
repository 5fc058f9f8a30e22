// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>

namespace lisco_test {

/// A TCP connection to a port of this machine. What is awaited comes within 20 s, or an exception is thrown.
class Socket {
 public:
  explicit Socket(std::uint16_t port) : descriptor_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (connect(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
      throw std::runtime_error("no connection");
  }
  ~Socket() { close(descriptor_); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  void send(const std::string& bytes) const {
    for (std::size_t sent = 0; sent < bytes.size();) {
      const ssize_t count = ::send(descriptor_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
      if (count <= 0) return;  // the other side has answered and closed
      sent += static_cast<std::size_t>(count);
    }
  }

  /// Exactly so many bytes; fewer if the connection ends before.
  std::string receive(std::size_t size) {
    while (received_.size() < size) {
      pollfd ready{descriptor_, POLLIN, 0};
      if (poll(&ready, 1, 20000) <= 0) throw std::runtime_error("silence");
      char buffer[65536];
      const ssize_t count = recv(descriptor_, buffer, sizeof buffer, 0);
      if (count <= 0) break;
      received_.append(buffer, static_cast<std::size_t>(count));
    }
    std::string result = received_.substr(0, size);
    received_.erase(0, result.size());
    return result;
  }
  /// Until the connection ends.
  std::string receiveAll() { return receive(std::string::npos); }

  /// Opens the WebSocket of the live view. \return the answer's head
  std::string openLive(std::uint16_t port, const std::string& origin) {
    const std::string host = "127.0.0.1:" + std::to_string(port);
    send("GET /live HTTP/1.1\r\nHost: " + host + "\r\nOrigin: " + (origin.empty() ? "http://" + host : origin) +
         "\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
         "Sec-WebSocket-Version: 13\r\n\r\n");
    std::string head;
    while (head.size() < 4 || head.substr(head.size() - 4) != "\r\n\r\n") {
      const std::string byte = receive(1);
      if (byte.empty()) break;
      head += byte;
    }
    return head;
  }

  /// A message from the server, after any pings, which it sends when it waits for long. \return its kind (2: binary,
  /// 8: close) and bytes
  std::pair<int, std::string> receiveMessage() {
    constexpr int kPing = 9;
    for (;;) {
      std::pair<int, std::string> message = receiveAnyMessage();
      if (message.first != kPing) return message;
    }
  }

 private:
  std::pair<int, std::string> receiveAnyMessage() {
    const auto number = [this](std::size_t bytes) {
      std::size_t value = 0;
      for (const char c : receive(bytes)) value = value << 8U | static_cast<unsigned char>(c);
      return value;
    };
    const std::size_t first = number(1);
    std::size_t size = number(1);
    if (size == 126) size = number(2);
    if (size == 127) size = number(8);
    return {static_cast<int>(first & 15U), receive(size)};
  }

  int descriptor_;
  std::string received_;
};

}  // namespace lisco_test
