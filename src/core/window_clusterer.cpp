// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "lisco/window_clusterer.h"

#include <algorithm>
#include <stdexcept>
#include <vector>

#include "core/column_block.h"
#include "core/disjoint_sets.h"
#include "core/laser_order.h"
#include "core/partition.h"
#include "core/run_selection.h"
#include "core/runs.h"
#include "core/simd.h"

namespace lisco {

/// The panes of the last window and the one that is being filled.
class WindowClusterer::Window {
 public:
  void begin(const WindowParameters& parameters);
  bool addColumn(const Return* cells, std::size_t lasers);

  bool isUsable() const { return usable_; }
  std::size_t columnCount() const { return columns_; }
  std::size_t returnCount() const { return returns_; }
  std::size_t subclusterCount() const { return sizes_.size(); }
  const std::uint32_t* sizes() const { return sizes_.data(); }
  void visitRuns(const RunVisitor& visit, const SizeRange& sizes);

 private:
  /// A subcluster of an older pane and one of a newer pane that hold neighbours.
  struct Edge {
    std::uint32_t older_subcluster, newer_subcluster;
    std::uint64_t newer_pane;  ///< its number
  };
  struct Pane : Partition {
    DisjointSets subclusters;               ///< of its runs
    std::vector<std::uint32_t> subcluster;  ///< of each run
    std::vector<std::uint32_t> sizes;       ///< of its subclusters
    std::vector<Edge> edges;                ///< to newer panes
    std::uint32_t first_in_window = 0;      ///< element of its first subcluster in the window's forest
  };
  class EdgeFinder;

  Pane& pane(std::uint64_t number) { return panes_[number % panes_.size()]; }
  void startPane();
  void readBlock();
  void finishPane();
  void numberWithin(Pane& pane);
  void placePanes();
  void linkPanes();
  void keepUsefulEdges(Pane& older);
  void numberSubclusters();

