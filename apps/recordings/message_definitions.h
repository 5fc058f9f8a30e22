// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the Lisco for PCL authors
#pragma once

/// The fields of ROS 2's messages that are written, as ros2msg: a definition, then those it refers to.
namespace lisco_apps {

#define LISCO_MESSAGE(name) \
  "================================================================================\nMSG: " name "\n"
#define LISCO_HEADER                                                \
  LISCO_MESSAGE("std_msgs/Header")                                  \
  "builtin_interfaces/Time stamp\nstring frame_id\n" LISCO_MESSAGE( \
      "builtin_interfaces/Time") "int32 sec\nuint32 nanosec\n"

inline constexpr const char* kPointCloud2Definition =
    "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\nbool is_bigendian\n"
    "uint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n" LISCO_HEADER LISCO_MESSAGE(
        "sensor_msgs/PointField") "string name\nuint32 offset\nuint8 datatype\nuint32 count\n";

inline constexpr const char* kMarkerArrayDefinition =
    "visualization_msgs/Marker[] markers\n" LISCO_MESSAGE("visualization_msgs/Marker")
    "std_msgs/Header header\nstring ns\nint32 id\nint32 type\nint32 action\ngeometry_msgs/Pose pose\n"
    "geometry_msgs/Vector3 scale\nstd_msgs/ColorRGBA color\nbuiltin_interfaces/Duration lifetime\nbool frame_locked\n"
    "geometry_msgs/Point[] points\nstd_msgs/ColorRGBA[] colors\nstring texture_resource\n"
    "sensor_msgs/CompressedImage texture\nvisualization_msgs/UVCoordinate[] uv_coordinates\nstring text\n"
    "string mesh_resource\nvisualization_msgs/MeshFile mesh_file\nbool mesh_use_embedded_materials\n" LISCO_HEADER
    LISCO_MESSAGE("geometry_msgs/Pose") "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"
    LISCO_MESSAGE("geometry_msgs/Point") "float64 x\nfloat64 y\nfloat64 z\n"
    LISCO_MESSAGE("geometry_msgs/Quaternion") "float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"
    LISCO_MESSAGE("geometry_msgs/Vector3") "float64 x\nfloat64 y\nfloat64 z\n"
    LISCO_MESSAGE("std_msgs/ColorRGBA") "float32 r\nfloat32 g\nfloat32 b\nfloat32 a\n"
    LISCO_MESSAGE("builtin_interfaces/Duration") "int32 sec\nuint32 nanosec\n"
    LISCO_MESSAGE("sensor_msgs/CompressedImage") "std_msgs/Header header\nstring format\nuint8[] data\n"
    LISCO_MESSAGE("visualization_msgs/UVCoordinate") "float32 u\nfloat32 v\n"
    LISCO_MESSAGE("visualization_msgs/MeshFile") "string filename\nuint8[] data\n";

#undef LISCO_HEADER
#undef LISCO_MESSAGE

}  // namespace lisco_apps
