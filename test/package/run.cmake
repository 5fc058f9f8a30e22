# SPDX-License-Identifier: BSD-3-Clause
# Shared by the scripts.
string(REPLACE "," ";" PROGRAMS "${PROGRAMS}")

# run(COMMAND...): runs a command, which must succeed. Sets `output` and `errors` to what it prints.
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

# use_shared_libraries(): sets `libraries` to the folder of the installed shared libraries, and `options` to the
# compiler's options that use them.
function(use_shared_libraries)
  set(libraries ${PREFIX}/${LIBRARY_DIR})
  set(ENV{PKG_CONFIG_PATH} ${libraries}/pkgconfig:${PCL_LIBRARY_DIR}/pkgconfig)
  run(pkg-config --cflags --libs lisco)
  separate_arguments(options UNIX_COMMAND "${output}")
  list(APPEND options -Wl,-rpath,${libraries})
  set(libraries ${libraries} PARENT_SCOPE)
  set(options ${options} PARENT_SCOPE)
endfunction()

# read_symbols(LIBRARY): sets `symbols` to the lines that nm prints of the symbols that a shared library defines.
function(read_symbols library)
  run(nm -DC --defined-only --format=posix ${PREFIX}/${LIBRARY_DIR}/lib${library}.so)
  string(REPLACE ";" "" output "${output}")
  string(STRIP "${output}" output)
  string(REGEX REPLACE "\n" ";" symbols "${output}")
  set(symbols "${symbols}" PARENT_SCOPE)
endfunction()

# expect(TEXT PATTERN WHAT): fails unless the text matches.
function(expect text pattern what)
  if(NOT "${text}" MATCHES "${pattern}")
    message(FATAL_ERROR "${what}: expected '${pattern}', got '${text}'")
  endif()
endfunction()
