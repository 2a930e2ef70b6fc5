// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "parkade/geometry/se2.hpp"
#include "parkade/mapping/parking_map.hpp"

namespace parkade {

/// Makes layers that hold what pictures showed, cell by cell, into those of the told map: with what
/// all of a drive, and its slots and objects, tell of them. Structure: walls where key points and
/// labels line up, nothing that nobody can have seen, whole feet of pillars. Lines of slots, the
/// slots' state, wheel stops. docs/math/grid.md.
///
/// wall_places: key points above the floor (WallPoints::places()); way: the car's poses in the map;
/// range: m, up to which pictures tell of the floor.
void completeLayers(const std::vector<Eigen::Vector3d>& wall_places, const std::vector<SE2>& way,
                    double range, ParkingMap& map);

}  // namespace parkade
