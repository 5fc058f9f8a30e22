// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "compare/comparison.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>

#include <pcl/common/io.h>

namespace lisco_apps {
namespace {

std::size_t affordableRuns(double tried_ms, const CompareSettings& settings) {
  constexpr double kMinRuns = 3;
  const double affordable = std::max(kMinRuns, std::floor(settings.max_seconds * 1000 / std::max(tried_ms, 1e-3)));
  return static_cast<std::size_t>(std::min(affordable, static_cast<double>(settings.runs)));
}

std::optional<double> speedUp(const BaselineResult* reference, const BaselineResult& result,
                              std::vector<double> Times::*runs) {
  if (reference == nullptr || !reference->times || !result.times) return std::nullopt;
  return median((*reference->times).*runs) / median((*result.times).*runs);
}

}  // namespace

bool CompareSettings::mustAgree(const Baseline& baseline) const {
  return std::find(must_agree.begin(), must_agree.end(), baseline.key) != must_agree.end();
}

const BaselineResult* CaseResult::find(const std::string& key) const {
  const auto found =
      std::find_if(baselines.begin(), baselines.end(), [&](const auto& r) { return r.baseline->key == key; });
  return found == baselines.end() ? nullptr : &*found;
}

std::optional<double> CaseResult::ratio(const BaselineResult& result) const {
  return speedUp(find(kReferenceKey), result, &Times::runs);
}

std::optional<double> CaseResult::coldRatio(const BaselineResult& result) const {
  return speedUp(find(kReferenceKey), result, &Times::cold);
}

ComparedScan prepareScan(const Cloud& cloud, std::vector<std::uint32_t> object_of, const pcl::Indices& clustered,
                         bool unorganized) {
  ComparedScan scan;
  scan.returns = std::make_shared<pcl::Indices>(clustered);
  if (scan.returns->empty()) throw std::runtime_error("no returns to cluster");
  scan.cloud = std::make_shared<ComparedCloud>();
  scan.object_of = std::move(object_of);
  if (!unorganized) {
    pcl::copyPointCloud(cloud, *scan.cloud);
    auto next = clustered.begin();
    for (std::size_t i = 0; i < scan.cloud->size(); ++i) {
      if (next != clustered.end() && static_cast<std::size_t>(*next) == i) {
        ++next;
        continue;
      }
      auto& point = (*scan.cloud)[i];
      point.x = point.y = point.z = std::numeric_limits<float>::quiet_NaN();
    }
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
                     const std::function<void(const std::string&, double)>& progress,
                     const std::function<void(const Baseline&, const Clusters&)>& report) {
  Problem problem;
  problem.cloud = scan.cloud;
  problem.returns = scan.returns;
  problem.tolerance = tolerance;
  problem.min_size = settings.min_size;

  const Baseline reference = referenceBaseline();
  CaseResult result;
  result.tolerance = tolerance;
  Clusters expected;
  progress(reference.title, 0);
  const double reference_ms = runMs([&] { reference.extract(problem, expected); });
  result.clusters = expected.size();
  if (!scan.object_of.empty()) result.objects = scoreObjects(problem, expected, scan.object_of);

  std::vector<Contestant> contestants;
  std::vector<BaselineResult*> results;  // of the contestants
  result.baselines.reserve(settings.baselines.size());
  for (const Baseline& baseline : settings.baselines) {
    BaselineResult& entry = result.baselines.emplace_back();
    entry.baseline = &baseline;
    if (baseline.needs_rows && scan.cloud->height < 2) {
      entry.failure = "needs an organized cloud";
      continue;
    }
    progress(baseline.title, 0);
    Clusters found;
    double tried_ms = reference_ms;
    try {
      if (baseline.key == kReferenceKey)
        found = expected;
      else
        tried_ms = runMs([&] { baseline.extract(problem, found); });
    } catch (const std::exception& error) {
      entry.failure = error.what();
      continue;
    }
    entry.clusters = found.size();
    report(baseline, found);
    entry.difference = differenceOf(problem, reference, expected, baseline, found, settings.locate);
    if (settings.runs == 0 || !baseline.timed || (!entry.difference.identical && settings.mustAgree(baseline)))
      continue;
    if (settings.runs == 1 && tried_ms >= kMaxShort) {
      entry.times = Times{{tried_ms}, {tried_ms}};
      continue;
    }
    contestants.push_back({runOf(baseline, problem), tried_ms, affordableRuns(tried_ms, settings)});
    results.push_back(&entry);
  }

  const std::vector<Times> times = timeInTurn(contestants, TimeKind::kWall, [&](std::size_t round, std::size_t rounds) {
    progress("run " + std::to_string(round + 1) + " of " + std::to_string(rounds),
             static_cast<double>(round) / static_cast<double>(rounds));
  });
  for (std::size_t i = 0; i < times.size(); ++i) results[i]->times = times[i];
  return result;
}

}  // namespace lisco_apps
