# SPDX-License-Identifier: BSD-3-Clause
# The public headers, compiled as C++14: one error names the standard and ends the compilation.
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)
file(REMOVE_RECURSE ${WORK_DIR})
foreach(header pcl/segmentation/lisco_cluster_extraction.h pcl/segmentation/lisco_stream_extraction.h
    pcl/segmentation/lisco_window_extraction.h pcl/segmentation/lisco_endless_extraction.h
    pcl/io/lisco_point_cloud2.h pcl/segmentation/impl/lisco_cluster_extraction.hpp
    pcl/filters/lisco_ground_filter.h pcl/filters/impl/lisco_ground_filter.hpp lisco/ground_filter.h
    lisco/label_ground.h lisco/column_clusterer.h lisco/window_clusterer.h lisco/endless_clusterer.h)
  file(WRITE ${WORK_DIR}/source.cpp "#include <${header}>\n")
  execute_process(COMMAND ${CXX_COMPILER} -std=c++14 -fsyntax-only -isystem ${PREFIX}/include
    ${WORK_DIR}/source.cpp RESULT_VARIABLE status ERROR_VARIABLE errors)
  string(REGEX MATCHALL "[^\n]*error:[^\n]*" lines "${errors}")
  list(LENGTH lines count)
  expect("${errors}" "#error [^\n]*Lisco needs C[+][+]17" ${header})
  if(status EQUAL 0 OR count GREATER 2)
    message(FATAL_ERROR "${header} as C++14:\n${errors}")
  endif()
endforeach()
