// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "lisco/endless_clusterer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "core/column_block.h"
#include "core/endless_sets.h"
#include "core/finite.h"
#include "core/neighbour.h"
#include "core/partition.h"
#include "core/simd.h"
#include "core/stream_position.h"
#include "core/stream_reach.h"

namespace lisco {

namespace {

void check(const EndlessParameters& parameters, const EndlessClusterer::Callback& callback) {
  if (!(parameters.stagger >= 0 && parameters.stagger <= EndlessParameters::kMaxStagger))
    throw std::invalid_argument("lisco::EndlessClusterer: the stagger must be within 0 and a sixteenth of a turn");
  if (!areFinite(parameters.origin)) throw std::invalid_argument("lisco::EndlessClusterer: the origin must be finite");
  if (!(std::fabs(parameters.start_azimuth) <= EndlessParameters::kMaxAzimuth))
    throw std::invalid_argument("lisco::EndlessClusterer: the start azimuth must be within -1e6 and 1e6 radians");
  if (!callback) throw std::invalid_argument("lisco::EndlessClusterer: the callback must not be empty");
}

}  // namespace

/// The state of a stream that has begun.
class EndlessClusterer::Stream {
 public:
  void begin(const EndlessParameters& parameters, Callback callback);
  void addColumn(const Return* cells, std::size_t lasers, double position);
  void addNextColumn(const Return* cells, std::size_t lasers);
  double nextPosition() const;
  void update();
  void finish();

  bool isUsable() const { return usable_; }
  std::uint64_t returnCount() const { return returns_; }
  std::uint64_t outlierCount() const { return outliers_; }
  std::size_t returnsHeld() const;

 private:
  using Element = EndlessSets::Element;
  using Set = EndlessSets::Set;
  struct Pane : Partition {
    std::int64_t number = 0;
    bool in_use = false;
    DisjointSets subclusters;                 ///< of its runs
    std::vector<DisjointSets::Merge> merges;  ///< of these, to be repeated among clusters
  };
  /// A cluster that waits for its delivery; it may have grown or joined another one since.
  struct Waiting {
    Ticks reach_end;
    Element root;
    bool operator<(const Waiting& other) const { return reach_end > other.reach_end; }  // a heap with the first on top
  };
  class PaneLinker;

  Pane& pane(std::int64_t number) { return panes_[EndlessSets::slotOf(number)]; }
  void startPane(std::int64_t number, Ticks now);
  void processBlock();
  void readBlock();
  void createSets(const RingBlockInfo& info, const double* rho, ColumnBits outliers);
  void replayMerges(Pane& pane);
  void wait(Element root);
  void deliverUpTo(Ticks now);
  void deliver(Element root);

  EndlessParameters parameters_;
  Callback callback_;
  Tolerance tolerance_;
  StreamReach reach_;
  bool usable_ = false;  ///< begun, and left by no exception since

  ColumnBlock block_;
  std::array<double, RingBlock::kColumns> positions_{};  ///< of the columns of the block
  double position_ = 0;                                  ///< of the latest column
  double given_position_ = 0;                            ///< the last one that was given, or 0
  double columns_since_given_ = 0;
  bool any_column_ = false;

