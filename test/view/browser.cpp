// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "browser.h"

#include <cairo.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds kPatience{60};

std::string bytesOfBase64(const std::string& text) {
  std::string bytes;
  std::uint32_t group = 0;
  int bits = 0;
  for (const char c : text) {
    const char* const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char* const found = c == '\0' ? nullptr : std::strchr(digits, c);
    if (found == nullptr) break;
    group = group << 6U | static_cast<std::uint32_t>(found - digits);
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes.push_back(static_cast<char>(group >> bits & 0xFFU));
  }
  return bytes;
}

cairo_status_t readBytes(void* closure, unsigned char* data, unsigned length) {
  auto& stream = *static_cast<std::istringstream*>(closure);
  stream.read(reinterpret_cast<char*>(data), length);
  return stream ? CAIRO_STATUS_SUCCESS : CAIRO_STATUS_READ_ERROR;
}

}  // namespace

std::size_t Screenshot::differencesTo(const Screenshot& other) const {
  if (width != other.width || height != other.height) throw std::runtime_error("pictures of different sizes");
  std::size_t differences = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i) differences += pixels[i] != other.pixels[i] ? 1 : 0;
  return differences;
}

std::string Browser::installed() {
  if (const char* const named = std::getenv("LISCO_CHROMIUM")) return named;
  const char* const path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');)
    for (const char* name : {"chromium", "chromium-browser", "google-chrome"})
      if (const std::string file = folder + "/" + name; access(file.c_str(), X_OK) == 0) return file;
  return {};
}

Browser::Browser(const std::filesystem::path& folder, int width, int height) {
  const std::string program = installed();
  std::vector<std::string> words{program,
                                 "--headless=new",
                                 "--no-sandbox",
                                 "--remote-debugging-pipe",
                                 "--use-angle=swiftshader",
                                 "--enable-unsafe-swiftshader",
                                 "--no-first-run",
                                 "--disable-background-networking",
                                 "--disable-component-update",
                                 "--disable-dev-shm-usage",
                                 "--hide-scrollbars",
                                 "--window-size=" + std::to_string(width) + "," + std::to_string(height),
                                 "--user-data-dir=" + (folder / "chromium").string(),
                                 "about:blank"};
  // Pages are composited by the processor, too, as on machines without a graphics processor.
  if (std::getenv("LISCO_WALL_TIME") != nullptr) words.emplace_back("--disable-gpu");
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  int down[2], up[2];
  if (pipe2(down, O_CLOEXEC) != 0 || pipe2(up, O_CLOEXEC) != 0) throw std::runtime_error("no pipes");
  process_ = fork();
  if (process_ == 0) {
    setpgid(0, 0);
    // Chromium reads from descriptor 3 and writes to 4.
    const int in = fcntl(down[0], F_DUPFD, 10);
    const int out = fcntl(up[1], F_DUPFD, 10);
    dup2(in, 3);
    dup2(out, 4);
    const int nowhere = ::open("/dev/null", O_RDWR);
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nowhere, stream);
    setenv("HOME", folder.c_str(), 1);
    execv(program.c_str(), arguments.data());
    _exit(99);
  }
  close(down[0]);
  close(up[1]);
  to_browser_ = down[1];
  from_browser_ = up[0];

  try {
    const Json target = send("Target.createTarget", {{"url", "about:blank"}}, "");
    session_ = send("Target.attachToTarget", {{"targetId", target["targetId"]}, {"flatten", true}}, "")["sessionId"];
    for (const char* domain : {"Page", "Runtime", "Log", "Network"}) call(std::string(domain) + ".enable");
    call("Emulation.setDeviceMetricsOverride",
         {{"width", width}, {"height", height}, {"deviceScaleFactor", 1}, {"mobile", false}});
  } catch (...) {
    end();
    throw;
  }
}

Browser::~Browser() {
  end();
}

