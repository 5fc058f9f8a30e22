# SPDX-License-Identifier: BSD-3-Clause
# `pip install .` of a copy of the sources, without network.
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)
file(REMOVE_RECURSE ${WORK_DIR})
foreach(path apps/view CMakeLists.txt LICENSE README.md cmake include pyproject.toml python setup.py src)
  get_filename_component(folder source/${path} DIRECTORY)
  file(COPY ${PROJECT_DIR}/${path} DESTINATION ${WORK_DIR}/${folder})
endforeach()
# Not optimized, for one level of vector instructions: compiled in seconds.
set(ENV{CMAKE_ARGS} "-DCMAKE_CXX_FLAGS_RELEASE=-O0 -DCMAKE_CXX_FLAGS=-DHWY_COMPILE_ONLY_STATIC")
set(ENV{CMAKE_CXX_COMPILER_LAUNCHER} "${CXX_COMPILER_LAUNCHER}")
set(ENV{PIP_DISABLE_PIP_VERSION_CHECK} 1)
run(${PYTHON} -m pip install --quiet --no-index --no-build-isolation --no-deps --target ${WORK_DIR}/installed
  ${WORK_DIR}/source)
run(${CMAKE_COMMAND} -E env PYTHONPATH=${WORK_DIR}/installed ${PYTHON} ${CMAKE_CURRENT_LIST_DIR}/python_package.py)
expect("${output}" "^${VERSION} ${WORK_DIR}/installed/.* .0, 0, -1.\n$" "the package that pip installs")
foreach(file py.typed _core.pyi _view.*.so)
  file(GLOB found ${WORK_DIR}/installed/lisco/${file})
  if(NOT found)
    message(FATAL_ERROR "pip does not install ${file}")
  endif()
endforeach()
