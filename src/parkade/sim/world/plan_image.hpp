// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

#include "parkade/sim/garage.hpp"

namespace parkade::sim {

/// A drawing of the garage from above, CV_8UC3 BGR: walls, rooms, pillars with their zone text,
/// slots with numbers (occupied ones hold a car), markings by class, signs, aisle graph. x to the
/// right, y up; one metre of margin.
cv::Mat drawPlan(const Garage& garage, double px_per_metre = 16.0);

/// The colour, BGR, that a class has in plans and overlays.
cv::Scalar classColour(SemanticClass semantic_class);

}  // namespace parkade::sim
