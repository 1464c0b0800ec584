# `cmake --install`, in two components. `alight`: the tools, the shipped files and the documents. `dev`: what the onboard
# engine is made of, as a CMake package:
#   find_package(alight REQUIRED)
#   target_link_libraries(app alight::infer)     # or alight::landing, which is free of torch
# and `#include <alight/infer/depth/depth_engine.hpp>`.
include(CMakePackageConfigHelpers)

set(ALIGHT_PACKAGE_TARGETS alight_foundation alight_pictures alight_geometry alight_poses alight_sensors
                           alight_dataset alight_landing alight_health alight_engine alight_mission alight_onboard alight_results alight_web
                           alight_autopilot alight_replay alight_recorder)
set(ALIGHT_TOOLS alight-dataset)
if(ALIGHT_WITH_GROUND)
  list(APPEND ALIGHT_TOOLS alight-sim alight-calibrate)
endif()
if(ALIGHT_WITH_TORCH)
  list(APPEND ALIGHT_PACKAGE_TARGETS alight_depth_dataset alight_models alight_infer)
  list(APPEND ALIGHT_TOOLS alight-infer)
endif()
if(ALIGHT_WITH_TORCH AND ALIGHT_WITH_GROUND)
  list(APPEND ALIGHT_TOOLS alight-train alight-evaluate alight-export)
endif()

set(data ${CMAKE_INSTALL_DATADIR}/alight)
install(TARGETS ${ALIGHT_TOOLS} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT alight)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/configs DESTINATION ${data} COMPONENT alight FILES_MATCHING PATTERN "*.yaml")
install(DIRECTORY ${PROJECT_SOURCE_DIR}/models/weights DESTINATION ${data}/models COMPONENT alight)
install(FILES ${PROJECT_SOURCE_DIR}/README.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT alight)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT alight)

set(package ${CMAKE_INSTALL_LIBDIR}/cmake/alight)
install(TARGETS ${ALIGHT_PACKAGE_TARGETS} EXPORT alightTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev)
install(EXPORT alightTargets NAMESPACE alight:: DESTINATION ${package} COMPONENT dev)
# Headers include each other from the source folder; where they are installed, from the folder that has alight/.
install(CODE "set(SOURCE \"${PROJECT_SOURCE_DIR}\")
              set(OUTPUT \"${PROJECT_BINARY_DIR}/include/alight\")" COMPONENT dev)
install(SCRIPT cmake/InstalledHeaders.cmake COMPONENT dev)
install(DIRECTORY ${PROJECT_BINARY_DIR}/include/alight DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/examples DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/libalight-dev COMPONENT dev)

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/alightConfig.cmake.in
                              ${PROJECT_BINARY_DIR}/alightConfig.cmake INSTALL_DESTINATION ${package})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/alightConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/alightConfig.cmake ${PROJECT_BINARY_DIR}/alightConfigVersion.cmake
              ${PROJECT_SOURCE_DIR}/cmake/AlightLibraries.cmake DESTINATION ${package} COMPONENT dev)
