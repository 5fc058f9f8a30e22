// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <string_view>

namespace lisco_apps {

/// What the answer to an HTTP request depends on. Header fields that are missing are empty.
struct RequestHead {
  std::string_view method, target, host, origin;
  bool upgrades = false;  ///< to a WebSocket, by a well-formed request
  bool has_body = false;  ///< or more bytes after the head
};

/// The answers, by status of HTTP.
enum class Verdict : unsigned {
  kLive = 101,
  kPage = 200,
  kBadRequest = 400,
  kForbidden = 403,
  kNotFound = 404,
  kMethodNotAllowed = 405,
  kUpgradeRequired = 426,
  kTooLong = 431,
};

inline constexpr std::string_view kLivePath = "/live";  ///< of the WebSocket

/// Decides on a request: GET of / is the page, GET of kLivePath the stream of frames.
/// A WebSocket whose Origin is not the server's own is refused, because any page may open one. So is, of a server that
/// only this machine reaches, a Host that is not the machine's own name for itself: a foreign name that was made to
/// point here would pass as the server's own.
/// \param is_loopback whether only this machine reaches the server
Verdict verdictOn(const RequestHead& request, bool is_loopback);

}  // namespace lisco_apps
