// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

#include <limits>
#include <vector>

#include <pcl/for_each_type.h>
#include <pcl/point_struct_traits.h>
#include <pcl/segmentation/lisco_point_cloud2.h>

namespace pcl {

namespace detail {

/** \brief Lists the fields of a point type, for for_each_type (). */
template <typename PointT>
struct LiscoFieldLister {
  std::vector<LiscoField>& fields;

  template <typename Tag>
  void operator()() {
    fields.push_back({::pcl::traits::name<PointT, Tag>::value, ::pcl::traits::offset<PointT, Tag>::value,
                      ::pcl::traits::datatype<PointT, Tag>::value, ::pcl::traits::datatype<PointT, Tag>::size});
  }
};

}  // namespace detail

}  // namespace pcl

template <typename PointT>
bool pcl::organizeLiscoCloud(const PCLPointCloud2& message, PointCloud<PointT>& cloud, Indices& point_of_cell) {
  std::vector<detail::LiscoField> fields;
  for_each_type<typename ::pcl::traits::fieldList<PointT>::type>(detail::LiscoFieldLister<PointT>{fields});

  detail::LiscoMessageReader reader;
  cloud.clear();
  point_of_cell.clear();
  if (!reader.open(message, fields, "pcl::organizeLiscoCloud")) return (false);
  point_of_cell.swap(reader.cells());

  PointT missing{};
  missing.x = missing.y = missing.z = std::numeric_limits<float>::quiet_NaN();
  cloud.header = message.header;
  cloud.points.assign(point_of_cell.size(), missing);
  cloud.width = static_cast<std::uint32_t>(reader.width());
  cloud.height = static_cast<std::uint32_t>(reader.height());
  cloud.is_dense = message.is_dense != 0;
  for (std::size_t cell = 0; cell < point_of_cell.size(); ++cell) {
    if (point_of_cell[cell] == UNAVAILABLE) {
      cloud.is_dense = false;
      continue;
    }
    cloud.points[cell] = PointT();
    reader.copyPoint(point_of_cell[cell], reinterpret_cast<std::uint8_t*>(&cloud.points[cell]));
  }
  return (true);
}

#define PCL_INSTANTIATE_organizeLiscoCloud(T) \
  template bool PCL_EXPORTS pcl::organizeLiscoCloud<T>(const pcl::PCLPointCloud2&, pcl::PointCloud<T>&, pcl::Indices&);
