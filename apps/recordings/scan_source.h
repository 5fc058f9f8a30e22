// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "io/scan_file.h"
#include "recordings/options.h"
#include "sensors/decoder.h"

namespace lisco_apps {

/// Adds --bin-fields.
void addFileOptions(boost::program_options::options_description& shown, ReadOptions& files);

/// How the inputs of a program are read.
struct InputOptions {
  RecordingOptions recording;
  DecoderOptions decoder;             ///< of packets
  std::optional<std::uint16_t> port;  ///< of captures: only packets to it
  ReadOptions files;

  void addTo(boost::program_options::options_description& shown);
  void check() const;
};

/// A scan to be read.
struct ScanItem {
  std::string name;            ///< of the file; of a message, "bag.mcap 000012 at 1673400149.412"
  fs::path file;               ///< or recording
  std::string folder;          ///< for its results among those of the input; empty: the input is one scan
  std::size_t input = 0;       ///< number of the file or recording it is from
  std::int64_t time_ns = 0;    ///< of a message or rotation, nanoseconds since 1970; else 0
  bool of_packets = false;     ///< a rotation in the sensor's own frame
  std::function<Scan()> read;  ///< may be called on another thread. Throws what readScan () throws
};

/// The scans of files, folders of files, recordings (each message of a topic of clouds, each rotation of packets) and
/// captures, one after the other. Holds one message at a time. An input that cannot be read, or breaks off, is an item
/// whose read () throws.
class ScanSource {
 public:
  /// \param is_interrupted ends the preparation of decoders
  ScanSource(
      const std::vector<std::string>& inputs, const InputOptions& options,
      std::function<bool()> is_interrupted = [] { return false; });
  ~ScanSource();
  ScanSource(const ScanSource&) = delete;
  ScanSource& operator=(const ScanSource&) = delete;

  /// Files and recordings, in order.
  const std::vector<fs::path>& files() const { return files_; }
  /// Whether there is a recording or capture, which hold an unknown number of scans.
  bool hasRecording() const;
  /// What is wrong with the folders among the inputs, a line each; otherwise next () gives them as items.
  std::vector<std::string> takeFailures() { return std::exchange(failures_, {}); }
  /// Called with each line about how an input is read.
  void onNote(std::function<void(const std::string&)> note) { note_ = std::move(note); }

  /// \return nothing at the end
  std::optional<ScanItem> next();

  /// How much has been read, 0 to 1.
  double share() const;

 private:
  class Messages;
  class Turns;
  class Sequence;

  std::unique_ptr<Sequence> open(const fs::path& file);
  /// Notes the options that do not act on a kind of input.
  void noteIdle(InputKind kind, const std::string& heading) const;

  InputOptions options_;
  std::function<bool()> is_interrupted_;
  std::function<void(const std::string&)> note_ = [](const std::string&) {};
  std::vector<std::string> failures_;  ///< of expanding the inputs
  std::vector<fs::path> files_;
  std::size_t scan_files_ = 0;  ///< passed
  std::size_t at_ = 0;
  std::unique_ptr<Sequence> open_;
};

}  // namespace lisco_apps
