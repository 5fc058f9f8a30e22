// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "recordings/recording.h"

#include <algorithm>
#include <array>
#include <set>
#include <stdexcept>

#include <boost/algorithm/string/case_conv.hpp>

namespace lisco_apps {
namespace {

struct Format {
  std::string_view ending;
  std::unique_ptr<Recording> (*open)(const fs::path& file);
};
constexpr std::array<Format, 3> kFormats{{{".db3", openSqliteBag}, {".mcap", openMcap}, {".bag", openRos1Bag}}};

const Format* formatOf(const fs::path& file) {
  const std::string ending = boost::to_lower_copy(file.extension().string());
  const auto* const found =
      std::find_if(kFormats.begin(), kFormats.end(), [&](const Format& format) { return format.ending == ending; });
  return found == kFormats.end() ? nullptr : found;
}

/// As of rosbag2's compression of files: "bag.db3.zstd".
bool isCompressedAsAWhole(const fs::path& file) {
  const std::string ending = boost::to_lower_copy(file.extension().string());
  return (ending == ".zstd" || ending == ".zst") && formatOf(file.stem()) != nullptr;
}

/// A folder with metadata.yaml, or with .db3 or .mcap files whose names differ in their numbers only.
bool isBagFolder(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) return false;
  if (fs::is_regular_file(folder / "metadata.yaml", error)) return true;
  std::set<std::string> names;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const fs::path& file = entry->path();
    const std::string ending = boost::to_lower_copy(file.extension().string());
    const std::string stem = file.stem().string();
    if (ending == ".db3" || ending == ".mcap")
      names.insert(stem.substr(0, stem.find_last_not_of("0123456789") + 1) + ending);
  }
  return names.size() == 1;
}

}  // namespace

bool isRecording(const fs::path& input) {
  return isBagFolder(input) || formatOf(input) != nullptr || isCompressedAsAWhole(input);
}

std::unique_ptr<Recording> openRecording(const fs::path& input) {
  std::error_code error;
  if (!fs::exists(input, error)) fail(input, error ? "cannot be read: " + error.message() : "does not exist");
  if (fs::is_directory(input, error)) return openBagFolder(input);
  if (isCompressedAsAWhole(input)) fail(input, "is compressed as a whole: decompress it (unzstd)");
  const Format* const format = formatOf(input);
  if (format == nullptr) fail(input, "is no recording (known: db3, mcap, bag)");
  if (fs::is_regular_file(input, error) && fs::file_size(input, error) == 0) fail(input, "is empty");
  return format->open(input);
}

std::string plainType(const std::string& type) {
  const std::size_t at = type.find("/msg/");
  return at == std::string::npos ? type : type.substr(0, at) + type.substr(at + 4);
}

Serialization serializationOf(const std::string& encoding) {
  if (encoding == "cdr") return Serialization::kCdr;
  return encoding == "ros1" || encoding == "rosmsg_v2" ? Serialization::kRos1 : Serialization::kOther;
}

std::size_t Recording::indexOf(const Topic& topic) {
  const auto found = std::find_if(topics_.begin(), topics_.end(), [&](const Topic& known) {
    return known.name == topic.name && known.type == topic.type && known.serialization == topic.serialization;
  });
  if (found != topics_.end()) return static_cast<std::size_t>(found - topics_.begin());
  topics_.push_back(topic);
  return topics_.size() - 1;
}

bool Recording::isSelected(std::size_t topic) const {
  return !selected_ || std::find(selected_->begin(), selected_->end(), topic) != selected_->end();
}

void Recording::countMessages() {
  Message message;
  start_ns_ = 0;
  bool is_first = true;
  while (next(message)) {
    ++topics_[message.topic].messages;
    start_ns_ = is_first ? message.time_ns : std::min(start_ns_, message.time_ns);
    is_first = false;
  }
  if (is_first && !error_.empty()) throw std::runtime_error(error_);
}

}  // namespace lisco_apps
