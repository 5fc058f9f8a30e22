// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include "bags.h"

#include <bzlib.h>
#include <lz4frame.h>
#include <sqlite3.h>
#include <unistd.h>

#include <fstream>
#include <stdexcept>

#include "io/little_endian.h"
#include "recordings/cdr_text.h"
#include "recordings/mcap_writer.h"

namespace lisco_test {

namespace fs = std::filesystem;
using lisco_apps::putNumber;
using lisco_apps::putText;

void FolderTest::SetUp() {
  std::string name = (fs::temp_directory_path() / "lisco_recordings_XXXXXX").string();
  ASSERT_NE(mkdtemp(name.data()), nullptr);
  folder_ = name;
}

void FolderTest::TearDown() {
  fs::remove_all(folder_);
}

fs::path FolderTest::beginningOf(const fs::path& whole, std::uintmax_t bytes) const {
  const fs::path part = folder_ / ("part_" + whole.filename().string());
  fs::copy_file(whole, part, fs::copy_options::overwrite_existing);
  fs::resize_file(part, bytes);
  return part;
}

TestRecording alternating(std::size_t messages, std::size_t bytes) {
  TestRecording recording{{{"/a", "std_msgs/msg/String"}, {"/b", "std_msgs/msg/String"}}, {}};
  for (std::size_t i = 0; i < messages; ++i) {
    std::string data(bytes, '\0');
    std::uint32_t state = static_cast<std::uint32_t>(i) + 1;
    for (char& c : data) c = static_cast<char>((state = state * 1664525U + 1013904223U) >> 24U);
    recording.messages.push_back(
        {i % 2, 1'600'000'000'000'000'000 + 100'000'000 * static_cast<std::int64_t>(i), std::move(data)});
  }
  return recording;
}

void writeDb3(const TestRecording& recording, const fs::path& file) {
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(file.c_str(), &database), SQLITE_OK);
  const auto run = [&](const std::string& text) {
    char* error = nullptr;
    if (sqlite3_exec(database, text.c_str(), nullptr, nullptr, &error) != SQLITE_OK)
      throw std::runtime_error(error == nullptr ? "sqlite" : error);
  };
  run("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
      "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)");
  run("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, "
      "data BLOB NOT NULL)");
  run("CREATE INDEX timestamp_idx ON messages (timestamp ASC)");
  run("BEGIN");
  for (std::size_t i = 0; i < recording.topics.size(); ++i)
    run("INSERT INTO topics VALUES(" + std::to_string(i + 1) + ",'" + recording.topics[i].name + "','" +
        recording.topics[i].type + "','cdr','')");
  sqlite3_stmt* insert = nullptr;
  ASSERT_EQ(sqlite3_prepare_v2(database, "INSERT INTO messages(topic_id, timestamp, data) VALUES(?,?,?)", -1, &insert,
                               nullptr),
            SQLITE_OK);
  for (const TestMessage& message : recording.messages) {
    sqlite3_bind_int64(insert, 1, static_cast<sqlite3_int64>(message.topic) + 1);
    sqlite3_bind_int64(insert, 2, message.time_ns);
    sqlite3_bind_blob(insert, 3, message.data.data(), static_cast<int>(message.data.size()), SQLITE_TRANSIENT);
    ASSERT_EQ(sqlite3_step(insert), SQLITE_DONE);
    sqlite3_reset(insert);
  }
  sqlite3_finalize(insert);
  run("COMMIT");
  sqlite3_close(database);
}

void writeMcap(const TestRecording& recording, const fs::path& file) {
  std::vector<lisco_apps::McapWriter::Channel> channels;
  for (const TestTopic& topic : recording.topics) channels.push_back({topic.name, topic.type, ""});
  lisco_apps::McapWriter writer(file, "tests", channels);
  for (const TestMessage& message : recording.messages) writer.write(message.topic, message.time_ns, message.data);
  writer.finish();
}

