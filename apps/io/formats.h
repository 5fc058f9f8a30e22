// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <string>

#include <pcl/PCLPointCloud2.h>

#include "io/cloud_file.h"
#include "io/scan_file.h"
#include "io/text.h"

namespace pcl {
class FileReader;
}

namespace lisco_apps {

/// What a file holds besides its points.
struct ReadExtras {
  pcl::PCLPointCloud2 fields;        ///< all, of each point of the cloud; empty if x, y, z are all
  pcl::PCLPointCloud2 message;       ///< of an unorganized cloud with field `ring`: its points; else empty
  std::vector<std::uint16_t> rings;  ///< of the points of an unorganized cloud, which is sorted by them; else empty
  std::string note;                  ///< how the file was read
};

// The readers behind readScan, one per format: a file that exists and is not empty to a cloud. They throw
// std::runtime_error as readScan does.
Cloud::Ptr readPcd(const fs::path& file, const ReadOptions& options, ReadExtras& extras);
Cloud::Ptr readPly(const fs::path& file, const ReadOptions& options, ReadExtras& extras);
Cloud::Ptr readFloatBin(const fs::path& file, const ReadOptions& options, ReadExtras& extras);
Cloud::Ptr readAuthorsCsv(const fs::path& file, const ReadOptions& options, ReadExtras& extras);
Cloud::Ptr readNpy(const fs::path& file, const ReadOptions& options, ReadExtras& extras);

/// Appends a field of one value. \param datatype of pcl::PCLPointField
void addField(pcl::PCLPointCloud2& cloud, const std::string& name, std::uint8_t datatype);
/// Makes room for points of these fields.
void allocate(pcl::PCLPointCloud2& cloud, std::uint32_t width, std::uint32_t height);
/// The points of a cloud with their rings.
pcl::PCLPointCloud2 messageOf(const Cloud& cloud, const std::vector<std::uint16_t>& rings);

// --- PCD and PLY, which PCL parses once their header has been checked ----------------------------------------------

inline constexpr int kMaxHeaderLines = 1000;

std::vector<std::string> wordsOf(const std::string& line);
/// A count in a header; NaN if the word is missing or no count.
double headerCount(const std::vector<std::string>& words, std::size_t at);

/// \param format as errors name it
/// \param check_header throws if the content would make PCL's reader crash, abort, or allocate far more than the file
///        holds; `file` is the name for errors
Cloud::Ptr readByPcl(pcl::FileReader& reader, const fs::path& file, const std::string& format,
                     void (*check_header)(const fs::path& file, const fs::path& content), ReadExtras& extras);

}  // namespace lisco_apps
