// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

#include "parkade/sim/drive/simulation.hpp"

namespace parkade::sim {

/// The garage's plan (world/plan_image.hpp) with the route on it: forwards blue, in reverse red,
/// with stops, and the car every few metres.
cv::Mat drawRoute(const Simulation& simulation, double px_per_metre = 12.0);

}  // namespace parkade::sim
