// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/text.h"

namespace lisco_apps {

/// How the fields of a message are written.
enum class Serialization { kCdr, kRos1, kOther };

struct Topic {
  std::string name;
  std::string type;  ///< such as "sensor_msgs/PointCloud2": without ROS 2's "/msg/"
  Serialization serialization = Serialization::kOther;
  std::uint64_t messages = 0;  ///< in the whole recording
};

struct Message {
  std::size_t topic = 0;               ///< index in Recording::topics ()
  std::int64_t time_ns = 0;            ///< when it was received, nanoseconds since 1970
  const std::uint8_t* data = nullptr;  ///< valid until the next one
  std::size_t size = 0;
};

/// The messages of a recording, one by one, in the order of the recording. Memory is bounded by the largest chunk or
/// message. A truncated or damaged recording is read as far as it goes.
///   const std::unique_ptr<Recording> recording = openRecording (file);
///   recording->select ({0});
///   Message message;
///   while (recording->next (message)) ...
///   if (!recording->error ().empty ()) ...
class Recording {
 public:
  virtual ~Recording() = default;

  /// All topics of the recording, by name.
  const std::vector<Topic>& topics() const { return topics_; }
  /// When the first message of any topic was received, nanoseconds since 1970; 0 if there is none.
  std::int64_t startNs() const { return start_ns_; }

  /// Restricts next () to these topics, indices in topics ().
  virtual void select(const std::vector<std::size_t>& topics) { selected_ = topics; }

  /// Reads the next message of the selected topics; of all before select (). \return false at the end
  virtual bool next(Message& message) = 0;

  /// How much has been read, 0 to 1.
  virtual double share() const = 0;

  /// One line that names the file: where the recording breaks off, and why; empty if it does not.
  const std::string& error() const { return error_; }

 protected:
  /// The index of a topic, by its name, type and serialization; adds it if it is new.
  std::size_t indexOf(const Topic& topic);
  bool isSelected(std::size_t topic) const;
  /// Counts the messages of a recording without an index, by reading it to its end, and finds its start.
  /// \throws std::runtime_error with one line if it breaks off before the first one
  void countMessages();

  std::vector<Topic> topics_;
  std::int64_t start_ns_ = 0;
  std::string error_;

 private:
  std::optional<std::vector<std::size_t>> selected_;  ///< nullopt: all
};

/// Whether openRecording () is the reader for an input: a file ending in .db3, .mcap or .bag, or a folder with
/// metadata.yaml, or .db3 or .mcap files that differ in the numbers at the ends of their names only.
bool isRecording(const fs::path& input);

/// Opens a ROS 2 bag (.db3, .mcap, or the folder with its metadata.yaml and splits) or a ROS 1 bag (.bag, version 2.0).
/// \throws std::runtime_error with one line that names the file, if it is no such recording
std::unique_ptr<Recording> openRecording(const fs::path& input);

// The readers behind it.
std::unique_ptr<Recording> openSqliteBag(const fs::path& file);
std::unique_ptr<Recording> openMcap(const fs::path& file);
std::unique_ptr<Recording> openRos1Bag(const fs::path& file);
std::unique_ptr<Recording> openBagFolder(const fs::path& folder);

/// A message type without ROS 2's "/msg/".
std::string plainType(const std::string& type);
/// By the name of the encoding: "cdr", "ros1" or another.
Serialization serializationOf(const std::string& encoding);

}  // namespace lisco_apps
