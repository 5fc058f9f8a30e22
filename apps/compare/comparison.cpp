// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "compare/comparison.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>

#include <pcl/common/io.h>

namespace lisco_apps {
namespace {

/// A rival's clusters, and how long it took to find them.
double tryOut(const Rival& rival, const Problem& problem, Clusters& clusters) {
  return millisecondsOf([&] { rival.extract(problem, clusters); });
}

std::size_t affordableRuns(double tried_ms, const CompareSettings& settings) {
  constexpr double kLeast = 3;
  const double affordable = std::max(kLeast, std::floor(settings.max_seconds * 1000 / std::max(tried_ms, 1e-3)));
  return static_cast<std::size_t>(std::min(affordable, static_cast<double>(settings.runs)));
}

}  // namespace

bool CompareSettings::mustAgree(const Rival& rival) const {
  return std::find(must_agree.begin(), must_agree.end(), rival.key) != must_agree.end();
}

const RivalResult* CaseResult::find(const std::string& key) const {
  const auto found = std::find_if(rivals.begin(), rivals.end(), [&](const auto& r) { return r.rival->key == key; });
  return found == rivals.end() ? nullptr : &*found;
}

std::optional<double> CaseResult::ratio(const RivalResult& result) const {
  const RivalResult* const reference = find(kReferenceKey);
  if (reference == nullptr || !reference->times || !result.times) return std::nullopt;
  return median(reference->times->runs) / median(result.times->runs);
}

std::optional<double> CaseResult::coldRatio(const RivalResult& result) const {
  const RivalResult* const reference = find(kReferenceKey);
  if (reference == nullptr || !reference->times || !result.times) return std::nullopt;
  return median(reference->times->cold) / median(result.times->cold);
}

ComparedScan prepareScan(const Cloud& cloud, std::vector<std::uint32_t> object_of, float ground_z, bool unorganized) {
  ComparedScan scan;
  scan.returns = std::make_shared<pcl::Indices>(returnsAbove(cloud, ground_z));
  if (scan.returns->empty()) throw std::runtime_error("no returns to cluster");
  scan.cloud = std::make_shared<RivalCloud>();
  scan.object_of = std::move(object_of);
  if (!unorganized) {
    pcl::copyPointCloud(cloud, *scan.cloud);
    for (auto& point : *scan.cloud)
      if (!(point.z >= ground_z)) point.x = point.y = point.z = std::numeric_limits<float>::quiet_NaN();
    scan.cloud->is_dense = scan.returns->size() == scan.cloud->size();
    return scan;
  }
  pcl::copyPointCloud(cloud, *scan.returns, *scan.cloud);
  for (std::size_t i = 0; i < scan.returns->size(); ++i) {
    auto& index = (*scan.returns)[i];
    if (!scan.object_of.empty()) scan.object_of[i] = scan.object_of[static_cast<std::size_t>(index)];
    index = static_cast<pcl::index_t>(i);
  }
  return scan;
}

CaseResult compareAt(const ComparedScan& scan, double tolerance, const CompareSettings& settings,
                     const std::function<void(const std::string&, double)>& progress) {
  Problem problem;
  problem.cloud = scan.cloud;
  problem.returns = scan.returns;
  problem.tolerance = tolerance;
  problem.min_size = settings.min_size;

  const Rival reference = referenceRival();
  CaseResult result;
  result.tolerance = tolerance;
  Clusters expected;
  progress(reference.title, 0);
  const double reference_ms = tryOut(reference, problem, expected);
  result.clusters = expected.size();
  if (!scan.object_of.empty()) result.objects = scoreObjects(problem, expected, scan.object_of);

  std::vector<Contestant> contestants;
  std::vector<std::size_t> contestant_of;
  for (const Rival& rival : settings.rivals) {
    RivalResult& entry = result.rivals.emplace_back();
    entry.rival = &rival;
    if (rival.needs_rows && scan.cloud->height < 2) {
      entry.failure = "needs an organized cloud";
      continue;
    }
    progress(rival.title, 0);
    Clusters found;
    double tried_ms = reference_ms;
    try {
      if (rival.key == kReferenceKey)
        found = expected;
      else
        tried_ms = tryOut(rival, problem, found);
    } catch (const std::exception& error) {
      entry.failure = error.what();
      continue;
    }
    entry.clusters = found.size();
    entry.difference = differenceOf(problem, reference, expected, rival, found);
    if (settings.runs == 0 || !rival.timed || (!entry.difference.identical && settings.mustAgree(rival))) continue;
    contestants.push_back({[&rival, &problem] {
                             Clusters clusters;
                             rival.extract(problem, clusters);
                           },
                           tried_ms, affordableRuns(tried_ms, settings)});
    contestant_of.push_back(result.rivals.size() - 1);
  }

  const std::vector<Times> times = timeInTurn(contestants, [&](std::size_t round, std::size_t rounds) {
    progress("run " + std::to_string(round + 1) + " of " + std::to_string(rounds),
             static_cast<double>(round) / static_cast<double>(rounds));
  });
  for (std::size_t i = 0; i < times.size(); ++i) result.rivals[contestant_of[i]].times = times[i];
  return result;
}

}  // namespace lisco_apps
