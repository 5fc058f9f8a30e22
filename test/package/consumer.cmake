# SPDX-License-Identifier: BSD-3-Clause
# Builds and runs the consumer project, by CMake with and without PCL, and by pkg-config.
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)
file(REMOVE_RECURSE ${WORK_DIR})

build(${SOURCE_DIR}/consumer ${WORK_DIR}/build -DCMAKE_PREFIX_PATH=${PREFIX})
run(${WORK_DIR}/build/with_pcl)
run(${WORK_DIR}/build/without_pcl)

# Without PCL, and for a shared library without any other package.
set(absent -DCMAKE_DISABLE_FIND_PACKAGE_PCL=ON -DCMAKE_DISABLE_FIND_PACKAGE_OpenMP=ON)
if(TYPE STREQUAL SHARED_LIBRARY)
  list(APPEND absent -DCMAKE_DISABLE_FIND_PACKAGE_PkgConfig=ON)
endif()
build(${SOURCE_DIR}/consumer ${WORK_DIR}/build_core -DCMAKE_PREFIX_PATH=${PREFIX} -DCOMPONENTS=core ${absent})
run(${WORK_DIR}/build_core/without_pcl)

# By pkg-config, whose flags set the standard.
file(GLOB_RECURSE files ${PREFIX}/*.pc)
list(GET files 0 file)
get_filename_component(folder ${file} DIRECTORY)
get_filename_component(libraries ${folder} DIRECTORY)
set(ENV{PKG_CONFIG_PATH} ${folder}:${PCL_LIBRARY_DIR}/pkgconfig)
set(ENV{LD_LIBRARY_PATH} ${libraries}:${PCL_LIBRARY_DIR})
separate_arguments(flags UNIX_COMMAND "${CXX_FLAGS}")
foreach(pair with_pcl:lisco without_pcl:lisco-core)
  string(REPLACE ":" ";" pair ${pair})
  list(GET pair 0 program)
  list(GET pair 1 package)
  run(pkg-config --cflags ${package})
  separate_arguments(compile_options UNIX_COMMAND "${output}")
  run(pkg-config --libs ${package})
  separate_arguments(link_options UNIX_COMMAND "${output}")
  if(package STREQUAL lisco-core AND "${compile_options}${link_options}" MATCHES "pcl|hwy" AND
     TYPE STREQUAL SHARED_LIBRARY)
    message(FATAL_ERROR "lisco-core requires other packages: ${compile_options} ${link_options}")
  endif()
  run(${CXX_COMPILER} -std=c++14 ${flags} ${compile_options} ${SOURCE_DIR}/consumer/${program}.cpp
    -o ${WORK_DIR}/${program} ${link_options})
  run(${WORK_DIR}/${program})
endforeach()
