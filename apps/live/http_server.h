// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "live/address.h"

namespace lisco_apps {

/// Serves one page and a stream of frames to any number of viewers, from a thread of its own. Each viewer has at most
/// two frames: one that is being sent, and the newest one. A viewer that is slower loses the frames between.
class HttpServer {
 public:
  using Frame = std::shared_ptr<const std::string>;

  static constexpr std::size_t kMaxHead = 8192;         ///< bytes of a request
  static constexpr std::size_t kMaxMessage = 125;       ///< bytes from a viewer
  static constexpr std::size_t kMaxConnections = 1024;  ///< further ones are closed at once
  static constexpr unsigned kSecondsForRequest = 10, kSecondsForFrame = 20, kSecondsToClose = 2;

  /// Starts.
  /// \param page text/html
  /// \param next_frame called by the server's thread every few milliseconds while there are viewers; nullptr: none yet
  /// \throws std::runtime_error with one line if it cannot listen there
  HttpServer(const HttpAddress& address, std::string page, std::function<Frame()> next_frame);
  /// Closes all connections.
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  /// With the actual port.
  const HttpAddress& address() const { return address_; }
  std::size_t viewers() const;
  /// Sends what next_frame () gives now, closes the viewers' connections, and waits for that, at most two seconds.
  void finish();

 private:
  class State;
  HttpAddress address_;
  std::unique_ptr<State> state_;
};

/// The answer to what a connection has sent so far.
struct HttpReply {
  unsigned status = 0;
  std::string text;  ///< the response; empty if the connection becomes a WebSocket
};

/// \param is_loopback see verdictOn ()
/// \return nullopt if the request is incomplete
std::optional<HttpReply> replyTo(std::string_view received, std::string_view page, bool is_loopback);

}  // namespace lisco_apps
