// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/vio/length_error.hpp"

#include <algorithm>
#include <cmath>

#include "parkade/core/check.hpp"

namespace parkade {

double lengthSigma(const std::vector<Eigen::Vector3d>& places, const Eigen::MatrixXd& covariance) {
  const auto n = static_cast<Eigen::Index>(places.size());
  PARKADE_CHECK(covariance.rows() == 3 * n && covariance.cols() == 3 * n,
                "covariance of {} x {} for {} places", covariance.rows(), covariance.cols(), n);
  if (n < 2) return 0.0;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& place : places) middle += place / static_cast<double>(n);
  Eigen::VectorXd growth(3 * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    growth.segment<3>(3 * i) = places[static_cast<std::size_t>(i)] - middle;
  }
  const double size2 = growth.squaredNorm();
  if (!(size2 > 0.0)) return 0.0;
  return std::sqrt(std::max(0.0, growth.dot(covariance * growth))) / size2;
}

void addLengthError(double sigma, PoseEstimate& estimate) {
  const Eigen::Vector3d way = sigma * (estimate.T_odom_vehicle.rotation().inverse() *
                                       estimate.T_odom_vehicle.translation());
  estimate.covariance.topLeftCorner<3, 3>() += way * way.transpose();
}

}  // namespace parkade