  WindowParameters parameters_;
  std::size_t max_lasers_ = 0;  ///< so that a window's cells have numbers
  Tolerance tolerance_;
  bool usable_ = false;  ///< begun, and left by no exception since
  ColumnBlock block_;
  std::vector<Pane> panes_;       ///< a ring
  std::uint64_t newest_ = 0;      ///< number of the pane that is being filled
  std::uint64_t oldest_ = 0;      ///< of the window
  std::size_t pane_columns_ = 0;  ///< read into the newest
  DisjointSets window_;           ///< of the panes' subclusters
  std::vector<std::uint32_t> subcluster_of_element_;
  std::vector<std::uint32_t> sizes_;
  std::size_t columns_ = 0;
  std::size_t returns_ = 0;
  LaserOrder order_;
};

void WindowClusterer::Window::begin(const WindowParameters& parameters) {
  const std::size_t hop = parameters.hop_columns;
  if (hop == 0 || parameters.window_columns < hop || parameters.window_columns % hop != 0)
    throw std::invalid_argument("lisco::WindowClusterer: the window must be a multiple of the hop, 1 or more");
  if (!usable_) *this = Window();
  usable_ = false;
  parameters_ = parameters;
  constexpr std::size_t kMaxCells = (std::size_t{1} << 31) - 1;
  max_lasers_ = kMaxCells / parameters.window_columns;
  tolerance_ = Tolerance(parameters.tolerance);
  // One more than a window has, so that its panes last while the next one is filled.
  panes_.resize(std::max(panes_.size(), parameters.window_columns / hop + 1));
  newest_ = oldest_ = 0;
  startPane();
  block_.clear();
  sizes_.clear();
  columns_ = returns_ = 0;
  usable_ = true;
}

bool WindowClusterer::Window::addColumn(const Return* cells, std::size_t lasers) {
  if (parameters_.lasers != 0 && lasers > parameters_.lasers)
    throw std::invalid_argument("lisco::WindowClusterer: a column of more cells than lasers were declared");
  if (lasers > max_lasers_) throw std::invalid_argument("lisco::WindowClusterer: a window of 2^31 cells or more");
  usable_ = false;
  block_.add(cells, lasers);
  const bool pane_ends = pane_columns_ + block_.columns() == parameters_.hop_columns;
  if (pane_ends || block_.columns() == RingBlock::kColumns) readBlock();
  if (pane_ends) finishPane();
  usable_ = true;
  return pane_ends;
}

void WindowClusterer::Window::startPane() {
  pane(newest_).prepare(tolerance_, SensorHints(), 0);
  pane(newest_).runs.keeps_source_indices = parameters_.keep_source_indices;
  pane(newest_).edges.clear();
  pane_columns_ = 0;
}

void WindowClusterer::Window::readBlock() {
  Pane& newest = pane(newest_);
  for (std::size_t laser = 0; laser < block_.lasers(); ++laser)
    newest.readRing(block_.ring(laser), laser, static_cast<std::uint32_t>(pane_columns_), block_.columns(),
                    newest.subclusters);
  pane_columns_ += block_.columns();
  block_.clear();
}

/// The newest pane is complete, and with it a window.
void WindowClusterer::Window::finishPane() {
  pane(newest_).linkWithin(pane(newest_).subclusters);
  pane(newest_).markLinked();
  numberWithin(pane(newest_));
  if (newest_ - oldest_ == parameters_.window_columns / parameters_.hop_columns) ++oldest_;
  placePanes();
  linkPanes();
  numberSubclusters();
  columns_ = (newest_ - oldest_ + 1) * parameters_.hop_columns;
  ++newest_;
  startPane();
}

/// Numbers the subclusters of a pane.
void WindowClusterer::Window::numberWithin(Pane& pane) {
  const GrowingArray<Run>& runs = pane.runs.runs;
  const std::size_t count = pane.runs.run_count;
  pane.subcluster.resize(count);
  SetNumbering numbering(pane.subclusters, pane.sizes);
  for (std::uint32_t run = 0; run < count; ++run)
    pane.subcluster[run] =
        numbering.numberOf(run, runs[run].count, [&](std::uint32_t parent) { return pane.subcluster[parent]; });
  numbering.finish();
}

/// Makes each subcluster of the window's panes an element of its forest.
void WindowClusterer::Window::placePanes() {
  std::uint32_t elements = 0;
  returns_ = 0;
  for (std::uint64_t number = oldest_; number != newest_ + 1; ++number) {
    pane(number).first_in_window = elements;
    elements += static_cast<std::uint32_t>(pane(number).sizes.size());
    returns_ += pane(number).runs.returns;
  }
  window_.reserve(elements);
  for (std::uint32_t element = 0; element < elements; ++element) window_.create(element);
  subcluster_of_element_.resize(elements);
}

/// Joins subclusters of the newest pane with those of an older one, and notes the edges there.
class WindowClusterer::Window::EdgeFinder : public PairVisitor {
 public:
  EdgeFinder(Window& window, std::uint64_t older) : window_(window), older_(window.pane(older)) {}

  bool inDifferentSets(std::uint32_t own, std::uint32_t others) override {
    return window_.window_.find(newest_.first_in_window + newest_.subcluster[own]) !=
           window_.window_.find(older_.first_in_window + older_.subcluster[others]);
  }

  void join(std::uint32_t own, std::uint32_t others) override {
    const Edge edge{older_.subcluster[others], newest_.subcluster[own], window_.newest_};
    window_.window_.merge(older_.first_in_window + edge.older_subcluster,
                          newest_.first_in_window + edge.newer_subcluster);
    older_.edges.push_back(edge);
  }

