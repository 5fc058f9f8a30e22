// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

/// The result of a program.
struct Outcome {
  int status;
  std::string out, err;
};

/// A test that runs a program in a temporary folder.
class ProgramTest : public testing::Test {
 protected:
  /// \param program path of the program that run () runs
  explicit ProgramTest(std::string program) : program_(std::move(program)) {}

  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "lisco_programs_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  static std::string textOf(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  }

  static std::string floats(const std::vector<float>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)};
  }

  void write(const std::string& name, const std::string& content) const {
    std::ofstream(folder_ / name, std::ios::binary) << content;
  }

  /// Runs a command line in the folder.
  Outcome runLine(const std::string& command) const {
    const std::string whole = "cd '" + folder_.string() + "' && " + command + " >out.txt 2>err.txt </dev/null";
    const int status = std::system(whole.c_str());
    Outcome outcome{WIFEXITED(status) ? WEXITSTATUS(status) : -1, textOf(folder_ / "out.txt"),
                    textOf(folder_ / "err.txt")};
    std::filesystem::remove(folder_ / "out.txt");
    std::filesystem::remove(folder_ / "err.txt");
    return outcome;
  }
  Outcome run(const std::string& arguments) const { return runLine(program_ + " " + arguments); }

  std::vector<std::string> filesLeft() const {
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_))
      files.push_back(std::filesystem::relative(entry.path(), folder_).string());
    std::sort(files.begin(), files.end());
    return files;
  }

  /// Expects one line on stderr with all of these words, exit code 2, and no new files.
  void expectRefusal(const std::string& arguments, const std::vector<std::string>& words) const {
    SCOPED_TRACE(arguments);
    const std::vector<std::string> before = filesLeft();
    const Outcome outcome = run(arguments);
    const std::string name = std::filesystem::path(program_).filename().string();
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_EQ(outcome.err.rfind(name + ": ", 0), 0U) << outcome.err;
    for (const std::string& word : words) EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
    EXPECT_EQ(filesLeft(), before);
  }

  std::string program_;
  std::filesystem::path folder_;
};
