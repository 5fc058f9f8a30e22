// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// Clusters scan files and writes the clusters as tables, clouds and pictures.
#include <algorithm>
#include <condition_variable>
#include <cstdio>
#include <iostream>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include <pcl/features/lisco_cluster_features.h>
#include <pcl/segmentation/lisco_cluster_extraction.h>
#include <boost/program_options.hpp>

#include "io/clock.h"
#include "io/cloud_file.h"
#include "io/cluster_json.h"
#include "io/clusters.h"
#include "io/interruption.h"
#include "io/options.h"
#include "io/result_files.h"
#include "io/scan_file.h"
#include "io/scan_options.h"
#include "io/scan_returns.h"
#include "io/terminal_line.h"
#include "recordings/result_bag.h"
#include "recordings/scan_source.h"
#include "recordings/work_progress.h"
#include "view/clustered_view.h"
#include "view/scan_encoder.h"
#include "view/timeline.h"

namespace {

namespace po = boost::program_options;
using namespace lisco_apps;

struct Options {
  std::vector<std::string> inputs;
  InputOptions input;
  ClusterOptions clustering;
  fs::path output;
  fs::path bag;
  ScanOptions scan{"slope", true};
  ResultKinds kinds;
  bool json = false;
  unsigned threads = 1;  ///< files clustered at the same time
};

/// \return false if --help or --version was given
bool parse(int argc, char** argv, Options& options) {
  po::options_description shown(
      "Usage: lisco_cluster INPUT... --tolerance M [options]\n\n"
      "Finds the Euclidean clusters of LiDAR scans: the clusters of PCL's EuclideanClusterExtraction.\n"
      "An input is\n"
      "  - a scan: .pcd, .ply, .bin (KITTI's, nuScenes' and others' floats), .npy (N x 3 or more, or rows x columns x "
      "3\n"
      "    or more), the paper authors' .csv; or a folder of scans\n"
      "  - a recording, each of whose clouds (sensor_msgs/PointCloud2) or rotations (packets, with --sensor) is a "
      "scan:\n"
      "    .db3 and .mcap of ROS 2, or the folder of such a bag; .bag of ROS 1; .pcap, .pcapng, .cap\n"
      "An unorganized cloud with a field `ring`, or sorted laser by laser, is arranged in rows first, in which\n"
      "the ground is found; the clusters do not depend on it. Ctrl-C ends the program after the scans it has begun.\n\n"
      "Options");
  options.clustering.addTo(shown);
  options.input.addTo(shown);
  options.scan.addTo(shown);
  std::string write;
  bool clouds = false;
  // clang-format off
  shown.add_options()
    ("threads", countOption("--threads", options.threads, 0, 1024),
     "cluster N files at the same time (default 1; 0: one per processor)")
    ("output,o", pathOption("DIR", "--output", options.output),
     "folder for the results; with several inputs, a folder in it for each; of a recording, a folder in it for each "
     "message or rotation, of its number and time; then DIR/view.html shows them all as a timeline (up to 64 MB)")
    ("bag", pathOption("FILE.mcap", "--bag", options.bag),
     "write the labelled clouds (sensor_msgs/PointCloud2) and oriented boxes (visualization_msgs/MarkerArray) as a "
     "recording of ROS 2; scans without a time are 0.1 s apart")
    ("write", po::value<std::string>(&write)->value_name("A,B,..."),
     "the results to write (default labels,table,pictures,view): labels (labels.pcd: the input's fields, `label`, the "
     "cluster's id or 0, and, if --ground leaves out any, `ground`, 1 for its returns; an input's own become "
     "`input_label` and `input_ground`), table (clusters.csv), pictures (range_image.png and top_view.png), view "
     "(view.html, a page for browsers), clouds (one PCD per cluster, with the input's fields), json (clusters.json), "
     "semantickitti (labels.label: the id as instance, class 49 for ground and 0 for all others; and labels.npy)")
    ("clouds", po::bool_switch(&clouds), "also write one cloud per cluster")
    ("json", po::bool_switch(&options.json), "print a line of JSON for each scan instead of text");
  // clang-format on
  po::variables_map given;
  if (!readCommandLine(argc, argv, "lisco_cluster", shown, &options.inputs, given)) return false;
  if (options.inputs.empty()) throw std::runtime_error("no input; see --help");
  options.clustering.check();
  options.input.check();
  options.scan.check();
  if (options.threads == 0) options.threads = std::max(1U, std::thread::hardware_concurrency());
  if (given.count("write") != 0) options.kinds = resultKindsOf(write);
  if (given.count("write") != 0 && options.output.empty()) throw std::runtime_error("--write needs --output");
  if (clouds && options.output.empty()) throw std::runtime_error("--clouds needs --output");
  options.kinds.clouds = options.kinds.clouds || clouds;
  return true;
}

/// Milliseconds of the steps of one scan.
struct StepTimes {
  double read, ground, cluster, write;
};

/// Prints the result for one scan as a line of JSON.
void printJson(const ClusteredScan& scan, const fs::path& file, const StepTimes& times) {
  Json json = jsonOf(scan);
  json["file"] = file.string();
  json["time_ms"] = {{"read", times.read}, {"ground", times.ground}, {"cluster", times.cluster}};
  std::printf("%s\n", lineOf(json).c_str());
}

/// Part of the tolerance above which the rounding of coordinates is noted, such as that of map coordinates.
constexpr double kMaxRounding = 0.25;

/// \return empty if the tolerance is well above the rounding of coordinates
std::string roundingNote(const ClusteredScan& scan) {
  const auto rounding = static_cast<double>(roundingOf(*scan.cloud, scan.returns.clustered));
  if (rounding <= kMaxRounding * scan.tolerance) return {};
  return formatted("coordinates as large as these are rounded to multiples of %g m: subtract an offset first",
                   rounding);
}

/// Prints the result for one scan.
void printSummary(const ClusteredScan& scan, const StepTimes& times, const fs::path& folder) {
  const Cloud& cloud = *scan.cloud;
  const std::size_t returns = scan.returns.returns;
  const std::size_t clustered = scan.returns.clustered.size();
  std::size_t in_clusters = 0;
  for (const auto& cluster : scan.clusters) in_clusters += cluster.indices.size();

  std::printf("%s\n", scan.name.c_str());
  if (!scan.note.empty()) std::printf("  read      %s\n", scan.note.c_str());
  if (cloud.height > 1)
    std::printf("  scan      %u rows x %u columns, %zu returns\n", cloud.height, cloud.width, returns);
  else
    std::printf("  scan      unorganized, %zu points, %zu returns\n", cloud.size(), returns);
  std::fputs(describe(scan.returns, scan.ground).c_str(), stdout);
  const std::string sizes =
      scan.max_size ? formatted("%u to %u", scan.min_size, *scan.max_size) : formatted("at least %u", scan.min_size);
  std::printf("  clusters  %zu of %s returns within %g m of each other; %zu returns are noise%s\n",
              scan.clusters.size(), sizes.c_str(), scan.tolerance, clustered - in_clusters,
              scan.max_size ? " or in larger ones" : "");
  if (!scan.clusters.empty()) {  // sorted by size
    const auto sizeOf = [&](std::size_t i) { return static_cast<double>(scan.clusters[i].indices.size()); };
    const std::size_t last = scan.clusters.size() - 1;
    std::printf("  sizes     largest %.0f, median %g, smallest %.0f\n", sizeOf(0),
                (sizeOf(last / 2) + sizeOf((last + 1) / 2)) / 2, sizeOf(last));
  }
  if (!scan.clusters.empty() && 2 * scan.clusters.front().indices.size() > clustered)
    std::printf(
        "  note      one cluster has more than half of these returns: is it the ground (see --ground), or is the "
        "tolerance too large?\n");
  if (const std::string note = roundingNote(scan); !note.empty()) std::printf("  note      %s\n", note.c_str());
  std::printf("  time      read %.1f ms, ground %.2f ms, cluster %.2f ms", times.read, times.ground, times.cluster);
  if (!folder.empty()) std::printf(", write %.1f ms\n  written   %s", times.write, folder.c_str());
  std::printf("\n");
}

/// Names the folder of each input's results: none if there is one input, which is no recording.
class ResultFolders {
 public:
  ResultFolders(const fs::path& output, const std::vector<fs::path>& files)
      : output_(output), is_single_(files.size() == 1), names_(namesOf(files)) {}

