// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

#include "parkade/sim/world/car_mesh.hpp"
#include "parkade/sim/world/car_profile.hpp"
#include "parkade/sim/world/mesh_builder.hpp"

namespace parkade::sim {

/// Points of half a cross-section of a body, underside to roof.
inline constexpr int kSidePoints = 17;
/// Where the side glass lies among them: from the belt to the roof's edge.
inline constexpr int kBeltPoint = 8;
inline constexpr int kEdgePoint = 12;

/// Half a cross-section at a share of the length: (y, z) in m, from the underside's middle to the
/// roof's.
std::array<Eigen::Vector2f, kSidePoints> crossSection(const CarProfile& profile,
                                                      const CarSize& size, float s);

/// The body with its windows, lofted over cross-sections, open at both ends.
void addHull(MeshBuilder& builder, const CarProfile& profile, const CarSize& size,
             const CarMaterials& materials);

/// The flat face of nose or tail, in strips from side to side.
void addEnd(MeshBuilder& builder, const CarProfile& profile, const CarSize& size,
            const CarMaterials& materials, bool nose);

}  // namespace parkade::sim
