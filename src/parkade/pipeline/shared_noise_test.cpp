// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/pipeline/shared_noise.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "parkade/core/units.hpp"

namespace parkade {
namespace {

// Lines seen ahead tie a turn to a step aside.
Eigen::Matrix3d seenAhead() {
  Eigen::Matrix3d covariance = Eigen::Vector3d(1e-4, 1e-4, 4e-6).asDiagonal();
  covariance(1, 2) = covariance(2, 1) = -0.7 * std::sqrt(1e-4 * 4e-6);
  return covariance.inverse();
}

TEST(SharedNoise, AddsItsCovarianceWhereAllIsObservable) {
  const Eigen::Matrix3d shared = sharedNoise(0.02, 0.1);
  const Eigen::Matrix3d expected = (seenAhead().inverse() + shared).inverse();
  EXPECT_LT((withSharedNoise(seenAhead(), shared) - expected).norm(), 1e-6 * expected.norm());
}

TEST(SharedNoise, LeavesWhatIsNotObservableUnknown) {
  const Eigen::Vector3d line(0.0, 1.0, 0.0);  // a lone line ahead fixes the way aside alone
  const Eigen::Matrix3d result =
      withSharedNoise(1e4 * line * line.transpose(), sharedNoise(0.02, 0.1));
  EXPECT_NEAR(result(1, 1), 1.0 / (1e-4 + 4e-4), 1e-3);
  EXPECT_NEAR(result(0, 0), 0.0, 1e-9);
  EXPECT_NEAR(result(2, 2), 0.0, 1e-9);
  EXPECT_TRUE(withSharedNoise(Eigen::Matrix3d::Zero(), sharedNoise(0.02, 0.1)).isZero());
}

}  // namespace
}  // namespace parkade
