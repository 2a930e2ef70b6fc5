// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/vio/calibration_spread.hpp"

#include <algorithm>
#include <cmath>

#include "parkade/core/check.hpp"
#include "parkade/vio/factors.hpp"

namespace parkade {
namespace {

constexpr double kLeastPosition = 2e-4;  // m; no calibration is better
constexpr double kLeastRotation = 1e-4;  // rad
constexpr double kLeastTime = 2e-5;      // s; of cameras that one clock triggers

// Of neighbouring degrees of freedom of all cameras, from the mean square of each.
void learn(Window& window, const Vector7d& mean_square, Eigen::Index first, Eigen::Index count,
           double least) {
  if (window.refinements.front().sigma(first) < least) return;
  const double sigma = std::max(least, std::sqrt(mean_square.segment(first, count).mean()));
  for (CameraRefinement& refinement : window.refinements) {
    refinement.sigma.segment(first, count).setConstant(sigma);
  }
}

// Whether pictures tell the clocks far better than the calibration does. One clock often triggers
// all cameras: while next to nothing is known of it, steps of (10) would make it exact.
bool clocksAreSeen(const Window& window, const Eigen::MatrixXd& global_covariance) {
  constexpr double kShare = 0.1;  // of the variance
  double sum = 0.0;
  for (std::size_t c = 0; c < window.refinements.size(); ++c) {
    const Eigen::Index time = Window::cameraGlobal(c) + 6;
    sum += global_covariance(time, time);
  }
  const double sigma = window.refinements.front().sigma(6);
  return sum < kShare * sigma * sigma * static_cast<double>(window.refinements.size());
}

}  // namespace

void learnCalibrationSpread(Window& window, const Eigen::MatrixXd& global_covariance, bool places) {
  if (window.refinements.empty()) return;
  PARKADE_CHECK(global_covariance.rows() == window.globalSize(), "covariance of {} of {} globals",
                global_covariance.rows(), window.globalSize());
  Vector7d sum = Vector7d::Zero();
  for (std::size_t c = 0; c < window.refinements.size(); ++c) {
    const CameraRefinement& refinement = window.refinements[c];
    const Vector7d whitened = calibrationResidual(window.cameras[c], refinement, nullptr);
    sum += whitened.cwiseProduct(refinement.sigma).cwiseAbs2() +
           global_covariance.diagonal().segment<7>(Window::cameraGlobal(c));
  }
  const Vector7d mean_square = sum / static_cast<double>(window.refinements.size());
  if (clocksAreSeen(window, global_covariance)) learn(window, mean_square, 6, 1, kLeastTime);
  if (!places) return;
  learn(window, mean_square, 0, 3, kLeastPosition);
  learn(window, mean_square, 3, 3, kLeastRotation);
}

}  // namespace parkade
