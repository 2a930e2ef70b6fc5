// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/semantics/markings/marking_shape.hpp"

namespace parkade {

/// Arrows of all meanings (straight, left, right and their unions, named as straight_left), in
/// several proportions, and without a meaning plain bars, and two heads back to back, as an arrow
/// leaves them whose shaft is worn: what fits those better is no arrow. x
/// points where a driver goes on to; y = 0 is the middle of the shaft.
std::vector<MarkingShape> arrowShapes();

/// Numbers of speed limits ("5", "10", ...), read up the page.
std::vector<MarkingShape> limitShapes();

/// The digits "0" to "9", read up the page.
std::vector<MarkingShape> digitShapes();

}  // namespace parkade
