// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/endless_sets.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

namespace lisco {

EndlessSets::Set& EndlessSets::create(std::int64_t pane, double position) {
  std::vector<Set>& sets = sets_[slotOf(pane)];
  if ((sets.size() + 1) >> kRunBits != 0)  // the last number of the last slot would be kNone
    throw std::length_error("lisco::EndlessClusterer: too many runs in an eighth of a turn");
  const Element element = elementOf(pane, static_cast<std::uint32_t>(sets.size()));
  constexpr Ticks kNever = std::numeric_limits<Ticks>::min();
  sets.push_back({element, kNone, element, 0, kNever, position, position, pane, false, false, false});
  return sets.back();
}

EndlessSets::Element EndlessSets::find(Element element) {
  while (true) {
    Set& own = (*this)[element];
    if (own.parent == element) return element;
    own.parent = (*this)[own.parent].parent;
    element = own.parent;
  }
}

void EndlessSets::merge(Element a, Element b) {
  a = find(a);
  b = find(b);
  if (a == b) return;
  if ((*this)[a].delivered || (!(*this)[b].delivered && (*this)[b].size > (*this)[a].size)) std::swap(a, b);
  Set& to = (*this)[a];
  Set& from = (*this)[b];
  from.parent = a;
  if (from.delivered) {
    to.continued = true;
    return;
  }
  (*this)[to.last_run].next_run = b;
  to.last_run = from.last_run;
  to.size += from.size;
  to.reach_end = std::max(to.reach_end, from.reach_end);
  to.first_position = std::min(to.first_position, from.first_position);
  to.last_position = std::max(to.last_position, from.last_position);
  to.first_pane = std::min(to.first_pane, from.first_pane);
  to.continued = to.continued || from.continued;
}

}  // namespace lisco
