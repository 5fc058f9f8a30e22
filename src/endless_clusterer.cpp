// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "lisco/endless_clusterer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace lisco {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kLargestRho = 1e18;  // metres; beyond, its square has overflowed a float

}  // namespace

void EndlessClusterer::begin(const EndlessParameters& parameters, Callback callback) {
  if (!(parameters.stagger >= 0) || parameters.stagger > EndlessParameters::kMostStagger)
    throw std::invalid_argument("lisco::EndlessClusterer: the stagger must be within 0 and a sixteenth of a turn");
  if (!begun_) *this = EndlessClusterer();
  begun_ = false;
  parameters_ = parameters;
  parameters_.block_columns = std::clamp<std::size_t>(parameters.block_columns, 1, Row::kColumns);
  callback_ = std::move(callback);
  tolerance_ = Tolerance(parameters.tolerance);
  range_.origin = parameters.origin;
  const double cosine = std::cos(parameters.stagger) - 1e-6;
  cos_stagger_ = static_cast<float>(cosine);
  turns_of_stagger_ = 2 * (std::acos(cosine - 1e-6) / (2 * kPi));  // on either side
  block_.clear();
  any_column_ = false;
  for (EndlessPane& pane : panes_) pane.in_use = false;
  waiting_.clear();
  returns_ = strays_ = 0;
  begun_ = true;
}

void EndlessClusterer::addColumn(const Return* cells, std::size_t lasers) {
  if (begun_ && !(parameters_.columns_per_turn > 0))
    throw std::logic_error("lisco::EndlessClusterer: a column without a position, and columns_per_turn is not known");
  addColumn(cells, lasers, any_column_ ? position_ + 1 / parameters_.columns_per_turn : 0.0);
}

void EndlessClusterer::addColumn(const Return* cells, std::size_t lasers, double position) {
  if (!begun_) throw std::logic_error("lisco::EndlessClusterer: a column before begin (), or after an exception");
  if (parameters_.lasers != 0 && lasers > parameters_.lasers)
    throw std::invalid_argument("lisco::EndlessClusterer: a column of more cells than lasers were declared");
  constexpr double kLargest = 1e12;  // from here on, a double cannot tell columns apart
  if (!(std::fabs(position) <= kLargest) || (any_column_ && position < position_))
    throw std::invalid_argument("lisco::EndlessClusterer: a position that is not finite or less than the one before");
  begun_ = false;  // unless nothing is thrown
  const auto number = static_cast<std::int64_t>(std::floor(position * static_cast<double>(kTurn)));
  if (!any_column_ || number != current_) startPane(number, position);
  any_column_ = true;
  position_ = position;

  const double turns = position - std::floor(position);
  const double azimuth = parameters_.start_azimuth + (parameters_.clockwise ? -2 : 2) * kPi * turns;
  positions_[block_.columns()] = position;
  cosines_[block_.columns()] = static_cast<float>(std::cos(azimuth));
  sines_[block_.columns()] = static_cast<float>(std::sin(azimuth));
  block_.add(0, 1, lasers, [cells](std::size_t laser, std::size_t) { return cells[laser]; });
  if (block_.columns() == parameters_.block_columns) workOnBlock();
  begun_ = true;
}

void EndlessClusterer::update() {
  if (!begun_) return;
  begun_ = false;
  workOnBlock();
  begun_ = true;
}

void EndlessClusterer::workOnBlock() {
  if (block_.columns() == 0) return;
  readBlock();
  deliverUpTo(position_);
}

void EndlessClusterer::finish() {
  if (!begun_ || !any_column_) return;
  begun_ = false;
  workOnBlock();
  deliverUpTo(std::numeric_limits<double>::infinity());
  for (EndlessPane& pane : panes_) pane.in_use = false;
  any_column_ = false;
  begun_ = true;
}

std::size_t EndlessClusterer::returnsHeld() const {
  std::size_t count = 0;
  for (const EndlessPane& pane : panes_) count += pane.in_use ? pane.runs.returns : 0;
  return count;
}

/// Delivers what the first column of a new pane cannot reach, or must not.
void EndlessClusterer::startPane(std::int64_t number, double position) {
  workOnBlock();
  deliverUpTo(position);
  const auto isYoung = [&](const Waiting& waiting) { return set(waiting.head).first_pane > number - kTurn; };
  const auto old = std::partition(waiting_.begin(), waiting_.end(), isYoung);
  std::sort(old, waiting_.end(), [](const Waiting& a, const Waiting& b) { return b < a; });
  for (auto waiting = old; waiting != waiting_.end(); ++waiting) {
    Set& set = this->set(waiting->head);
    if (set.parent != waiting->head) continue;
    set.cut = true;
    deliver(waiting->head);
  }
  waiting_.erase(old, waiting_.end());
  std::make_heap(waiting_.begin(), waiting_.end());

  current_ = number;
  EndlessPane& pane = this->pane(number);
  pane.clear(tolerance_);
  pane.sets.clear();
  pane.merges.clear();
  pane.number = number;
  pane.in_use = true;
}

