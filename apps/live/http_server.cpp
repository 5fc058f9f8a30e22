// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// The only file of the programs that includes Boost.Beast, which takes long to compile.
#include "live/http_server.h"

#include <sys/resource.h>

#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <set>
#include <stdexcept>
#include <thread>
#include <utility>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>

#include "live/request.h"
#include "live/websocket_settings.h"

namespace lisco_apps {
namespace {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using Error = beast::error_code;
using tcp = net::ip::tcp;
using Request = http::request<http::empty_body>;

/// A request, or why there is none.
struct Reading {
  bool is_complete = false;
  Verdict verdict = Verdict::kBadRequest;
  Request request;
};

std::string_view viewOf(beast::string_view text) {
  return {text.data(), text.size()};
}

Reading readRequest(std::string_view received, bool is_loopback) {
  Reading reading;
  http::request_parser<http::empty_body> parser;
  parser.header_limit(HttpServer::kMaxHead);
  Error error;
  const std::size_t used = parser.put(net::buffer(received.data(), received.size()), error);
  if (error == http::error::need_more && received.size() < HttpServer::kMaxHead) return reading;
  reading.is_complete = true;
  if (error == http::error::need_more || error == http::error::header_limit) reading.verdict = Verdict::kTooLong;
  if (error) return reading;
  RequestHead head;
  const Request& request = parser.get();
  head.method = viewOf(request.method_string());
  head.target = viewOf(request.target());
  head.host = viewOf(request[http::field::host]);
  head.origin = viewOf(request[http::field::origin]);
  head.upgrades = websocket::is_upgrade(request) && request[http::field::sec_websocket_version] == "13" &&
                  !request[http::field::sec_websocket_key].empty();
  head.has_body = used < received.size() || parser.chunked() || parser.content_length().value_or(0) > 0;
  const bool is_ambiguous = request.count(http::field::host) != 1 || request.count(http::field::origin) > 1;
  reading.verdict = is_ambiguous ? Verdict::kBadRequest : verdictOn(head, is_loopback);
  reading.request = parser.release();
  return reading;
}

std::string responseTo(Verdict verdict, std::string_view page) {
  http::response<http::string_body> response(static_cast<http::status>(verdict), 11);
  const bool is_page = verdict == Verdict::kPage;
  response.set(http::field::content_type, is_page ? "text/html; charset=utf-8" : "text/plain; charset=utf-8");
  response.set(http::field::connection, "close");
  response.set(http::field::cache_control, "no-store");
  response.set(http::field::x_frame_options, "DENY");
  response.set("X-Content-Type-Options", "nosniff");
  response.set("Referrer-Policy", "no-referrer");
  if (verdict == Verdict::kMethodNotAllowed) response.set(http::field::allow, "GET");
  if (verdict == Verdict::kUpgradeRequired) response.set(http::field::upgrade, "websocket");
  if (is_page)
    response.body() = std::string(page);
  else
    response.body() = std::string(viewOf(http::obsolete_reason(response.result()))) + "\n";
  response.prepare_payload();
  std::string text;
  Error error;
  http::response_serializer<http::string_body> serializer(response);
  while (!error && !serializer.is_done()) {
    serializer.next(error, [&](Error&, const auto& buffers) {
      text += beast::buffers_to_string(buffers);
      serializer.consume(beast::buffer_bytes(buffers));
    });
  }
  return text;
}

class Viewer;

/// What connections share. All of it belongs to the server's thread, but the number of viewers.
struct Site {
  std::string page;
  bool is_loopback = true;
  std::size_t connections = 0;
  std::set<std::shared_ptr<Viewer>> viewers;
  std::atomic<std::size_t> viewer_count{0};
  HttpServer::Frame last;
  bool is_ending = false;
  std::function<void()> onViewers;  ///< called when their number has changed
};

/// A WebSocket, which receives frames and sends nothing.
class Viewer : public std::enable_shared_from_this<Viewer> {
 public:
  Viewer(beast::tcp_stream&& stream, Request&& request, Site& site)
      : socket_(std::move(stream)), request_(std::move(request)), site_(site) {
    ++site_.connections;
  }
  ~Viewer() { --site_.connections; }
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  void start() {
    beast::get_lowest_layer(socket_).expires_never();
    applySettings(socket_);
    socket_.async_accept(request_, [self = shared_from_this()](Error error) {
      if (!error) self->join();
    });
  }

