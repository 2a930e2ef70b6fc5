// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/standing/raised_points.hpp"

#include <gtest/gtest.h>

namespace parkade {
namespace {

using Eigen::Vector3d;

TEST(RaisedPoints, AreSureAndNearTheCar) {
  const RaisedPointOptions options;
  const auto landmark = [&](double x, double z) {
    Landmark l;
    l.p_odom = {x, 0.0, z};
    l.covariance = 1e-4 * Eigen::Matrix3d::Identity();
    l.num_observations = 10;
    return l;
  };
  std::vector<Landmark> landmarks(5, landmark(3.0, 0.9));
  landmarks[1].p_odom.z() = 0.1;
  landmarks[2].p_odom.x() = 20.0;
  landmarks[3].num_observations = 2;
  landmarks[4].covariance *= 1e4;
  // The levelled frame's origin lies on the floor, odom's half a metre above.
  const SE3 T_level_odom(SO3(), Vector3d(0.0, 0.0, 0.5));
  const std::vector<RaisedPoint> raised = raisedPoints(landmarks, T_level_odom, {}, options);
  ASSERT_EQ(raised.size(), 2U);
  EXPECT_NEAR(raised[0].p_level.z(), 1.4, 1e-12);
  EXPECT_NEAR(raised[1].p_level.z(), 0.6, 1e-12);
}

}  // namespace
}  // namespace parkade
