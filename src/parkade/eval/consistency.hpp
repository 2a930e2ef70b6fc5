// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "parkade/core/result.hpp"
#include "parkade/eval/association.hpp"
#include "parkade/geometry/se3.hpp"
#include "parkade/types/pose_covariance.hpp"

namespace parkade {

// Is an estimator's covariance honest? Bar-Shalom, Li, Kirubarajan, "Estimation with Applications
// to Tracking and Navigation", 2001, section 5.4. Definitions: docs/evaluation.md.

/// Error of a pose in the tangent order of covariances here, right perturbation:
/// T_truth = T_estimate * exp(error). (translation, rotation), m and rad.
Vector6d poseError(const SE3& T_estimate, const SE3& T_truth);

/// Normalised estimation error squared: error' covariance^-1 error. Chi-square distributed with as
/// many degrees of freedom as the error has parts, if the covariance is right. Fails where sizes
/// differ, a number is not finite, or the covariance is not symmetric positive definite.
Result<double> nees(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance);

/// P(X <= x) of a chi-square variable with dof > 0 degrees of freedom (need not be whole).
double chiSquareCdf(double x, double dof);

/// The x with chiSquareCdf(x, dof) = p, 0 < p < 1, to 1e-9 relative.
double chiSquareQuantile(double p, double dof);

/// Mean NEES of independent runs beside the interval in which it lies with the given probability if
/// the estimator is consistent.
struct NeesTest {
  double mean = 0.0;  ///< expected: dof
  double lower = 0.0;
  double upper = 0.0;
  std::size_t runs = 0;
  int dof = 0;

  [[nodiscard]] bool consistent() const { return mean >= lower && mean <= upper; }
  [[nodiscard]] bool overconfident() const { return mean > upper; }  ///< covariance too small
};

/// One NEES per independent run (seed), each of the same instant or the mean over the run: a mean
/// over a run varies less, so that the band is then on the safe side. Fails without a run.
Result<NeesTest> neesTest(const std::vector<double>& nees_of_runs, int dof,
                          double probability = 0.95);

/// NEES of a run's poses, the mean over time.
struct PoseConsistency {
  double position = 0.0;  ///< 3 if the covariance is right
  double yaw = 0.0;       ///< about the reference's z; 1 if the covariance is right
  std::size_t poses = 0;  ///< that count: matched, not the first, covariance positive definite
};

/// The first poses are joined, as the covariances are relative to it; the reference is
/// interpolated. Fails where nothing matches or no pose counts.
Result<PoseConsistency> poseConsistency(const Trajectory& estimate,
                                        const PoseCovariances& covariances,
                                        const Trajectory& reference,
                                        AssociationOptions association = {});

}  // namespace parkade
