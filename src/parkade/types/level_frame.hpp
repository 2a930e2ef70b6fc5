// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parkade/geometry/se3.hpp"
#include "parkade/types/bev_image.hpp"

namespace parkade {

/// T_level_vehicle: from the vehicle to the levelled frame of bev_image.hpp, whose origin lies on
/// the ground.
inline SE3 levelFrom(const GroundAttitude& attitude) {
  return {SO3::fromYawPitchRoll(0.0, attitude.pitch, attitude.roll), {0.0, 0.0, attitude.height}};
}

}  // namespace parkade
