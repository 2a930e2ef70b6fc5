// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

#include "parkade/sim/drive/simulation.hpp"

namespace parkade::sim {

/// A plan of the garage with the route on it, CV_8UC3: slots (filled where occupied), pillars,
/// rooms, markings; the path forwards blue and in reverse red, with stops and the car at the start.
cv::Mat drawPlan(const Simulation& simulation, double px_per_metre = 10.0);

}  // namespace parkade::sim
