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

// Of three neighbouring degrees of freedom of all cameras.
void learn(Window& window, const Eigen::MatrixXd& covariance, Eigen::Index first, double least) {
  if (window.refinements.front().sigma(first) < least) return;
  double sum = 0.0;
  for (std::size_t c = 0; c < window.refinements.size(); ++c) {
    const CameraRefinement& refinement = window.refinements[c];
    const Vector7d whitened = calibrationResidual(window.cameras[c], refinement, nullptr);
    const Vector7d off = whitened.cwiseProduct(refinement.sigma);
    const Eigen::Index row = 2 + 7 * static_cast<Eigen::Index>(c) + first;
    sum += off.segment<3>(first).squaredNorm() + covariance.diagonal().segment<3>(row).sum();
  }
  const double mean = sum / (3.0 * static_cast<double>(window.refinements.size()));
  for (CameraRefinement& refinement : window.refinements) {
    refinement.sigma.segment<3>(first).setConstant(std::max(least, std::sqrt(mean)));
  }
}

}  // namespace

void learnCalibrationSpread(Window& window, const Eigen::MatrixXd& global_covariance) {
  if (window.refinements.empty()) return;
  PARKADE_CHECK(global_covariance.rows() == window.globalSize(), "covariance of {} of {} globals",
                global_covariance.rows(), window.globalSize());
  learn(window, global_covariance, 0, kLeastPosition);
  learn(window, global_covariance, 3, kLeastRotation);
}

}  // namespace parkade
