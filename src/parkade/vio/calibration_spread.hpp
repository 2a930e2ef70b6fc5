// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "parkade/vio/window.hpp"

namespace parkade {

/// Sets how wrong the calibration is taken to be (the sigmas of the refinements' time offsets and,
/// with places, of positions and rotations, one of each for all cameras) to what the refined
/// cameras show, by one step of expectation-maximisation (docs/math/residuals.md, eq. 10). Cameras
/// that all turn out to sit where the calibration says tell that it is exact also in what no
/// picture shows, their common turn against the inertial unit. Sigmas that are held (below the
/// floors) stay. global_covariance: of the window's globals, as the solve left it.
void learnCalibrationSpread(Window& window, const Eigen::MatrixXd& global_covariance, bool places);

}  // namespace parkade
