// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// The server of the live view by plain sockets.
#include "live/http_server.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "socket.h"

namespace lisco_test {
namespace {

using lisco_apps::HttpServer;

/// A server on a free port, whose frames begin with their numbers.
struct Server {
  explicit Server(std::size_t frame_bytes = 8)
      : server({}, "<!doctype html>the page", [this, frame_bytes]() -> HttpServer::Frame {
          std::string frame = std::to_string(++made);
          frame.resize(frame_bytes, ' ');
          return std::make_shared<const std::string>(frame);
        }) {}
  std::uint16_t port() const { return server.address().port; }
  std::string answerTo(const std::string& request) const {
    Socket socket(port());
    socket.send(request);
    return socket.receiveAll();
  }

  std::atomic<int> made{0};
  HttpServer server;
};

int statusOf(const std::string& answer) {
  return answer.rfind("HTTP/1.1 ", 0) == 0 ? std::stoi(answer.substr(9)) : -1;
}

std::string request(const std::string& line, const std::string& fields = "") {
  return line + " HTTP/1.1\r\nHost: localhost\r\n" + fields + "\r\n";
}

TEST(HttpServer, ServesThePageAndNothingElse) {
  const Server server;
  const std::string page = server.answerTo(request("GET /"));
  EXPECT_EQ(statusOf(page), 200);
  EXPECT_NE(page.find("\r\n\r\n<!doctype html>the page"), std::string::npos) << page;
  EXPECT_NE(page.find("Content-Type: text/html; charset=utf-8\r\n"), std::string::npos) << page;
  EXPECT_EQ(statusOf(server.answerTo(request("GET /view.html"))), 404);
  EXPECT_EQ(statusOf(server.answerTo(request("GET /../../etc/passwd"))), 404);
  EXPECT_EQ(statusOf(server.answerTo(request("GET /live"))), 426);
  const std::string post = server.answerTo(request("POST /", "Content-Length: 5\r\n") + "hello");
  EXPECT_EQ(statusOf(post), 405);
  EXPECT_NE(post.find("Allow: GET\r\n"), std::string::npos) << post;
  EXPECT_EQ(statusOf(server.answerTo("GET / HTTP/1.1\r\nHost: example.com\r\n\r\n")), 403);
  EXPECT_EQ(statusOf(server.answerTo("GET / HTTP/1.1\r\n\r\n")), 400);
}

TEST(HttpServer, RefusesWhatIsNoRequest) {
  const Server server;
  EXPECT_EQ(statusOf(server.answerTo("hello\r\n\r\n")), 400);
  EXPECT_EQ(statusOf(server.answerTo(std::string("\x16\x03\x01\x02\x00\x01\x00\x01\r\n\r\n", 12))), 400);
  EXPECT_EQ(statusOf(server.answerTo(request("GET /", "Host: example.com\r\n"))), 400);
  EXPECT_EQ(statusOf(server.answerTo(request("GET /", "Content-Length: 3\r\n") + "abc")), 400);
  EXPECT_EQ(statusOf(server.answerTo("GET /" + std::string(20000, 'a'))), 431);
  EXPECT_EQ(statusOf(server.answerTo(request("GET /", "Cookie: " + std::string(20000, 'a') + "\r\n"))), 431);
  EXPECT_EQ(statusOf(server.answerTo(request("GET /"))), 200);  // still there
}

TEST(HttpServer, TakesARequestByteByByte) {
  const Server server;
  Socket socket(server.port());
  for (const char c : request("GET /")) socket.send({c});
  EXPECT_EQ(statusOf(socket.receiveAll()), 200);
}

TEST(HttpServer, RefusesAWebSocketOfAForeignPage) {
  const Server server;
  for (const char* origin : {"http://example.com", "null", "http://127.0.0.1"}) {
    Socket socket(server.port());
    EXPECT_EQ(statusOf(socket.openLive(server.port(), origin)), 403) << origin;
  }
  EXPECT_EQ(server.server.viewers(), 0U);
}

TEST(HttpServer, SendsFramesInTheirOrderAndEnds) {
  Server server;
  std::vector<std::unique_ptr<Socket>> viewers;
  for (int i = 0; i < 2; ++i) {
    viewers.push_back(std::make_unique<Socket>(server.port()));
    ASSERT_EQ(statusOf(viewers.back()->openLive(server.port(), "")), 101);
  }
  int last = 0;
  for (int i = 0; i < 5; ++i) {
    const auto [kind, frame] = viewers[0]->receiveMessage();
    ASSERT_EQ(kind, 2);
    EXPECT_GT(std::stoi(frame), last);
    last = std::stoi(frame);
  }
  EXPECT_EQ(server.server.viewers(), 2U);
  std::thread reader([&] {
    for (auto& viewer : viewers) {
      int newest = 0;
      for (;;) {
        const auto [kind, frame] = viewer->receiveMessage();
        if (kind == 8) {
          EXPECT_EQ(frame.substr(0, 2), "\x03\xe8");  // 1000: normal
          viewer->send("\x88\x80\1\2\3\4");
          break;
        }
        newest = std::stoi(frame);
      }
      EXPECT_EQ(newest, server.made);
      viewer.reset();
    }
  });
  const auto start = std::chrono::steady_clock::now();
  server.server.finish();
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(1900));
  reader.join();
  EXPECT_THROW(Socket{server.port()}, std::runtime_error);
}

TEST(HttpServer, WaitsTwoSecondsForViewersThatDoNotEnd) {
  Server server(std::size_t{16} << 20);
  Socket silent(server.port());
  ASSERT_EQ(statusOf(silent.openLive(server.port(), "")), 101);
  const auto start = std::chrono::steady_clock::now();
  server.server.finish();
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
}

TEST(HttpServer, AViewerThatDoesNotReadDelaysNoOther) {
  Server server(std::size_t{4} << 20);
  Socket silent(server.port()), reading(server.port());
  for (Socket* viewer : {&silent, &reading}) ASSERT_EQ(statusOf(viewer->openLive(server.port(), "")), 101);
  const auto start = std::chrono::steady_clock::now();
  int last = 0;
  for (int i = 0; i < 30; ++i) {
    const auto [kind, frame] = reading.receiveMessage();
    ASSERT_EQ(kind, 2);
    EXPECT_GT(std::stoi(frame), last);
    last = std::stoi(frame);
  }
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(15));
  // The silent one has at most what the sockets hold, and then gets a newer frame.
  int numbers = 0;
  for (int newest = 0; newest < last; ++numbers) newest = std::stoi(silent.receiveMessage().second);
  EXPECT_LT(numbers, 20);
}