  std::int64_t current_ = 0;  ///< number of the pane that is being filled
  std::array<Pane, static_cast<std::size_t>(EndlessSets::kSlots)> panes_;
  EndlessSets sets_;
  std::vector<Waiting> waiting_;  ///< a heap: all open clusters
  std::vector<Element> chain_;    ///< runs of the cluster that is being delivered
  EndlessCluster delivered_;
  std::uint64_t returns_ = 0, outliers_ = 0;
};

// --- Receiving columns ----------------------------------------------------------------------------------------------

void EndlessClusterer::Stream::begin(const EndlessParameters& parameters, Callback callback) {
  check(parameters, callback);
  if (!usable_) *this = Stream();
  usable_ = false;
  parameters_ = parameters;
  parameters_.block_columns = std::clamp<std::size_t>(parameters.block_columns, 1, RingBlock::kColumns);
  callback_ = std::move(callback);
  tolerance_ = Tolerance(parameters.tolerance);
  reach_.begin(parameters);
  block_.clear();
  any_column_ = false;
  for (Pane& pane : panes_) pane.in_use = false;
  waiting_.clear();
  returns_ = outliers_ = 0;
  usable_ = true;
}

double EndlessClusterer::Stream::nextPosition() const {
  return any_column_ ? given_position_ + (columns_since_given_ + 1) / parameters_.columns_per_turn : 0.0;
}

void EndlessClusterer::Stream::addNextColumn(const Return* cells, std::size_t lasers) {
  if (!(parameters_.columns_per_turn > 0))
    throw std::logic_error("lisco::EndlessClusterer: a column without a position, and columns_per_turn is not known");
  const double position = nextPosition();
  const double given = any_column_ ? given_position_ : 0.0;
  const double columns = any_column_ ? columns_since_given_ + 1 : 0.0;
  addColumn(cells, lasers, position);
  given_position_ = given;
  columns_since_given_ = columns;
}

void EndlessClusterer::Stream::addColumn(const Return* cells, std::size_t lasers, double position) {
  if (parameters_.lasers != 0 && lasers > parameters_.lasers)
    throw std::invalid_argument("lisco::EndlessClusterer: a column of more cells than lasers were declared");
  if (!(std::fabs(position) <= EndlessParameters::kMaxPosition) || (any_column_ && position < position_))
    throw std::invalid_argument("lisco::EndlessClusterer: a position out of range or less than the one before");
  usable_ = false;
  const Ticks now = ticksOf(position);
  if (!any_column_ || paneOf(now) != current_) startPane(paneOf(now), now);
  any_column_ = true;
  position_ = given_position_ = position;
  columns_since_given_ = 0;

  positions_[block_.columns()] = position;
  reach_.setColumn(block_.columns(), position);
  block_.add(cells, lasers);
  if (block_.columns() == parameters_.block_columns) processBlock();
  usable_ = true;
}

void EndlessClusterer::Stream::update() {
  usable_ = false;
  processBlock();
  usable_ = true;
}

void EndlessClusterer::Stream::finish() {
  if (!any_column_) return;
  usable_ = false;
  processBlock();
  deliverUpTo(std::numeric_limits<Ticks>::max());
  for (Pane& pane : panes_) pane.in_use = false;
  any_column_ = false;
  usable_ = true;
}

std::size_t EndlessClusterer::Stream::returnsHeld() const {
  std::size_t count = 0;
  for (const Pane& pane : panes_) count += pane.in_use ? pane.runs.returns : 0;
  return count;
}

void EndlessClusterer::Stream::processBlock() {
  if (block_.columns() == 0) return;
  readBlock();
  deliverUpTo(ticksOf(position_));
}

/// Delivers what the first column of a new pane cannot reach, and cuts what is a turn old.
void EndlessClusterer::Stream::startPane(std::int64_t number, Ticks now) {
  processBlock();
  deliverUpTo(now);
  const auto isYoung = [&](const Waiting& waiting) { return sets_[waiting.root].first_pane > number - kPanesPerTurn; };
  const auto old = std::partition(waiting_.begin(), waiting_.end(), isYoung);
  std::sort(old, waiting_.end(), [](const Waiting& a, const Waiting& b) { return b < a; });
  for (auto waiting = old; waiting != waiting_.end(); ++waiting) {
    if (!sets_.isRoot(waiting->root)) continue;
    sets_[waiting->root].cut = true;
    deliver(waiting->root);
  }
  waiting_.erase(old, waiting_.end());
  std::make_heap(waiting_.begin(), waiting_.end());

  current_ = number;
  sets_.startPane(number);
  SensorHints sensor;  // without steps, all returns are near
  sensor.origin = parameters_.origin;
  Pane& pane = this->pane(number);
  pane.prepare(tolerance_, sensor, 0);
  pane.merges.clear();
  pane.number = number;
  pane.in_use = true;
}

// --- Linking a block of columns -------------------------------------------------------------------------------------

/// Joins clusters of the current pane with those of an older one.
class EndlessClusterer::Stream::PaneLinker : public PairVisitor {
 public:
  PaneLinker(Stream& stream, std::int64_t older)
      : stream_(stream), older_(older), end_of_older_(stream.reach_.rayAfter(older)) {}

