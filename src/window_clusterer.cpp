// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "lisco/window_clusterer.h"

#include <algorithm>
#include <stdexcept>

namespace lisco {

void WindowClusterer::begin(const WindowParameters& parameters) {
  const std::size_t hop = parameters.hop_columns;
  if (hop == 0 || parameters.window_columns < hop || parameters.window_columns % hop != 0)
    throw std::invalid_argument("lisco::WindowClusterer: the window must be a multiple of the hop, 1 or more");
  if (!begun_) *this = WindowClusterer();
  begun_ = false;
  parameters_ = parameters;
  tolerance_ = Tolerance(parameters.tolerance);
  // One more than a window has, so that its panes last while the next one is filled.
  panes_.resize(std::max(panes_.size(), parameters.window_columns / hop + 1));
  newest_ = oldest_ = 0;
  pane(newest_).clear(tolerance_);
  pane(newest_).edges.clear();
  block_.clear();
  pane_columns_ = 0;
  sizes_.clear();
  columns_ = returns_ = 0;
  begun_ = true;
}

bool WindowClusterer::addColumn(const Return* cells, std::size_t lasers) {
  if (!begun_) throw std::logic_error("lisco::WindowClusterer: a column before begin (), or after an exception");
  if (parameters_.lasers != 0 && lasers > parameters_.lasers)
    throw std::invalid_argument("lisco::WindowClusterer: a column of more cells than lasers were declared");
  begun_ = false;  // unless nothing is thrown
  block_.add(0, 1, lasers, [cells](std::size_t laser, std::size_t) { return cells[laser]; });
  const bool pane_ends = pane_columns_ + block_.columns() == parameters_.hop_columns;
  if (pane_ends || block_.columns() == Row::kColumns) {
    const auto first_column = static_cast<std::uint32_t>(pane_columns_);
    pane_columns_ += block_.columns();
    pane(newest_).read(block_, first_column, tolerance_, FarRange(),
                       [](const Row&, const MeasuredRow& measured) { return measured.returns; });
  }
  if (pane_ends) finishPane();
  begun_ = true;
  return pane_ends;
}

/// Gives the subclusters of a pane their numbers.
void WindowClusterer::numberSubclusters(WindowPane& pane) {
  pane.voxels.link(pane.subclusters);
  pane.voxels.settle();
  pane.sizes.clear();
  std::vector<Runs::Run>& runs = pane.runs.runs;
  for (std::uint32_t i = 0; i < runs.size(); ++i) {
    const std::uint32_t head = pane.subclusters.head(i);  // the first of its set
    if (head == i) {
      runs[i].subcluster = static_cast<std::uint32_t>(pane.sizes.size());
      pane.sizes.push_back(0);
    } else {
      runs[i].subcluster = runs[head].subcluster;
    }
    pane.sizes[runs[i].subcluster] += runs[i].count;
  }
}

/// Joins subclusters of the newest pane with those of an older one, and remembers it there.
class WindowClusterer::PaneJoiner : public Voxels::Joiner {
 public:
  PaneJoiner(WindowClusterer& clusterer, std::uint64_t older) : clusterer_(clusterer), older_(clusterer.pane(older)) {}

  bool areApart(std::uint32_t own, std::uint32_t others) override {
    return clusterer_.window_.head(newest_.first_element + newest_.runs.runs[own].subcluster) !=
           clusterer_.window_.head(older_.first_element + older_.runs.runs[others].subcluster);
  }

  void join(std::uint32_t own, std::uint32_t others) override {
    const Edge edge{older_.runs.runs[others].subcluster, newest_.runs.runs[own].subcluster, clusterer_.newest_};
    clusterer_.window_.merge(older_.first_element + edge.older_subcluster,
                             newest_.first_element + edge.newer_subcluster);
    older_.edges.push_back(edge);
  }

 private:
  WindowClusterer& clusterer_;
  WindowPane& newest_{clusterer_.pane(clusterer_.newest_)};
  WindowPane& older_;
};

/// Joins a pane with all newer ones, which have been joined with each other.
void WindowClusterer::join(WindowPane& older) {
  const auto isOfUse = [&](const Edge& edge) {
    const std::uint32_t a = older.first_element + edge.older_subcluster;
    const std::uint32_t b = pane(edge.newer_pane).first_element + edge.newer_subcluster;
    const bool apart = window_.head(a) != window_.head(b);
    if (apart) window_.merge(a, b);
    return apart;
  };
  older.edges.erase(std::remove_if(older.edges.begin(), older.edges.end(), [&](const Edge& e) { return !isOfUse(e); }),
                    older.edges.end());
}

void WindowClusterer::finishPane() {
  numberSubclusters(pane(newest_));
  if (newest_ - oldest_ == parameters_.window_columns / parameters_.hop_columns) ++oldest_;

  std::uint32_t elements = 0;
  returns_ = 0;
  for (std::uint64_t number = oldest_; number != newest_ + 1; ++number) {
    pane(number).first_element = elements;
    elements += static_cast<std::uint32_t>(pane(number).sizes.size());
    returns_ += pane(number).runs.returns;
  }
  window_.reset(elements);
  for (std::uint32_t element = 0; element < elements; ++element) window_.create(element);
  for (std::uint64_t number = newest_; number != oldest_; --number) {
    join(pane(number - 1));
    PaneJoiner joiner(*this, number - 1);
    pane(newest_).voxels.linkTo(pane(number - 1).voxels, Voxels::Part::kAll, joiner);
  }

  sizes_.clear();
  subcluster_of_element_.resize(elements);
  for (std::uint64_t number = oldest_; number != newest_ + 1; ++number)
    for (std::uint32_t i = 0; i < pane(number).sizes.size(); ++i) {
      const std::uint32_t element = pane(number).first_element + i;
      const std::uint32_t head = window_.head(element);
      if (head == element) {
        subcluster_of_element_[element] = static_cast<std::uint32_t>(sizes_.size());
        sizes_.push_back(0);
      } else {
        subcluster_of_element_[element] = subcluster_of_element_[head];
      }
      sizes_[subcluster_of_element_[element]] += pane(number).sizes[i];
    }
  columns_ = (newest_ - oldest_ + 1) * parameters_.hop_columns;

  ++newest_;
  pane(newest_).clear(tolerance_);
  pane(newest_).edges.clear();
  pane_columns_ = 0;
}

}  // namespace lisco
