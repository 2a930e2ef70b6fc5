// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "parkade/sim/world/polygon.hpp"

namespace parkade::sim {

/// A line of text as polygons (counter-clockwise, overlapping, union): x along the line, y up, the
/// baseline's middle at the origin. Capitals, digits, blank and . - / : + < > ^ (arrows) are drawn;
/// other characters leave a gap. weight is the stroke's width as a share of the height.
std::vector<Polygon> textPolygons(std::string_view text, double height, double weight);

/// Width of the line from outer edge to outer edge, m.
double textWidth(std::string_view text, double height, double weight);

}  // namespace parkade::sim
