// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "parkade/types/semantic_features.hpp"

namespace parkade {

/// Points (m) in the order in which a viewer sweeps over them, with the nearest one of each
/// direction (half a degree).
std::vector<Eigen::Vector2d> sweepOver(const std::vector<Eigen::Vector2d>& points,
                                       const Eigen::Vector2d& viewer);

/// How far the points from begin to before end lie from the first of them, m.
double reachOf(const std::vector<Eigen::Vector2d>& points, std::size_t begin, std::size_t end);

/// One car's part of an edge.
struct CarEdge {
  std::vector<Eigen::Vector2d> swept;  ///< as the picture shows it
  std::vector<Eigen::Vector2d> floor;  ///< where its points stand
  std::optional<double> heading;       ///< rad, of its row's slots, where it stands in one
};

/// Parts the edge that cars' smears have at the floor, its points swept over by the viewer, into
/// one per car: where something else is in between, at a notch (least_depth, m) as the gap between
/// two cars makes it, where it passes from slot to slot (agent_slots.hpp), and where it is larger
/// than cars are, or wider than those in a row of slots, at the place after which two cars fit
/// best. on_floor: where such points stand.
std::vector<CarEdge> partCars(
    std::vector<Eigen::Vector2d> swept, const Eigen::Vector2d& viewer, double least_depth,
    const std::vector<SlotObservation>& slots,
    const std::function<std::vector<Eigen::Vector2d>(const std::vector<Eigen::Vector2d>&)>&
        on_floor);

}  // namespace parkade
