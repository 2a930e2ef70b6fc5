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

constexpr Eigen::Index kTime = 6;  // of a camera's degrees of freedom

// Of neighbouring degrees of freedom of all cameras, from the mean square of each.
void learn(Window& window, const CalibrationVector& mean_square, Eigen::Index first,
           Eigen::Index count, double least) {
  if (window.refinements.front().sigma(first) < least) return;
  const double sigma = std::max(least, std::sqrt(mean_square.segment(first, count).mean()));
  for (CameraRefinement& refinement : window.refinements) {
    refinement.sigma.segment(first, count).setConstant(sigma);
  }
}

}  // namespace

void learnCalibrationSpread(Window& window, const Eigen::MatrixXd& global_covariance, bool places) {
  if (window.refinements.empty()) return;
  PARKADE_CHECK(global_covariance.rows() == window.globalSize(), "covariance of {} of {} globals",
                global_covariance.rows(), window.globalSize());
  CalibrationVector sum = CalibrationVector::Zero();
  double of_times = 0.0;  // what pictures leave open of the clocks
  for (std::size_t c = 0; c < window.refinements.size(); ++c) {
    const CameraRefinement& refinement = window.refinements[c];
    const CalibrationVector whitened = calibrationResidual(window.cameras[c], refinement, nullptr);
    const CalibrationVector variance =
        global_covariance.diagonal().segment<kCalibration>(Window::cameraGlobal(c));
    sum += whitened.cwiseProduct(refinement.sigma).cwiseAbs2() + variance;
    of_times += variance(kTime);
  }
  const auto count = static_cast<double>(window.refinements.size());
  const CalibrationVector mean_square = sum / count;
  // One clock often triggers all cameras: while pictures tell next to nothing of it beside what the
  // calibration does, steps of (10) would make it exact.
  constexpr double kSeenShare = 0.1;  // of the calibration's variance
  const double told = window.refinements.front().sigma(kTime);
  if (of_times < kSeenShare * told * told * count) {
    learn(window, mean_square, kTime, 1, kLeastTime);
  }
  if (!places) return;
  learn(window, mean_square, 0, 3, kLeastPosition);
  learn(window, mean_square, 3, 3, kLeastRotation);
}

}  // namespace parkade
