# SPDX-License-Identifier: BSD-3-Clause
# What the scripts share.
string(REPLACE "," ";" PROGRAMS "${PROGRAMS}")

# run(COMMAND...): runs a command, which must succeed. Leaves what it printed in `output` and `errors`.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE errors)
  if(NOT status EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${output}${errors}\nfailed (${status}): ${command}")
  endif()
  set(output "${output}" PARENT_SCOPE)
  set(errors "${errors}" PARENT_SCOPE)
endfunction()

# build(SOURCE BUILD CMAKE-OPTION...): configures and builds a project.
function(build source build)
  run(${CMAKE_COMMAND} -S ${source} -B ${build} -G ${GENERATOR} -DCMAKE_BUILD_TYPE=${CONFIG}
    -DCMAKE_CXX_COMPILER=${CXX_COMPILER} -DCMAKE_CXX_COMPILER_LAUNCHER=${CXX_COMPILER_LAUNCHER}
    -DCMAKE_CXX_FLAGS=${CXX_FLAGS} -DPCL_DIR=${PCL_DIR} ${ARGN})
  run(${CMAKE_COMMAND} --build ${build} --config ${CONFIG})
endfunction()

# expect(TEXT PATTERN WHAT)
function(expect text pattern what)
  if(NOT "${text}" MATCHES "${pattern}")
    message(FATAL_ERROR "${what}: expected '${pattern}', got '${text}'")
  endif()
endfunction()