void Browser::end() {
  if (process_ > 0) {
    kill(-process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
  close(to_browser_);
  close(from_browser_);
}

Browser::Json Browser::receive() {
  std::size_t end = 0;
  while ((end = received_.find('\0')) == std::string::npos) {
    pollfd ready{from_browser_, POLLIN, 0};
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(give_up_at_ - Clock::now()).count();
    if (left <= 0 || poll(&ready, 1, static_cast<int>(left)) <= 0) throw std::runtime_error("the browser is silent");
    char buffer[65536];
    const ssize_t count = read(from_browser_, buffer, sizeof buffer);
    if (count <= 0) throw std::runtime_error("the browser has ended");
    received_.append(buffer, static_cast<std::size_t>(count));
  }
  Json message = Json::parse(received_.begin(), received_.begin() + static_cast<std::ptrdiff_t>(end));
  received_.erase(0, end + 1);
  return message;
}

void Browser::note(const Json& event) {
  const std::string method = event.value("method", "");
  const Json& data = event.contains("params") ? event["params"] : event;
  if (method == "Page.loadEventFired") has_loaded_ = true;
  if (method == "Runtime.exceptionThrown") complaints_.push_back(data["exceptionDetails"].dump());
  if (method == "Runtime.consoleAPICalled" && (data["type"] == "error" || data["type"] == "warning"))
    complaints_.push_back(data["args"].dump());
  if (method == "Log.entryAdded" && (data["entry"]["level"] == "error" || data["entry"]["level"] == "warning"))
    complaints_.push_back(data["entry"]["text"]);
  if (method == "Network.requestWillBeSent") {
    const std::string url = data["request"]["url"];
    if (url != page_url_ && url.rfind("data:", 0) != 0) requests_.push_back(url);
  }
  if (method == "Network.webSocketCreated") requests_.push_back(data["url"]);
}

Browser::Json Browser::send(const std::string& method, const Json& parameters, const std::string& session) {
  Json message{{"id", ++last_id_}, {"method", method}, {"params", parameters}};
  if (!session.empty()) message["sessionId"] = session;
  std::string text = message.dump();
  text.push_back('\0');
  for (std::size_t sent = 0; sent < text.size();) {
    const ssize_t count = write(to_browser_, text.data() + sent, text.size() - sent);
    if (count <= 0) throw std::runtime_error("the browser has ended");
    sent += static_cast<std::size_t>(count);
  }
  give_up_at_ = Clock::now() + kPatience;
  for (;;) {
    Json answer = receive();
    if (answer.value("id", 0) != last_id_) {
      note(answer);
    } else if (answer.contains("error")) {
      throw std::runtime_error(method + ": " + answer["error"].dump());
    } else {
      return answer["result"];
    }
  }
}

Browser::Json Browser::call(const std::string& method, const Json& parameters) {
  return send(method, parameters, session_);
}

void Browser::open(const std::string& url) {
  page_url_ = url.substr(0, url.find('#'));
  has_loaded_ = false;
  const Json answer = call("Page.navigate", {{"url", url}});
  if (answer.contains("errorText")) throw std::runtime_error(url + ": " + answer["errorText"].get<std::string>());
  give_up_at_ = Clock::now() + kPatience;
  while (!has_loaded_) note(receive());
}

Browser::Json Browser::evaluate(const std::string& expression) {
  const Json answer =
      call("Runtime.evaluate", {{"expression", expression}, {"awaitPromise", true}, {"returnByValue", true}});
  if (answer.contains("exceptionDetails"))
    throw std::runtime_error(expression + ": " + answer["exceptionDetails"].dump());
  return answer["result"].contains("value") ? answer["result"]["value"] : Json();
}

bool Browser::waitFor(const std::string& expression, std::chrono::seconds limit) {
  const auto end = Clock::now() + limit;
  while (evaluate("Boolean(" + expression + ")") != true) {
    if (Clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return true;
}

void Browser::settle() {
  evaluate("new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done(1))))");
}

std::string Browser::pngBytes() {
  settle();
  return bytesOfBase64(call("Page.captureScreenshot", {{"format", "png"}})["data"]);
}

Screenshot Browser::screenshot() {
  std::istringstream stream(pngBytes());
  cairo_surface_t* const surface = cairo_image_surface_create_from_png_stream(readBytes, &stream);
  if (cairo_surface_status(surface) != CAIRO_STATUS_SUCCESS) throw std::runtime_error("the screenshot is no PNG");
  Screenshot picture{static_cast<std::size_t>(cairo_image_surface_get_width(surface)),
                     static_cast<std::size_t>(cairo_image_surface_get_height(surface)),
                     {}};
  const unsigned char* const data = cairo_image_surface_get_data(surface);
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface));
  for (std::size_t y = 0; y < picture.height; ++y) {
    for (std::size_t x = 0; x < picture.width; ++x) {
      std::uint32_t pixel = 0;
      std::memcpy(&pixel, data + y * stride + 4 * x, sizeof pixel);
      picture.pixels.push_back(pixel & 0xFFFFFFU);
    }
  }
  cairo_surface_destroy(surface);
  return picture;
}

void Browser::saveScreenshot(const std::filesystem::path& png) {
  std::ofstream(png, std::ios::binary) << pngBytes();
}

void Browser::click(double x, double y) {
  drag(x, y, x, y);
}

void Browser::drag(double x, double y, double to_x, double to_y) {
  const auto event = [&](const char* type, double at_x, double at_y, int buttons) {
    call("Input.dispatchMouseEvent",
         {{"type", type}, {"x", at_x}, {"y", at_y}, {"button", "left"}, {"buttons", buttons}, {"clickCount", 1}});
  };
  event("mousePressed", x, y, 1);
  for (int step = 1; step <= 4 && (x != to_x || y != to_y); ++step)
    event("mouseMoved", x + (to_x - x) * step / 4, y + (to_y - y) * step / 4, 1);
  event("mouseReleased", to_x, to_y, 0);
  settle();
}

void Browser::tap(double x, double y) {
  call("Input.dispatchTouchEvent", {{"type", "touchStart"}, {"touchPoints", {{{"x", x}, {"y", y}}}}});
  call("Input.dispatchTouchEvent", {{"type", "touchEnd"}, {"touchPoints", Json::array()}});
  settle();
}

void Browser::pinch(double x, double y, double from, double to) {
  for (int step = 0; step <= 4; ++step) {
    const double distance = from + (to - from) * step / 4;
    call("Input.dispatchTouchEvent",
         {{"type", step == 0 ? "touchStart" : "touchMove"},
          {"touchPoints", {{{"x", x - distance}, {"y", y}, {"id", 0}}, {{"x", x + distance}, {"y", y}, {"id", 1}}}}});
  }
  call("Input.dispatchTouchEvent", {{"type", "touchEnd"}, {"touchPoints", Json::array()}});
  settle();
}

void Browser::key(const std::string& key) {
  Json event{{"type", "keyDown"}, {"key", key}};
  if (key.size() == 1) event["text"] = key;
  call("Input.dispatchKeyEvent", event);
  call("Input.dispatchKeyEvent", {{"type", "keyUp"}, {"key", key}});
  settle();
}

void Browser::becomePhone(int width, int height) {
  call("Emulation.setDeviceMetricsOverride",
       {{"width", width}, {"height", height}, {"deviceScaleFactor", 2}, {"mobile", true}});
  call("Emulation.setTouchEmulationEnabled", {{"enabled", true}, {"maxTouchPoints", 5}});
}

void Browser::preferScheme(const std::string& dark_or_light) {
  call("Emulation.setEmulatedMedia", {{"features", {{{"name", "prefers-color-scheme"}, {"value", dark_or_light}}}}});
}
