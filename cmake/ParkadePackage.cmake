# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
#
# cmake --build BUILD --target package: two Debian packages. parkade, the program with its networks,
# depends on the shared libraries that it is linked with; libparkade-dev, the archives and headers,
# on the packages that ParkadeConfig.cmake looks for.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The Parkade authors <parkade@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)

set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME parkade)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION
    "Localises a car with surround cameras and an inertial unit in a garage that
it has never seen, and maps the garage as it goes. With its networks.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libparkade-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "parkade (= ${PROJECT_VERSION}), libceres-dev, libdnnl-dev, libeigen3-dev, libembree-dev, libfmt-dev, libonnx-dev, libopencv-dev, libprotobuf-dev, libspdlog-dev, libsqlite3-dev, libturbojpeg0-dev, libyaml-cpp-dev, libzstd-dev, nlohmann-json3-dev, ocl-icd-opencl-dev, pkg-config"
)
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION
    "Headers, static libraries and what find_package(Parkade) needs.")
include(CPack)
