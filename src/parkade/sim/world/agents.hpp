// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "parkade/core/random.hpp"
#include "parkade/sim/garage.hpp"
#include "parkade/sim/scene.hpp"
#include "parkade/sim/world/car_mesh.hpp"
#include "parkade/sim/world/scene_builder.hpp"

namespace parkade::sim {

/// Instance ids of what moves start here.
inline constexpr std::uint32_t kAgentInstance = 1;

/// Adds moving cars and walking people with their meshes to a scene. Cars drive along the aisles on
/// the right; people walk along aisles and cross them. All keep 0.8 m clear of the own car, whose
/// drive is known, and of each other, at all times; of several ways found for one of them the one
/// that comes into the own car's view longest is taken. One for whom no safe way is found is left
/// out. They stand still after ego.duration.
void addAgents(const Garage& garage, int vehicles, int pedestrians, const EgoInput& ego,
               const CarMaterials& materials, const Random& random, Scene& scene);

}  // namespace parkade::sim
