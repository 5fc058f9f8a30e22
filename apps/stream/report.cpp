// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "stream/report.h"

#include <cmath>
#include <cstdio>
#include <string>

#include "io/cluster_json.h"
#include "io/options.h"
#include "io/point_geometry.h"
#include "io/text.h"
#include "sensors/laser.h"

namespace lisco_apps {
namespace {

constexpr const char* kWindow = "window";

/// For %llu.
unsigned long long number(std::uint64_t count) {
  return count;
}

constexpr double kPerTurn = 1e5, kPerMillisecond = 1e4;

double secondsOf(std::int64_t time_us) {
  return static_cast<double>(time_us) / 1e6;
}

/// Degrees clockwise, 0 <= azimuth < 360.
double azimuthAt(double position) {
  return std::fmod(rounded(360 * (position - std::floor(position)), kPerDegree), 360.);
}
double azimuthOf(double x, double y) {
  return azimuthAt(std::atan2(-y, x) / (360 * kRadiansPerDegree));
}

/// The number of returns and the box of the largest cluster.
std::string describeLargest(const lisco::ClusterFeatures& largest) {
  if (largest.size == 0) return ", largest 0";
  return formatted(", largest %zu (%.1f x %.1f x %.1f m)", largest.size, largest.box.length, largest.box.width,
                   largest.box.height);
}

/// \param is_first of those with ground
std::string groundOf(const Turn& turn, bool is_first) {
  if (turn.ground == 0) return "";
  return formatted(", %llu of the ground left out", number(turn.ground)) +
         (is_first ? " (--ground none keeps them)" : "");
}

std::string lostIn(const Turn& turn) {
  return turn.lost > 0 ? formatted(", %llu packets lost", number(turn.lost)) : "";
}

}  // namespace

void Report::print(const std::string& line) {
  if (shares_terminal_) status_.clear();
  std::fputs(line.c_str(), stdout);
  std::fputc('\n', stdout);
  unflushed_ = true;
}

void Report::flush() {
  if (!unflushed_) return;
  unflushed_ = false;
  flushOutput();
  if (shares_terminal_ && !shown_.empty()) status_.show(shown_);
}

void Report::count(const FoundCluster& cluster) {
  ++totals_.clusters;
  ++clusters_of_turn_;
  totals_.in_clusters += cluster.features.size;
  if (cluster.features.size > largest_of_turn_.size) largest_of_turn_ = cluster.features;
}

std::string Report::countTurn(const char* name, const Turn& turn) {
  ++totals_.turns;
  totals_.columns += turn.columns();
  totals_.returns += turn.returns;
  const bool is_first_ground = totals_.ground == 0;
  totals_.ground += turn.ground;
  return formatted("%s %llu: %zu columns, %llu returns", name, number(turn.number), turn.columns(),
                   number(turn.returns)) +
         groundOf(turn, is_first_ground);
}

void Report::found(const Turn& turn, const std::vector<FoundCluster>& clusters, Clock::duration latency) {
  if (turn.is_window) span_ = kWindow;
  const std::string heading = countTurn(span_, turn);
  for (const FoundCluster& cluster : clusters) count(cluster);
  if (clouds_ != nullptr) clouds_->write(turn);
  if (on_found_) on_found_(turn, clusters);
  if (format_ == Format::kText) {
    print(heading + formatted(", %zu clusters", clusters.size()) + describeLargest(largest_of_turn_) +
          formatted(", after %.2f ms", millisecondsOf(latency)) + lostIn(turn));
  } else {
    Json json{{span_, turn.number},
              {"time", secondsOf(turn.time_us)},
              {"azimuth", azimuthAt(turn.azimuth / 360)},
              {"columns", turn.columns()},
              {"returns", turn.returns},
              {"ground", turn.ground},
              {"lost_packets", turn.lost},
              {"latency_ms", rounded(millisecondsOf(latency), kPerMillisecond)},
              {"clusters", Json::array()}};
    for (const FoundCluster& cluster : clusters) {
      const auto& centroid = cluster.features.centroid;
      Json of_cluster{{"id", cluster.id}, {"azimuth", azimuthOf(centroid[0], centroid[1])}};
      addFeatures(of_cluster, cluster.features);
      json["clusters"].push_back(std::move(of_cluster));
    }
    print(json.dump());
  }
  clusters_of_turn_ = 0;
  largest_of_turn_ = {};
}

void Report::cluster(const DeliveredCluster& cluster) {
  count(cluster.found);
  if (cluster.is_cut) ++totals_.cut;
  if (cluster.is_continued) ++totals_.continued;
  if (format_ == Format::kText) return;
  const double sense = cluster.turns_clockwise ? 1 : -1;
  Json json{{"id", cluster.found.id},
            {"time", secondsOf(cluster.time_us)},
            {"first_azimuth", azimuthAt(sense * cluster.first_position)},
            {"last_azimuth", azimuthAt(sense * cluster.last_position)},
            {"turns", rounded(cluster.last_position - cluster.first_position, kPerTurn)}};
  addFeatures(json, cluster.found.features);
  json["cut"] = cluster.is_cut;
  json["continued"] = cluster.is_continued;
  json["latency_ms"] = cluster.latency ? Json(rounded(millisecondsOf(*cluster.latency), kPerMillisecond)) : Json();
  print(json.dump());
}

void Report::turnEnds(const Turn& turn) {
  const std::string heading = countTurn("turn", turn);
  if (format_ == Format::kText)
    print(heading + formatted(", %llu clusters delivered", number(clusters_of_turn_)) +
          describeLargest(largest_of_turn_) + lostIn(turn));
  clusters_of_turn_ = 0;
  largest_of_turn_ = {};
}

void Report::turnIsLabelled(const Turn& turn) {
  if (clouds_ != nullptr) clouds_->write(turn);
}

void Report::showStatus(const Decoder& decoder, const Stream& stream, const PacketSource* file) {
  constexpr std::chrono::milliseconds kMinPause{200};
  const auto now = Clock::now();
  if (!status_.isShown() || now - shown_at_ < kMinPause) return;
  shown_at_ = now;
  const Decoder::Counts& counts = decoder.counts();
  const Latency& latency = stream.clusterLatency();
  if (counts.data == 0)
    shown_ =
        formatted("no data yet; %llu position packets, %llu foreign", number(counts.position), number(counts.foreign));
  else
    shown_ =
        formatted("%llu %ss, %llu columns, packets: %llu lost, %llu late; %llu clusters, ms: p50 %.2f, p99 %.2f",
                  number(totals_.turns), span_, number(counts.columns), number(counts.missing), number(counts.late),
                  number(totals_.clusters), latency.percentileMs(0.5), latency.percentileMs(0.99));
  if (file != nullptr) {
    const double share = file->share();
    const double seconds = std::chrono::duration<double>(now - start_).count();
    const std::string rate =
        seconds > 1 ? formatted("%.1f a second, ", static_cast<double>(totals_.turns) / seconds) : "";
    shown_ = formatted("%d%%, ", static_cast<int>(100 * share)) + timeLeft(seconds, share) + rate + shown_;
  }
  status_.show(shown_);
}

void Report::warn(const std::string& text) {
  status_.clear();
  std::fprintf(stderr, "lisco_stream: %s\n", text.c_str());
}

void Report::warnOfOutliers(const Stream& stream) {
  constexpr double kMany = 0.05;  // of the returns
  const auto outliers = static_cast<double>(stream.outliers().value_or(0));
  const auto returns = static_cast<double>(totals_.returns);
  if (outliers > kMany * returns)
    warn(
        formatted("%.0f %% of the returns are not at the azimuth of their column and in no cluster (outliers): is "
                  "this a rotating sensor? --mode rotation clusters all",
                  100 * outliers / returns));
}

void Report::printStatistics(const PacketSource& source, const Decoder& decoder, const Stream& stream) {
  flush();
  shown_.clear();
  status_.clear();
  const auto rowOf = [](const char* name, const Latency& latency) {
    return formatted("  %-9s p50 %.5f, p99 %.5f, max %.5f (%llu times)\n", name, latency.percentileMs(0.5),
                     latency.percentileMs(0.99), latency.maxMs(), number(latency.count()));
  };
  const Decoder::Counts& counts = decoder.counts();
  const double per_second = decoder.turnUs() > 0 ? 1e6 / decoder.turnUs() : 0;
  std::string table;
  if (decoder.lasers() > 0) {
    table = formatted("sensor      %s, %zu lasers, %.0f columns a turn, %.2f turns a second\n", decoder.name().c_str(),
                      decoder.lasers(), decoder.columnsPerTurn(), per_second);
    table += formatted("packets     %llu data, %llu position, %llu foreign, %llu lost, %llu late\n",
                       number(counts.data), number(counts.position), number(counts.foreign + source.foreign()),
                       number(counts.missing), number(counts.late));
  } else {
    table = formatted("clouds      %llu\n", number(counts.data));
  }
  if (counts.dual > 0) table += formatted("            %llu with two returns per laser\n", number(counts.dual));
  if (counts.says_other_model > 0)
    table += formatted("            %llu name another model of sensor\n", number(counts.says_other_model));
  if (counts.clock_jumps > 0)
    table += formatted("            the sensor's clock was set %llu times\n", number(counts.clock_jumps));
  table += formatted("%-11s %llu\ncolumns     %llu\nreturns     %llu", (std::string(span_) + "s").c_str(),
                     number(totals_.turns), number(totals_.columns), number(totals_.returns));
  if (totals_.ground > 0)
    table += formatted(" and %llu of the ground, left out; --ground none keeps them", number(totals_.ground));
  if (span_ == kWindow) table += "; columns of several windows count as often";
  table += formatted("\nclusters    %llu, of %llu returns\n", number(totals_.clusters), number(totals_.in_clusters));
  const std::optional<std::uint64_t> outliers = stream.outliers();
  if (outliers)
    table += formatted("            %llu cut after a turn, %llu continued; %llu outliers\n", number(totals_.cut),
                       number(totals_.continued), number(*outliers));
  table += "latency in ms\n" + rowOf("column", stream.columnLatency()) +
           rowOf(outliers ? "delivery" : span_, stream.clusterLatency());
  std::fputs(table.c_str(), format_ == Format::kJson ? stderr : stdout);
  unflushed_ = true;
  flush();
}

}  // namespace lisco_apps
