# `cmake --install`: the tools, the shipped configurations, and as a CMake package what the onboard engine needs:
#   find_package(alight REQUIRED)
#   target_link_libraries(app alight::infer)     # or alight::landing, which is free of torch
include(CMakePackageConfigHelpers)

set(ALIGHT_PACKAGE_TARGETS alight_configs alight_cli alight_geometry alight_alignment alight_dataset alight_landing
                           alight_health alight_engine alight_mission alight_onboard alight_results alight_autopilot
                           alight_replay)
set(ALIGHT_TOOLS alight-dataset)
if(ALIGHT_WITH_GROUND)
  list(APPEND ALIGHT_TOOLS alight-sim alight-calibrate)
endif()
if(ALIGHT_WITH_TORCH)
  list(APPEND ALIGHT_PACKAGE_TARGETS alight_models alight_infer)
  list(APPEND ALIGHT_TOOLS alight-infer)
endif()
if(ALIGHT_WITH_TORCH AND ALIGHT_WITH_GROUND)
  list(APPEND ALIGHT_TOOLS alight-train alight-evaluate alight-export)
endif()
get_property(imported_targets GLOBAL PROPERTY ALIGHT_IMPORTED_TARGETS)

install(TARGETS ${ALIGHT_TOOLS} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS ${ALIGHT_PACKAGE_TARGETS} ${imported_targets} EXPORT alightTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT alightTargets NAMESPACE alight:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/alight)
foreach(folder configs cli geometry dataset models infer)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${folder} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/alight
          FILES_MATCHING PATTERN "*.hpp")
endforeach()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/configs DESTINATION ${CMAKE_INSTALL_DATADIR}/alight FILES_MATCHING PATTERN "*.yaml")

install(DIRECTORY ${PROJECT_SOURCE_DIR}/models/shipped/ DESTINATION ${CMAKE_INSTALL_DATADIR}/alight/models/shipped)

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/alightConfig.cmake.in
                              ${PROJECT_BINARY_DIR}/alightConfig.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/alight)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/alightConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/alightConfig.cmake ${PROJECT_BINARY_DIR}/alightConfigVersion.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/alight)