namespace {

using Fields = std::vector<std::pair<std::string, std::string>>;

template <typename Number>
std::string bytesOf(Number number) {
  std::string bytes;
  putNumber(bytes, number);
  return bytes;
}

std::string headerOf(const Fields& fields) {
  std::string header;
  for (const auto& [name, value] : fields) putText(header, name + "=" + value);
  return header;
}

std::string recordOf(const Fields& fields, const std::string& data) {
  std::string record;
  putText(record, headerOf(fields));
  putText(record, data);
  return record;
}

std::string op(int value) {
  return std::string(1, static_cast<char>(value));
}

std::string timeOf(std::int64_t time_ns) {
  return bytesOf(static_cast<std::uint32_t>(time_ns / 1000000000)) +
         bytesOf(static_cast<std::uint32_t>(time_ns % 1000000000));
}

std::string compressed(const std::string& data, const std::string& method) {
  if (method == "none") return data;
  std::string result(data.size() + 65536, '\0');
  if (method == "lz4") {
    result.resize(LZ4F_compressFrameBound(data.size(), nullptr));
    result.resize(LZ4F_compressFrame(result.data(), result.size(), data.data(), data.size(), nullptr));
  } else {
    auto size = static_cast<unsigned>(result.size());
    EXPECT_EQ(BZ2_bzBuffToBuffCompress(result.data(), &size, const_cast<char*>(data.data()),
                                       static_cast<unsigned>(data.size()), 9, 0, 0),
              BZ_OK);
    result.resize(size);
  }
  return result;
}

}  // namespace

void writeRos1Bag(const TestRecording& recording, const std::string& compression, bool is_finished,
                  const fs::path& file) {
  constexpr std::size_t kMessagesOfChunk = 4;
  const auto connection = [&](std::size_t i) {
    return recordOf(
        {{"op", op(7)}, {"conn", bytesOf(static_cast<std::uint32_t>(i))}, {"topic", recording.topics[i].name}},
        headerOf({{"topic", recording.topics[i].name},
                  {"type", lisco_apps::plainType(recording.topics[i].type)},
                  {"md5sum", "*"},
                  {"message_definition", "string data\n"}}));
  };
  std::string chunks;
  std::string infos;
  std::uint32_t chunk_count = 0;
  const std::string magic = "#ROSBAG V2.0\n";
  constexpr std::size_t kBagHeader = 4096;
  for (std::size_t first = 0; first < recording.messages.size(); first += kMessagesOfChunk) {
    std::string content;
    if (first == 0)
      for (std::size_t i = 0; i < recording.topics.size(); ++i) content += connection(i);
    std::vector<std::uint32_t> counts(recording.topics.size(), 0);
    const std::size_t last = std::min(first + kMessagesOfChunk, recording.messages.size());
    for (std::size_t i = first; i < last; ++i) {
      const TestMessage& message = recording.messages[i];
      content += recordOf({{"op", op(2)},
                           {"conn", bytesOf(static_cast<std::uint32_t>(message.topic))},
                           {"time", timeOf(message.time_ns)}},
                          message.data);
      ++counts[message.topic];
    }
    std::string list;
    for (std::size_t i = 0; i < counts.size(); ++i) list += bytesOf(static_cast<std::uint32_t>(i)) + bytesOf(counts[i]);
    infos += recordOf({{"op", op(6)},
                       {"ver", bytesOf(std::uint32_t{1})},
                       {"chunk_pos", bytesOf(std::uint64_t{magic.size() + kBagHeader + chunks.size()})},
                       {"start_time", timeOf(recording.messages[first].time_ns)},
                       {"end_time", timeOf(recording.messages[last - 1].time_ns)},
                       {"count", bytesOf(static_cast<std::uint32_t>(counts.size()))}},
                      list);
    chunks += recordOf(
        {{"op", op(5)}, {"compression", compression}, {"size", bytesOf(static_cast<std::uint32_t>(content.size()))}},
        compressed(content, compression));
    chunks += recordOf({{"op", op(4)},
                        {"ver", bytesOf(std::uint32_t{1})},
                        {"conn", bytesOf(std::uint32_t{0})},
                        {"count", bytesOf(std::uint32_t{0})}},
                       "");
    ++chunk_count;
  }
  const std::uint64_t index_at = is_finished ? magic.size() + kBagHeader + chunks.size() : 0;
  const std::string header = headerOf({{"op", op(3)},
                                       {"index_pos", bytesOf(index_at)},
                                       {"conn_count", bytesOf(static_cast<std::uint32_t>(recording.topics.size()))},
                                       {"chunk_count", bytesOf(chunk_count)}});
  std::string bag = magic;
  putText(bag, header);
  putText(bag, std::string(kBagHeader - 8 - header.size(), ' '));
  bag += chunks;
  if (is_finished) {
    for (std::size_t i = 0; i < recording.topics.size(); ++i) bag += connection(i);
    bag += infos;
  }
  std::ofstream(file, std::ios::binary) << bag;
}

