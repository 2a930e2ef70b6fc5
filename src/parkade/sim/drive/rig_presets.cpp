// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/drive/rig_presets.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <filesystem>

namespace parkade::sim {

std::vector<std::string> rigPresetNames() {
  std::vector<std::string> names;
  for (int i = 0; i < kNumRigPresets; ++i) names.emplace_back(kRigPresets[i].name);
  return names;
}

Result<Rig> loadRig(const std::string& name_or_path) {
  for (int i = 0; i < kNumRigPresets; ++i) {
    if (name_or_path == kRigPresets[i].name) {
      return parseRig(kRigPresets[i].text, fmt::format("{}.yaml", name_or_path));
    }
  }
  const bool looks_like_file =
      name_or_path.find('/') != std::string::npos || name_or_path.find('.') != std::string::npos;
  if (!looks_like_file && !std::filesystem::exists(name_or_path)) {
    return Error{fmt::format("rig '{}' is unknown; known are {}, or name a rig.yaml file",
                             name_or_path, fmt::join(rigPresetNames(), ", "))};
  }
  return readRig(name_or_path);
}

}  // namespace parkade::sim
