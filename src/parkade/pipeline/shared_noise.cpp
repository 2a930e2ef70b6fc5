// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/pipeline/shared_noise.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "parkade/core/units.hpp"

namespace parkade {

Eigen::Matrix3d sharedNoise(double sigma_m, double sigma_deg) {
  const double turn = sigma_deg * kDegree;
  const Eigen::Vector3d variances(sigma_m * sigma_m, sigma_m * sigma_m, turn * turn);
  return variances.asDiagonal();
}

Eigen::Matrix3d withSharedNoise(const Eigen::Matrix3d& information, const Eigen::Matrix3d& shared) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(information);
  Eigen::Matrix3d result = Eigen::Matrix3d::Zero();
  constexpr double kLeast = 1e-6;
  for (int k = 0; k < 3; ++k) {
    if (eigen.eigenvalues()[k] <= kLeast) continue;
    const Eigen::Vector3d u = eigen.eigenvectors().col(k);
    result += u * u.transpose() / (1.0 / eigen.eigenvalues()[k] + u.dot(shared * u));
  }
  return result;
}

double largestSigma(const Eigen::Matrix2d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, eigen.eigenvalues()[1]));
}

}  // namespace parkade
