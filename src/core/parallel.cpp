// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>
#include <vector>

#include "core/processors.h"

#ifdef __has_feature
#if __has_feature(thread_sanitizer)
#define LISCO_THREAD_SANITIZER
#endif
#endif
#ifdef __SANITIZE_THREAD__
#define LISCO_THREAD_SANITIZER
#endif
// Without OpenMP, and under ThreadSanitizer, which reports races across OpenMP's barriers.
#if defined(LISCO_THREAD_SANITIZER) || !defined(_OPENMP)
#define LISCO_STD_THREADS
#endif

namespace lisco {
namespace {

/// Threads for some parts: more than cores would wait for each other. Under ThreadSanitizer one for each, so that it
/// sees them all.
std::size_t threadsFor(std::size_t parts) {
#ifdef LISCO_THREAD_SANITIZER
  return parts;
#else
  return std::min(parts, allThreads());
#endif
}

}  // namespace

std::size_t allThreads() {
  static const std::size_t threads = std::max<std::size_t>(1, std::thread::hardware_concurrency());
  return threads;
}

void inParallel(std::size_t parts, void (*work)(void* context, std::size_t part), void* context) {
  const std::size_t threads = threadsFor(parts);
  if (threads <= 1) {
    for (std::size_t part = 0; part < parts; ++part) work(context, part);
    return;
  }
  std::exception_ptr failure;
  std::atomic_flag has_failed = ATOMIC_FLAG_INIT;
  SpreadStart start(threads);
  const auto run = [&](std::size_t thread) {
    start.enter();
    for (std::size_t part = thread; part < parts; part += threads) {
      try {
        work(context, part);
      } catch (...) {  // must not leave the thread; the first one is rethrown below
        if (!has_failed.test_and_set()) failure = std::current_exception();
      }
    }
  };
#ifdef LISCO_STD_THREADS
  std::vector<std::thread> running;
  running.reserve(threads - 1);
  std::size_t started = 1;
  try {
    for (; started < threads; ++started) running.emplace_back(run, started);
  } catch (...) {  // no more threads can be started: this one does the rest
  }
  run(0);
  for (std::size_t thread = started; thread < threads; ++thread) run(thread);
  for (std::thread& one : running) one.join();
#else
  const auto count = static_cast<int>(threads);
#pragma omp parallel for num_threads(count) schedule(static, 1)
  for (int thread = 0; thread < count; ++thread) run(static_cast<std::size_t>(thread));
#endif
  if (failure) std::rethrow_exception(failure);
}

}  // namespace lisco
