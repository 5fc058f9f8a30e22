// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// What an extraction takes from the heap, apart from the clusters it returns. This program has its own malloc (), which
// counts and hands on to the C library's; operator new, Eigen's and PCL's allocations end there too.
#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <omp.h>

#include <pcl/segmentation/lisco_cluster_extraction.h>

#include "compare/comparison.h"
#include "compare/report.h"
#include "ground_heights.h"
#include "io/options.h"
#include "io/output_file.h"
#include "io/scan_file.h"
#include "io/text.h"

extern "C" {
// The C library's own ones, which it offers to those that replace malloc ().
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* memory);
}

namespace {

std::atomic<std::size_t> allocation_count{0};
std::atomic<std::ptrdiff_t> live_bytes{0};  ///< as large as malloc () made the pieces, a little more than was asked for
std::atomic<std::ptrdiff_t> peak_bytes{0};

void* taken(void* memory) {
  if (memory == nullptr) return nullptr;
  allocation_count.fetch_add(1, std::memory_order_relaxed);
  const auto size = static_cast<std::ptrdiff_t>(malloc_usable_size(memory));
  const std::ptrdiff_t live = live_bytes.fetch_add(size, std::memory_order_relaxed) + size;
  std::ptrdiff_t peak = peak_bytes.load(std::memory_order_relaxed);
  while (live > peak && !peak_bytes.compare_exchange_weak(peak, live, std::memory_order_relaxed)) {
  }
  return memory;
}

void givenBack(void* memory) {
  if (memory != nullptr)
    live_bytes.fetch_sub(static_cast<std::ptrdiff_t>(malloc_usable_size(memory)), std::memory_order_relaxed);
}

}  // namespace

extern "C" {

void* malloc(std::size_t size) noexcept {
  return taken(__libc_malloc(size));
}
void* calloc(std::size_t count, std::size_t size) noexcept {
  return taken(__libc_calloc(count, size));
}
void* realloc(void* memory, std::size_t size) noexcept {
  givenBack(memory);
  void* const moved = __libc_realloc(memory, size);
  if (moved == nullptr && size > 0 && memory != nullptr)  // it failed and left everything as it was
    live_bytes.fetch_add(static_cast<std::ptrdiff_t>(malloc_usable_size(memory)), std::memory_order_relaxed);
  return taken(moved);
}
void* memalign(std::size_t alignment, std::size_t size) noexcept {
  return taken(__libc_memalign(alignment, size));
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  return taken(__libc_memalign(alignment, size));
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
  *memory = taken(__libc_memalign(alignment, size));
  return *memory == nullptr ? ENOMEM : 0;
}
void free(void* memory) noexcept {
  givenBack(memory);
  __libc_free(memory);
}

}  // extern "C"

