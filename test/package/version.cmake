# SPDX-License-Identifier: BSD-3-Clause
# Programs, packages, headers and the changelog give the version of CMakeLists.txt.
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)
string(REPLACE "." "[.]" number ${VERSION})

set(ENV{LD_LIBRARY_PATH} ${PREFIX}/${LIBRARY_DIR})  # for programs made to be installed in /usr
foreach(program IN LISTS PROGRAMS)
  run(${PREFIX}/bin/${program} --version)
  expect("${output}" "^${program} ${number}\n$" "${program} --version")
endforeach()

set(libraries ${PREFIX}/${LIBRARY_DIR})
set(ENV{PKG_CONFIG_PATH} ${libraries}/pkgconfig)
foreach(package lisco lisco-core)
  run(pkg-config --modversion ${package})
  expect("${output}" "^${number}\n$" "${package}.pc")
endforeach()

set(PACKAGE_FIND_VERSION ${VERSION})
include(${libraries}/cmake/lisco/liscoConfigVersion.cmake)
if(NOT PACKAGE_VERSION_EXACT)
  message(FATAL_ERROR "liscoConfigVersion.cmake: ${PACKAGE_VERSION} instead of ${VERSION}")
endif()

file(READ ${PREFIX}/include/lisco/version.h header)
expect("${header}" "#define LISCO_VERSION \"${number}\"" lisco/version.h)

if(TYPE STREQUAL SHARED_LIBRARY)
  string(REGEX MATCH "^[0-9]+[.][0-9]+" interface ${VERSION})
  foreach(library lisco lisco_core)
    if(NOT EXISTS ${libraries}/lib${library}.so.${VERSION})
      message(FATAL_ERROR "no lib${library}.so.${VERSION} in ${libraries}")
    endif()
    run(objdump -p ${libraries}/lib${library}.so)
    expect("${output}" "SONAME +lib${library}[.]so[.]${interface}\n" "lib${library}.so")
  endforeach()
endif()

# The changelog's newest entry.
file(STRINGS ${PROJECT_DIR}/CHANGELOG.md entries REGEX "^## ")
list(GET entries 0 newest)
expect("${newest}" "^## ${number}( |$)" CHANGELOG.md)
