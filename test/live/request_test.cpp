// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "live/request.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "live/address.h"

namespace lisco_test {
namespace {

using lisco_apps::httpAddressOf;
using lisco_apps::RequestHead;
using lisco_apps::Verdict;
using lisco_apps::verdictOn;

RequestHead get(std::string_view target, std::string_view host = "127.0.0.1:8080") {
  return {"GET", target, host, "", false, false};
}

RequestHead upgrade(std::string_view origin, std::string_view host = "127.0.0.1:8080") {
  return {"GET", "/live", host, origin, true, false};
}

TEST(Request, OnlyKnownPathsAreServed) {
  EXPECT_EQ(verdictOn(get("/"), true), Verdict::kPage);
  EXPECT_EQ(verdictOn(get("/?theme=dark"), true), Verdict::kPage);
  for (const char* target : {"", "/index.html", "/live/", "//", "/../etc/passwd", "*", "http://127.0.0.1:8080/"})
    EXPECT_EQ(verdictOn(get(target), true), Verdict::kNotFound) << target;
  EXPECT_EQ(verdictOn(get("/live"), true), Verdict::kUpgradeRequired);
}

TEST(Request, OnlyGetIsServed) {
  for (const char* method : {"POST", "HEAD", "PUT", "OPTIONS", "get", "CONNECT"}) {
    RequestHead request = get("/");
    request.method = method;
    EXPECT_EQ(verdictOn(request, true), Verdict::kMethodNotAllowed) << method;
  }
  RequestHead request = get("/");
  request.has_body = true;
  EXPECT_EQ(verdictOn(request, true), Verdict::kBadRequest);
}

TEST(Request, AWebSocketComesFromTheServersOwnPage) {
  for (const char* origin : {"http://127.0.0.1:8080", "HTTP://127.0.0.1:8080", "https://127.0.0.1:8080", ""})
    EXPECT_EQ(verdictOn(upgrade(origin), true), Verdict::kLive) << origin;
  for (const char* origin : {"http://example.com", "http://127.0.0.1", "http://127.0.0.1:80801", "null",
                             "127.0.0.1:8080", "http://example.com/127.0.0.1:8080", "file://"})
    EXPECT_EQ(verdictOn(upgrade(origin), true), Verdict::kForbidden) << origin;
}

TEST(Request, AServerOfThisMachineRefusesForeignNames) {
  for (const char* host : {"localhost", "LOCALHOST:1", "lidar.localhost:80", "127.1.2.3:8080", "[::1]", "[::1]:8080"})
    EXPECT_EQ(verdictOn(get("/", host), true), Verdict::kPage) << host;
  for (const char* host : {"example.com", "127.0.0.1.example.com", "localhost.example.com:80", "192.168.1.2",
                           "[::2]:80", "notlocalhost", "127.x"}) {
    EXPECT_EQ(verdictOn(get("/", host), true), Verdict::kForbidden) << host;
    EXPECT_EQ(verdictOn(get("/", host), false), Verdict::kPage) << host;
    EXPECT_EQ(verdictOn(upgrade("http://" + std::string(host), host), true), Verdict::kForbidden) << host;
  }
  EXPECT_EQ(verdictOn(get("/", ""), false), Verdict::kBadRequest);
}

TEST(HttpAddress, IsReadWithAndWithoutAHost) {
  EXPECT_EQ(httpAddressOf("8080").text(), "127.0.0.1:8080");
  EXPECT_EQ(httpAddressOf("localhost:1").text(), "127.0.0.1:1");
  EXPECT_EQ(httpAddressOf("0.0.0.0:65535").text(), "0.0.0.0:65535");
  EXPECT_EQ(httpAddressOf("[::1]:80").text(), "[::1]:80");
  EXPECT_TRUE(httpAddressOf("[::1]:80").isLoopback());
  EXPECT_TRUE(httpAddressOf("127.0.0.2:80").isLoopback());
  EXPECT_FALSE(httpAddressOf("0.0.0.0:80").isLoopback());
  for (const char* wrong : {"", ":", ":80", "80:", "::1:80", "[127.0.0.1]:80", "example.com:80", "1.2.3:80", "-1",
                            "65536", "8080x", "127.0.0.1:", "[::1]"})
    EXPECT_THROW(httpAddressOf(wrong), std::runtime_error) << wrong;
}

}  // namespace
}  // namespace lisco_test