 private:
  Window& window_;
  Pane& newest_{window_.pane(window_.newest_)};
  Pane& older_;
};

/// Joins the panes of the window, from the newest older one to the oldest.
void WindowClusterer::Window::linkPanes() {
  for (std::uint64_t number = newest_; number != oldest_; --number) {
    Pane& older = pane(number - 1);
    keepUsefulEdges(older);
    EdgeFinder finder(*this, number - 1);
    pane(newest_).linkPanes(older, VoxelLinker::Part::kAll, finder);
  }
}

/// Joins a pane with the newer ones by its edges; drops edges within subclusters that newer edges join.
void WindowClusterer::Window::keepUsefulEdges(Pane& older) {
  const auto isUseless = [&](const Edge& edge) {
    const std::uint32_t a = older.first_in_window + edge.older_subcluster;
    const std::uint32_t b = pane(edge.newer_pane).first_in_window + edge.newer_subcluster;
    if (window_.find(a) == window_.find(b)) return true;
    window_.merge(a, b);
    return false;
  };
  older.edges.erase(std::remove_if(older.edges.begin(), older.edges.end(), isUseless), older.edges.end());
}

/// Numbers the subclusters of the window.
void WindowClusterer::Window::numberSubclusters() {
  SetNumbering numbering(window_, sizes_);
  for (std::uint64_t number = oldest_; number != newest_ + 1; ++number) {
    Pane& own = pane(number);
    for (std::uint32_t i = 0; i < own.sizes.size(); ++i)
      subcluster_of_element_[own.first_in_window + i] = numbering.numberOf(
          own.first_in_window + i, own.sizes[i], [&](std::uint32_t parent) { return subcluster_of_element_[parent]; });
  }
  numbering.finish();
}

void WindowClusterer::Window::visitRuns(const RunVisitor& visit, const SizeRange& sizes) {
  if (!visit.takesPlaces() && !parameters_.keep_source_indices)
    throw std::logic_error("lisco::WindowClusterer: source indices are not kept");
  if (columns_ == 0) return;
  const auto runsOf = [this](std::size_t i) -> const Runs& { return pane(oldest_ + i).runs; };
  const std::size_t panes = newest_ - oldest_;
  const RunSelection selection(visit, sizes, sizes_, panes, runsOf);
  order_.sort(panes, runsOf);
  order_.forEachBlock(false, runsOf, [&](RunVisitor::From from, std::size_t i, const Runs&, const Runs::Block& block) {
    Pane& own = pane(oldest_ + i);
    for (std::uint32_t run = block.first_run; run < block.first_run + block.count; ++run)
      own.runs.runs[run].subcluster = subcluster_of_element_[own.first_in_window + own.subcluster[run]];
    RunBlock visited = own.runs.blockOf(block);
    visited.first_column += static_cast<std::uint32_t>(i * parameters_.hop_columns);
    selection.visit(from, visited);
  });
}

// --- The public face ------------------------------------------------------------------------------------------------

WindowClusterer::WindowClusterer() : window_(std::make_unique<Window>()) {
  chooseSimdLevel();
}
WindowClusterer::~WindowClusterer() = default;
WindowClusterer::WindowClusterer(const WindowClusterer& other) : window_(std::make_unique<Window>(*other.window_)) {}
WindowClusterer& WindowClusterer::operator=(const WindowClusterer& other) {
  window_ = std::make_unique<Window>(*other.window_);
  return *this;
}

void WindowClusterer::begin(const WindowParameters& parameters) {
  window_->begin(parameters);
}

bool WindowClusterer::addColumn(const Return* cells, std::size_t lasers) {
  if (!window_->isUsable())
    throw std::logic_error("lisco::WindowClusterer: a column before begin (), or after an exception");
  return window_->addColumn(cells, lasers);
}

std::size_t WindowClusterer::columnCount() const {
  return window_->columnCount();
}
std::size_t WindowClusterer::returnCount() const {
  return window_->returnCount();
}
std::size_t WindowClusterer::subclusterCount() const {
  return window_->subclusterCount();
}
const std::uint32_t* WindowClusterer::sizes() const {
  return window_->sizes();
}

void WindowClusterer::visitRuns(const RunVisitor& visit, const SizeRange& sizes) {
  if (window_->isUsable()) window_->visitRuns(visit, sizes);
}

}  // namespace lisco
