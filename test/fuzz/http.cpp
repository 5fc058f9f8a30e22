// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>
#include <string_view>

#include <boost/asio/io_context.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include "bodies.h"
#include "live/address.h"
#include "live/http_server.h"
#include "live/websocket_settings.h"

namespace lisco_test {
namespace {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using Error = beast::error_code;

/// A connection whose other side has sent all it will send, and takes any answer.
class MemoryStream {
 public:
  using executor_type = net::io_context::executor_type;

  MemoryStream(net::io_context& context, std::string_view received) : context_(&context), received_(received) {}
  executor_type get_executor() { return context_->get_executor(); }

  template <typename Buffers>
  std::size_t read_some(const Buffers& buffers, Error& error) {
    const std::size_t size = net::buffer_copy(buffers, net::buffer(received_.data(), received_.size()));
    received_.remove_prefix(size);
    if (size == 0) error = net::error::eof;
    return size;
  }
  template <typename Buffers>
  std::size_t read_some(const Buffers& buffers) {
    Error error;
    return read_some(buffers, error);
  }
  template <typename Buffers>
  std::size_t write_some(const Buffers& buffers, Error& /*error*/) {
    return beast::buffer_bytes(buffers);
  }
  template <typename Buffers>
  std::size_t write_some(const Buffers& buffers) {
    return beast::buffer_bytes(buffers);
  }

 private:
  net::io_context* context_;
  std::string_view received_;
};

/// Called by Beast, some versions of it, when a WebSocket is closed.
[[maybe_unused]] void teardown(beast::role_type /*role*/, MemoryStream& /*stream*/, Error& /*error*/) {}
[[maybe_unused]] void beast_close_socket(MemoryStream& /*stream*/) {}

constexpr std::string_view kPage = "<!doctype html>";

/// A request, as a server that all machines reach, or only this one, answers it.
void request(std::string_view bytes, bool is_loopback) {
  const auto reply = lisco_apps::replyTo(bytes, kPage, is_loopback);
  if (!reply) {
    hold(bytes.size() < lisco_apps::HttpServer::kMaxHead, "a long request without an answer");
    return;
  }
  constexpr std::array<unsigned, 8> kStatuses{101, 200, 400, 403, 404, 405, 426, 431};
  hold(std::count(kStatuses.begin(), kStatuses.end(), reply->status) == 1, "the status");
  hold(reply->text.empty() == (reply->status == 101), "the answer of a WebSocket");
  if (reply->status == 200 || reply->status == 101) {
    hold(bytes.substr(0, 4) == "GET ", "a method that is not GET");
    const bool names_this_machine = bytes.find("127.") != bytes.npos || bytes.find("[::1]") != bytes.npos ||
                                    bytes.find("ost") != bytes.npos || bytes.find("OST") != bytes.npos;
    hold(!is_loopback || names_this_machine, "a foreign Host");
  }
  if (reply->text.empty()) return;
  hold(reply->text.rfind("HTTP/1.1 " + std::to_string(reply->status) + " ", 0) == 0, "the status line");
  hold(reply->text.find("Connection: close\r\n") != std::string::npos, "the connection's end");
  const bool has_page = reply->text.find(kPage) != std::string::npos;
  hold(has_page == (reply->status == 200), "the page");
}

/// What a viewer sends once the connection is a WebSocket.
void viewer(std::string_view bytes) {
  static net::io_context context;
  beast::http::request<beast::http::empty_body> upgrade(beast::http::verb::get, "/live", 11);
  upgrade.set(beast::http::field::host, "127.0.0.1");
  upgrade.set(beast::http::field::upgrade, "websocket");
  upgrade.set(beast::http::field::connection, "upgrade");
  upgrade.set(beast::http::field::sec_websocket_key, "dGhlIHNhbXBsZSBub25jZQ==");
  upgrade.set(beast::http::field::sec_websocket_version, "13");
  websocket::stream<MemoryStream> socket(context, bytes);
  lisco_apps::applySettings(socket);
  Error error;
  socket.accept(upgrade, error);
  hold(!error, "the handshake");
  beast::flat_buffer message(lisco_apps::HttpServer::kMaxMessage);
  const std::size_t size = socket.read(message, error);
  hold(size <= lisco_apps::HttpServer::kMaxMessage, "a long message");
  hold(error || bytes.size() >= size, "a message of more bytes than were sent");
}

void address(std::string_view bytes) {
  try {
    const lisco_apps::HttpAddress read = lisco_apps::httpAddressOf(std::string(bytes));
    const lisco_apps::HttpAddress again = lisco_apps::httpAddressOf(read.text());
    hold(again.host == read.host && again.port == read.port, "an address that is another one when written");
  } catch (const std::runtime_error& refusal) {
    hold(std::string_view(refusal.what()).find("--http") != std::string_view::npos, "a refusal without the option");
  }
}

}  // namespace

void fuzzHttp(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  switch (data[0] % 4) {
    case 0:
      return request(bytes, true);
    case 1:
      return request(bytes, false);
    case 2:
      return viewer(bytes);
    default:
      return address(bytes);
  }
}

}  // namespace lisco_test
