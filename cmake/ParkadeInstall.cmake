# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
#
# cmake --install: the program, the library (one archive per room), its headers, the networks, and
# what find_package(Parkade) needs. A user links parkade::pipeline, parkade::mapping, ...
# Component `program` runs by itself; `development` is for those who link.
include(CMakePackageConfigHelpers)
set(PARKADE_CONFIG_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/Parkade)

get_property(ROOMS GLOBAL PROPERTY PARKADE_ROOMS)
foreach(ROOM IN LISTS ROOMS)
  install(TARGETS parkade_${ROOM} EXPORT ParkadeTargets
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}/parkade COMPONENT development)
endforeach()
install(EXPORT ParkadeTargets NAMESPACE parkade:: DESTINATION ${PARKADE_CONFIG_DIR}
        COMPONENT development)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/src/parkade DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
        COMPONENT development
        FILES_MATCHING PATTERN "*.hpp" PATTERN "*test_support.hpp" EXCLUDE PATTERN "cli" EXCLUDE)

if(TARGET parkade)
  install(TARGETS parkade RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
endif()
install(DIRECTORY ${PROJECT_SOURCE_DIR}/models DESTINATION ${CMAKE_INSTALL_DATADIR}/parkade
        COMPONENT program)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/config/rigs DESTINATION ${CMAKE_INSTALL_DATADIR}/parkade
        COMPONENT program)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/parkade
        RENAME copyright COMPONENT program)

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/ParkadeConfig.cmake.in
                              ${PROJECT_BINARY_DIR}/ParkadeConfig.cmake
                              INSTALL_DESTINATION ${PARKADE_CONFIG_DIR})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/ParkadeConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/ParkadeConfig.cmake
              ${PROJECT_BINARY_DIR}/ParkadeConfigVersion.cmake
        DESTINATION ${PARKADE_CONFIG_DIR} COMPONENT development)
