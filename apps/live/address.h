// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstdint>
#include <string>

namespace lisco_apps {

/// Where a server listens.
struct HttpAddress {
  std::string host = "127.0.0.1";  ///< IPv4 or IPv6, numeric
  std::uint16_t port = 0;          ///< 0: any that is free

  bool isIpv6() const { return host.find(':') != std::string::npos; }
  /// Whether only programs of this machine reach it.
  bool isLoopback() const;
  /// As in a URL: 127.0.0.1:8080 or [::1]:8080.
  std::string text() const;
};

/// Reads [ADDRESS:]PORT. The address is numeric, IPv6 in brackets, or localhost.
/// \throws std::runtime_error with one line that names --http
HttpAddress httpAddressOf(const std::string& text);

}  // namespace lisco_apps