  /// \return empty if no results are written
  fs::path of(const ScanItem& item) const {
    if (output_.empty()) return {};
    const fs::path folder = is_single_ ? output_ : output_ / names_[item.input];
    return item.folder.empty() ? folder : folder / item.folder;
  }

 private:
  fs::path output_;
  bool is_single_;
  std::vector<std::string> names_;
};

/// A clustered scan as a recording has it.
/// \param number of the scan, from 0
LabelledScan labelledScanOf(const ClusteredScan& scan, std::int64_t time_ns, std::size_t number) {
  constexpr std::int64_t kPeriodNs = 100000000;
  const Cloud& cloud = *scan.cloud;
  LabelledScan labelled;
  labelled.time_ns = time_ns > 0 ? time_ns : kPeriodNs * static_cast<std::int64_t>(number);
  labelled.frame = cloud.header.frame_id.empty() ? "lidar" : cloud.header.frame_id;
  labelled.rows = cloud.height;
  labelled.columns = cloud.width;
  for (const pcl::PointXYZ& point : cloud) labelled.points.push_back({point.x, point.y, point.z});
  labelled.labels = labelsOf(scan.clusters, cloud.size());
  if (scan.isGroundKnown()) labelled.ground = groundOf(scan);
  for (const lisco::ClusterFeatures& features : scan.features)
    labelled.boxes.push_back({static_cast<std::uint32_t>(labelled.boxes.size() + 1), features.box});
  return labelled;
}

/// Turns a scan that was clustered as arranged by rings into that of the input's points, in their order: results are of
/// these, the range image is of the rows.
void toInputOrder(const Scan& input, ClusteredScan& scan) {
  if (!input.arranged) return;
  auto rows = std::make_shared<ClusteredScan>(scan);
  scan.cloud = input.cloud;
  input.toInputOrder(scan.clusters);
  for (pcl::Indices* const indices : {&scan.returns.clustered, &scan.returns.ground}) {
    for (auto& index : *indices) index = input.point_of_cell[static_cast<std::size_t>(index)];
    std::sort(indices->begin(), indices->end());
  }
  pcl::Indices cell_of_point(input.cloud->size(), pcl::UNAVAILABLE);
  for (std::size_t cell = 0; cell < input.point_of_cell.size(); ++cell)
    if (const auto point = input.point_of_cell[cell]; point != pcl::UNAVAILABLE)
      cell_of_point[static_cast<std::size_t>(point)] = static_cast<pcl::index_t>(cell);
  rows->clusters = scan.clusters;  // equal sizes may have changed their order
  for (auto& cluster : rows->clusters)
    for (auto& index : cluster.indices) index = cell_of_point[static_cast<std::size_t>(index)];
  scan.arranged = std::move(rows);
}

/// Threads that share the scans of the inputs.
class Workers {
 public:
  Workers(const Options& options, ScanSource& source)
      : options_(options),
        source_(source),
        folders_(options.output, source.files()),
        progress_(source.hasRecording() || source.files().size() > 1) {
    if (!options.bag.empty()) bag_.emplace(options.bag, "lisco_cluster");
    if (source.hasRecording() || source.files().size() > 1) {
      if (options.kinds.view && !options.output.empty()) timeline_.emplace(options.output / "view.html");
    }
    source_.onNote([this](const std::string& note) { say(note); });
  }

