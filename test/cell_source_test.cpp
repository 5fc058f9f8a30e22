// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lisco/column_clusterer.h"
#include "lisco/return.h"

namespace lisco_test {
namespace {

using lisco::CellSource;
using lisco::Return;

Return cellAt(std::size_t laser, std::size_t column) {
  const auto step = static_cast<float>(column);
  return {5.0F + 0.1F * step, static_cast<float>(laser), column % 7 < 3 ? 1.0F : 4.0F,
          static_cast<std::uint32_t>(1000 * laser + column)};
}

TEST(CellSource, ReadsCellsAndBlocksEqually) {
  std::size_t calls = 0;
  const auto cells = [](std::size_t laser, std::size_t column) { return cellAt(laser, column); };
  auto blocks = [&calls](std::size_t laser, std::size_t first, std::size_t count, const CellSource::Destination& to) {
    ++calls;
    for (std::size_t i = 0; i < count; ++i) {
      const Return cell = cellAt(laser, first + i);
      to.x[i] = cell.x;
      to.y[i] = cell.y;
      to.z[i] = cell.z;
      to.source_index[i] = cell.source_index;
    }
  };
  const CellSource by_cell(cells);
  const CellSource by_block(blocks);
  for (const CellSource* source : {&by_cell, &by_block}) {
    std::array<float, 5> x{}, y{}, z{};
    std::array<std::uint32_t, 5> source_index{};
    source->read(3, 40, 5, {x.data(), y.data(), z.data(), source_index.data()});
    for (std::size_t i = 0; i < 5; ++i) {
      EXPECT_EQ(x[i], cellAt(3, 40 + i).x);
      EXPECT_EQ(y[i], cellAt(3, 40 + i).y);
      EXPECT_EQ(z[i], cellAt(3, 40 + i).z);
      EXPECT_EQ(source_index[i], cellAt(3, 40 + i).source_index);
    }
    EXPECT_EQ(source->at(2, 9).source_index, cellAt(2, 9).source_index);
  }
  EXPECT_EQ(calls, 2U);

  std::vector<std::vector<std::uint32_t>> found;
  const auto cluster = [&](const auto& source) {
    lisco::ColumnClusterer clusterer;
    lisco::Parameters parameters;
    parameters.tolerance = 0.5F;
    clusterer.begin(parameters);
    clusterer.addColumns(60, 4, source);
    clusterer.update();
    std::vector<std::uint32_t>& runs = found.emplace_back();
    clusterer.forEachRun([&](const std::uint32_t* names, std::size_t count, std::uint32_t subcluster) {
      runs.insert(runs.end(), names, names + count);
      runs.push_back(subcluster);
    });
  };
  calls = 0;
  cluster(cells);
  cluster(blocks);
  EXPECT_EQ(calls, 4U);  // per laser and block of 64 columns
  EXPECT_GT(found[0].size(), 4U * 60U);
  EXPECT_EQ(found[0], found[1]);
}

}  // namespace
}  // namespace lisco_test
