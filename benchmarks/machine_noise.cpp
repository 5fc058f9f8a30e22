// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// How much other work disturbs this machine: times a fixed loop on each processor, again and again.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <sched.h>

#include "io/options.h"

namespace {

namespace po = boost::program_options;
using namespace lisco_apps;

struct Options {
  unsigned seconds = 60;
  double limit = 10;  ///< percent; an idle virtual machine has 3 to 10, one with a busy thread 80
};

/// \return false if there is nothing to do but to print help or version, which has been done
bool parse(int argc, char** argv, Options& options) {
  po::options_description shown(
      "Usage: machine_noise [options]\n\n"
      "Times a fixed loop of some milliseconds on each processor, once a second, and prints by how much the loops "
      "exceed\n"
      "the fastest one: their median and their 90th percentile.\n\n"
      "Exit code: 0 if the percentile is at most --limit, 1 if it is above, 2 on bad usage.\n\n"
      "Options");
  std::string seconds = "60", limit = "10";
  // clang-format off
  shown.add_options()
    ("seconds", po::value<std::string>(&seconds)->value_name("S"), "duration, 10 or more (default 60)")
    ("limit", po::value<std::string>(&limit)->value_name("PERCENT"), "of a quiet machine (default 10)");
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

/// The processors that the program may use.
std::vector<std::size_t> allowedProcessors() {
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) throw std::runtime_error("the processors are unknown");
  std::vector<std::size_t> processors;
  for (std::size_t i = 0; i < CPU_SETSIZE; ++i)
    if (CPU_ISSET(i, &allowed)) processors.push_back(i);
  return processors;
}

/// Continues on a processor.
void moveTo(std::size_t processor) {
  cpu_set_t only;
  CPU_ZERO(&only);
  CPU_SET(processor, &only);
  if (sched_setaffinity(0, sizeof only, &only) != 0) throw std::runtime_error("a processor cannot be chosen");
}

int run(const Options& options) {
  const std::vector<std::size_t> processors = allowedProcessors();
  std::vector<double> loops;
  for (unsigned second = 0; second < options.seconds; ++second) {
    const auto next = std::chrono::steady_clock::now() + std::chrono::seconds(1);
    // One after the other: two processors may share a core.
    for (const std::size_t processor : processors) {
      moveTo(processor);
      loops.push_back(timeLoop());
    }
    std::this_thread::sleep_until(next);
  }
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