  /// \return whether all scans succeeded
  bool run() {
    std::vector<std::thread> others;
    try {
      while (others.size() + 1 < options_.threads) others.emplace_back([this] { work(); });
    } catch (const std::system_error&) {  // no more threads than these
    }
    work();
    for (std::thread& other : others) other.join();
    progress_.clear();
    if (bag_) {
      bag_->finish();
      sayWritten(options_.bag);
    }
    if (const std::string page = timeline_ ? timeline_->write() : ""; !page.empty()) sayWritten(page);
    if (Interruption::happened() && !is_over_) {
      say(formatted("interrupted after %zu scans, whose results are complete", done_));
      all_well_ = false;
    }
    return all_well_;
  }

 private:
  /// The next scan. \return nothing at the end, or after an interruption
  std::optional<ScanItem> take(std::size_t& number) {
    const std::lock_guard<std::mutex> reading(reading_);
    if (Interruption::happened() || is_over_) return std::nullopt;
    std::optional<ScanItem> item = source_.next();
    is_over_ = !item;
    number = taken_++;
    if (item) {
      const std::lock_guard<std::mutex> lock(terminal_);
      progress_.show(source_.share(), item->name, number);
    }
    return item;
  }

  void work() {
    pcl::LiscoClusterExtraction<pcl::PointXYZ> extraction;
    extraction.setClusterTolerance(options_.clustering.tolerance);
    extraction.setMinClusterSize(options_.clustering.min_size);
    extraction.setMaxClusterSize(options_.clustering.max_size);
    std::size_t number = 0;
    while (const std::optional<ScanItem> item = take(number)) {
      try {
        clusterScan(*item, number, extraction);
        const std::lock_guard<std::mutex> lock(terminal_);
        ++done_;
      } catch (const std::exception& error) {
        awaitTurn(number);
        say(error.what());
        const std::lock_guard<std::mutex> lock(terminal_);
        all_well_ = false;
      }
      endTurn();
    }
  }