namespace {

namespace fs = std::filesystem;
namespace po = boost::program_options;
using namespace lisco_apps;

constexpr const char* kSignature = "input,rows,columns,cells,returns,ground_z,tolerance,min_size,clusters,index_bytes";

/// What was taken from the heap between two points.
struct Use {
  std::size_t allocations = 0;
  std::ptrdiff_t kept = 0;  ///< bytes that have been taken and not given back
  std::ptrdiff_t peak = 0;  ///< the most bytes that were so at one time
};

template <typename Run>
Use useOf(Run&& run) {
  const std::size_t allocations = allocation_count;
  const std::ptrdiff_t live = live_bytes;
  peak_bytes = live;
  run();
  return {allocation_count - allocations, live_bytes - live, peak_bytes - live};
}

/// What the indices of clusters hold, in bytes.
std::ptrdiff_t bytesOfIndices(const Clusters& clusters) {
  std::size_t bytes = 0;
  for (const pcl::PointIndices& cluster : clusters)
    if (cluster.indices.capacity() != 0) bytes += malloc_usable_size(const_cast<pcl::index_t*>(cluster.indices.data()));
  return static_cast<std::ptrdiff_t>(bytes);
}

/// How often such clusters have to be allocated: once for the indices of each, and for the vector of all, which starts
/// empty and grows by doubling: 1, 2, 4, ... Headers with a frame of 15 letters or less take nothing.
std::size_t allocationsOf(const Clusters& clusters) {
  std::size_t allocations = clusters.size();
  for (std::size_t capacity = 1, size = clusters.size(); size > 0; capacity *= 2) {
    ++allocations;
    if (capacity >= size) break;
  }
  return allocations;
}

/// What every class of PCL does before its own work: pcl::PCLBase lists the numbers of all points if it is given none.
class BaseAlone : public pcl::PCLBase<ComparedPoint> {
 public:
  void run(const ComparedCloud::ConstPtr& cloud) {
    setInputCloud(cloud);
    initCompute();
    deinitCompute();
  }
};

struct MemoryResult {
  double tolerance = 0;
  std::size_t clusters = 0;
  std::ptrdiff_t output = 0;  ///< bytes of the clusters' indices
  Use base;                   ///< of pcl::PCLBase in the first call
  std::ptrdiff_t kept = 0;    ///< that the extraction keeps for the next scan, without PCLBase's
  std::ptrdiff_t later = 0;   ///< the same after kLaterCalls
  std::ptrdiff_t most = 0;    ///< that it used at one time, beyond output and PCLBase's
  std::size_t needed = 0;     ///< allocations of the output, into an empty vector
  // Allocations beyond the output's, and in the first call beyond PCLBase's:
  std::ptrdiff_t first_beyond = 0;
  std::ptrdiff_t second_beyond = 0;  ///< PCLBase's included
  std::ptrdiff_t third_beyond = 0;   ///< the same, if the vector of clusters is cleared and given again
  bool identical = false;
};

/// Calls that follow the first three: more than lisco::FarHistory leaves range images out of at first.
constexpr int kLaterCalls = 20;

MemoryResult measure(const ComparedScan& scan, double tolerance, unsigned min_size) {
  Problem problem;
  problem.cloud = scan.cloud;
  problem.returns = scan.returns;
  problem.tolerance = tolerance;
  problem.min_size = min_size;
  Clusters expected;
  referenceBaseline().extract(problem, expected);

  MemoryResult result;
  result.tolerance = tolerance;
  result.clusters = expected.size();
  std::unique_ptr<pcl::LiscoClusterExtraction<ComparedPoint>> extraction;
  const auto extract = [&](Clusters& clusters) {
    extraction->setInputCloud(problem.cloud);
    extraction->setClusterTolerance(tolerance);
    extraction->setMinClusterSize(min_size);
    extraction->extract(clusters);
  };
  Clusters first, second, again;
  // The old arrays of a vector that grows are to be no part of the peak.
  first.reserve(expected.size());
  const Use creation = useOf([&] { extraction = std::make_unique<pcl::LiscoClusterExtraction<ComparedPoint>>(); });
  const Use first_use = useOf([&] { extract(first); });
  const Use second_use = useOf([&] { extract(second); });
  again = second;
  again.clear();
  const Use third_use = useOf([&] { extract(again); });
  const auto same = [&expected](const Clusters& clusters) {
    return std::equal(expected.begin(), expected.end(), clusters.begin(), clusters.end(),
                      [](const pcl::PointIndices& a, const pcl::PointIndices& b) {
                        return a.indices == b.indices && a.header.frame_id == b.header.frame_id &&
                               a.header.stamp == b.header.stamp && a.header.seq == b.header.seq;
                      });
  };
  bool are_later_same = true;
  const Use later_use = useOf([&] {
    for (int i = 0; i < kLaterCalls; ++i) {
      Clusters clusters;
      extract(clusters);
      are_later_same = are_later_same && same(clusters);
    }
  });

  // Whether the extraction did what PCLBase does shows in the indices that it has.
  if (extraction->getIndices() != nullptr && !extraction->getIndices()->empty()) {
    BaseAlone base;
    result.base = useOf([&] { base.run(problem.cloud); });
  }
  const auto beyond = [](std::size_t allocations, std::size_t needed) {
    return static_cast<std::ptrdiff_t>(allocations) - static_cast<std::ptrdiff_t>(needed);
  };
  result.output = bytesOfIndices(first);
  result.kept = creation.kept + first_use.kept - result.output - result.base.kept;
  result.later = result.kept + later_use.kept;
  result.most = creation.kept + first_use.peak - result.output - result.base.kept;
  result.needed = allocationsOf(second);
  result.first_beyond = beyond(creation.allocations + first_use.allocations, first.size() + result.base.allocations);
  result.second_beyond = beyond(second_use.allocations, result.needed);
  result.third_beyond = beyond(third_use.allocations, again.size());
  result.identical = same(first) && same(second) && same(again) && are_later_same;
  return result;
}

struct Options {
  std::vector<std::string> inputs;
  std::vector<double> tolerances;
  unsigned min_size = 10;
  PerInput<float> ground = groundHeights({});
  fs::path csv;
};

/// \return false if there is nothing to do but to print help or version, which has been done
bool parse(int argc, char** argv, Options& options) {
  po::options_description shown(
      "Usage: memory_use SCAN-OR-FOLDER... [options]\n\n"
      "What pcl::LiscoClusterExtraction takes from the heap, by counting all calls of malloc () in the program:\n"
      "  PCLBase  kept by the base class, which lists the numbers of all points; all of PCL's classes do\n"
      "  kept     kept for the next scan, beyond that; per cell of the cloud, as the two beside it\n"
      "  later    the same after 20 more calls, which may read the scan in other ways\n"
      "  most     at one time during the first call, beyond the clusters it returns and PCLBase's\n"
      "  output   allocations of the clusters: one for the indices of each, and those of the vector of clusters, "
      "which\n"
      "           grows from nothing by doubling (1, 2, 4, ...)\n"
      "  1st      allocations of a new object's first call beyond the output's and PCLBase's, with room for all "
      "clusters\n"
      "  2nd      those of its second call, on the same scan, beyond the output's; must be 0\n"
      "  reused   the same if the vector of clusters is cleared and used again, which needs not grow then\n"
      "Bytes are those of the pieces that malloc () has made, which may be a little larger than it was asked for.\n\n"
      "Exit code: 1 if the clusters are not those of EuclideanClusterExtraction or a call after the first allocates\n"
      "anything beyond the output, 2 on bad input or usage (1 goes before 2).\n\n"
      "Options");
  std::string tolerances = "0.4";
  std::string min_size = "10";
  std::vector<std::string> ground;
  std::string csv;
  // clang-format off
  shown.add_options()
    ("tolerance,t", po::value<std::string>(&tolerances)->value_name("M[,M...]"), "metres (default 0.4)")
    ("min-size", po::value<std::string>(&min_size)->value_name("N"), "least returns of a cluster (default 10)")
    ("ground-z", po::value<std::vector<std::string>>(&ground)->value_name("M"),
     "leave out returns below this height in metres; NAME=M: of the input of this name only")
    ("csv", po::value<std::string>(&csv)->value_name("FILE"), "write a row per input and tolerance");
  // clang-format on
  po::variables_map given;
  if (!readCommandLine(argc, argv, "memory_use", shown, &options.inputs, given)) return false;
  if (options.inputs.empty()) throw std::runtime_error("no input; see --help");
  for (const std::string& item : itemsOf(tolerances)) options.tolerances.push_back(toleranceOf(item));
  options.min_size = countOf(min_size, "--min-size", 1);
  options.ground = groundHeights(ground);
  if (given.count("csv") != 0 && csv.empty()) throw std::runtime_error("--csv is empty");
  options.csv = csv;
  return true;
}

/// Prints a scan's rows as they come.
/// \return whether all is as it must be
bool measureFile(const fs::path& file, const std::string& name, const Options& options, std::string& csv) {
  const float ground_z = options.ground.of(file.stem().string());
  const Cloud::Ptr cloud = readScan(file).cloud;
  ComparedScan scan;
  try {
    scan = prepareScan(*cloud, {}, returnsAbove(*cloud, ground_z), false);
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(file.string() + ": " + error.what());
  }
  const auto cells = static_cast<double>(scan.cloud->size());
  const auto perCell = [cells](std::ptrdiff_t bytes) { return static_cast<double>(bytes) / cells; };
  bool good = true;
  for (const double tolerance : options.tolerances) {
    const MemoryResult result = measure(scan, tolerance, options.min_size);
    const bool frugal = result.second_beyond <= 0 && result.third_beyond <= 0;
    good = good && result.identical && frugal;
    std::printf("%-18s %8zu %8zu %5.2f %8zu %7.1f %6.1f %6.1f %6.1f %7zu %6td %6td %6td  %s\n", name.c_str(),
                scan.cloud->size(), scan.returns->size(), tolerance, result.clusters, perCell(result.base.kept),
                perCell(result.kept), perCell(result.later), perCell(result.most), result.needed, result.first_beyond,
                result.second_beyond, result.third_beyond, result.identical ? "yes" : "NO");
    std::fflush(stdout);
    csv += formatted("\"%s\",%u,%u,%zu,%zu,%g,%g,%u,%zu,%td,%td,%zu,%td,%td,%td,%zu,%td,%td,%td,%s\n", name.c_str(),
                     scan.cloud->height, scan.cloud->width, scan.cloud->size(), scan.returns->size(),
                     static_cast<double>(ground_z), tolerance, options.min_size, result.clusters, result.output,
                     result.base.kept, result.base.allocations, result.kept, result.later, result.most, result.needed,
                     result.first_beyond, result.second_beyond, result.third_beyond, result.identical ? "yes" : "no");
  }
  return good;
}

int run(const Options& options) {
  std::vector<std::string> failures;
  const std::vector<fs::path> files = expandInputs(options.inputs, failures);
  const std::vector<std::string> names = namesOf(files);
  if (!options.csv.empty()) checkMayWrite(options.csv, kSignature);
  std::string csv =
      std::string(kSignature) +
      ",base_bytes,base_allocations,kept_bytes,later_bytes,most_bytes,output_allocations,first_allocations_beyond,"
      "second_allocations_beyond,reused_allocations_beyond,identical\n";
  CompareSettings untimed;
  untimed.runs = 0;
  std::fputs(describeRun(untimed).c_str(), stdout);
  std::printf("%-18s %8s %8s %5s %8s %28s %7s %20s\n", "", "", "", "", "", "bytes per cell", "", "allocations beyond");
  std::printf("%-18s %8s %8s %5s %8s %7s %6s %6s %6s %7s %6s %6s %6s  %s\n", "scan", "cells", "returns", "eps",
              "clusters", "PCLBase", "kept", "later", "most", "output", "1st", "2nd", "reused", "identical");
  bool good = true;
  std::size_t measured = 0;
  for (std::size_t i = 0; i < files.size(); ++i) {
    try {
      good = measureFile(files[i], names[i], options, csv) && good;
      ++measured;
    } catch (const std::exception& error) {
      failures.emplace_back(error.what());
    }
  }
  for (const std::string& failure : failures) std::fprintf(stderr, "memory_use: %s\n", failure.c_str());
  if (measured > 0 && !options.csv.empty()) writeOwnFile(options.csv, csv, kSignature);
  if (!good) {
    std::fprintf(stderr, "memory_use: wrong clusters, or allocations beyond the output after the first call\n");
    return 1;
  }
  return failures.empty() ? 0 : 2;
}

}  // namespace

int main(int argc, char** argv) {
  omp_set_num_threads(1);  // as lisco_compare
  return runProgram("memory_use", [&] {
    Options options;
    return parse(argc, argv, options) ? run(options) : 0;
  });
}
