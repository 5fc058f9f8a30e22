// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <signal.h>

namespace lisco_apps {

/// The first SIGINT or SIGTERM asks the program to end after what it has begun; the second ends it at once.
class Interruption {
 public:
  static void listen() {
    handleBy([](int) {
      happened_ = 1;
      handleBy(SIG_DFL);
    });
  }
  static bool happened() { return happened_ != 0; }

 private:
  static void handleBy(void (*handler)(int)) {
    struct sigaction action {};
    action.sa_handler = handler;
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
  }

  static inline volatile sig_atomic_t happened_ = 0;
};

}  // namespace lisco_apps
