// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/bev/ground_plane.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "parkade/core/random.hpp"

namespace parkade {
namespace {

using Eigen::Vector3d;

// A body at (pitch, roll, height) over a floor z = slope_x x + slope_y y of odom, at (x, y, yaw).
struct Case {
  double x = 0.0;
  double y = 0.0;
  double yaw = 0.0;
  double slope_x = 0.0;
  double slope_y = 0.0;
  GroundAttitude attitude;
};

PoseEstimate poseOf(const Case& c, TimeNs t_ns) {
  // The levelled frame lies on the slope with its x axis along the heading.
  const Vector3d normal = Vector3d(-c.slope_x, -c.slope_y, 1.0).normalized();
  const Vector3d heading(std::cos(c.yaw), std::sin(c.yaw), 0.0);
  const Vector3d ahead = (heading - normal * normal.dot(heading)).normalized();
  Eigen::Matrix3d R;
  R << ahead, normal.cross(ahead), normal;
  const SE3 T_odom_level(SO3(Eigen::Quaterniond(R)),
                         Vector3d(c.x, c.y, c.slope_x * c.x + c.slope_y * c.y));
  const SO3 body = SO3::exp(Vector3d(0.0, c.attitude.pitch, 0.0)) *
                   SO3::exp(Vector3d(c.attitude.roll, 0.0, 0.0));
  PoseEstimate pose;
  pose.t_ns = t_ns;
  pose.T_odom_vehicle = T_odom_level * SE3(body, Vector3d(0.0, 0.0, c.attitude.height));
  pose.health = Health::kTracking;
  return pose;
}

std::vector<Landmark> floorAround(const Case& c, int count, double noise, Random& random,
                                  std::uint64_t first_id) {
  std::vector<Landmark> landmarks;
  for (int i = 0; i < count; ++i) {
    Landmark landmark;
    landmark.id = first_id + static_cast<std::uint64_t>(i);
    const double px = c.x + random.uniform(-6.0, 6.0);
    const double py = c.y + random.uniform(-6.0, 6.0);
    landmark.p_odom = {px, py, c.slope_x * px + c.slope_y * py + noise * random.normal()};
    landmark.covariance = noise * noise * Eigen::Matrix3d::Identity();
    landmark.num_observations = 5;
    landmarks.push_back(landmark);
  }
  return landmarks;
}

TEST(GroundPlane, FindsAttitudeAndHeightExactlyWithoutNoise) {
  Case c{3.0, -2.0, 0.7, 0.02, -0.01, {0.012, -0.008, 0.015}};
  GroundPlaneOptions options;
  options.tilt_prior_deg = 10.0;
  options.height_prior_m = 1.0;
  options.elevation.curvature_sigma = 0.0;
  GroundPlaneEstimator estimator(options);
  Random random(1);
  const std::vector<Landmark> landmarks = floorAround(c, 200, 0.0, random, 0);
  GroundPlaneEstimate estimate;
  for (int i = 0; i < 30; ++i)
    estimate = estimator.update(poseOf(c, i * 100 * kNsPerMs), landmarks);
  EXPECT_NEAR(estimate.attitude.pitch, 0.012, 2e-5);
  EXPECT_NEAR(estimate.attitude.roll, -0.008, 2e-5);
  EXPECT_NEAR(estimate.attitude.height, 0.015, 5e-5);
  // The floor's elevation leans a little towards a level one where nothing is seen.
  options.elevation = {};
  GroundPlaneEstimator with_relief(options);
  for (int i = 0; i < 30; ++i)
    estimate = with_relief.update(poseOf(c, i * 100 * kNsPerMs), landmarks);
  EXPECT_NEAR(estimate.attitude.pitch, 0.012, 1e-3);
  EXPECT_NEAR(estimate.attitude.roll, -0.008, 1e-3);
  EXPECT_NEAR(estimate.attitude.height, 0.015, 1e-3);
}

TEST(GroundPlane, HoldsAmongThingsThatStandOnTheFloor) {
  Random random(2);
  GroundPlaneEstimator estimator({});
  Case c;
  c.slope_x = 0.015;
  double worst = 0.0;
  for (int i = 0; i < 100; ++i) {
    c.x = 0.3 * i;
    c.yaw = 0.01 * i;
    c.attitude = {0.005 * std::sin(0.1 * i), 0.004 * std::cos(0.15 * i), 0.01};
    std::vector<Landmark> landmarks =
        floorAround(c, 25, 0.015, random, static_cast<std::uint64_t>(1000 * i));
    // Wheels, bumpers, walls: more of them than of the floor, all above it.
    std::vector<Landmark> objects =
        floorAround(c, 40, 0.015, random, static_cast<std::uint64_t>(1000 * i + 500));
    for (Landmark& object : objects) object.p_odom.z() += random.uniform(0.05, 1.5);
    landmarks.insert(landmarks.end(), objects.begin(), objects.end());
    const GroundPlaneEstimate e = estimator.update(poseOf(c, i * 100 * kNsPerMs), landmarks);
    if (i < 10) continue;
    worst = std::max({worst, std::abs(e.attitude.pitch - c.attitude.pitch),
                      std::abs(e.attitude.roll - c.attitude.roll)});
    EXPECT_NEAR(e.attitude.height, 0.01, 0.012) << i;
  }
  EXPECT_LT(worst, 0.004);
}

TEST(GroundPlane, ReliefIsWhatNoPlaneFits) {
  // A ridge under the car: the floor falls by 2 % to either side of x = 0.
  const auto floor = [](double x) { return -0.02 * std::abs(x); };
  Random random(5);
  std::vector<Landmark> landmarks = floorAround({}, 300, 0.01, random, 0);
  for (Landmark& landmark : landmarks) landmark.p_odom.z() += floor(landmark.p_odom.x());
  GroundPlaneEstimator estimator({});
  GroundPlaneEstimate e;
  for (int i = 0; i < 20; ++i) e = estimator.update(poseOf({}, i * 100 * kNsPerMs), landmarks);
  EXPECT_NEAR(e.attitude.pitch, 0.0, 0.002);
  for (const double x : {-5.0, -2.0, 0.0, 3.0, 5.0}) {
    const double found = e.relief.at({x, 1.0}) - e.attitude.height;
    EXPECT_NEAR(found, floor(x), 0.015) << x;
  }
  GroundPlaneOptions plane_only;
  plane_only.elevation.curvature_sigma = 0.0;
  GroundPlaneEstimator plane(plane_only);
  EXPECT_TRUE(plane.update(poseOf({}, 0), landmarks).relief.isFlat());
}

TEST(GroundPlane, AFloorThatIsNearlyAPlaneIsTakenForOne) {
  Case c{0.0, 0.0, 0.4, 0.015, 0.005, {0.004, -0.003, 0.01}};
  Random random(6);
  const std::vector<Landmark> landmarks = floorAround(c, 150, 0.012, random, 0);
  GroundPlaneEstimator estimator({});
  GroundPlaneEstimate e;
  for (int i = 0; i < 10; ++i) e = estimator.update(poseOf(c, i * 100 * kNsPerMs), landmarks);
  EXPECT_EQ(e.relief.heights.cwiseAbs().maxCoeff(), 0.0);
  EXPECT_NEAR(e.attitude.pitch, c.attitude.pitch, 0.0015);
  EXPECT_NEAR(e.attitude.roll, c.attitude.roll, 0.0015);
}

TEST(GroundPlane, SaysThatItKnowsLittleWithoutLandmarks) {
  GroundPlaneEstimator estimator({});
  const GroundPlaneEstimate e = estimator.update(poseOf({}, 0), {});
  EXPECT_EQ(e.points, 0);
  EXPECT_NEAR(e.sigma_pitch, 0.7 * M_PI / 180.0, 1e-6);
  EXPECT_NEAR(e.sigma_height, 0.02, 1e-9);
  EXPECT_NEAR(e.attitude.pitch, 0.0, 1e-9);
}

}  // namespace
}  // namespace parkade
