// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "program_test.h"

/// A program that runs beside its test, killed at the end of the test.
class Child {
 public:
  /// Starts a program in a folder, where its output goes to child_out.txt and child_err.txt.
  Child(const std::string& program, const std::vector<std::string>& arguments, const std::filesystem::path& folder)
      : folder_(folder) {
    std::vector<const char*> words{program.c_str()};
    for (const std::string& argument : arguments) words.push_back(argument.c_str());
    words.push_back(nullptr);
    for (const char* file : {"child_out.txt", "child_err.txt"}) std::filesystem::remove(folder / file);
    process_ = fork();
    if (process_ != 0) return;
    const auto redirect = [](const char* file, int to) { dup2(open(file, O_WRONLY | O_CREAT | O_TRUNC, 0600), to); };
    if (chdir(folder.c_str()) != 0) _exit(99);
    redirect("child_out.txt", STDOUT_FILENO);
    redirect("child_err.txt", STDERR_FILENO);
    execv(program.c_str(), const_cast<char* const*>(words.data()));
    _exit(99);
  }
  ~Child() {
    if (process_ <= 0) return;
    kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  std::string out() const { return textOf("child_out.txt"); }
  std::string err() const { return textOf("child_err.txt"); }
  void signal(int number) const { kill(process_, number); }

  /// Waits at most half a minute for a condition. \return whether it holds
  template <typename Condition>
  static bool waitUntil(Condition&& condition) {
    const auto give_up_at = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (!condition()) {
      if (std::chrono::steady_clock::now() > give_up_at) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return true;
  }

  /// Waits for the end of the program. \return its result; status -1 if it does not end
  Outcome end() {
    int status = 0;
    const bool has_ended = waitUntil([&] { return waitpid(process_, &status, WNOHANG) != 0; });
    if (has_ended) process_ = -1;
    return {has_ended && WIFEXITED(status) ? WEXITSTATUS(status) : -1, out(), err()};
  }

 private:
  std::string textOf(const char* name) const {
    std::ifstream stream(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  }

  std::filesystem::path folder_;
  pid_t process_ = -1;
};
