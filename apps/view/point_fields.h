// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

#include <pcl/PCLPointCloud2.h>

namespace lisco_apps {

/// The values of a field of one number per point, of any of PCL's types.
/// \param names the field is the first of these that there is
/// \param points size of the cloud
/// \return empty if there is no such field, or the data are not of as many points
inline std::vector<double> numbersOf(const pcl::PCLPointCloud2& cloud, const std::vector<const char*>& names,
                                     std::size_t points) {
  std::vector<double> numbers;
  for (const char* name : names) {
    for (const pcl::PCLPointField& field : cloud.fields) {
      if (field.name != name || field.count > 1) continue;
      const auto read = [&](auto value) {
        if (field.offset + sizeof value > cloud.point_step || cloud.data.size() < points * cloud.point_step) return;
        for (std::size_t i = 0; i < points; ++i) {
          std::memcpy(&value, cloud.data.data() + i * cloud.point_step + field.offset, sizeof value);
          numbers.push_back(static_cast<double>(value));
        }
      };
      const auto type = field.datatype;
      if (type == pcl::PCLPointField::INT8) read(std::int8_t{});
      if (type == pcl::PCLPointField::UINT8) read(std::uint8_t{});
      if (type == pcl::PCLPointField::INT16) read(std::int16_t{});
      if (type == pcl::PCLPointField::UINT16) read(std::uint16_t{});
      if (type == pcl::PCLPointField::INT32) read(std::int32_t{});
      if (type == pcl::PCLPointField::UINT32) read(std::uint32_t{});
      if (type == pcl::PCLPointField::FLOAT32) read(float{});
      if (type == pcl::PCLPointField::FLOAT64) read(double{});
      if (!numbers.empty()) return numbers;
    }
  }
  return numbers;
}

}  // namespace lisco_apps
