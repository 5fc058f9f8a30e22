// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "live/request.h"

#include <string>

#include <boost/algorithm/string/case_conv.hpp>
#include <boost/algorithm/string/predicate.hpp>

namespace lisco_apps {
namespace {

/// A Host without its port.
std::string_view hostNameOf(std::string_view host) {
  const std::size_t bracket = host.find(']');
  return host.substr(0, host.find(':', bracket == std::string_view::npos ? 0 : bracket));
}

/// Whether a name is this machine's for itself: localhost, [::1], or 127 and three numbers.
bool isLoopbackName(const std::string& name) {
  if (name == "localhost" || boost::ends_with(name, ".localhost") || name == "[::1]") return true;
  return boost::starts_with(name, "127.") && name.find_first_not_of("0123456789.") == std::string::npos;
}

}  // namespace

Verdict verdictOn(const RequestHead& request, bool is_loopback) {
  const std::string host = boost::to_lower_copy(std::string(request.host));
  if (host.empty() || request.has_body)
    return request.method == "GET" ? Verdict::kBadRequest : Verdict::kMethodNotAllowed;
  if (is_loopback && !isLoopbackName(std::string(hostNameOf(host)))) return Verdict::kForbidden;
  const std::string_view path = request.target.substr(0, request.target.find('?'));
  if (path != "/" && path != kLivePath) return Verdict::kNotFound;
  if (request.method != "GET") return Verdict::kMethodNotAllowed;
  if (path == "/") return Verdict::kPage;
  if (!request.upgrades) return Verdict::kUpgradeRequired;
  const std::string origin = boost::to_lower_copy(std::string(request.origin));
  const bool is_own = origin.empty() || origin == "http://" + host || origin == "https://" + host;
  return is_own ? Verdict::kLive : Verdict::kForbidden;
}

}  // namespace lisco_apps
