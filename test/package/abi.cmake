# SPDX-License-Identifier: BSD-3-Clause
# Builds and runs a program with and without AVX2, on a library without: both print the same.
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)
file(REMOVE_RECURSE ${WORK_DIR})
build(${SOURCE_DIR}/abi ${WORK_DIR}/build -DCMAKE_PREFIX_PATH=${PREFIX})
set(ENV{MALLOC_CHECK_} 3)  # of glibc: memory freed by the wrong function ends the program
run(${WORK_DIR}/build/host)
set(expected "${output}")
expect("${expected}" "extract: [1-9].*endless: [1-9]" "output of the host")
foreach(program host_avx2 host_avx2_debug)
  run(${WORK_DIR}/build/${program})
  if(NOT output STREQUAL expected)
    message(FATAL_ERROR "${program} found\n${output}instead of\n${expected}")
  endif()
  expect("${errors}" "Eigen aligns to (32|64) bytes" ${program})
endforeach()
