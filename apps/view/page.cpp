// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "view/page.h"

#include <zlib.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include <nlohmann/json.hpp>

namespace lisco_apps {
namespace {

constexpr std::string_view kDataMark = "<!-- data -->";  ///< in the page, replaced by the scans

std::string compressed(const std::string& bytes) {
  if (bytes.size() > std::numeric_limits<uInt>::max()) throw std::runtime_error("the scan is too large for a page");
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string result(size, '\0');
  if (compress2(reinterpret_cast<Bytef*>(result.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                static_cast<uLong>(bytes.size()), Z_DEFAULT_COMPRESSION) != Z_OK)
    throw std::runtime_error("the scan cannot be compressed: out of memory");
  result.resize(size);
  return result;
}

void appendBase64(const std::string& bytes, std::string& text) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8U | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) text.push_back(k <= count ? kDigits[group >> (18 - 6 * k) & 63U] : '=');
  }
}

/// A JSON string that may stand in a script element: without '<'.
std::string quoted(const std::string& text) {
  const std::string json = nlohmann::json(text).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  std::string result;
  for (const char c : json) c == '<' ? result += "\\u003c" : result += c;
  return result;
}

/// The page with its data.
std::string pageWith(const std::string& data) {
  const std::string_view page = emptyViewPage();
  const std::size_t mark = page.find(kDataMark);
  std::string result(page.substr(0, mark));
  result += data;
  result += page.substr(mark + kDataMark.size());
  return result;
}

std::string jsonScript(const char* id, const std::string& text) {
  return std::string("<script type=\"application/json\" id=\"") + id + "\">" + quoted(text) + "</script>\n";
}

}  // namespace

std::string viewPage(const std::string& title, const std::vector<std::string>& scans) {
  std::string data = jsonScript("title", title);
  for (const std::string& scan : scans) {
    data += "<script type=\"text/plain\" class=\"scan\">";
    appendBase64(compressed(scan), data);
    data += "</script>\n";
  }
  return pageWith(data);
}

std::string liveViewPage(const std::string& title, const std::string& path) {
  return pageWith(jsonScript("title", title) + jsonScript("live", path));
}

}  // namespace lisco_apps
