// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "parkade/mapping/parking_map.hpp"

namespace parkade {

/// What is wrong with a map that a file gave, one sentence each, in a fixed order: repeated ids,
/// slots without area, too far away or lying on one another, edges whose information is no
/// information matrix. A map that this program saved has none.
std::vector<std::string> findFaults(const ParkingMap& map);

/// Share of the smaller one's area that two convex quadrilaterals have in common, 0 to 1.
double overlapShare(const std::array<Eigen::Vector2d, 4>& a,
                    const std::array<Eigen::Vector2d, 4>& b);
/// The same of convex polygons; 0 where one has fewer than 3 corners.
double overlapShare(const std::vector<Eigen::Vector2d>& a, const std::vector<Eigen::Vector2d>& b);

/// Signed area, m^2: positive where the corners run counter-clockwise.
double signedArea(const std::vector<Eigen::Vector2d>& polygon);

}  // namespace parkade
