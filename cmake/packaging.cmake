# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright (C) 2026 The acf-dealii authors

# Debian packages: `cpack -G DEB` in the build folder makes acf-dealii (program,
# models, documentation) and libacf-dev (library and headers). See
# doc/installation.md.

# Each package has its copyright file and a change log as Debian wants them.
string(TIMESTAMP ACF_PACKAGE_DATE "%a, %d %b %Y %H:%M:%S +0000" UTC)
set(CPACK_PACKAGE_CONTACT "The acf-dealii authors <acf-dealii@example.org>"
  CACHE STRING "Maintainer of the Debian packages")
set(package_files ${PROJECT_BINARY_DIR}/install/debian)
configure_file(cmake/debian/changelog.in ${package_files}/changelog @ONLY)
execute_process(COMMAND ${GZIP_PROGRAM} -9nkf ${package_files}/changelog
  COMMAND_ERROR_IS_FATAL ANY)
foreach(package acf-dealii libacf-dev)
  install(FILES cmake/debian/copyright ${package_files}/changelog.gz
    DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package}
    COMPONENT debian_${package} EXCLUDE_FROM_ALL)
endforeach()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_VENDOR "The acf-dealii authors")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE
  GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_COMPONENTS_ALL
  program debian_acf-dealii development debian_libacf-dev)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_DEB_COMPONENT_INSTALL ON)

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_COMPRESSION_TYPE xz)
set(CPACK_DEBIAN_PACKAGE_SOURCE acf-dealii)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME acf-dealii)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION science)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SUGGESTS
  "paraview, python3, python3-matplotlib, python3-numpy, python3-vtk9, xvfb")
set(CPACK_DEBIAN_RUNTIME_DESCRIPTION
  "flexible multibody dynamics of three-dimensional solids
acf-dealii simulates the motion of flexible bodies that turn and move through
large angles and distances while they deform little. The bodies are solids of
quadratic tetrahedra or hexahedra with absolute positions as unknowns and the
small strain in a frame that turns with the body (absolute coordinate
formulation); joints, springs, drives and loads connect them. A model is a
text file; results are files for ParaView and tables.")

# Headers of the library need these, and libraries of deal.II name the others
# when a program is linked.
set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libacf-dev)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS
  "libdeal.ii-dev (>= ${DEAL_II_VERSION}), libeigen3-dev, libgmsh-dev, \
libhdf5-mpi-dev, libmumps-dev, libopenblas-dev, libsuitesparse-dev, \
nlohmann-json3-dev, trilinos-all-dev")
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SUGGESTS "acf-dealii, cmake")
set(CPACK_DEBIAN_LIBRARY_DESCRIPTION
  "flexible multibody dynamics of three-dimensional solids (library)
This package has the static library of acf-dealii, its headers and its CMake
package, for programs that run simulations of flexible multibody systems with
the absolute coordinate formulation by themselves.")

include(CPack)
cpack_add_component_group(runtime)
cpack_add_component_group(library)
cpack_add_component(program GROUP runtime)
cpack_add_component(debian_acf-dealii GROUP runtime)
cpack_add_component(development GROUP library)
cpack_add_component(debian_libacf-dev GROUP library)
