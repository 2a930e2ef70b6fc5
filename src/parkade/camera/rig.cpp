// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/camera/rig.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

namespace parkade {

int Rig::find(const std::string& camera_name) const {
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    if (cameras[i].name == camera_name) return static_cast<int>(i);
  }
  return -1;
}

Result<Rig> Rig::subset(const std::vector<std::string>& names) const {
  Rig rig = *this;
  rig.cameras.clear();
  for (const std::string& camera_name : names) {
    const int index = find(camera_name);
    if (index < 0) {
      std::vector<std::string> known;
      for (const RigCamera& camera : cameras) known.push_back(camera.name);
      return Error{fmt::format("rig '{}' has no camera '{}'; its cameras: {}", name, camera_name,
                               fmt::join(known, ", "))};
    }
    if (rig.find(camera_name) >= 0)
      return Error{fmt::format("camera '{}' named twice", camera_name)};
    rig.cameras.push_back(cameras[static_cast<std::size_t>(index)]);
  }
  return rig;
}

}  // namespace parkade
