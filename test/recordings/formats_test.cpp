// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#include <fstream>
#include <iterator>

#include "../sensors/temporary_folder.h"
#include "bags.h"
#include "recordings/recording.h"
#include "recordings/topic_reader.h"

namespace lisco_test {
namespace {

using lisco_apps::openRecording;
using lisco_apps::Recording;

class Formats : public FolderTest {
 protected:
  /// The recording in every format.
  std::vector<std::filesystem::path> written(const TestRecording& recording) const {
    writeDb3(recording, file("a.db3"));
    writeMcap(recording, file("a.mcap"));
    writeRos1Bag(recording, "none", true, file("none.bag"));
    writeRos1Bag(recording, "lz4", true, file("lz4.bag"));
    writeRos1Bag(recording, "bz2", true, file("bz2.bag"));
    writeRos1Bag(recording, "lz4", false, file("unfinished.bag"));
    return {file("a.db3"), file("a.mcap"), file("none.bag"), file("lz4.bag"), file("bz2.bag"), file("unfinished.bag")};
  }
};

TEST_F(Formats, GiveTheMessagesThatWereWritten) {
  const TestRecording recording = alternating(41, 3000);
  for (const auto& path : written(recording)) {
    SCOPED_TRACE(path);
    const std::unique_ptr<Recording> reader = openRecording(path);
    ASSERT_EQ(reader->topics().size(), 2U);
    EXPECT_EQ(reader->topics()[0].name, "/a");
    EXPECT_EQ(reader->topics()[0].type, "std_msgs/String");
    EXPECT_EQ(reader->topics()[0].messages, 21U);
    EXPECT_EQ(reader->topics()[1].messages, 20U);
    EXPECT_EQ(reader->startNs(), recording.messages.front().time_ns);
    const std::vector<ReadMessage> messages = messagesOf(*reader);
    EXPECT_EQ(messages.size(), 41U);
    expectBeginning(recording, messages);
    EXPECT_EQ(reader->error(), "");
  }
}

TEST_F(Formats, GiveTheMessagesOfSelectedTopics) {
  const TestRecording recording = alternating(41, 3000);
  for (const auto& path : written(recording)) {
    SCOPED_TRACE(path);
    const std::unique_ptr<Recording> reader = openRecording(path);
    reader->select({1});
    const std::vector<ReadMessage> messages = messagesOf(*reader);
    ASSERT_EQ(messages.size(), 20U);
    for (const ReadMessage& message : messages) EXPECT_EQ(message.topic, "/b");
    EXPECT_GE(reader->share(), 0.5);
    EXPECT_LE(reader->share(), 1);
  }
}

TEST_F(Formats, AreReadAsFarAsTheyGo) {
  const TestRecording recording = alternating(1000, 12000);
  const auto all = static_cast<double>(recording.messages.size());
  for (const auto& path : written(recording)) {
    for (const double share : {0.4, 0.6, 0.97}) {
      const auto size = static_cast<double>(std::filesystem::file_size(path));
      const std::filesystem::path part = beginningOf(path, static_cast<std::uintmax_t>(share * size));
      SCOPED_TRACE(part.string() + " " + std::to_string(share));
      const std::unique_ptr<Recording> reader = openRecording(part);
      std::uint64_t counted = 0;
      for (const lisco_apps::Topic& topic : reader->topics()) counted += topic.messages;
      const std::vector<ReadMessage> messages = messagesOf(*reader);
      EXPECT_EQ(counted, messages.size());
      // All but what shares a chunk with the break.
      EXPECT_GT(static_cast<double>(messages.size()), all * (share - 0.25));
      EXPECT_LT(static_cast<double>(messages.size()), all);
      expectBeginning(recording, messages);
      EXPECT_EQ(reader->error().rfind(part.string() + ": breaks off ", 0), 0U) << reader->error();
      EXPECT_EQ(reader->error().find('\n'), std::string::npos);
    }
  }
}

// Of a table of three levels, the way from the root to the first rows leads through pages near the end.
TEST_F(Formats, OfSqliteAreReadWithoutTheirEnd) {
  const TestRecording recording = alternating(9000, 600);
  writeDb3(recording, file("a.db3"));
  const auto size = static_cast<double>(std::filesystem::file_size(file("a.db3")));
  for (const double share : {0.02, 0.1, 0.5, 0.9}) {
    SCOPED_TRACE(share);
    const auto part = beginningOf(file("a.db3"), static_cast<std::uintmax_t>(share * size));
    const std::unique_ptr<Recording> reader = openRecording(part);
    const std::vector<ReadMessage> messages = messagesOf(*reader);
    EXPECT_GT(static_cast<double>(messages.size()), 9000 * (share - 0.01));
    expectBeginning(recording, messages);
    EXPECT_EQ(reader->error(), part.string() + ": breaks off after " + std::to_string(messages.size()) +
                                   " messages: the file has " + std::to_string(std::filesystem::file_size(part)) +
                                   " of " + std::to_string(static_cast<std::uintmax_t>(size)) + " bytes");
    reader->select({1});
    EXPECT_TRUE(messagesOf(*reader).empty()) << "after the end";
  }
}

TEST_F(Formats, OfMcapEndAtAWrongCheckSum) {
  const TestRecording recording = alternating(3000, 6000);
  writeMcap(recording, file("a.mcap"));
  std::fstream stream(file("a.mcap"), std::ios::binary | std::ios::in | std::ios::out);
  std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  std::vector<std::size_t> chunks;
  for (std::size_t at = 8; at + 9 < bytes.size();) {
    std::uint64_t length = 0;
    for (std::size_t i = 8; i-- > 0;) length = length << 8U | static_cast<std::uint8_t>(bytes[at + 1 + i]);
    if (bytes[at] == 6) chunks.push_back(at);
    at += 9 + static_cast<std::size_t>(length);
  }
  ASSERT_GT(chunks.size(), 4U);
  const std::size_t damaged = chunks[chunks.size() / 2], sum_at = damaged + 9 + 24;
  stream.seekp(static_cast<std::streamoff>(sum_at));
  stream.put(static_cast<char>(bytes[sum_at] ^ 1));
  stream.close();
  const std::unique_ptr<Recording> reader = openRecording(file("a.mcap"));
  const std::vector<ReadMessage> messages = messagesOf(*reader);
  EXPECT_GT(messages.size(), 1000U);
  EXPECT_LT(messages.size(), 2000U);
  expectBeginning(recording, messages);
  EXPECT_EQ(reader->error(), file("a.mcap").string() + ": breaks off at byte " + std::to_string(damaged) +
                                 ": a chunk whose check sum is wrong");
}

TEST_F(Formats, EndAtADamagedChunk) {
  const TestRecording recording = alternating(3000, 6000);
  writeMcap(recording, file("a.mcap"));
  writeRos1Bag(recording, "lz4", true, file("a.bag"));
  for (const char* const name : {"a.mcap", "a.bag"}) {
    SCOPED_TRACE(name);
    std::fstream stream(file(name), std::ios::binary | std::ios::in | std::ios::out);
    stream.seekp(static_cast<std::streamoff>(std::filesystem::file_size(file(name)) / 2));
    stream << std::string(64, '\xFF');
    stream.close();
    const std::unique_ptr<Recording> reader = openRecording(file(name));
    const std::vector<ReadMessage> messages = messagesOf(*reader);
    if (messages.size() == 3000U) continue;  // stored as it was: the damage is in a message
    EXPECT_GT(messages.size(), 500U);
    EXPECT_NE(reader->error().find("breaks off at byte"), std::string::npos) << reader->error();
  }
}

TEST_F(Formats, RefuseOtherFiles) {
  for (const char* const name : {"a.db3", "a.mcap", "a.bag"}) {
    SCOPED_TRACE(name);
    std::ofstream(file(name)) << "This is neither a database nor a bag, however long it may be; it is text."
                              << std::endl;
    try {
      openRecording(file(name));
      ADD_FAILURE();
    } catch (const std::runtime_error& why) {
      EXPECT_EQ(std::string(why.what()).rfind(file(name).string() + ": ", 0), 0U) << why.what();
    }
  }
  EXPECT_THROW(openRecording(file("missing.mcap")), std::runtime_error);
  for (const char* const name : {"a.db3.zstd", "A.MCAP.ZST"}) {
    std::ofstream(file(name)) << "compressed" << std::endl;
    EXPECT_TRUE(lisco_apps::isRecording(file(name)));
    EXPECT_EQ(lisco_test::refusalOf([&] { openRecording(file(name)); }),
              file(name).string() + ": is compressed as a whole: decompress it (unzstd)");
  }
  EXPECT_THROW(openRecording(file("a.txt")), std::runtime_error);
}

TEST_F(Formats, GiveTheMessagesOfATimeSpan) {
  const TestRecording recording = alternating(100, 100);
  for (const auto& path : written(recording)) {
    SCOPED_TRACE(path);
    lisco_apps::TopicReader reader(openRecording(path), 1, {2.05, 3.15});
    lisco_apps::Message message;
    std::vector<std::uint64_t> numbers;
    while (reader.next(message)) numbers.push_back(reader.number());
    // Messages 0.1, 0.3, ... s after the first one: 2.1 to 3.1.
    EXPECT_EQ(numbers, (std::vector<std::uint64_t>{11, 12, 13, 14, 15, 16}));
  }
}

TEST_F(Formats, JoinTheSplitsOfAFolder) {
  const TestRecording recording = alternating(24, 500);
  const auto partOf = [&](std::size_t first, std::size_t last) {
    TestRecording part{recording.topics, {}};
    part.messages.assign(recording.messages.begin() + static_cast<std::ptrdiff_t>(first),
                         recording.messages.begin() + static_cast<std::ptrdiff_t>(last));
    return part;
  };
  // Without metadata.yaml, by number: 2 before 10.
  std::filesystem::create_directories(file("bag"));
  writeMcap(partOf(0, 10), file("bag/bag_0.mcap"));
  writeMcap(partOf(10, 12), file("bag/bag_2.mcap"));
  writeMcap(partOf(12, 24), file("bag/bag_10.mcap"));
  ASSERT_TRUE(lisco_apps::isRecording(file("bag")));
  std::unique_ptr<Recording> reader = openRecording(file("bag"));
  EXPECT_EQ(reader->topics()[0].messages, 12U);
  EXPECT_EQ(reader->startNs(), recording.messages.front().time_ns);
  std::vector<ReadMessage> messages = messagesOf(*reader);
  EXPECT_EQ(messages.size(), 24U);
  expectBeginning(recording, messages);

  // With it, as it says.
  std::filesystem::create_directories(file("named"));
  writeDb3(partOf(0, 20), file("named/second.db3"));
  writeDb3(partOf(20, 24), file("named/first.db3"));
  std::ofstream(file("named/metadata.yaml")) << "rosbag2_bagfile_information:\n  version: 5\n"
                                                "  relative_file_paths:\n    - second.db3\n    - \"first.db3\"\n"
                                                "  duration:\n    nanoseconds: 1\n";
  reader = openRecording(file("named"));
  messages = messagesOf(*reader);
  EXPECT_EQ(messages.size(), 24U);
  expectBeginning(recording, messages);

  // A split that is missing ends it.
  std::filesystem::remove(file("named/first.db3"));
  reader = openRecording(file("named"));
  EXPECT_EQ(messagesOf(*reader).size(), 20U);
  EXPECT_NE(reader->error().find("first.db3: does not exist"), std::string::npos) << reader->error();

  // Names of folders, such as the bag's own, are refused.
  for (const char* const name : {"", ".", "sub/", ".."}) {
    std::ofstream(file("named/metadata.yaml")) << "  relative_file_paths:\n    - \"" << name << "\"\n";
    EXPECT_NE(refusalOf([&] { openRecording(file("named")); }).find("names a folder"), std::string::npos) << name;
  }
}

}  // namespace
}  // namespace lisco_test
