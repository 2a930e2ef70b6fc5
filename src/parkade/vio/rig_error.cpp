// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/vio/rig_error.hpp"

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

Eigen::Vector3d commonTurnSigma(const Eigen::MatrixXd& covariance) {
  const Eigen::Index n = covariance.rows() / 3;
  PARKADE_CHECK(covariance.rows() == 3 * n && covariance.cols() == 3 * n,
                "covariance of {} x {} for turns", covariance.rows(), covariance.cols());
  if (n == 0) return Eigen::Vector3d::Zero();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (Eigen::Index a = 0; a < n; ++a) {
    for (Eigen::Index b = 0; b < n; ++b) {
      sum += covariance.block<3, 3>(3 * a, 3 * b).diagonal();
    }
  }
  return sum.cwiseMax(0.0).cwiseSqrt() / static_cast<double>(n);
}

void RigErrorOnWay::advance(const SE3& T_odom_vehicle, const SE3& T_world_vehicle,
                            const RigSigma& sigma) {
  if (moved_) {
    const Eigen::Vector3d step =
        T_odom_vehicle.rotation().inverse() *
        Eigen::Vector3d(T_odom_vehicle.translation() - last_T_odom_vehicle_.translation());
    Eigen::Matrix<double, 3, 4> off;
    off.col(0) = sigma.length * step;
    for (int k = 0; k < 3; ++k) {
      off.col(1 + k) = sigma.turn[k] * Eigen::Vector3d::Unit(k).cross(step);
    }
    error_ += T_world_vehicle.rotation().matrix() * off;
  }
  moved_ = true;
  last_T_odom_vehicle_ = T_odom_vehicle;
}

void RigErrorOnWay::addTo(PoseEstimate& estimate) const {
  const Eigen::Matrix<double, 3, 4> off =
      estimate.T_odom_vehicle.rotation().matrix().transpose() * error_;
  estimate.covariance.topLeftCorner<3, 3>() += off * off.transpose();
}

}  // namespace parkade
