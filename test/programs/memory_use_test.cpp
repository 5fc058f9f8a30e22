// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// memory_use, run as a program.
#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "program_test.h"

namespace {

class MemoryUse : public ProgramTest {
 protected:
  MemoryUse() : ProgramTest(MEMORY_USE) {}

  /// The rows of a table by the names of their columns.
  std::vector<std::map<std::string, std::string>> rowsIn(const std::string& name) const {
    std::istringstream lines(textOf(folder_ / name));
    std::vector<std::string> columns;
    std::vector<std::map<std::string, std::string>> rows;
    for (std::string line; std::getline(lines, line);) {
      std::istringstream cells(line);
      std::vector<std::string> values;
      for (std::string cell; std::getline(cells, cell, ',');) values.push_back(cell);
      if (columns.empty()) {
        columns = values;
        continue;
      }
      EXPECT_EQ(values.size(), columns.size()) << line;
      auto& row = rows.emplace_back();
      for (std::size_t i = 0; i < std::min(values.size(), columns.size()); ++i) row[columns[i]] = values[i];
    }
    return rows;
  }
};

TEST_F(MemoryUse, SeparatesTheOutputFromOtherMemory) {
  ASSERT_EQ(
      runLine(std::string(LISCO_SIMULATE) + " --case singletons --sensor vlp16 --drop-outs 0 -o apart.pcd").status, 0);
  ASSERT_EQ(runLine(std::string(LISCO_SIMULATE) + " --case wall --sensor vlp16 --drop-outs 0 -o wall.pcd").status, 0);
  const Outcome outcome = run("apart.pcd wall.pcd --tolerance 0.4 --min-size 1 --csv memory.csv");
  const auto rows = rowsIn("memory.csv");
  ASSERT_EQ(rows.size(), 2U) << outcome.err;
  constexpr double kCells = 16 * 1808;
  for (const auto& row : rows) {
    const auto number = [&row](const char* column) { return std::stod(row.at(column)); };
    SCOPED_TRACE(row.at("input"));
    EXPECT_EQ(number("cells"), kCells);
    EXPECT_EQ(number("returns"), kCells);
    EXPECT_EQ(row.at("identical"), "yes");
    // Every return is in a cluster, and malloc () rounds sizes up.
    EXPECT_GE(number("index_bytes"), 4 * kCells);
    EXPECT_LE(number("index_bytes"), 4 * kCells + 24 * number("clusters") + 8192);
    const double growth = 1 + std::ceil(std::log2(number("clusters")));
    EXPECT_EQ(number("output_allocations"), number("clusters") + growth);
    EXPECT_GT(number("kept_bytes"), 0);
    EXPECT_GE(number("most_bytes"), number("kept_bytes"));
    EXPECT_GT(number("later_bytes"), 0);
    EXPECT_GT(number("first_allocations_beyond"), 0);
    EXPECT_LE(number("second_allocations_beyond"), 0);
    EXPECT_GE(number("second_allocations_beyond"), -growth) << "unless a vector was allocated at its final size";
    EXPECT_EQ(number("reused_allocations_beyond"), 0);
  }
  EXPECT_EQ(rows[0].at("clusters"), "28928");
  EXPECT_EQ(rows[1].at("clusters"), "1");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
}

TEST_F(MemoryUse, PrintsHelpAndRefusesBadOptions) {
  const Outcome help = run("--help");
  EXPECT_EQ(help.status, 0);
  for (const char* word : {"Usage: memory_use", "--tolerance", "--csv", "PCLBase", "must be 0"})
    EXPECT_NE(help.out.find(word), std::string::npos) << word;
  expectRefusal("", {"no input"});
  expectRefusal("nowhere.pcd", {"nowhere.pcd"});
  for (const char* tolerance : {"0", "-1", "nan", "wide", "0.1,"})
    expectRefusal(std::string("nowhere.pcd --tolerance=") + tolerance, {"--tolerance"});
  expectRefusal("nowhere.pcd --min-size=0", {"--min-size"});
  write("mine.csv", "my own table\n");
  ASSERT_EQ(runLine(std::string(LISCO_SIMULATE) + " --case wall --steps 50 -o wall.pcd").status, 0);
  expectRefusal("wall.pcd --csv mine.csv", {"mine.csv", "not written by this program"});
}

}  // namespace
