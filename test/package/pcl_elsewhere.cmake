# SPDX-License-Identifier: BSD-3-Clause
# Configures Lisco with a PCL outside the system's folders: installed files get its folder as a RPATH.
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)
file(REMOVE_RECURSE ${WORK_DIR})

# The folder, with links to the PCL of the system. CMake adds no RPATH for folders within the project, where the build
# folder may lie.
run(mktemp -d)
string(STRIP "${output}" pcl)
get_filename_component(root ${PCL_DIR}/../../../.. ABSOLUTE)
file(RELATIVE_PATH config ${root} ${PCL_DIR})
get_filename_component(libraries ${config}/../.. ABSOLUTE BASE_DIR ${pcl})
string(REGEX MATCH "^[0-9]+[.][0-9]+" version ${PCL_VERSION})
file(MAKE_DIRECTORY ${pcl}/include)
file(CREATE_LINK ${root}/include/pcl-${version} ${pcl}/include/pcl-${version} SYMBOLIC)
file(COPY ${PCL_DIR}/ DESTINATION ${pcl}/${config})
file(GLOB files ${PCL_LIBRARY_DIR}/libpcl_*.so*)
foreach(file IN LISTS files)
  get_filename_component(name ${file} NAME)
  file(CREATE_LINK ${file} ${libraries}/${name} SYMBOLIC)
endforeach()

execute_process(COMMAND ${CMAKE_COMMAND} -S ${PROJECT_DIR} -B ${WORK_DIR}/build -G ${GENERATOR}
  -DCMAKE_BUILD_TYPE=${CONFIG} -DCMAKE_CXX_COMPILER=${CXX_COMPILER} -DCMAKE_PREFIX_PATH=${pcl} -DLISCO_BUILD_TESTS=OFF
  RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
file(REMOVE_RECURSE ${pcl})
if(NOT status EQUAL 0)
  message(FATAL_ERROR "${output}")
endif()
file(READ ${WORK_DIR}/build/cmake_install.cmake script)
file(READ ${WORK_DIR}/build/cmake/install/cmake_install.cmake part)
string(APPEND script "${part}")
list(REMOVE_ITEM PROGRAMS lisco_simulate lisco_stream)  # which load no library of PCL
foreach(name liblisco.so ${PROGRAMS})
  if(NOT script MATCHES "/${name}\"[ \n]*OLD_RPATH \"[^\"]*\"[ \n]*NEW_RPATH \"[^\"]*:${libraries}\"")
    message(FATAL_ERROR "${name} is installed without ${libraries} in its RPATH")
  endif()
endforeach()
