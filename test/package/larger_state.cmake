# SPDX-License-Identifier: BSD-3-Clause
# A program that was compiled before a private field was added to the states of the PCL classes runs with the larger
# states. The field comes first, so that all others move.
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)
file(REMOVE_RECURSE ${WORK_DIR})
file(MAKE_DIRECTORY ${WORK_DIR})

use_shared_libraries()
run(${CXX_COMPILER} ${SOURCE_DIR}/abi/host.cpp -o ${WORK_DIR}/host ${options})
run(${WORK_DIR}/host)
set(expected "${output}")

# add_field(SOURCE COPY): copies a file and adds the field to the state that it defines.
function(add_field source copy)
  file(READ ${source} text)
  string(REGEX REPLACE "(::State( : public [^{;]*)? {\n public:\n)" "\\1  int added_field[32] = {announce()};\n"
    larger "${text}")
  if(larger STREQUAL text)
    message(FATAL_ERROR "no state in ${source}")
  endif()
  file(WRITE ${copy} "${larger}")
endfunction()
foreach(name stream window endless)
  set(header pcl/segmentation/impl/lisco_${name}_extraction.hpp)
  add_field(${PREFIX}/include/${header} ${WORK_DIR}/include/${header})
endforeach()
add_field(${PROJECT_DIR}/src/pcl/lisco_cloud_clusterer.cpp ${WORK_DIR}/include/lisco_cloud_clusterer.cpp)
run(${CXX_COMPILER} -O1 -shared -fPIC -fvisibility=hidden -I${WORK_DIR}/include ${SOURCE_DIR}/abi/larger_state.cpp
  -o ${WORK_DIR}/liblarger.so ${options})

set(ENV{LD_PRELOAD} ${WORK_DIR}/liblarger.so)
run(${WORK_DIR}/host)
unset(ENV{LD_PRELOAD})
if(NOT output STREQUAL expected)
  message(FATAL_ERROR "With the larger states the host found\n${output}instead of\n${expected}")
endif()
string(REGEX MATCHALL "larger state" announced "${errors}")
list(LENGTH announced count)
if(count LESS 6)  # three extractions, a stream, windows, an endless stream; copies print nothing
  message(FATAL_ERROR "only ${count} larger states were made:\n${errors}")
endif()
