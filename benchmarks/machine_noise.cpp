// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// How much other work disturbs this machine: times a fixed loop on all cores, again and again.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

#include <omp.h>

#include "io/options.h"

namespace {

namespace po = boost::program_options;
using namespace lisco_apps;

struct Options {
  unsigned seconds = 60;
  double limit = 5;  ///< percent
};

/// \return false if there is nothing to do but to print help or version, which has been done
bool parse(int argc, char** argv, Options& options) {
  po::options_description shown(
      "Usage: machine_noise [options]\n\n"
      "Times a fixed loop of some milliseconds on each core, once a second, and prints by how much the loops exceed\n"
      "the fastest one: their median and their 90th percentile.\n\n"
      "Exit code: 0 if the percentile is at most --limit, 1 if it is above, 2 on bad usage.\n\n"
      "Options");
  std::string seconds = "60", limit = "5";
  // clang-format off
  shown.add_options()
    ("seconds", po::value<std::string>(&seconds)->value_name("S"), "duration, 10 or more (default 60)")
    ("limit", po::value<std::string>(&limit)->value_name("PERCENT"), "of a quiet machine (default 5)");
  // clang-format on
  po::variables_map given;
  if (!readCommandLine(argc, argv, "machine_noise", shown, nullptr, given)) return false;
  options.seconds = countOf(seconds, "--seconds", 10);
  options.limit = numberOf(limit, "--limit");
  return true;
}

/// A chain of multiplications, which no compiler shortens. \return milliseconds
double timeLoop() {
  const auto start = std::chrono::steady_clock::now();
  volatile std::uint32_t seed = 1;
  std::uint32_t value = seed;
  for (int i = 0; i < 5'000'000; ++i) value = value * 1664525U + 1013904223U;
  seed = value;
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

int run(const Options& options) {
  std::vector<double> loops(static_cast<std::size_t>(omp_get_num_procs()) * options.seconds);
  std::size_t measured = 0;
  for (unsigned second = 0; second < options.seconds; ++second) {
    const auto next = std::chrono::steady_clock::now() + std::chrono::seconds(1);
#pragma omp parallel num_threads(omp_get_num_procs())
    {
      const double ms = timeLoop();
#pragma omp critical
      if (measured < loops.size()) loops[measured++] = ms;
    }
    std::this_thread::sleep_until(next);
  }
  loops.resize(measured);
  std::sort(loops.begin(), loops.end());
  const auto excess = [&](std::size_t percent) {
    return 100 * (loops[(loops.size() - 1) * percent / 100] / loops.front() - 1);
  };
  std::printf(
      "noise: a loop of %.1f ms, %zu times in %u s: median %.1f %% and 90th percentile %.1f %% over the least\n",
      loops.front(), loops.size(), options.seconds, excess(50), excess(90));
  return excess(90) <= options.limit ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  return lisco_apps::runProgram("machine_noise", [&] {
    Options options;
    return parse(argc, argv, options) ? run(options) : 0;
  });
}
