// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "parkade/mapping/parking_map.hpp"

namespace parkade {

/// What is wrong with a map that a file gave, one sentence each, in a fixed order: repeated ids;
/// tiles, slots, objects and nodes 10 km or more from the origin along an axis; slots without area
/// or lying on one another; sigmas and counts below zero; nodes out of order in time; edges that
/// join a node to itself, span 10 km or whose information is no information matrix. A map that
/// this program saved has none, unless the drive went 10 km astray.
std::vector<std::string> findFaults(const ParkingMap& map);

/// Share of the smaller one's area that two convex quadrilaterals have in common, 0 to 1.
double overlapShare(const std::array<Eigen::Vector2d, 4>& a,
                    const std::array<Eigen::Vector2d, 4>& b);
/// The same of convex polygons; 0 where one has fewer than 3 corners.
double overlapShare(const std::vector<Eigen::Vector2d>& a, const std::vector<Eigen::Vector2d>& b);

/// Signed area, m^2: positive where the corners run counter-clockwise.
double signedArea(const std::vector<Eigen::Vector2d>& polygon);

}  // namespace parkade
