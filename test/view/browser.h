// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

/// A picture of 0x00RRGGBB.
struct Screenshot {
  std::size_t width = 0, height = 0;
  std::vector<std::uint32_t> pixels;  ///< row by row

  std::uint32_t at(std::size_t x, std::size_t y) const { return pixels.at(y * width + x); }
  /// Pixels that differ from another picture of this size.
  std::size_t differencesTo(const Screenshot& other) const;
};

/// A headless Chromium with one page, drawn by software (SwiftShader). It is driven by Chromium's DevTools protocol
/// over two pipes.
class Browser {
 public:
  using Json = nlohmann::json;

  /// The installed Chromium: $LISCO_CHROMIUM, or the first of its usual names in $PATH; empty: none.
  static std::string installed();

  /// \param folder of the browser's profile
  /// \throws std::runtime_error if it does not start
  explicit Browser(const std::filesystem::path& folder, int width = 1280, int height = 720);
  ~Browser();
  Browser(const Browser&) = delete;
  Browser& operator=(const Browser&) = delete;

  /// Loads a page and waits for its `load` event.
  void open(const std::string& url);
  /// The value of a JavaScript expression; waits for promises.
  /// \throws std::runtime_error if it throws
  Json evaluate(const std::string& expression);
  /// Waits at most `limit` for an expression to be true. \return whether it is
  bool waitFor(const std::string& expression, std::chrono::seconds limit = std::chrono::seconds(30));
  /// Waits for two animation frames: the page has heard of all input and drawn it.
  void settle();
  Screenshot screenshot();
  void saveScreenshot(const std::filesystem::path& png);

  void click(double x, double y);
  void drag(double x, double y, double to_x, double to_y);
  void tap(double x, double y);
  void pinch(double x, double y, double from, double to);  ///< distance of the fingers from (x, y)
  void key(const std::string& key);
  /// A phone's screen, touch and user agent.
  void becomePhone(int width, int height);
  void preferScheme(const std::string& dark_or_light);

  /// Errors and warnings on the console and exceptions since the start.
  const std::vector<std::string>& complaints() const { return complaints_; }
  /// Requests since the start, without those of the page itself and of data: URLs.
  const std::vector<std::string>& requests() const { return requests_; }

  Json call(const std::string& method, const Json& parameters = Json::object());

 private:
  Json send(const std::string& method, const Json& parameters, const std::string& session);
  Json receive();  ///< the next message
  void note(const Json& event);
  void end();
  std::string pngBytes();

  pid_t process_ = -1;
  int to_browser_ = -1, from_browser_ = -1;
  std::string received_, session_, page_url_;
  std::chrono::steady_clock::time_point give_up_at_;
  int last_id_ = 0;
  bool has_loaded_ = false;
  std::vector<std::string> complaints_, requests_;
};
