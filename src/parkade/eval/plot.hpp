// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "parkade/eval/report.hpp"

namespace parkade {

/// The plane that the top view looks at. kAuto: xy, but xz where the reference hardly extends in y
/// and does in z, as in a camera's frame (KITTI: y down).
enum class PlotPlane { kAuto, kXy, kXz, kYz };

/// The evaluation as one SVG picture that a browser opens: the trajectories from above (equal
/// axes), position and rotation error over time, height profile. The reference is all of it, not
/// only the matched poses. Long lines are thinned to what the eye can see.
std::string evaluationSvg(const Evaluation& evaluation, const Trajectory& reference,
                          const EvaluationLabels& labels = {}, PlotPlane plane = PlotPlane::kAuto);

}  // namespace parkade