  /// Waits until all scans before this one are reported: results come in the order of the inputs.
  void awaitTurn(std::size_t number) {
    std::unique_lock<std::mutex> lock(terminal_);
    turn_ended_.wait(lock, [&] { return reported_ == number; });
  }

  void endTurn() {
    const std::lock_guard<std::mutex> lock(terminal_);
    ++reported_;
    turn_ended_.notify_all();
  }

  void say(const std::string& line) {
    const std::lock_guard<std::mutex> lock(terminal_);
    progress_.clear();
    std::cerr << "lisco_cluster: " << line << '\n';
  }

  void sayWritten(const std::string& file) const {
    if (!options_.json) std::printf("written     %s\n", file.c_str());
  }

  void clusterScan(const ScanItem& item, std::size_t number, pcl::LiscoClusterExtraction<pcl::PointXYZ>& extraction) {
    const auto start = Clock::now();
    const Scan input = item.read();
    ClusteredScan scan;
    scan.name = item.name;
    scan.note = input.note;
    scan.tolerance = options_.clustering.tolerance;
    scan.min_size = options_.clustering.min_size;
    scan.max_size = options_.clustering.maxSize();
    scan.ground = options_.scan.ground.of(item.file.stem().string());
    scan.cloud = input.clustered();
    scan.fields = input.fields;
    if (scan.cloud->empty()) fail(item.file, (item.folder.empty() ? "" : item.folder + ": ") + "holds no points");

    const auto read = Clock::now();
    scan.returns = returnsOf(*scan.cloud, scan.ground, options_.scan.region, item.of_packets);

    const auto ground = Clock::now();
    extraction.setInputCloud(scan.cloud);
    extraction.setIndices(std::make_shared<const pcl::Indices>(scan.returns.clustered));
    extraction.extract(scan.clusters);

    const auto clustered = Clock::now();
    toInputOrder(input, scan);
    const fs::path folder = folders_.of(item);
    if (options_.json || !folder.empty() || bag_) {
      pcl::LiscoClusterFeatures<pcl::PointXYZ> estimation;
      estimation.setInputCloud(scan.cloud);
      estimation.compute(scan.clusters, scan.features);
    }
    const std::string left_out = folder.empty() ? "" : writeResults(scan, folder, options_.kinds);
    if (!left_out.empty()) say(left_out);
    std::optional<LabelledScan> labelled;
    if (bag_) labelled = labelledScanOf(scan, item.time_ns, number);
    std::string viewed;
    if (timeline_) viewed = encodeViewScan(viewScanOf(scan));
    const auto written = Clock::now();

    awaitTurn(number);
    if (const std::string note = options_.json ? roundingNote(scan) : ""; !note.empty()) say(scan.name + ": " + note);
    const std::lock_guard<std::mutex> lock(terminal_);
    all_well_ = all_well_ && left_out.empty();
    if (labelled) bag_->write(*labelled);
    if (timeline_) timeline_->add(number, std::move(viewed));
    progress_.clear();
    const StepTimes times{millisecondsOf(read - start), millisecondsOf(ground - read),
                          millisecondsOf(clustered - ground), millisecondsOf(written - clustered)};
    if (options_.json)
      printJson(scan, item.file, times);
    else
      printSummary(scan, times, folder);
  }

  const Options& options_;
  std::mutex reading_;  ///< guards the members up to terminal_; taken before that
  ScanSource& source_;
  std::size_t taken_ = 0;
  bool is_over_ = false;
  const ResultFolders folders_;
  std::mutex terminal_;  ///< guards the terminal and the members after it
  std::condition_variable turn_ended_;
  std::size_t reported_ = 0;  ///< scans
  WorkProgress progress_;
  std::optional<ResultBag> bag_;
  std::optional<ViewTimeline> timeline_;
  std::size_t done_ = 0;
  bool all_well_ = true;
};

}  // namespace

int main(int argc, char** argv) {
  return runProgram("lisco_cluster", [&] {
    Options options;
    if (!parse(argc, argv, options)) return 0;
    Interruption::listen();
    ScanSource source(options.inputs, options.input, Interruption::happened);
    for (const std::string& line : options.scan.unknownNames(source.files()))
      std::cerr << "lisco_cluster: " << line << '\n';
    return Workers(options, source).run() ? 0 : 2;
  });
}