  bool reaches(const Box& own) const override { return stream_.reach_.reaches(own, end_of_older_); }

  bool inDifferentSets(std::uint32_t own, std::uint32_t others) override {
    const Element a = rootOfOwn(own);
    const Element b = rootOfOther(others);
    return a != b && !(stream_.sets_[b].delivered && stream_.sets_[a].continued);
  }

  /// A cluster that was delivered, cut, is continued by all that reach it, and joins none of these.
  void join(std::uint32_t own, std::uint32_t others) override {
    const Element a = rootOfOwn(own);
    const Element b = rootOfOther(others);
    if (stream_.sets_[b].delivered)
      stream_.sets_[a].continued = true;
    else
      stream_.sets_.merge(a, b);
  }

 private:
  Element rootOfOwn(std::uint32_t run) { return stream_.sets_.find(EndlessSets::elementOf(stream_.current_, run)); }
  Element rootOfOther(std::uint32_t run) { return stream_.sets_.find(EndlessSets::elementOf(older_, run)); }

  Stream& stream_;
  std::int64_t older_;
  StreamReach::Ray end_of_older_;
};

/// Reads the columns of the block and compares them with all that may be neighbours.
void EndlessClusterer::Stream::readBlock() {
  Pane& pane = this->pane(current_);
  const std::size_t before = pane.runs.returns;
  const std::uint32_t first_run = sets_.runCount(current_);
  pane.subclusters.logTo(&pane.merges);
  for (std::size_t laser = 0; laser < block_.lasers(); ++laser)
    pane.readRing(block_.ring(laser), laser, 0, block_.columns(), pane.subclusters,
                  [&](const RingBlock& block, RingBlockInfo& info) {
                    std::array<double, RingBlock::kColumns> rho;
                    const ColumnBits outliers = reach_.findOutliers(block, info, rho.data());
                    info.starts |= outliers | (outliers << 1 & info.returns);
                    outliers_ += countBits(outliers);
                    createSets(info, rho.data(), outliers);
                    return info.returns & ~outliers;
                  });
  block_.clear();
  returns_ += pane.runs.returns - before;
  pane.linkWithin(pane.subclusters);
  replayMerges(pane);
  for (std::int64_t older = current_ - StreamReach::kComparablePanes + 1; older < current_; ++older)
    if (this->pane(older).in_use && this->pane(older).number == older) {
      PaneLinker linker(*this, older);
      pane.linkPanes(this->pane(older), VoxelLinker::Part::kNew, linker);
    }
  pane.markLinked();
  pane.subclusters.logTo(nullptr);
  for (std::uint32_t run = first_run; run < sets_.runCount(current_); ++run) {
    const Element element = EndlessSets::elementOf(current_, run);
    if (sets_.isRoot(element)) wait(element);
  }
}

/// Makes a cluster of each run of a row.
void EndlessClusterer::Stream::createSets(const RingBlockInfo& info, const double* rho, ColumnBits outliers) {
  Set* set = nullptr;
  forEachBit(info.returns, [&](std::size_t i) {
    if ((info.starts >> i & 1) != 0) set = &sets_.create(current_, positions_[i]);
    const Ticks column = ticksOf(positions_[i]);
    ++set->size;
    set->last_position = positions_[i];
    set->reach_end = (outliers >> i & 1) != 0 ? column : reach_.endOf(column, current_, rho[i], set->reach_end);
  });
}

/// Joins the clusters of the runs that the pane has joined.
void EndlessClusterer::Stream::replayMerges(Pane& pane) {
  for (const DisjointSets::Merge& joined : pane.merges)
    sets_.merge(EndlessSets::elementOf(current_, joined.root), EndlessSets::elementOf(current_, joined.former_root));
  pane.merges.clear();
}

// --- Delivery -------------------------------------------------------------------------------------------------------

/// Delivers all clusters that a column at a position, and those after it, cannot reach.
void EndlessClusterer::Stream::deliverUpTo(Ticks now) {
  while (!waiting_.empty() && waiting_.front().reach_end <= now) {
    std::pop_heap(waiting_.begin(), waiting_.end());
    const Waiting first = waiting_.back();
    waiting_.pop_back();
    if (!sets_.isRoot(first.root)) continue;  // joined to another one, which waits itself
    if (sets_[first.root].reach_end > first.reach_end)
      wait(first.root);
    else
      deliver(first.root);
  }
}

void EndlessClusterer::Stream::wait(Element root) {
  waiting_.push_back({sets_[root].reach_end, root});
  std::push_heap(waiting_.begin(), waiting_.end());
}

void EndlessClusterer::Stream::deliver(Element root) {
  Set& set = sets_[root];
  set.delivered = true;
  if (set.size < parameters_.min_size || set.size > parameters_.max_size) return;
  chain_.clear();
  for (Element run = root; run != EndlessSets::kNone; run = sets_[run].next_run) chain_.push_back(run);
  const auto paneNumber = [this](Element run) { return panes_[EndlessSets::slotOfElement(run)].number; };
  std::sort(chain_.begin(), chain_.end(), [&](Element a, Element b) {
    return paneNumber(a) != paneNumber(b) ? paneNumber(a) < paneNumber(b) : a < b;
  });
  delivered_.runs_.clear();
  for (const Element element : chain_) {
    const Runs& runs = panes_[EndlessSets::slotOfElement(element)].runs;
    const Run& run = runs.runs[EndlessSets::runOf(element)];
    delivered_.runs_.push_back({runs.source_index.data() + run.first_cell, run.count});
  }
  delivered_.size_ = set.size;
  delivered_.first_position_ = set.first_position;
  delivered_.last_position_ = set.last_position;
  delivered_.reach_end_ = std::max(positionOf(set.reach_end), set.last_position);  // an outlier's is its own position
  delivered_.is_cut_ = set.cut;
  delivered_.is_continued_ = set.continued;
  callback_(delivered_);
}

// --- The public face ------------------------------------------------------------------------------------------------

EndlessClusterer::EndlessClusterer() : stream_(std::make_unique<Stream>()) {
  chooseSimdLevel();
}
EndlessClusterer::~EndlessClusterer() = default;
EndlessClusterer::EndlessClusterer(const EndlessClusterer& other) : stream_(std::make_unique<Stream>(*other.stream_)) {}
EndlessClusterer& EndlessClusterer::operator=(const EndlessClusterer& other) {
  stream_ = std::make_unique<Stream>(*other.stream_);
  return *this;
}

void EndlessClusterer::begin(const EndlessParameters& parameters, Callback callback) {
  stream_->begin(parameters, std::move(callback));
}

void EndlessClusterer::addColumn(const Return* cells, std::size_t lasers, double position) {
  if (!stream_->isUsable())
    throw std::logic_error("lisco::EndlessClusterer: a column before begin (), or after an exception");
  stream_->addColumn(cells, lasers, position);
}

void EndlessClusterer::addColumn(const Return* cells, std::size_t lasers) {
  if (!stream_->isUsable())
    throw std::logic_error("lisco::EndlessClusterer: a column before begin (), or after an exception");
  stream_->addNextColumn(cells, lasers);
}

double EndlessClusterer::nextPosition() const {
  return stream_->nextPosition();
}

void EndlessClusterer::update() {
  if (stream_->isUsable()) stream_->update();
}

void EndlessClusterer::finish() {
  if (stream_->isUsable()) stream_->finish();
}

std::uint64_t EndlessClusterer::returnCount() const {
  return stream_->returnCount();
}
std::uint64_t EndlessClusterer::outlierCount() const {
  return stream_->outlierCount();
}
std::size_t EndlessClusterer::returnsHeld() const {
  return stream_->returnsHeld();
}

}  // namespace lisco
