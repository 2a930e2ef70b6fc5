// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "parkade/camera/rig.hpp"
#include "parkade/core/result.hpp"

namespace parkade::sim {

/// The text of a file of config/rigs, compiled into the program (rig_presets.cmake).
struct RigPreset {
  const char* name;
  const char* text;
};
extern const RigPreset kRigPresets[];
extern const int kNumRigPresets;

std::vector<std::string> rigPresetNames();

/// A rig by the name of a preset, or from a file. Fails on an unknown name (and lists the known) or
/// a file that is no rig.
Result<Rig> loadRig(const std::string& name_or_path);

}  // namespace parkade::sim
