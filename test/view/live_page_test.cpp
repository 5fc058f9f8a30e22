// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// The page of lisco_stream --http in headless Chromium.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "../live/socket.h"
#include "../programs/child.h"
#include "browser_test.h"

namespace {

using Json = nlohmann::json;
using lisco_test::Socket;

/// Simulated packets of a VLP-16, 12 rotations in 1.2 s.
class LivePageTest : public BrowserTest {
 protected:
  static void SetUpTestSuite() {
    BrowserTest::SetUpTestSuite();
    if (!browser_) return;
    simulate("drive", 12);
  }
  static void simulate(const std::string& folder, int rotations) {
    ASSERT_EQ(std::system((LISCO_SIMULATE " --terrain road --sensor vlp16 --speed 8 --rotations " +
                           std::to_string(rotations) + " --pcap -o " + (folder_ / folder).string() + " >/dev/null")
                              .c_str()),
              0);
  }

  /// Starts lisco_stream on a capture, with a server on a free port.
  void start(const std::vector<std::string>& more, const std::string& capture = "drive/capture.pcap") {
    std::vector<std::string> arguments{capture, "--sensor", "vlp16", "--tolerance", "0.4", "--stats"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    for (const char* word : {"--http", "0"}) arguments.emplace_back(word);
    stream_.emplace(LISCO_STREAM, arguments, folder_);
    std::smatch found;
    ASSERT_TRUE(Child::waitUntil([&] {
      err_ = stream_->err();
      return std::regex_search(err_, found, std::regex("lisco_stream: view at (http://127.0.0.1:([0-9]+)/)\n"));
    })) << err_;
    url_ = found[1];
    port_ = static_cast<std::uint16_t>(std::stoi(found[2]));
  }

  static bool waitForState(const std::string& state) {
    return browser_->waitFor("window.lisco?.view?.live && document.getElementById('state').textContent === '" + state +
                             "'");
  }
  static Json status(const std::string& name) { return browser_->evaluate("lisco.view.live.status." + name); }

  /// The rotations' lines without their times.
  static std::vector<std::string> rotationsOf(const std::string& out) {
    std::vector<std::string> lines;
    std::istringstream stream(out);
    for (std::string line; std::getline(stream, line);)
      if (line.rfind("rotation ", 0) == 0)
        lines.push_back(std::regex_replace(line, std::regex(", after [0-9.]+ ms"), ""));
    return lines;
  }
  /// A number of the closing table.
  static long long statOf(const std::string& out, const std::string& expression) {
    std::smatch found;
    EXPECT_TRUE(std::regex_search(out, found, std::regex(expression))) << expression << "\n" << out;
    return found.empty() ? -1 : std::stoll(found[1]);
  }

  std::optional<Child> stream_;
  std::string err_, url_;
  std::uint16_t port_ = 0;
};

TEST_F(LivePageTest, ShowsACapturesRotationsAndEnds) {
  const std::size_t complaints = browser_->complaints().size();
  const std::size_t requests = browser_->requests().size();
  start({"--realtime", "--viewers", "3"});
  // One viewer never reads, one is this test, one the page.
  Socket silent(port_), reading(port_);
  ASSERT_EQ(silent.openLive(port_, "").substr(0, 12), "HTTP/1.1 101");
  ASSERT_EQ(reading.openLive(port_, "").substr(0, 12), "HTTP/1.1 101");
  browser_->open(url_);
  ASSERT_TRUE(waitForState("Live"));
  ASSERT_TRUE(browser_->waitFor("lisco.view.scan?.points > 1000"));
  EXPECT_EQ(browser_->evaluate("document.title"), "capture.pcap, vlp16");
  ASSERT_TRUE(waitForState("Ended"));
  std::size_t frames = 0;
  for (auto message = reading.receiveMessage(); message.first == 2; message = reading.receiveMessage()) ++frames;
  const Outcome outcome = stream_->end();
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_GT(frames, 5U);

  // What the page says is what the program says.
  EXPECT_EQ(status("state"), "ended");
  EXPECT_EQ(status("rotations"), statOf(outcome.out, "rotations +([0-9]+)"));
  EXPECT_EQ(status("columns"), statOf(outcome.out, "columns +([0-9]+)"));
  EXPECT_EQ(status("returns"), statOf(outcome.out, "returns +([0-9]+)"));
  EXPECT_EQ(status("clusters"), statOf(outcome.out, "clusters +([0-9]+), of"));
  EXPECT_EQ(status("in_clusters"), statOf(outcome.out, "clusters +[0-9]+, of ([0-9]+)"));
  EXPECT_EQ(status("packets"), statOf(outcome.out, "packets +([0-9]+)"));
  EXPECT_EQ(status("lost"), statOf(outcome.out, "([0-9]+) lost"));
  EXPECT_GT(status("latency_ms[2]").get<double>(), 0);
  EXPECT_GE(status("samples.length").get<int>(), 2);

  // The last rotation stays, with its clusters.
  const std::vector<std::string> rotations = rotationsOf(outcome.out);
  ASSERT_GE(rotations.size(), 10U);
  const long long clusters = statOf(rotations.back(), ", ([0-9]+) clusters");
  EXPECT_GT(clusters, 3);
  EXPECT_EQ(browser_->evaluate("lisco.view.labelling.clusters.length"), clusters);
  EXPECT_EQ(browser_->evaluate("document.querySelectorAll('#rows tr').length"), std::min(clusters, 200LL));
  EXPECT_EQ(browser_->evaluate("lisco.view.scan.points - lisco.view.labelling.ground"),
            statOf(rotations.back(), ", ([0-9]+) returns"));
  const std::string counts = browser_->evaluate("document.getElementById('counts').innerText");
  EXPECT_EQ(counts.rfind(std::to_string(rotations.size()) + ": " + std::to_string(clusters) + " clusters of ", 0), 0U)
      << counts;
  EXPECT_GT(browser_->evaluate("lisco.view.live.frames_shown").get<int>(), 1);
  browser_->key("t");  // the scene is not dead
  EXPECT_EQ(Json(std::vector<std::string>(browser_->complaints().begin() + static_cast<std::ptrdiff_t>(complaints),
                                          browser_->complaints().end())),
            Json::array());
  EXPECT_EQ(Json(std::vector<std::string>(browser_->requests().begin() + static_cast<std::ptrdiff_t>(requests),
                                          browser_->requests().end())),
            Json({"ws://127.0.0.1:" + std::to_string(port_) + "/live"}));

  // Viewers change nothing, not even those that do not read.
  const Child without(LISCO_STREAM, {"drive/capture.pcap", "--sensor", "vlp16", "--tolerance", "0.4"}, folder_);
  ASSERT_TRUE(Child::waitUntil([&] { return rotationsOf(without.out()).size() >= rotations.size(); }));
  EXPECT_EQ(rotationsOf(without.out()), rotations);
}

TEST_F(LivePageTest, ShowsWindowsAndEndlessClusters) {
  for (const std::vector<std::string>& mode :
       {std::vector<std::string>{"--mode", "windows", "--window", "900", "--hop", "100"},
        std::vector<std::string>{"--mode", "endless"}}) {
    std::vector<std::string> arguments = mode;
    for (const char* word : {"--viewers", "1"}) arguments.emplace_back(word);
    start(arguments);
    browser_->open(url_);
    ASSERT_TRUE(waitForState("Ended")) << mode[1];
    const Outcome outcome = stream_->end();
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(status("clusters"), statOf(outcome.out, "clusters +([0-9]+), of"));
    EXPECT_GT(browser_->evaluate("lisco.view.labelling.listed").get<int>(), 3) << mode[1];
    EXPECT_GT(browser_->evaluate("lisco.view.scan.points").get<int>(), 1000) << mode[1];
  }
}

TEST_F(LivePageTest, EndlessClustersKeepTheirIdsAndColours) {
  simulate("longer_drive", 30);
  start({"--mode", "endless", "--realtime", "--json", "--viewers", "2"}, "longer_drive/capture.pcap");
  browser_->open(url_);
  ASSERT_TRUE(browser_->waitFor("lisco.view?.live"));
  // The size and colour of each id in each frame, none of which is left out
  browser_->evaluate(
      "(() => { const {live} = lisco.view; window.seen = []; live.schedule = () => { const data = live.newest; "
      "live.newest = null; if (data) live.show(data); if (live.closed) live.end(); "
      "for (const c of lisco.view.scan?.labellings[0].clusters.filter(c => !c.open) ?? []) "
      "window.seen.push([c.name, c.size, c.color]); }; })()");
  Socket second(port_);  // the stream begins
  ASSERT_EQ(second.openLive(port_, "").substr(0, 12), "HTTP/1.1 101");
  ASSERT_TRUE(waitForState("Ended"));
  const Outcome outcome = stream_->end();
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  std::map<long long, long long> sizes;
  std::istringstream lines(outcome.out);
  for (std::string line; std::getline(lines, line);)
    if (const Json found = Json::parse(line); found.contains("id")) sizes[found["id"]] = found["size"];
  ASSERT_GT(sizes.size(), 20U);
  std::map<long long, Json> colors;
  std::size_t repeated = 0;
  for (const Json& cluster : browser_->evaluate("window.seen")) {
    const long long id = cluster[0];
    ASSERT_EQ(sizes.count(id), 1U) << id;
    EXPECT_EQ(cluster[1], sizes[id]) << id;
    if (!colors.emplace(id, cluster[2]).second) ++repeated;
    EXPECT_EQ(cluster[2], colors[id]) << id;
  }
  EXPECT_GT(colors.size(), 20U);
  EXPECT_GT(repeated, 0U);
  // Rows of the list are headed by ids, too.
  EXPECT_EQ(browser_->evaluate("document.querySelector('#rows tr').innerText.split('\\t')[0]"),
            browser_->evaluate("String(lisco.view.labelling.clusters[0].name)"));
}

TEST_F(LivePageTest, PlacesTheCameraByAWholeRotation) {
  const auto place = [] { return browser_->evaluate("lisco.view.camera.place()"); };
  start({"--realtime", "--viewers", "1"});
  browser_->open(url_);
  ASSERT_TRUE(browser_->waitFor("lisco.view?.live?.status?.whole"));
  const Json fitted = place();
  EXPECT_EQ(fitted, browser_->evaluate("lisco.view.placed"));
  ASSERT_TRUE(waitForState("Ended"));
  EXPECT_EQ(place(), fitted);
  // A fit to all points of a rotation reaches about as far.
  const double distance = browser_->evaluate("lisco.view.camera.distance");
  browser_->key("r");
  const double whole = browser_->evaluate("lisco.view.camera.distance");
  EXPECT_NEAR(distance / whole, 1, 0.2);
  EXPECT_EQ(stream_->end().status, 0);

  // A camera that the user has moved stays.
  start({"--realtime", "--viewers", "2"});
  browser_->open(url_);
  ASSERT_TRUE(browser_->waitFor("lisco.view?.live && document.getElementById('state').textContent !== ''"));
  browser_->evaluate(
      "new Promise(done => { const {live} = lisco.view; const show = live.show.bind(live); let first = true; "
      "live.show = data => { show(data); if (first && lisco.view.scan.points) { lisco.view.top(); "
      "window.moved = lisco.view.camera.place(); first = false; } }; done(1); })");
  Socket second(port_);
  ASSERT_EQ(second.openLive(port_, "").substr(0, 12), "HTTP/1.1 101");
  ASSERT_TRUE(browser_->waitFor("lisco.view.live.status?.whole"));
  EXPECT_EQ(place(), browser_->evaluate("window.moved"));
  stream_->signal(SIGINT);
  EXPECT_EQ(stream_->end().status, 0);
}

TEST_F(LivePageTest, AClickOnARowSelectsItWhileFramesCome) {
  start({"--realtime", "--viewers", "1"});
  browser_->open(url_);
  ASSERT_TRUE(browser_->waitFor("document.querySelectorAll('#rows tr').length > 3"));
  // The row that is pressed is the one that is released, some frames later.
  EXPECT_TRUE(browser_->evaluate(
      "(async () => { const row = document.querySelector('#rows tr:nth-child(2)'); row.focus(); "
      "const {rotations} = lisco.view.live.status; "
      "while (lisco.view.live.status.rotations < rotations + 2) await new Promise(requestAnimationFrame); "
      "return row.isConnected && document.activeElement === row; })()"));
  stream_->signal(SIGINT);
  EXPECT_EQ(stream_->end().status, 0);
}

/// Makes a picture for doc/view.md.
TEST_F(LivePageTest, IsDrawnWhileItRuns) {
  const char* const folder = std::getenv("LISCO_SCREENSHOTS");
  if (folder == nullptr) GTEST_SKIP() << "LISCO_SCREENSHOTS is not set";
  simulate("long_drive", 60);
  start({"--realtime", "--viewers", "1"}, "long_drive/capture.pcap");
  browser_->open(url_);
  ASSERT_TRUE(browser_->waitFor("lisco.view?.live?.status?.rotations >= 30"));
  browser_->saveScreenshot(std::filesystem::path(folder) / "live.png");
  EXPECT_TRUE(browser_->evaluate("document.getElementById('state').textContent === 'Live'"));
  stream_->signal(SIGINT);
  EXPECT_EQ(stream_->end().status, 0);
}

TEST_F(LivePageTest, PausesAndMeasures) {
  start({"--realtime", "--viewers", "1"});
  browser_->open(url_);
  ASSERT_TRUE(browser_->waitFor("lisco.view?.scan?.points > 1000"));
  browser_->key(" ");
  const Json frame = status("frame");
  EXPECT_EQ(stream_->end().status, 0);
  EXPECT_LE(status("frame").get<int>(), frame.get<int>() + 1);
  browser_->key(" ");
  EXPECT_TRUE(waitForState("Ended"));
  EXPECT_GT(status("frame").get<int>(), frame.get<int>());
}

TEST_F(LivePageTest, AForeignPageGetsNothing) {
  start({"--realtime", "--viewers", "1"});
  browser_->open("about:blank");
  EXPECT_EQ(
      browser_->evaluate("new Promise(done => { const socket = new WebSocket('ws://127.0.0.1:" + std::to_string(port_) +
                         "/live'); socket.onopen = () => done('open'); socket.onerror = () => done('refused'); })"),
      "refused");
  stream_->signal(SIGINT);
  EXPECT_EQ(stream_->end().status, 0);
}

TEST_F(LivePageTest, EndsByCtrlC) {
  start({"--realtime", "--viewers", "1"});
  browser_->open(url_);
  ASSERT_TRUE(browser_->waitFor("lisco.view?.scan?.points > 1000"));
  stream_->signal(SIGINT);
  const Outcome outcome = stream_->end();
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(waitForState("Ended"));
  EXPECT_EQ(status("columns"), statOf(outcome.out, "columns +([0-9]+)"));
}

}  // namespace