  void offer(const HttpServer::Frame& frame) {
    waiting_ = frame;
    if (!sending_) sendNext();
  }

  /// Closes the connection after the frames it has.
  void end() {
    is_ending_ = true;
    if (!sending_) close();
  }

 private:
  void join() {
    site_.viewers.insert(shared_from_this());
    site_.onViewers();
    if (site_.last) offer(site_.last);
    socket_.async_read(buffer_, [self = shared_from_this()](Error error, std::size_t) {
      if (!error) beast::get_lowest_layer(self->socket_).close();  // a viewer has nothing to say
      self->leave();
    });
    if (site_.is_ending) end();
  }

  void sendNext() {
    sending_ = std::move(waiting_);
    socket_.async_write(net::buffer(*sending_), [self = shared_from_this()](Error error, std::size_t) {
      self->sending_.reset();
      if (error) return self->leave();
      if (self->waiting_) return self->sendNext();
      if (self->is_ending_) self->close();
    });
  }

  void close() {
    socket_.async_close(websocket::close_code::normal, [self = shared_from_this()](Error) { self->leave(); });
  }

  void leave() {
    if (site_.viewers.erase(shared_from_this()) > 0) site_.onViewers();
  }

  websocket::stream<beast::tcp_stream> socket_;
  Request request_;
  Site& site_;
  beast::flat_buffer buffer_{HttpServer::kMaxMessage};
  HttpServer::Frame sending_, waiting_;
  bool is_ending_ = false;
};

/// A connection with one request.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(tcp::socket&& socket, Site& site) : stream_(std::move(socket)), site_(site) { ++site_.connections; }
  ~Connection() { --site_.connections; }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void start() {
    stream_.expires_after(std::chrono::seconds(HttpServer::kSecondsForRequest));
    read();
  }

 private:
  void read() {
    const std::size_t space = HttpServer::kMaxHead - received_.size();
    stream_.async_read_some(net::buffer(buffer_.data(), space),
                            [self = shared_from_this()](Error error, std::size_t size) {
                              if (error) return;
                              self->received_.append(self->buffer_.data(), size);
                              self->decide();
                            });
  }

  void decide() {
    Reading reading = readRequest(received_, site_.is_loopback);
    if (!reading.is_complete) return read();
    if (reading.verdict == Verdict::kLive)
      return std::make_shared<Viewer>(std::move(stream_), std::move(reading.request), site_)->start();
    response_ = responseTo(reading.verdict, site_.page);
    net::async_write(stream_, net::buffer(response_), [self = shared_from_this()](Error error, std::size_t) {
      if (error) return;
      self->stream_.socket().shutdown(tcp::socket::shutdown_send, error);
      self->stream_.expires_after(std::chrono::seconds(1));
      self->drain();
    });
  }

  /// Reads on for a second: closing with bytes unread would take the response from the other side.
  void drain() {
    stream_.async_read_some(net::buffer(buffer_), [self = shared_from_this()](Error error, std::size_t) {
      if (!error) self->drain();
    });
  }

  beast::tcp_stream stream_;
  Site& site_;
  std::array<char, HttpServer::kMaxHead> buffer_{};
  std::string received_, response_;
};

}  // namespace

std::optional<HttpReply> replyTo(std::string_view received, std::string_view page, bool is_loopback) {
  const Reading reading = readRequest(received.substr(0, HttpServer::kMaxHead), is_loopback);
  if (!reading.is_complete) return std::nullopt;
  const bool is_live = reading.verdict == Verdict::kLive;
  return HttpReply{static_cast<unsigned>(reading.verdict), is_live ? "" : responseTo(reading.verdict, page)};
}

