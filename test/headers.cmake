# SPDX-License-Identifier: BSD-3-Clause
# Every public header compiles alone, and twice in one file.
file(GLOB_RECURSE headers RELATIVE ${PROJECT_SOURCE_DIR}/include CONFIGURE_DEPENDS
  ${PROJECT_SOURCE_DIR}/include/*.h ${PROJECT_SOURCE_DIR}/include/*.hpp)
set(sources)
foreach(header IN LISTS headers ITEMS lisco/version.h)
  string(MAKE_C_IDENTIFIER ${header} name)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/headers/${name}.cpp)
  file(GENERATE OUTPUT ${source} CONTENT "#include <${header}>\n#include <${header}>\n")
  list(APPEND sources ${source})
endforeach()
add_library(lisco_headers_alone OBJECT ${sources})
target_link_libraries(lisco_headers_alone PRIVATE lisco_pcl lisco_flags)
