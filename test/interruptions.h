// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
// Calls that are interrupted by an exception: memory is refused, or a callback throws. For programs that include
// refused_allocations.cpp.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <new>
#include <string>

#include "engine.h"
#include "random.h"
#include "refused_allocations.h"

namespace lisco_test {

/// Thrown by callbacks.
struct Interruption {};

/// Throws at the n-th call of burn (), by any thread; never if n is 0.
class Fuse {
 public:
  explicit Fuse(std::size_t times) : left_(times) {}
  void burn() {
    if (left_-- == 1) throw Interruption();
  }
  void replace(std::size_t times) { left_ = times; }

 private:
  std::atomic<std::size_t> left_;
};

/// Makes one call of a session, which returns, is refused memory or is interrupted.
/// \param refused number of the allocation to refuse, from 1; 0: none
/// \return whether that allocation was asked for
template <typename Session>
bool interruptedCall(Session& session, std::size_t number, std::size_t refused, bool& thrown) {
  const RefusedAllocation refusal(refused);
  thrown = true;
  try {
    session.call(number);
    thrown = false;
  } catch (const std::bad_alloc&) {
  } catch (const Interruption&) {
  }
  return refused > 0 && refusal.happened();
}

/// Refuses the first allocation of a call, then in a new session the second, and so on until the call needs no more.
/// After each refusal, checks what the session promises, that it can be used again, and that it frees all its memory.
///
/// A Session has call (number); checkInterrupted (number), called after an exception in that call; and redo (), which
/// begins again and returns what is wrong with the clusters.
/// \param make makes a session
/// \param number of the call
/// \return how many allocations were refused
template <typename Make>
std::size_t refuseEachAllocation(Make&& make, std::size_t number) {
  constexpr std::size_t kMaxRefused = 20000;
  for (std::size_t refused = 1; refused < kMaxRefused; ++refused) {
    const std::size_t live = liveAllocations();
    bool thrown = false;
    bool happened = false;
    std::string wrong;
    {
      auto session = make();
      for (std::size_t before = 0; before < number; ++before) session.call(before);
      happened = interruptedCall(session, number, refused, thrown);
      if (thrown) session.checkInterrupted(number);
      if (happened) wrong = session.redo();
    }
    if (!wrong.empty() || testing::Test::HasFailure()) {
      ADD_FAILURE() << "after allocation " << refused << " of call " << number << " had been refused: " << wrong;
      return refused;
    }
    std::string().swap(wrong);
    EXPECT_EQ(liveAllocations(), live) << "allocation " << refused << " of call " << number << ": a leak";
    if (!happened) return refused - 1;
  }
  ADD_FAILURE() << "call " << number << " has no end";
  return kMaxRefused;
}

/// Makes the callback of endless streams throw in each kind of call: addColumn (), update (), finish (). Checks what
/// the session promises, that it can be used again, and that it frees all its memory.
/// \param first_seed of `streams` streams, one of each
template <typename Session, typename Stream>
void interruptEndlessStreams(std::uint64_t first_seed, std::uint64_t streams) {
  std::array<std::size_t, 3> interrupted{};  // addColumn (), update () and finish ()
  for (std::uint64_t seed = first_seed; seed < first_seed + streams; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    Random random(seed);
    const SimdLevel level(levels()[seed % levels().size()]);
    const Stream stream(random);
    const std::size_t live = liveAllocations();
    {
      Fuse fuse(1 + random.below(stream.truth.size() + 1));
      Session session(stream, &fuse);
      const std::size_t last = Session::calls(stream) - 1;
      bool thrown = false;
      for (std::size_t number = 0; number <= last && !thrown; ++number) {
        interruptedCall(session, number, 0, thrown);
        if (!thrown) continue;
        session.checkInterrupted(number);
        ++interrupted[number == last ? 2 : (number + 1) % 2];
      }
      ASSERT_EQ(session.redo(), "");
    }
    ASSERT_EQ(liveAllocations(), live) << "a leak";
    if (testing::Test::HasFailure()) return;
  }
  for (const std::size_t count : interrupted) EXPECT_GT(count, 5U);
}

}  // namespace lisco_test
