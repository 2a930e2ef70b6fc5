# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
#
# One room = one folder under src/parkade = one target parkade::NAME, with its tests beside its code.

# Flags that every Parkade target is compiled with; private, so that users of the library are free.
add_library(parkade_flags INTERFACE)
target_compile_options(parkade_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
                                               -Woverloaded-virtual)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # False positives on std::string operator+ (GCC bug 105651).
  target_compile_options(parkade_flags INTERFACE -Wno-restrict)
endif()
if(PARKADE_UNITY)
  # Meant for headers; here sources are included.
  target_compile_options(parkade_flags INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
endif()
if(PARKADE_WARNINGS_AS_ERRORS)
  target_compile_options(parkade_flags INTERFACE -Werror)
endif()
if(PARKADE_NATIVE)
  # Global: Eigen's alignment must be the same in every translation unit.
  add_compile_options(-march=native)
endif()
if(PARKADE_SANITIZE)
  # Global as well: GoogleTest's and our own objects must agree. vptr needs RTTI of OpenCV's privates.
  add_compile_options(-fsanitize=${PARKADE_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${PARKADE_SANITIZE})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # The instrumented code hides from GCC that a variant's alternative was set (GCC bug 105562).
    target_compile_options(parkade_flags INTERFACE -Wno-maybe-uninitialized)
  endif()
endif()
if(CMAKE_BUILD_TYPE STREQUAL "Debug")
  add_compile_definitions(EIGEN_INITIALIZE_MATRICES_BY_NAN)
endif()

# With PARKADE_UNITY, sources of a target are compiled together: names in their anonymous namespaces
# must differ.
function(parkade_unity TARGET)
  set_target_properties(${TARGET} PROPERTIES UNITY_BUILD ${PARKADE_UNITY} UNITY_BUILD_BATCH_SIZE 8)
endfunction()

# parkade_room(NAME SOURCES a.cpp ... DEPS targets ... [PRIVATE_DEPS targets ...]
#              [TESTS a_test.cpp ...] [TEST_DEPS targets ...])
# DEPS name rooms (geometry) or outside targets (Eigen3::Eigen).
function(parkade_room NAME)
  cmake_parse_arguments(ROOM "" "" "SOURCES;DEPS;PRIVATE_DEPS;TESTS;TEST_DEPS" ${ARGN})
  set(TARGET parkade_${NAME})
  if(ROOM_SOURCES)
    add_library(${TARGET} STATIC ${ROOM_SOURCES})
    set(SCOPE PUBLIC)
    parkade_unity(${TARGET})
    target_link_libraries(${TARGET} PRIVATE $<BUILD_INTERFACE:parkade_flags>)
    set_target_properties(${TARGET} PROPERTIES POSITION_INDEPENDENT_CODE ON)
  else()
    add_library(${TARGET} INTERFACE)
    set(SCOPE INTERFACE)
  endif()
  add_library(parkade::${NAME} ALIAS ${TARGET})
  set_target_properties(${TARGET} PROPERTIES EXPORT_NAME ${NAME})
  set_property(GLOBAL APPEND PROPERTY PARKADE_ROOMS ${NAME})
  target_include_directories(${TARGET} ${SCOPE} $<BUILD_INTERFACE:${CMAKE_SOURCE_DIR}/src>
                                                $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(${TARGET} ${SCOPE} cxx_std_20)
  if(PARKADE_NATIVE)
    # Whoever uses the installed library must agree with it on Eigen's alignment.
    target_compile_options(${TARGET} ${SCOPE} $<INSTALL_INTERFACE:$<$<COMPILE_LANGUAGE:CXX>:-march=native>>)
  endif()
  foreach(DEP IN LISTS ROOM_DEPS)
    if(TARGET parkade_${DEP})
      set(DEP parkade::${DEP})
    endif()
    target_link_libraries(${TARGET} ${SCOPE} ${DEP})
  endforeach()
  foreach(DEP IN LISTS ROOM_PRIVATE_DEPS)
    target_link_libraries(${TARGET} PRIVATE ${DEP})
  endforeach()
  if(PARKADE_BUILD_TESTS AND ROOM_TESTS)
    parkade_test(parkade_${NAME}_test SOURCES ${ROOM_TESTS}
                 DEPS parkade::${NAME} ${ROOM_TEST_DEPS} LABEL ${NAME})
  endif()
endfunction()

# With PARKADE_UNITY, the headers that most tests spend their compile time on are compiled once. Tests include
# what they use all the same.
add_library(parkade_test_flags INTERFACE)
target_link_libraries(parkade_test_flags INTERFACE parkade_flags GTest::gmock)
target_compile_definitions(parkade_test_flags INTERFACE PARKADE_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
function(parkade_test_headers)
  add_library(parkade_test_headers OBJECT ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/test_headers.cpp)
  target_link_libraries(parkade_test_headers PRIVATE parkade_test_flags Eigen3::Eigen fmt::fmt opencv_core)
  target_precompile_headers(parkade_test_headers PRIVATE
      <gmock/gmock.h> <gtest/gtest.h> <Eigen/Core> <Eigen/Geometry> <fmt/core.h> <opencv2/core.hpp>
      <filesystem> <fstream> <functional>)
endfunction()

# parkade_test(NAME SOURCES ... DEPS ... LABEL room): one GoogleTest program, each case one ctest.
function(parkade_test NAME)
  cmake_parse_arguments(TEST "" "LABEL" "SOURCES;DEPS" ${ARGN})
  add_executable(${NAME} ${TEST_SOURCES})
  target_link_libraries(${NAME} PRIVATE parkade_test_flags ${TEST_DEPS} GTest::gtest_main)
  if(PARKADE_UNITY)
    target_precompile_headers(${NAME} REUSE_FROM parkade_test_headers)
  endif()
  if(PARKADE_SANITIZE)
    set(LIMIT_S 1500)
  else()
    set(LIMIT_S 300)
  endif()
  gtest_discover_tests(${NAME} DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60
                       PROPERTIES LABELS "${TEST_LABEL}" TIMEOUT ${LIMIT_S})
endfunction()
