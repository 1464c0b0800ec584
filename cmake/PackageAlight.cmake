# `cpack` in the build folder: Debian packages of what `cmake --install` installs under /usr.
#   alight_<version>-1_<architecture>.deb          tools, node, shipped files, documents; what they link, by dpkg-shlibdeps
#   libalight-dev_<version>-1_<architecture>.deb   static libraries, headers, CMake package, examples
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME alight)
set(CPACK_PACKAGE_VENDOR "Alight")
set(CPACK_PACKAGE_CONTACT "Alight maintainers <maintainers@alight.invalid>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # the first line of each description is its own
set(CPACK_STRIP_FILES ON)
# Files that name their own place name the one below /usr.
set(CPACK_SET_DESTDIR ON)
set(CPACK_INSTALL_PREFIX /usr)

set(CPACK_COMPONENTS_ALL alight dev)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)

set(CPACK_DEBIAN_ALIGHT_PACKAGE_NAME alight)
set(CPACK_DEBIAN_ALIGHT_PACKAGE_SECTION science)
set(CPACK_DEBIAN_ALIGHT_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_ALIGHT_DESCRIPTION "${PROJECT_DESCRIPTION}
Completes the depth map of a down-looking stereo camera with the points of a
LiDAR, judges its own result, and picks ground that is flat, free and large
enough. Tools for simulation, calibration, data sets, training, evaluation
and replay, the onboard ROS 1 node, and a trained network.")

set(CPACK_DEBIAN_DEV_PACKAGE_NAME libalight-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_DESCRIPTION "${PROJECT_DESCRIPTION} - development files
Static libraries, headers and CMake package of Alight's onboard engine:
depth with a verdict, choice of landing sites, flight logs.")
# What AlightLibraries.cmake finds, by names that Debian 12 and 13 share.
set(dev_depends libeigen3-dev libopencv-dev libyaml-cpp-dev libfmt-dev libspdlog-dev libcli11-dev
                nlohmann-json3-dev libgeographiclib-dev libturbojpeg0-dev libxxhash-dev librosbag-storage-dev libsensor-msgs-dev
                libgeometry-msgs-dev libnav-msgs-dev libstd-msgs-dev libcpp-httplib-dev)
if(ALIGHT_WITH_TORCH)
  list(APPEND dev_depends libtorch-dev)
endif()
list(JOIN dev_depends ", " CPACK_DEBIAN_DEV_PACKAGE_DEPENDS)

# Per package: doc/<package>/copyright, and the changelog: ours, and the one of the packages that Debian wants.
find_program(GZIP_PROGRAM gzip REQUIRED)
file(READ ${PROJECT_SOURCE_DIR}/LICENSE license)
string(REGEX REPLACE "^[^\n]*\n\n[^\n]*\n\n" "" license "${license}")  # its title and the line of the copyright
string(REGEX REPLACE "\n\n" "\n.\n" license "${license}")
string(STRIP "${license}" license)
string(REPLACE "\n" "\n " license "${license}")
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/debian/copyright @ONLY CONTENT
"Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/
Upstream-Name: @PROJECT_NAME@

Files: *
Copyright: 2026 the Alight authors
License: BSD-3-Clause
 @license@
")
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/debian/changelog.in @ONLY CONTENT
"alight (@PROJECT_VERSION@-1) unstable; urgency=medium

  * What is new stands in changelog.gz.

 -- @CPACK_PACKAGE_CONTACT@  @date@
")
function(alight_compressed from name)
  set(to ${PROJECT_BINARY_DIR}/debian/${name})
  add_custom_command(OUTPUT ${to}.gz COMMAND ${CMAKE_COMMAND} -E copy ${from} ${to} COMMAND ${GZIP_PROGRAM} -9nf ${to}
                     DEPENDS ${from})
endfunction()
alight_compressed(${PROJECT_SOURCE_DIR}/CHANGELOG.md changelog)
alight_compressed(${PROJECT_BINARY_DIR}/debian/changelog.in changelog.Debian)
set(documents ${PROJECT_BINARY_DIR}/debian/changelog.gz ${PROJECT_BINARY_DIR}/debian/changelog.Debian.gz)
foreach(package alight/alight dev/libalight-dev)
  cmake_path(GET package PARENT_PATH component)
  cmake_path(GET package FILENAME name)
  install(FILES ${PROJECT_BINARY_DIR}/debian/copyright ${documents} DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name}
          COMPONENT ${component})
endforeach()

# Manual pages, of what --help prints; a program for another computer cannot be asked here.
if(NOT CMAKE_CROSSCOMPILING)
  foreach(tool IN LISTS ALIGHT_TOOLS)
    set(page ${PROJECT_BINARY_DIR}/debian/${tool}.1.gz)
    add_custom_command(OUTPUT ${page}
      COMMAND ${CMAKE_COMMAND} -D TOOL=$<TARGET_FILE:${tool}> -D VERSION=${PROJECT_VERSION} -D GZIP=${GZIP_PROGRAM}
              -D OUTPUT=${page} -P ${PROJECT_SOURCE_DIR}/cmake/ManualPage.cmake
      DEPENDS ${tool} ${PROJECT_SOURCE_DIR}/cmake/ManualPage.cmake
      COMMENT "Writing the manual page of ${tool}")
    list(APPEND documents ${page})
    install(FILES ${page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT alight)
  endforeach()
endif()
add_custom_target(documents ALL DEPENDS ${documents})

include(CPack)
