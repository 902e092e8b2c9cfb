# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors

# What `cmake --install` installs: the component "program" with models and
# documentation, and the component "development", the library for other programs.

include(CMakePackageConfigHelpers)

# --- program ---

install(TARGETS acf-dealii
  RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
install(DIRECTORY prm
  DESTINATION ${CMAKE_INSTALL_DATADIR}/acf-dealii COMPONENT program
  USE_SOURCE_PERMISSIONS
  PATTERN __pycache__ EXCLUDE
  PATTERN "*-results" EXCLUDE)
install(FILES README.md CHANGELOG.md CITATION.cff
  DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(DIRECTORY doc
  DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program
  PATTERN completion EXCLUDE
  PATTERN Doxyfile EXCLUDE
  PATTERN "*.dox" EXCLUDE
  PATTERN "*.1.in" EXCLUDE)
# Scripts for results, which find their modules beside bin or in share.
foreach(name render report sweep view)
  install(PROGRAMS scripts/${name}
    DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program
    RENAME acf-dealii-${name})
endforeach()
install(DIRECTORY scripts/acf_tools
  DESTINATION ${CMAKE_INSTALL_DATADIR}/acf-dealii COMPONENT program
  FILES_MATCHING PATTERN "*.py"
  PATTERN __pycache__ EXCLUDE)
# Debian's packages refer to the licence on the system instead.
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT licence)
# Models and documentation name each other as they lie in the sources.
set(links ${PROJECT_BINARY_DIR}/install)
file(MAKE_DIRECTORY ${links})
file(CREATE_LINK ../../acf-dealii/prm ${links}/prm SYMBOLIC)
file(CREATE_LINK ../doc/acf-dealii/doc ${links}/doc SYMBOLIC)
install(FILES ${links}/prm
  DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(FILES ${links}/doc
  DESTINATION ${CMAKE_INSTALL_DATADIR}/acf-dealii COMPONENT program)

find_program(GZIP_PROGRAM gzip REQUIRED)
set(man_page ${PROJECT_BINARY_DIR}/install/acf-dealii.1)
configure_file(doc/acf-dealii.1.in ${man_page} @ONLY)
execute_process(COMMAND ${GZIP_PROGRAM} -9nkf ${man_page}
  COMMAND_ERROR_IS_FATAL ANY)
install(FILES ${man_page}.gz
  DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
install(FILES doc/completion/acf-dealii
  DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions
  COMPONENT program)

# --- library ---

# Programs that use the library have warnings and optimisation of their own;
# deal.II's definitions come from acfConfig.cmake.
foreach(property INTERFACE_COMPILE_OPTIONS INTERFACE_COMPILE_DEFINITIONS)
  get_target_property(value acf ${property})
  set_property(TARGET acf PROPERTY ${property} "$<BUILD_INTERFACE:${value}>")
endforeach()
target_compile_features(acf INTERFACE $<INSTALL_INTERFACE:cxx_std_17>)

set(package_directory ${CMAKE_INSTALL_LIBDIR}/cmake/acf)
configure_package_config_file(cmake/acfConfig.cmake.in
  ${PROJECT_BINARY_DIR}/install/acfConfig.cmake
  INSTALL_DESTINATION ${package_directory}
  NO_SET_AND_CHECK_MACRO NO_CHECK_REQUIRED_COMPONENTS_MACRO)
write_basic_package_version_file(
  ${PROJECT_BINARY_DIR}/install/acfConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)

install(TARGETS acf EXPORT acfTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
  INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT acfTargets NAMESPACE acf::
  DESTINATION ${package_directory} COMPONENT development)
install(FILES
  ${PROJECT_BINARY_DIR}/install/acfConfig.cmake
  ${PROJECT_BINARY_DIR}/install/acfConfigVersion.cmake
  DESTINATION ${package_directory} COMPONENT development)
install(DIRECTORY include/acf ${PROJECT_BINARY_DIR}/include/acf
  DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development
  FILES_MATCHING PATTERN "*.h")
