// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
//
// The programs on a full disk, without write permission, with inputs that change, and when killed.
#include <signal.h>

#include <fstream>
#include <set>
#include <string>

#include "program_test.h"

namespace {

namespace fs = std::filesystem;

class Programs : public ProgramTest {
 protected:
  Programs() : ProgramTest(LISCO_CLUSTER) {}

  void SetUp() override {
    ProgramTest::SetUp();
    ASSERT_EQ(runLine(std::string(LISCO_SIMULATE) + " --scene 3 --seed 1 -o scan.pcd").status, 0);
    inputs_ = filesLeft();
  }

  /// Runs a command line that may write files of at most so many blocks of 512 bytes, which fails as on a full disk.
  Outcome runWithLimitedDisk(int blocks, const std::string& command) const {
    return runLine("sh -c \"trap '' XFSZ; ulimit -f " + std::to_string(blocks) + "; " + command + "\"");
  }

  std::vector<std::string> inputs_;
};

TEST_F(Programs, LeaveNoPartialResultsOnAFullDisk) {
  for (const int blocks : {0, 8, 300}) {
    SCOPED_TRACE(blocks);
    const Outcome outcome = runWithLimitedDisk(blocks, program_ + " scan.pcd -t 0.4 --clouds -o results 2>&1");
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.out.find("partial"), std::string::npos) << outcome.out;
    EXPECT_EQ(filesLeft(), inputs_);
  }
  EXPECT_EQ(run("scan.pcd -t 0.4 --clouds -o results").status, 0);
}

TEST_F(Programs, KeepEarlierResultsOnAFullDisk) {
  ASSERT_EQ(run("scan.pcd -t 0.4 --clouds -o results").status, 0);
  const std::vector<std::string> files = filesLeft();
  const std::string table = textOf(folder_ / "results/clusters.csv");
  EXPECT_EQ(runWithLimitedDisk(8, program_ + " scan.pcd -t 0.7 --clouds -o results 2>/dev/null").status, 2);
  EXPECT_EQ(filesLeft(), files);
  EXPECT_EQ(textOf(folder_ / "results/clusters.csv"), table);
}

TEST_F(Programs, LeaveNoPartialFilesOnAFullDisk) {
  for (const std::string& command :
       {LISCO_SIMULATE + std::string(" --scene 3 -o other.pcd"),
        LISCO_COMPARE + std::string(" scan.pcd -t 0.4 --check-only --baselines lisco --csv all.csv --json all.json")}) {
    SCOPED_TRACE(command);
    EXPECT_EQ(runWithLimitedDisk(0, command + " >/dev/null 2>&1").status, 2);
    EXPECT_EQ(filesLeft(), inputs_);
  }
}

TEST_F(Programs, ReportAnUnwritableStandardOutput) {
  if (!fs::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  const std::string compare = LISCO_COMPARE + std::string(" scan.pcd -t 0.4 --check-only --baselines lisco");
  for (const std::string& command :
       {program_ + " scan.pcd -t 0.4", program_ + " scan.pcd -t 0.4 --json", program_ + " --help", compare,
        LISCO_COMPARE + std::string(" --version"), LISCO_SIMULATE + std::string(" --scene 1 -o other.pcd"),
        LISCO_SIMULATE + std::string(" --case sheets -o other.pcd"),
        LISCO_SIMULATE + std::string(" --terrain road -o other.pcd")}) {
    SCOPED_TRACE(command);
    const Outcome outcome = runLine("sh -c '" + command + " >/dev/full'");
    EXPECT_EQ(outcome.status, 2);
    const std::string name = fs::path(command.substr(0, command.find(' '))).filename().string();
    EXPECT_EQ(outcome.err.substr(outcome.err.rfind(name)), name + ": the standard output cannot be written\n");
    fs::remove(folder_ / "other.pcd");
  }
}

TEST_F(Programs, RefuseAFolderWithoutWritePermission) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  fs::create_directory(folder_ / "closed");
  fs::permissions(folder_ / "closed", fs::perms::owner_read | fs::perms::owner_exec);
  expectRefusal("scan.pcd -t 0.4 -o closed/results", {"closed", "cannot be written: Permission denied"});
  expectRefusal("scan.pcd -t 0.4 -o closed", {"closed: cannot be written: Permission denied"});
  for (const std::string& command :
       {LISCO_SIMULATE + std::string(" --scene 3 -o closed/other.pcd"),
        LISCO_COMPARE + std::string(" scan.pcd -t 0.4 --check-only --baselines lisco --json closed/all.json"),
        LISCO_COMPARE + std::string(" scan.pcd -t 0.4 --baselines lisco --plot closed/charts")}) {
    const Outcome outcome = runLine(command);
    EXPECT_EQ(outcome.status, 2) << command;
    EXPECT_EQ(outcome.out, "") << command;  // reported before the work
    EXPECT_NE(outcome.err.find("cannot be written: Permission denied"), std::string::npos) << outcome.err;
  }
  fs::permissions(folder_ / "closed", fs::perms::owner_all);
}

