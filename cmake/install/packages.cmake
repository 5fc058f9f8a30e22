# SPDX-License-Identifier: BSD-3-Clause
# `cpack` makes Debian packages, one for each component.
set(LISCO_PACKAGE_libraries liblisco${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(LISCO_PACKAGE_development liblisco-dev)
set(LISCO_PACKAGE_applications lisco-tools)
set(LISCO_PACKAGE_documentation lisco-doc)
set(components libraries development documentation)
if(programs)
  list(APPEND components applications)
endif()
set(LISCO_PACKAGE_python python3-lisco)
if(LISCO_BUILD_PYTHON)
  list(APPEND components python)
endif()
foreach(component IN LISTS components)
  string(TOUPPER ${component} COMPONENT)
  set(CPACK_DEBIAN_${COMPONENT}_PACKAGE_NAME ${LISCO_PACKAGE_${component}})
  install(FILES ${PROJECT_SOURCE_DIR}/LICENSE RENAME copyright COMPONENT ${component}
    DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/doc/${LISCO_PACKAGE_${component}})
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_COMPONENTS_ALL ${components})
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGE_CONTACT "the Lisco for PCL authors <lisco@lisco.invalid>")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)

set(CPACK_COMPONENT_LIBRARIES_DESCRIPTION "The libraries: the clustering engine, and its classes for PCL.")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "Headers, CMake package and pkg-config files.")
set(CPACK_COMPONENT_APPLICATIONS_DESCRIPTION "Programs that cluster scans, compare with PCL, and simulate scans.")
set(CPACK_COMPONENT_DOCUMENTATION_DESCRIPTION "Algorithm, contract, tutorials, benchmarks.")
set(CPACK_COMPONENT_PYTHON_DESCRIPTION "Python package: clusters of numpy arrays.")
set(CPACK_DEBIAN_LIBRARIES_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_APPLICATIONS_PACKAGE_SECTION science)
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_SECTION doc)
set(CPACK_DEBIAN_DOCUMENTATION_PACKAGE_ARCHITECTURE all)

# Dependencies: the libraries that the files are linked with, and the packages of other components.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR})  # the libraries that are being packaged
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS_POLICY ">=")
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)
set(CPACK_COMPONENT_DEVELOPMENT_DEPENDS libraries)
set(CPACK_COMPONENT_APPLICATIONS_DEPENDS libraries)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libpcl-dev (>= ${LISCO_PCL_LEAST})")
if(LISCO_CORE_TYPE STREQUAL STATIC_LIBRARY)
  string(APPEND CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS ", libhwy-dev")
endif()
set(CPACK_DEBIAN_APPLICATIONS_PACKAGE_RECOMMENDS fonts-dejavu-core)
set(CPACK_DEBIAN_APPLICATIONS_PACKAGE_SUGGESTS gnuplot-nox)  # charts
if(LISCO_BUILD_PYTHON)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_COMPONENT_PYTHON_DEPENDS libraries)
  math(EXPR next_minor "${Python3_VERSION_MINOR} + 1")  # the extension is compiled for one version of Python
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "python3 (>= 3.${Python3_VERSION_MINOR}~), python3 (<< 3.${next_minor}), python3-numpy")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS python3-matplotlib)
  # Removes what the interpreter compiled.
  file(WRITE ${CMAKE_CURRENT_BINARY_DIR}/prerm
    "#!/bin/sh\nset -e\nrm -rf \"\${DPKG_ROOT:-}/usr/${LISCO_PYTHON_DIR}/lisco/__pycache__\"\n")
  file(CHMOD ${CMAKE_CURRENT_BINARY_DIR}/prerm PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${CMAKE_CURRENT_BINARY_DIR}/prerm)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_STRICT_PERMISSION ON)
endif()
include(CPack)
