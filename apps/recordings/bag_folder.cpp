// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// A ROS 2 bag as a folder: files that continue each other, in the order of metadata.yaml (`relative_file_paths`) or,
// without it, of the numbers at the ends of their names.
#include <algorithm>
#include <fstream>

#include <boost/algorithm/string.hpp>

#include "recordings/recording.h"

namespace lisco_apps {
namespace {

/// The items of a list in a YAML file, one in a line.
std::vector<std::string> listedFiles(const fs::path& metadata) {
  std::ifstream stream(metadata);
  if (!stream) fail(metadata, "cannot be read");
  std::vector<std::string> files;
  bool is_in_list = false;
  for (std::string line; std::getline(stream, line);) {
    boost::trim(line);
    if (line == "relative_file_paths:") {
      is_in_list = true;
    } else if (is_in_list && boost::starts_with(line, "- ")) {
      files.push_back(boost::trim_copy_if(line.substr(2), boost::is_any_of(" \"'")));
    } else if (is_in_list) {
      break;
    }
  }
  return files;
}

/// By the number at the end of a name, after the text before it: bag_2 before bag_10.
bool comesBefore(const fs::path& a, const fs::path& b) {
  const auto split = [](const fs::path& file) {
    const std::string stem = file.stem().string();
    const std::size_t digits = stem.find_last_not_of("0123456789") + 1;
    const std::string number = boost::trim_left_copy_if(stem.substr(digits), boost::is_any_of("0"));
    return std::make_tuple(stem.substr(0, digits), number.size(), number, file.extension().string());
  };
  return split(a) < split(b);
}

std::vector<fs::path> splitsIn(const fs::path& folder) {
  std::vector<fs::path> files;
  try {
    if (fs::exists(folder / "metadata.yaml"))
      for (const std::string& name : listedFiles(folder / "metadata.yaml")) {
        files.push_back(folder / fs::path(name).filename());  // older bags name their folder as well
        if (fs::is_directory(files.back()))                   // such as `folder` itself, if the name is empty
          fail(folder / "metadata.yaml", "names a folder instead of a file: '" + name + "'");
      }
    if (!files.empty()) return files;
    for (const auto& entry : fs::directory_iterator(folder)) {
      const std::string ending = boost::to_lower_copy(entry.path().extension().string());
      if ((ending == ".db3" || ending == ".mcap") && entry.is_regular_file()) files.push_back(entry.path());
    }
  } catch (const fs::filesystem_error& error) {
    fail(folder, "cannot be read: " + error.code().message());
  }
  if (files.empty()) fail(folder, "is no ROS 2 bag: it holds no .db3 or .mcap");
  std::sort(files.begin(), files.end(), comesBefore);
  return files;
}

class BagFolder : public Recording {
 public:
  explicit BagFolder(const fs::path& folder) {
    bool is_first = true;
    for (const fs::path& file : splitsIn(folder)) {
      if (file.extension() == ".zstd")
        fail(file, "is compressed as a whole: decompress it (unzstd), and name the result in metadata.yaml");
      try {
        // Opened one at a time later on: a recording may have more splits than a process may have files.
        const std::unique_ptr<Recording> split = openRecording(file);
        std::vector<std::size_t> topics;
        std::uint64_t messages = 0;
        for (const Topic& topic : split->topics()) {
          topics.push_back(indexOf({topic.name, topic.type, topic.serialization, 0}));
          topics_[topics.back()].messages += topic.messages;
          messages += topic.messages;
        }
        splits_.push_back({file, topics, static_cast<double>(std::max<std::uint64_t>(messages, 1))});
        if (messages > 0) {
          start_ns_ = is_first ? split->startNs() : std::min(start_ns_, split->startNs());
          is_first = false;
        }
      } catch (const std::runtime_error& why) {
        // What comes before is read.
        first_error_ = why.what();
        break;
      }
    }
    if (splits_.empty()) throw std::runtime_error(first_error_);
    for (const Split& split : splits_) all_ += split.weight;
  }

  bool next(Message& message) override {
    while (error_.empty() && at_ < splits_.size()) {
      const Split& split = splits_[at_];
      if (!open_) open(split);
      if (open_->next(message)) {
        message.topic = split.topics[message.topic];
        return true;
      }
      error_ = open_->error();
      open_.reset();
      done_ += split.weight;
      ++at_;
    }
    if (error_.empty()) error_ = first_error_;
    return false;
  }

  double share() const override { return (done_ + (open_ ? open_->share() * splits_[at_].weight : 0)) / all_; }

 private:
  struct Split {
    fs::path file;
    std::vector<std::size_t> topics;  ///< of its topics
    double weight;
  };

  void open(const Split& split) {
    open_ = openRecording(split.file);
    std::vector<std::size_t> selected;
    for (std::size_t i = 0; i < split.topics.size(); ++i)
      if (isSelected(split.topics[i])) selected.push_back(i);
    open_->select(selected);
  }

  std::vector<Split> splits_;
  std::string first_error_;  ///< of a split that cannot be opened
  std::size_t at_ = 0;
  std::unique_ptr<Recording> open_;
  double done_ = 0, all_ = 0;  ///< weights
};

}  // namespace

std::unique_ptr<Recording> openBagFolder(const fs::path& folder) {
  return std::make_unique<BagFolder>(folder);
}

}  // namespace lisco_apps
