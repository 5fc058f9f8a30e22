// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "core/processors.h"

#ifdef __linux__
#include <sched.h>

int lisco::currentProcessor() noexcept {
  return sched_getcpu();
}

void lisco::leaveProcessor(int processor) noexcept {
  if (processor < 0 || processor >= CPU_SETSIZE || sched_getcpu() != processor) return;
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) return;  // this thread's
  cpu_set_t others = allowed;
  CPU_CLR(processor, &others);
  if (CPU_COUNT(&others) == 0 || sched_setaffinity(0, sizeof others, &others) != 0) return;
  sched_setaffinity(0, sizeof allowed, &allowed);
}
#else
int lisco::currentProcessor() noexcept {
  return -1;
}
void lisco::leaveProcessor(int) noexcept {}
#endif
