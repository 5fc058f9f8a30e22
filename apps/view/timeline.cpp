// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "view/timeline.h"

#include <utility>
#include <vector>

#include "io/output_file.h"
#include "view/page.h"

namespace lisco_apps {

ViewTimeline::ViewTimeline(fs::path file) : file_(std::move(file)) {
  if (!fs::exists(file_)) return;
  checkMayWrite(file_, kViewSignature);
  fs::remove(file_);
}

void ViewTimeline::add(std::size_t number, std::string scan) {
  if (bytes_ + scan.size() > kMaxBytes) {
    ++left_out_;
    return;
  }
  bytes_ += scan.size();
  scans_[number] = std::move(scan);
}

std::string ViewTimeline::write() const {
  if (scans_.empty()) return {};
  std::vector<std::string> scans;
  for (const auto& [number, scan] : scans_) scans.push_back(scan);
  const std::string all = formatted("%zu scans", scans.size());
  writeOwnFile(file_, viewPage(all, scans), kViewSignature);
  return file_.string() + " shows " + all + (left_out_ > 0 ? formatted("; %zu more do not fit", left_out_) : "");
}

}  // namespace lisco_apps
