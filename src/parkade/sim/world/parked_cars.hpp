// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/core/random.hpp"
#include "parkade/sim/garage.hpp"
#include "parkade/sim/scene.hpp"
#include "parkade/sim/world/car_mesh.hpp"

namespace parkade::sim {

/// Instance ids of parked cars are this plus the slot's id.
inline constexpr std::uint32_t kParkedInstance = 1000;

/// A paint colour as cars on the road have them.
struct CarPaint {
  Eigen::Vector3f colour;
  bool metallic = false;
};
CarPaint drawCarPaint(Random& random);

/// A body shape as frequent as in a car park.
CarBody drawCarBody(Random& random);

/// A car in every occupied slot, nose in or out, not quite straight.
void addParkedCars(const Garage& garage, const CarMaterials& materials, Random random,
                   Scene& scene);

/// Pose on the floor: origin at p, x along the heading, z along the floor's normal.
SE3 poseOnFloor(const Garage& garage, const Eigen::Vector2d& p, double heading);

}  // namespace parkade::sim