class HttpServer::State {
 public:
  State(const HttpAddress& address, std::string page, std::function<Frame()> next_frame)
      : acceptor_(context_), retry_(context_), ticker_(context_), next_frame_(std::move(next_frame)) {
    site_.page = std::move(page);
    site_.is_loopback = address.isLoopback();
    site_.onViewers = [this] { viewersChanged(); };
    Error error;
    const tcp::endpoint endpoint(net::ip::make_address(address.host), address.port);
    acceptor_.open(endpoint.protocol(), error);
    if (!error) acceptor_.set_option(tcp::acceptor::reuse_address(true), error);
    if (!error) acceptor_.bind(endpoint, error);
    if (!error) acceptor_.listen(tcp::acceptor::max_listen_connections, error);
    if (error) throw std::runtime_error("--http " + address.text() + ": " + error.message());
    accept();
    thread_ = std::thread([this] { run(); });
  }

  ~State() {
    context_.stop();
    thread_.join();
    site_.viewers.clear();  // before the context of their sockets
  }

  std::uint16_t port() const { return acceptor_.local_endpoint().port(); }
  std::size_t viewers() const { return site_.viewer_count; }

  void finish() {
    net::post(context_, [this] {
      Error error;
      acceptor_.close(error);
      site_.is_ending = true;
      const Frame last = site_.viewers.empty() ? nullptr : nextFrame();
      if (last) site_.last = last;
      const auto viewers = site_.viewers;
      for (const auto& viewer : viewers) {
        if (last) viewer->offer(last);
        viewer->end();
      }
      viewersChanged();
    });
    std::unique_lock<std::mutex> lock(mutex_);
    emptied_.wait_for(lock, std::chrono::seconds(2), [this] { return is_empty_; });
  }

 private:
  static constexpr std::chrono::milliseconds kTick{5}, kRetry{200};

  void run() {
    // Gives way to the clustering thread where both share a core.
    setpriority(PRIO_PROCESS, 0, getpriority(PRIO_PROCESS, 0) + 5);
    for (;;) {
      try {
        context_.run();
        return;
      } catch (const std::exception&) {  // of a connection, without memory: it is given up
      }
    }
  }

  void accept() {
    acceptor_.async_accept([this](Error error, tcp::socket socket) {
      if (!acceptor_.is_open()) return;
      if (error) {  // for example no free descriptors
        retry_.expires_after(kRetry);
        retry_.async_wait([this](Error) { accept(); });
        return;
      }
      accept();
      socket.set_option(tcp::no_delay(true), error);
      if (site_.connections < kMaxConnections) std::make_shared<Connection>(std::move(socket), site_)->start();
    });
  }

  void viewersChanged() {
    site_.viewer_count = site_.viewers.size();
    if (site_.viewers.empty() && site_.is_ending) {
      const std::lock_guard<std::mutex> lock(mutex_);
      is_empty_ = true;
      emptied_.notify_all();
    }
    if (!site_.viewers.empty() && !is_ticking_) tick();
  }

  void tick() {
    is_ticking_ = !site_.viewers.empty() && !site_.is_ending;
    if (!is_ticking_) return;
    ticker_.expires_after(kTick);
    ticker_.async_wait([this](Error) {
      const Frame frame = site_.is_ending ? nullptr : nextFrame();
      tick();
      if (!frame) return;
      site_.last = frame;
      for (const auto& viewer : site_.viewers) viewer->offer(frame);
    });
  }

  /// \return nullptr if there is none, or no memory for it
  Frame nextFrame() {
    try {
      return next_frame_();
    } catch (const std::exception&) {
      return nullptr;
    }
  }

  Site site_;  ///< outlives the connections, which the context holds
  net::io_context context_{1};
  tcp::acceptor acceptor_;
  net::steady_timer retry_, ticker_;
  std::function<Frame()> next_frame_;
  bool is_ticking_ = false;
  std::mutex mutex_;
  std::condition_variable emptied_;
  bool is_empty_ = false;  ///< after finish ()
  std::thread thread_;
};

HttpServer::HttpServer(const HttpAddress& address, std::string page, std::function<Frame()> next_frame)
    : address_(address), state_(std::make_unique<State>(address, std::move(page), std::move(next_frame))) {
  address_.port = state_->port();
}

HttpServer::~HttpServer() = default;

std::size_t HttpServer::viewers() const {
  return state_->viewers();
}

void HttpServer::finish() {
  state_->finish();
}

}  // namespace lisco_apps
