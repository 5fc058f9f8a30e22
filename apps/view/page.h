// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace lisco_apps {

/// Text near the beginning of each page.
inline constexpr const char* kViewSignature = "<!-- Lisco view -->";

/// The page without scans, as text/html in UTF-8: source files of apps/view/page in one.
std::string_view emptyViewPage();

/// A page that shows scans, in one HTML file that loads nothing else. Several are frames of a timeline.
/// \param title UTF-8; malformed bytes are replaced
/// \param scans as encodeViewScan () gives them
/// \throws std::runtime_error if a scan cannot be compressed
std::string viewPage(const std::string& title, const std::vector<std::string>& scans);

/// A page that shows the frames of a stream, which it receives by WebSocket (see doc/view.md).
/// \param title see viewPage ()
/// \param path of the WebSocket on the page's own server
std::string liveViewPage(const std::string& title, const std::string& path);

}  // namespace lisco_apps
