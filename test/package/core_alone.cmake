# SPDX-License-Identifier: BSD-3-Clause
# The engine alone, within another project and installed, without PCL.
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)
file(REMOVE_RECURSE ${WORK_DIR})
set(WITHOUT_PCL -DCMAKE_DISABLE_FIND_PACKAGE_PCL=ON -DLISCO_BUILD_PCL=OFF)
build(${SOURCE_DIR}/subproject ${WORK_DIR}/build -DFETCHCONTENT_SOURCE_DIR_LISCO=${PROJECT_DIR} -DLISCO_INSTALL=ON
  ${WITHOUT_PCL})
run(${WORK_DIR}/build/without_pcl)
run(${CMAKE_COMMAND} --install ${WORK_DIR}/build --config ${CONFIG} --prefix ${WORK_DIR}/prefix)
file(GLOB_RECURSE installed ${WORK_DIR}/prefix/*pcl* ${WORK_DIR}/prefix/*lisco.pc)
if(installed)
  message(FATAL_ERROR "installed without PCL: ${installed}")
endif()
build(${SOURCE_DIR}/consumer ${WORK_DIR}/consumer -DCMAKE_PREFIX_PATH=${WORK_DIR}/prefix ${WITHOUT_PCL})
run(${WORK_DIR}/consumer/without_pcl)
