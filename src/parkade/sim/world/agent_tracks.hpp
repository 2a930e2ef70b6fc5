// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>

#include "parkade/core/random.hpp"
#include "parkade/sim/garage.hpp"
#include "parkade/sim/world/agent_motion.hpp"

namespace parkade::sim {

/// A random walk on the aisles, as far as a car gets in the time, on the right-hand side: at least
/// 5 m and about length (m), of a point middle (m) before its rear axle. Nothing where the aisles
/// are too short.
std::optional<AgentTrack> carTrack(const Garage& garage, double middle, double length,
                                   Random& random);

/// Along one side of an aisle, across it, and along the other side. Near a place, if one is given;
/// nothing where no aisle is.
std::optional<AgentTrack> personTrack(const Garage& garage,
                                      const std::optional<Eigen::Vector2d>& near, Random& random);

/// Whether a box of this half length and width, moved along a track, touches a pillar, a room or a
/// parked car.
bool hitsStanding(const AgentTrack& track, const Eigen::Vector2d& half, const Garage& garage);

}  // namespace parkade::sim
