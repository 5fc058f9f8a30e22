// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "recordings/options.h"

#include "io/options.h"

namespace lisco_apps {

void RecordingOptions::addTo(boost::program_options::options_description& shown) {
  // clang-format off
  shown.add_options()
    ("topic", textOption("NAME", [this](const std::string& text) { topic = text; }),
     "of a recording: the topic of clouds or packets to read (default: the only one that fits; a list if there are "
     "several)")
    ("from", numberOption("S", "--from", span.from),
     "of a recording: begin S seconds after its first message or packet (default 0)")
    ("to", numberOption("S", "--to", span.to), "of a recording: end S seconds after its first message or packet")
    ("every", countOption("--every", every, 1),
     "of a recording: take the first of every N messages or rotations (default 1)");
  // clang-format on
}

void RecordingOptions::check() const {
  if (span.from < 0) throw std::runtime_error("--from must not be negative");
  if (span.to < span.from) throw std::runtime_error("--to is before --from");
}

}  // namespace lisco_apps
