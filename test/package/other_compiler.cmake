# SPDX-License-Identifier: BSD-3-Clause
# Static libraries built and installed by OTHER_COMPILER, used by CXX_COMPILER, which has another OpenMP runtime.
# Debug, which compiles faster and links the same libraries.
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)
file(REMOVE_RECURSE ${WORK_DIR})
run(${CMAKE_COMMAND} -S ${PROJECT_DIR} -B ${WORK_DIR}/build -G ${GENERATOR} -DCMAKE_BUILD_TYPE=Debug
  -DCMAKE_CXX_COMPILER=${OTHER_COMPILER} -DCMAKE_CXX_COMPILER_LAUNCHER=${CXX_COMPILER_LAUNCHER}
  -DPCL_DIR=${PCL_DIR} -DBUILD_SHARED_LIBS=OFF -DLISCO_BUILD_APPS=OFF -DLISCO_BUILD_TESTS=OFF)
run(${CMAKE_COMMAND} --build ${WORK_DIR}/build --config Debug)
run(${CMAKE_COMMAND} --install ${WORK_DIR}/build --config Debug --prefix ${WORK_DIR}/prefix)
set(PREFIX ${WORK_DIR}/prefix)
set(TYPE STATIC_LIBRARY)
set(WORK_DIR ${WORK_DIR}/consumer)
include(${CMAKE_CURRENT_LIST_DIR}/consumer.cmake)
