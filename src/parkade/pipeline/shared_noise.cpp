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
  constexpr double kLeast = 1e-6;
  // Eigenvalues come in ascending order: the observable directions are the last ones.
  Eigen::Index unknown = 0;
  while (unknown < 3 && eigen.eigenvalues()[unknown] <= kLeast) ++unknown;
  const Eigen::Index known = 3 - unknown;
  if (known == 0) return Eigen::Matrix3d::Zero();
  const Eigen::MatrixXd U = eigen.eigenvectors().rightCols(known);
  Eigen::MatrixXd covariance = U.transpose() * shared * U;
  covariance.diagonal() += eigen.eigenvalues().tail(known).cwiseInverse();
  return U * covariance.inverse() * U.transpose();
}

double largestSigma(const Eigen::Matrix2d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(covariance, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, eigen.eigenvalues()[1]));
}

}  // namespace parkade