std::vector<ReadMessage> messagesOf(lisco_apps::Recording& recording) {
  std::vector<ReadMessage> messages;
  lisco_apps::Message message;
  while (recording.next(message))
    messages.push_back({recording.topics()[message.topic].name, message.time_ns,
                        std::string(reinterpret_cast<const char*>(message.data), message.size)});
  return messages;
}

void expectBeginning(const TestRecording& recording, const std::vector<ReadMessage>& messages) {
  ASSERT_LE(messages.size(), recording.messages.size());
  for (std::size_t i = 0; i < messages.size(); ++i) {
    EXPECT_EQ(messages[i].topic, recording.topics[recording.messages[i].topic].name) << i;
    EXPECT_EQ(messages[i].time_ns, recording.messages[i].time_ns) << i;
    EXPECT_TRUE(messages[i].data == recording.messages[i].data) << i;
  }
}

std::string pointCloud2(const std::vector<TestPoint>& points, bool is_ros1) {
  constexpr std::uint32_t kStep = 20;
  std::string data;
  for (const TestPoint& point : points) {
    for (const float value : {point.x, point.y, point.z}) putNumber(data, value);
    putNumber(data, point.ring);
    putNumber(data, std::uint16_t{0});
    putNumber(data, point.time);
  }
  const auto count = static_cast<std::uint32_t>(points.size());
  struct Field {
    const char* name;
    std::uint32_t offset;
    std::uint8_t type;
  };
  const std::vector<Field> fields{{"x", 0, 7}, {"y", 4, 7}, {"z", 8, 7}, {"ring", 12, 4}, {"time", 16, 7}};
  if (is_ros1) {
    std::string message;
    for (const std::uint32_t value : {7U, 12U, 34U}) putNumber(message, value);  // sequence number, time
    putText(message, "lidar");
    for (const std::uint32_t value : {1U, count, 5U}) putNumber(message, value);
    for (const Field& field : fields) {
      putText(message, field.name);
      putNumber(message, field.offset);
      putNumber(message, field.type);
      putNumber(message, std::uint32_t{1});
    }
    putNumber(message, std::uint8_t{0});
    putNumber(message, kStep);
    putNumber(message, kStep * count);
    putText(message, data);
    putNumber(message, std::uint8_t{1});
    return message;
  }
  lisco_apps::CdrText message;
  message.header(12'000'000'034, "lidar");
  for (const std::uint32_t value : {1U, count, 5U}) message.number(value);
  for (const Field& field : fields) {
    message.text(field.name);
    message.number(field.offset);
    message.number(field.type);
    message.number(std::uint32_t{1});
  }
  message.number(std::uint8_t{0});
  message.number(kStep);
  message.number(kStep * count);
  message.number(static_cast<std::uint32_t>(data.size()));
  message.bytes() += data;
  message.number(std::uint8_t{1});
  return message.done();
}

}  // namespace lisco_test