/// Joins clusters of the current pane with those of an older one.
class EndlessClusterer::PaneJoiner : public Voxels::Joiner {
 public:
  PaneJoiner(EndlessClusterer& clusterer, std::int64_t older) : clusterer_(clusterer), older_(older) {
    // All that the older pane holds lies on one side of the ray under which its last column can have seen anything.
    const EndlessParameters& parameters = clusterer.parameters_;
    const double turns = static_cast<double>(older + 1) / static_cast<double>(kTurn);
    const double direction = parameters.clockwise ? -1 : 1;
    const double azimuth = parameters.start_azimuth +
                           direction * (2 * kPi * (turns - std::floor(turns)) + kPi * clusterer.turns_of_stagger_);
    across_ = {-direction * std::sin(azimuth), direction * std::cos(azimuth)};
  }

  /// Whether the box is not all further from that ray than the tolerance, on the other side.
  bool reaches(const Box& own) const override {
    double least = 0;
    double largest = 0;
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const double origin = static_cast<double>(clusterer_.range_.origin[axis]);
      const double lo = static_cast<double>(own.lo[axis]) - origin;
      const double hi = static_cast<double>(own.hi[axis]) - origin;
      least += std::min(across_[axis] * lo, across_[axis] * hi);
      largest = std::max({largest, std::fabs(lo), std::fabs(hi)});
    }
    constexpr double kRounding = 1e-5;
    return !(least > clusterer_.tolerance_.reach() * (1 + kRounding) + largest * kRounding);
  }

  bool areApart(std::uint32_t own, std::uint32_t others) override {
    const Element a = clusterer_.head(clusterer_.elementOf(clusterer_.current_, own));
    const Element b = clusterer_.head(clusterer_.elementOf(older_, others));
    if (a == b) return false;
    return !clusterer_.set(b).delivered || (clusterer_.set(b).cut && !clusterer_.set(a).continued);
  }

  void join(std::uint32_t own, std::uint32_t others) override {
    const Element a = clusterer_.head(clusterer_.elementOf(clusterer_.current_, own));
    const Element b = clusterer_.head(clusterer_.elementOf(older_, others));
    if (clusterer_.set(b).delivered)
      clusterer_.set(a).continued = true;
    else
      clusterer_.merge(a, b);
  }

 private:
  EndlessClusterer& clusterer_;
  std::int64_t older_;
  std::array<double, 2> across_{};  ///< unit vector from the ray towards what comes later
};

/// Reads the columns that wait, and compares them with all that may be neighbours.
void EndlessClusterer::readBlock() {
  EndlessPane& pane = this->pane(current_);
  const std::size_t before = pane.runs.returns;
  const std::size_t first_run = pane.sets.size();
  pane.subclusters.logTo(&pane.merges);
  pane.read(block_, 0, tolerance_, range_, [&](const Row& row, MeasuredRow& measured) {
    const std::uint64_t strays = findStrays(row, measured);
    measured.starts |= strays | (strays << 1 & measured.returns);
    strays_ += static_cast<std::uint64_t>(__builtin_popcountll(strays));
    createSets(pane, measured, strays);
    return measured.returns & ~strays;
  });
  returns_ += pane.runs.returns - before;
  pane.voxels.link(pane.subclusters);
  replayMerges(pane);
  for (std::int64_t older = current_ - kComparable + 1; older < current_; ++older)
    if (this->pane(older).in_use && this->pane(older).number == older) {
      PaneJoiner joiner(*this, older);
      pane.voxels.linkTo(this->pane(older).voxels, Voxels::Part::kNew, joiner);
    }
  pane.voxels.settle();
  pane.subclusters.logTo(nullptr);
  for (std::size_t run = first_run; run < pane.sets.size(); ++run) {
    const Element element = elementOf(current_, static_cast<std::uint32_t>(run));
    if (set(element).parent == element) wait(element);
  }
}

/// Which returns are seen under another azimuth than their column can have.
std::uint64_t EndlessClusterer::findStrays(const Row& row, const MeasuredRow& measured) const {
  std::uint64_t strays = 0;
  for (std::uint64_t left = measured.returns; left != 0; left &= left - 1) {
    const auto i = static_cast<std::size_t>(__builtin_ctzll(left));
    const float east = row.x[Row::kMargin + i] - range_.origin[0];
    const float north = row.y[Row::kMargin + i] - range_.origin[1];
    if (!(east * cosines_[i] + north * sines_[i] >= cos_stagger_ * measured.rho[i])) strays |= left & -left;
  }
  return strays;
}

