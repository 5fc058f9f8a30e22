// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "bodies.h"
#include "engine.h"
#include "random.h"

namespace lisco_test {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct Target {
  const char* name;
  void (*body)(const std::uint8_t*, std::size_t);
  std::uint64_t random_inputs;
};

class Fuzz : public testing::TestWithParam<Target> {
 protected:
  static void expectNoFinding(const Bytes& input, const std::string& what) {
    try {
      GetParam().body(input.data(), input.size());
    } catch (const std::exception& finding) {
      ADD_FAILURE() << what << ": " << finding.what();
    }
  }
};

INSTANTIATE_TEST_SUITE_P(Bodies, Fuzz,
                         testing::Values(Target{"engine", fuzzEngine, 6000}, Target{"stream", fuzzStream, 6000},
                                         Target{"ground", fuzzGround, 2000}, Target{"readers", fuzzReaders, 2000},
                                         Target{"recordings", fuzzRecordings, 2000},
                                         Target{"packets", fuzzPackets, 6000}, Target{"hesai", fuzzHesai, 6000},
                                         Target{"ouster", fuzzOuster, 6000}, Target{"http", fuzzHttp, 6000}),
                         [](const auto& target) { return std::string(target.param.name); });

std::vector<Bytes> corpus() {
  const std::filesystem::path folder = std::filesystem::path(LISCO_FUZZ_CORPUS) / Fuzz::GetParam().name;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<Bytes> inputs;
  for (const std::filesystem::path& file : files) {
    std::ifstream stream(file, std::ios::binary);
    inputs.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }
  return inputs;
}

TEST_P(Fuzz, AcceptsTheCorpus) {
  const std::vector<Bytes> inputs = corpus();
  EXPECT_FALSE(inputs.empty());
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    expectNoFinding(inputs[i], "file " + std::to_string(i) + " of the corpus, in the order of names");
    if (HasFailure()) return;
  }
}

// Random bytes, and the corpus with some of its bytes changed.
TEST_P(Fuzz, AcceptsAnyBytes) {
  const std::vector<Bytes> inputs = corpus();
  for (std::uint64_t seed = 1; seed <= timesEffort(GetParam().random_inputs); ++seed) {
    Random random(seed);
    Bytes input(random.below(300));
    for (std::uint8_t& byte : input) byte = static_cast<std::uint8_t>(random.below(256));
    if (!inputs.empty() && random.chance(0.7)) {
      input = random.oneOf(inputs);
      for (std::size_t i = 0; i < input.size() / 20 + 1 && !input.empty(); ++i)
        input[random.below(input.size())] = static_cast<std::uint8_t>(random.below(256));
    }
    expectNoFinding(input, "seed " + std::to_string(seed));
    if (HasFailure()) return;
  }
}

}  // namespace
}  // namespace lisco_test
