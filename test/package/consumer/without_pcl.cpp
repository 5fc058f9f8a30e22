// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// A program for the engine alone, which reads a sensor column by column.
#include <cstdint>
#include <cstdio>

#include "lisco/column_clusterer.h"
#include "lisco/label_clusters.h"
#include "lisco/version.h"

int main() {
  lisco::ColumnClusterer clusterer;
  lisco::Parameters parameters;
  parameters.tolerance = 0.3F;
  clusterer.begin(parameters);
  for (std::uint32_t step = 0; step < 3; ++step) {
    const float y = 0.2F * static_cast<float>(step);
    const lisco::Return column[] = {{5.0F, y, 0.0F, 2 * step}, lisco::kNoReturn, {9.0F, y, 1.0F, 2 * step + 1}};
    clusterer.addColumn(column, 3);
  }
  clusterer.update();
  bool right = clusterer.returnCount() == 6;
  clusterer.forEachRun([&](const std::uint32_t* source_indices, std::size_t count, std::uint32_t subcluster) {
    for (std::size_t i = 1; i < count; ++i) right = right && source_indices[i] % 2 == source_indices[0] % 2;
    right = right && clusterer.sizeOf(subcluster) == 3;
  });
  const float points[] = {5.0F, 0.0F, 0.0F, 9.0F, 0.0F, 1.0F, 5.0F, 0.2F, 0.0F};
  std::int32_t labels[3];
  lisco::LabelParameters label_parameters;
  label_parameters.tolerance = 0.3F;
  right = right && lisco::labelClusters(points, 3, 3 * sizeof(float), label_parameters, labels) == 2 &&
          labels[0] == 0 && labels[1] == 1 && labels[2] == 0;
  std::printf("lisco %s: %s\n", LISCO_VERSION, right ? "two subclusters, as expected" : "not as expected");
  return right ? 0 : 1;
}
