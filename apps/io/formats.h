// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <string>
#include <string_view>

#include "io/cloud_file.h"
#include "io/text.h"

namespace pcl {
class FileReader;
}

namespace lisco_apps {

using Labels = std::vector<std::uint32_t>;

// The readers behind readCloudFile, one per format: a file that exists and is not empty to a cloud. `object_of` may be
// nullptr; formats without labels leave it as it is. They throw std::runtime_error as readCloudFile does.
Cloud::Ptr readPcd(const fs::path& file, Labels* object_of);
Cloud::Ptr readPly(const fs::path& file, Labels* object_of);
Cloud::Ptr readKittiBin(const fs::path& file, Labels* object_of);
Cloud::Ptr readAuthorsCsv(const fs::path& file, Labels* object_of);

std::string wholeContentOf(const fs::path& file);

// --- PCD and PLY, which PCL parses once their header has been checked ----------------------------------------------

inline constexpr int kMaxHeaderLines = 1000;

std::vector<std::string> wordsOf(const std::string& line);
/// A count in a header; NaN if the word is missing or no count.
double headerCount(const std::vector<std::string>& words, std::size_t at);

/// \param format as errors name it
/// \param check_header throws if the content would make PCL's reader crash, abort, or allocate far more than the file
///        holds; `file` is the name for errors
Cloud::Ptr readByPcl(pcl::FileReader& reader, const fs::path& file, const std::string& format,
                     void (*check_header)(const fs::path& file, const fs::path& content), Labels* object_of);

}  // namespace lisco_apps
