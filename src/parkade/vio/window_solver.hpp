// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "parkade/vio/linear_system.hpp"
#include "parkade/vio/window.hpp"

namespace parkade {

struct SolveOptions {
  int max_iterations = 2;
  WindowLoss loss;
  StillSigma still;
  /// Ends the solve once a step promises to lower the cost (half the chi-square) by less.
  double min_decrease = 1e-2;
  /// Ends it, too, after a step that moves no frame by more: linearised again, the terms would be
  /// the same to far less than their noise. 0: never.
  double settled_position = 0.0;  ///< m
  double settled_rotation = 0.0;  ///< rad
};

struct SolveSummary {
  bool ok = false;  ///< false: no step could be computed; the window is as before
  int iterations = 0;
  int observations = 0;
  double initial_cost = 0.0;
  double final_cost = 0.0;  ///< as the last step predicts it
  bool has_covariance = false;
  /// Of the newest frame's tangent, from the information of the whole window and its prior.
  Matrix15d newest_covariance = Matrix15d::Zero();
  Eigen::MatrixXd global_covariance;  ///< of the window's globals, gravity's direction first
};

/// Levenberg-Marquardt over the frames and the given landmarks, which are eliminated in each step.
/// The number of steps depends on the data alone, never on the clock.
SolveSummary solveWindow(Window& window, const std::vector<WindowFeature*>& features,
                         const SolveOptions& options);

/// The same for a car at rest: only the frames from `first_free` on and the globals move, by their
/// readings and the rest alone; landmarks and the frames before stay as they are. The covariance is
/// still that of the whole window with the given landmarks.
SolveSummary solveAtRest(Window& window, const std::vector<WindowFeature*>& features,
                         std::size_t first_free, const SolveOptions& options);

/// Whitened distance of an observation from its landmark's projection; infinity where it does not
/// project.
double whitenedError(const Window& window, const WindowFeature& feature,
                     const WindowObservation& observation);

/// Covariance of a landmark's point in the odom frame, given the frames' poses, m^2.
Eigen::Matrix3d landmarkCovariance(const Window& window, const WindowFeature& feature);

}  // namespace parkade
