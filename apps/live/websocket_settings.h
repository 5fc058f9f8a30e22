// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <chrono>

#include <boost/beast/websocket.hpp>

#include "live/http_server.h"

namespace lisco_apps {

/// Settings of a viewer's WebSocket: whole frames, small messages from the viewer, and an end for viewers that are
/// silent or do not read.
template <typename WebSocket>
void applySettings(WebSocket& socket) {
  namespace websocket = boost::beast::websocket;
  socket.set_option(websocket::stream_base::timeout{std::chrono::seconds(HttpServer::kSecondsToClose),
                                                    std::chrono::seconds(HttpServer::kSecondsForFrame), true});
  socket.read_message_max(HttpServer::kMaxMessage);
  socket.auto_fragment(false);
  socket.binary(true);
}

}  // namespace lisco_apps
