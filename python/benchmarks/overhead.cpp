// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// overhead POINTS ROWS COLUMNS TOLERANCE: labels a file of float32 x y z, row by row, once for each line on stdin, and
// prints the seconds of processor time it takes. The C++ side of overhead.py.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "lisco/label_clusters.h"

/// Processor time of this thread.
static double threadSeconds() {
  std::timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  try {
    const std::size_t rows = std::stoul(argv[2]), columns = std::stoul(argv[3]);
    std::vector<float> points(3 * rows * columns);
    std::ifstream file(argv[1], std::ios::binary);
    file.read(reinterpret_cast<char*>(points.data()), static_cast<std::streamsize>(points.size() * sizeof(float)));
    if (!file) return 2;
    lisco::LabelParameters parameters;
    parameters.tolerance = std::stof(argv[4]);
    parameters.min_size = 10;
    parameters.lasers = rows;
    const auto cell_at = [&](std::size_t laser, std::size_t column) {
      const float* const point = points.data() + 3 * (laser * columns + column);
      return lisco::Return{point[0], point[1], point[2], 0};
    };
    lisco::ClusterLabeller labeller;
    std::string line;
    while (std::getline(std::cin, line)) {
      const double start = threadSeconds();
      std::vector<std::int32_t> labels(rows * columns);
      labeller.label(labels.size(), cell_at, parameters, labels.data());
      std::printf("%.9f\n", threadSeconds() - start);
      std::fflush(stdout);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "overhead: %s\n", error.what());
    return 2;
  }
  return 0;
}
