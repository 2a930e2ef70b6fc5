// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "parkade/core/random.hpp"
#include "parkade/sim/garage.hpp"
#include "parkade/sim/world/layout.hpp"
#include "parkade/sim/world/polygon.hpp"
#include "parkade/sim/world/style.hpp"

namespace parkade::sim {

/// Lines, numbers, wheel stops of the slots, and hatched areas.
void paintSlots(const Layout& layout, const GarageStyle& style, Garage& garage);

/// Edge and centre lines, arrows, limits, stop lines, crossings and bumps of the aisles.
void paintAisles(const GarageStyle& style, Random random, Garage& garage);

/// Zone text of pillars and slots; zone markers, guide signs and speed-limit signs.
void placeSigns(const Layout& layout, const GarageStyle& style, Random random, Garage& garage);

/// Outlines of an arrow of a length, pointing along x, its middle at the origin. meaning: straight,
/// left, right, straight_left, straight_right, left_right, straight_left_right.
std::vector<Polygon> arrowPolygons(const std::string& meaning, double length);

/// The axis-aligned (in the frame) rectangle's part of a convex polygon; empty where none.
Polygon clipToRectangle(const Polygon& polygon, const Frame2& frame, double x0, double y0,
                        double x1, double y1);

/// A marking with the next id, appended.
Marking& addMarking(Garage& garage, SemanticClass semantic_class, std::vector<Polygon> polygons,
                    const std::string& meaning, const Frame2& place, const Eigen::Vector3f& colour);

}  // namespace parkade::sim
