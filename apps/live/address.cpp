// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "live/address.h"

#include <arpa/inet.h>

#include <limits>
#include <stdexcept>

#include "io/options.h"

namespace lisco_apps {

bool HttpAddress::isLoopback() const {
  return host == "::1" || host.rfind("127.", 0) == 0;
}

std::string HttpAddress::text() const {
  return (isIpv6() ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

HttpAddress httpAddressOf(const std::string& text) {
  HttpAddress address;
  const std::size_t colon = text.rfind(':');
  if (colon != std::string::npos) {
    address.host = text.substr(0, colon);
    if (address.host == "localhost") address.host = "127.0.0.1";
    const bool has_brackets = address.host.size() > 2 && address.host.front() == '[' && address.host.back() == ']';
    if (has_brackets) address.host = address.host.substr(1, address.host.size() - 2);
    in6_addr binary{};
    if (inet_pton(has_brackets ? AF_INET6 : AF_INET, address.host.c_str(), &binary) != 1)
      throw std::runtime_error(
          "--http must be [ADDRESS:]PORT with a numeric address (IPv6 in brackets) or localhost, "
          "not '" +
          text + "'");
  }
  const std::string port = colon == std::string::npos ? text : text.substr(colon + 1);
  address.port =
      static_cast<std::uint16_t>(countOf(port, "the port of --http", 0, std::numeric_limits<std::uint16_t>::max()));
  return address;
}

}  // namespace lisco_apps
