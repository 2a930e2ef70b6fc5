// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "parkade/sim/scene.hpp"

namespace parkade::sim {

using Outline = std::vector<Eigen::Vector2d>;

/// Paint of one colour and meaning on the floor; later paints cover earlier ones.
struct FloorPaint {
  std::vector<Outline> polygons;  ///< garage frame, m; union
  SemanticClass label = SemanticClass::kSlotLine;
  Eigen::Vector3f albedo = Eigen::Vector3f::Constant(0.74F);  ///< linear RGB
  double wear = 0.0;                                          ///< 0 fresh .. 1 nearly gone
  float specular = 0.04F;
  float roughness = 0.4F;
};

/// The floor under the paint.
struct FloorLook {
  Eigen::Vector3f albedo = Eigen::Vector3f::Constant(0.30F);
  /// Areas of another colour (painted aisles); their edges are blurred over about 3 cm.
  struct Zone {
    std::vector<Outline> outlines;  ///< union
    Eigen::Vector3f albedo = Eigen::Vector3f::Constant(0.30F);
  };
  std::vector<Zone> zones;
  float specular = 0.05F;
  float roughness = 0.25F;
  double grain = 0.25;  ///< contrast of the fine texture, 0 to 1
  double dirt = 0.4;    ///< 0 clean .. 1 filthy: stains, dust, tyre marks, oil
  std::uint64_t seed = 1;
  std::vector<Outline> tyre_tracks;  ///< centre lines of the way that cars take
  std::vector<Eigen::Vector2d> oil_spots;
  std::vector<Outline> joints;  ///< polylines of expansion joints, about 1 cm wide, dark
};

/// Floor with all of this between two corners of the garage frame; bare floor beyond. Edges of
/// paint are exact to a millimetre: coverage by exact areas in cells of 1 cm, filtered by bilinear
/// interpolation in a pyramid. Memory: about 2.7 bytes per painted square centimetre and 15 bytes
/// per 16 cm^2 of floor.
std::shared_ptr<const FloorSurface> makeFloorSurface(const Eigen::Vector2d& min,
                                                     const Eigen::Vector2d& max,
                                                     const FloorLook& look,
                                                     const std::vector<FloorPaint>& paints);

}  // namespace parkade::sim