TEST(HttpServer, ClosesAViewerThatSpeaks) {
  Server server;
  std::vector<std::unique_ptr<Socket>> viewers;
  for (const std::string& message : {std::string("\x81\x80\1\2\3\4"), std::string("\x82\xfe\xff\xff\1\2\3\4"),
                                     std::string("\x81\x02hi"), std::string(14, '\xff')}) {
    viewers.push_back(std::make_unique<Socket>(server.port()));
    ASSERT_EQ(statusOf(viewers.back()->openLive(server.port(), "")), 101);
    viewers.back()->send(message);
  }
  for (const auto& viewer : viewers) EXPECT_NO_THROW(viewer->receiveAll());
  viewers.clear();
  const auto give_up_at = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (server.server.viewers() > 0 && std::chrono::steady_clock::now() < give_up_at)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_EQ(server.server.viewers(), 0U);
}

TEST(HttpServer, SaysThatAPortIsInUse) {
  const Server server;
  try {
    HttpServer second(server.server.address(), "", [] { return nullptr; });
    FAIL() << "two servers on one port";
  } catch (const std::runtime_error& error) {
    const std::string text = error.what();
    EXPECT_EQ(text, "--http " + server.server.address().text() + ": Address already in use");
  }
}

TEST(HttpServer, EndsWithoutViewersAtOnce) {
  Server server;
  Socket half(server.port());
  half.send("GET / HT");
  const auto start = std::chrono::steady_clock::now();
  server.server.finish();
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(1));
}

}  // namespace
}  // namespace lisco_test