/// Makes a cluster of each run of a row.
void EndlessClusterer::createSets(EndlessPane& pane, const MeasuredRow& measured, std::uint64_t strays) {
  for (std::uint64_t left = measured.returns; left != 0; left &= left - 1) {
    const auto i = static_cast<std::size_t>(__builtin_ctzll(left));
    if ((measured.starts >> i & 1) != 0) {
      const Element element = elementOf(current_, static_cast<std::uint32_t>(pane.sets.size()));
      pane.sets.push_back(
          {element, kNone, element, 0, positions_[i], positions_[i], positions_[i], current_, false, false, false});
    }
    Set& set = pane.sets.back();
    ++set.size;
    set.last_position = positions_[i];
    if ((strays >> i & 1) == 0)
      set.reach_end =
          std::max(set.reach_end, reachEnd(positions_[i], static_cast<double>(measured.rho[i]), set.reach_end));
  }
}

/// From which position on no column can reach a return.
/// \param rho horizontal distance, metres
/// \param known nobody wants to know if it is not later than this
double EndlessClusterer::reachEnd(double position, double rho, double known) const {
  const double latest = static_cast<double>(current_ + kComparable) / static_cast<double>(kTurn);
  constexpr double kRounding = 1 + 1e-6;
  const double sine = tolerance_.reach() * kRounding / rho;
  if (!(sine < 1) || !(rho <= kLargestRho)) return latest;
  const double sum = position + turns_of_stagger_;
  // asin (t) <= t + (pi / 2 - 1) t^3 for t in 0..1
  if (sum + (sine + (kPi / 2 - 1) * sine * sine * sine) / (2 * kPi) <= known) return known;
  return std::min(sum + std::asin(sine) / (2 * kPi), latest);
}

/// Joins the clusters of the runs that the pane has joined.
void EndlessClusterer::replayMerges(EndlessPane& pane) {
  for (const DisjointSets::Merge& joined : pane.merges)
    merge(elementOf(current_, joined.head), elementOf(current_, joined.former_head));
  pane.merges.clear();
}

EndlessClusterer::Element EndlessClusterer::head(Element element) {
  while (true) {
    Set& own = set(element);
    if (own.parent == element) return element;
    own.parent = set(own.parent).parent;
    element = own.parent;
  }
}

void EndlessClusterer::merge(Element a, Element b) {
  a = head(a);
  b = head(b);
  if (a == b) return;
  if (set(b).size > set(a).size) std::swap(a, b);
  Set& to = set(a);
  Set& from = set(b);
  from.parent = a;
  set(to.last_run).next_run = b;
  to.last_run = from.last_run;
  to.size += from.size;
  to.reach_end = std::max(to.reach_end, from.reach_end);
  to.first_position = std::min(to.first_position, from.first_position);
  to.last_position = std::max(to.last_position, from.last_position);
  to.first_pane = std::min(to.first_pane, from.first_pane);
  to.continued = to.continued || from.continued;
}

/// Delivers all clusters that a column at a position, and those after it, cannot reach.
void EndlessClusterer::deliverUpTo(double position) {
  while (!waiting_.empty() && waiting_.front().reach_end <= position) {
    std::pop_heap(waiting_.begin(), waiting_.end());
    const Waiting first = waiting_.back();
    waiting_.pop_back();
    const Set& set = this->set(first.head);
    if (set.parent != first.head) continue;  // joined to another one, which waits itself
    if (set.reach_end > first.reach_end)
      wait(first.head);
    else
      deliver(first.head);
  }
}

void EndlessClusterer::wait(Element head) {
  waiting_.push_back({set(head).reach_end, head});
  std::push_heap(waiting_.begin(), waiting_.end());
}

void EndlessClusterer::deliver(Element head) {
  Set& set = this->set(head);
  set.delivered = true;
  if (set.size < parameters_.min_size || set.size > parameters_.max_size) return;
  delivered_runs_.clear();
  for (Element run = head; run != kNone; run = this->set(run).next_run) delivered_runs_.push_back(run);
  std::sort(delivered_runs_.begin(), delivered_runs_.end(), [this](Element a, Element b) {
    const std::int64_t pane_a = paneOf(a).number;
    const std::int64_t pane_b = paneOf(b).number;
    return pane_a != pane_b ? pane_a < pane_b : a < b;
  });
  callback_(EndlessCluster(*this, set));
}

}  // namespace lisco
