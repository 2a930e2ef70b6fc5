// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "parkade/sim/world/floor_surface.hpp"
#include "parkade/sim/world/noise_texture.hpp"
#include "parkade/sim/world/quad_texture.hpp"

namespace parkade::sim {

inline constexpr float kFloorMapCell = 0.04F;  ///< m: of the maps over the whole floor
inline constexpr float kFineTexel = 0.004F;    ///< m: grain of the floor's surface
inline constexpr float kCloudTexel = 0.05F;    ///< m: clouds of wear and damp

/// What a value of makeFloorMaps means.
enum FloorChannel : int {
  kCloudChannel,  ///< lighter and darker clouds, -1 to 1
  kDirtChannel,   ///< darkening, 0 to 1: tyre marks along the ways of cars, oil, stains
  kZoneChannel,   ///< number of FloorLook::zones (0: none) times zoneValue()
};

/// What kZoneChannel holds of the first of so many zones: as much as lets all have a multiple of
/// it, so that the shares of cells at a zone's edge are not rounded away.
float zoneValue(std::size_t zones);

/// What varies slowly over a floor between two corners, one texel per cell, texel (0, 0) at min.
QuadTexture makeFloorMaps(const Eigen::Vector2d& min, const Eigen::Vector2d& max,
                          const FloorLook& look, const GreyTexture& clouds);

}  // namespace parkade::sim