// Another process rewrites the input all the time: the program gives a result or refuses it.
TEST_F(Programs, SurviveAFileThatChangesWhileRead) {
  ASSERT_EQ(runLine(std::string(LISCO_SIMULATE) + " --scene 3 --sensor os1-128 --seed 1 -o large.pcd").status, 0);
  const std::string whole = textOf(folder_ / "large.pcd");
  const pid_t writer = fork();
  if (writer == 0) {
    for (std::size_t round = 0;; ++round) {
      std::ofstream(folder_ / "changing.pcd", std::ios::binary) << whole;
      fs::resize_file(folder_ / "changing.pcd", whole.size() / (2 + round % 5));
    }
  }
  std::set<int> statuses;
  for (int i = 0; i < 40; ++i) {
    const Outcome outcome = run("changing.pcd -t 0.4 --json results.json");
    statuses.insert(outcome.status);
    EXPECT_TRUE(outcome.status == 0 || outcome.status == 2) << outcome.status << ": " << outcome.err;
  }
  kill(writer, SIGKILL);
  waitpid(writer, nullptr, 0);
  EXPECT_EQ(statuses.count(2), 1U) << "no run read a truncated file";
}

TEST_F(Programs, SurviveAFileThatVanishesWhileRead) {
  const std::string whole = textOf(folder_ / "scan.pcd");
  const pid_t writer = fork();
  if (writer == 0)
    for (;;) {
      std::ofstream(folder_ / "vanishing.pcd", std::ios::binary) << whole;
      fs::remove(folder_ / "vanishing.pcd");
    }
  for (int i = 0; i < 20; ++i) {
    const Outcome outcome = run("vanishing.pcd -t 0.4");
    EXPECT_TRUE(outcome.status == 0 || outcome.status == 2) << outcome.status << ": " << outcome.err;
  }
  kill(writer, SIGKILL);
  waitpid(writer, nullptr, 0);
}

// Killed at any time, results are whole, and the next run removes the leftovers.
TEST_F(Programs, LeaveWholeResultsWhenKilled) {
  ASSERT_EQ(run("scan.pcd -t 0.4 --clouds -o whole").status, 0);
  const std::size_t whole = filesLeft().size() - inputs_.size();
  fs::remove_all(folder_ / "whole");
  for (int ms = 0; ms < 400; ms += 20) {
    SCOPED_TRACE(ms);
    const std::string wait = "sleep " + std::to_string(ms / 1000.0);
    runLine("sh -c '" + program_ + " scan.pcd -t 0.4 --clouds -o results & p=$!; " + wait +
            "; kill -KILL $p; wait $p'");
  }
  ASSERT_EQ(run("scan.pcd -t 0.4 --clouds -o results").status, 0);
  EXPECT_EQ(filesLeft().size() - inputs_.size(), whole);
}

TEST_F(Programs, KeepFilesOfRunningProcesses) {
  fs::create_directories(folder_ / "results");
  const pid_t child = fork();
  if (child == 0) _exit(0);
  waitpid(child, nullptr, 0);
  const std::string living = "results/.lisco_partial_" + std::to_string(getpid());
  const std::string dead = "results/.lisco_partial_" + std::to_string(child);
  fs::create_directories(folder_ / living);
  fs::create_directories(folder_ / dead);
  fs::create_directories(folder_ / "results/.lisco_partial_not_ours");
  ASSERT_EQ(run("scan.pcd -t 0.4 -o results").status, 0);
  EXPECT_TRUE(fs::exists(folder_ / living));
  EXPECT_FALSE(fs::exists(folder_ / dead));
  EXPECT_TRUE(fs::exists(folder_ / "results/.lisco_partial_not_ours"));
}

}  // namespace
