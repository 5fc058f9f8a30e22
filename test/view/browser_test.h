// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>

#include "browser.h"

/// One browser, with a folder, for all tests of a suite; they are skipped where none is installed.
class BrowserTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (Browser::installed().empty()) return;
    std::string name = (std::filesystem::temp_directory_path() / "lisco_view_XXXXXX").string();
    folder_ = mkdtemp(name.data());
    browser_ = std::make_unique<Browser>(folder_);
  }
  static void TearDownTestSuite() {
    browser_.reset();
    if (!folder_.empty()) std::filesystem::remove_all(folder_);
    folder_.clear();
  }
  void SetUp() override {
    if (!browser_) GTEST_SKIP() << "no Chromium: apt-get install --no-install-recommends chromium";
  }

  static inline std::filesystem::path folder_;
  static inline std::unique_ptr<Browser> browser_;
};
