# SPDX-FileCopyrightText: 2026 The Parkade authors
# SPDX-License-Identifier: Apache-2.0
#
# Compiles the rigs of cars in config/rigs into the program, so that it finds them wherever it is installed.
file(GLOB RIG_FILES CONFIGURE_DEPENDS ${CMAKE_SOURCE_DIR}/config/rigs/*.yaml)
list(SORT RIG_FILES)
set(RIG_PRESETS)
set(RIG_COUNT 0)
foreach(RIG_FILE IN LISTS RIG_FILES)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${RIG_FILE})
  get_filename_component(RIG_NAME ${RIG_FILE} NAME_WE)
  file(READ ${RIG_FILE} RIG_TEXT)
  if(NOT RIG_TEXT MATCHES "\nvehicle:")
    continue()  # of a recording without a car
  endif()
  string(APPEND RIG_PRESETS "    {\"${RIG_NAME}\", R\"rig(${RIG_TEXT})rig\"},\n")
  math(EXPR RIG_COUNT "${RIG_COUNT} + 1")
endforeach()
set(RIG_PRESETS_SOURCE ${CMAKE_CURRENT_BINARY_DIR}/rig_preset_texts.cpp)
file(CONFIGURE OUTPUT ${RIG_PRESETS_SOURCE} CONTENT
"// Generated from config/rigs by drive/rig_presets.cmake.
#include \"parkade/sim/drive/rig_presets.hpp\"

namespace parkade::sim {
const RigPreset kRigPresets[] = {
@RIG_PRESETS@    {nullptr, nullptr}};
const int kNumRigPresets = @RIG_COUNT@;
}  // namespace parkade::sim
" @ONLY)
