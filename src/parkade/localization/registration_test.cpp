// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/localization/registration.hpp"

#include <gmock/gmock.h>

#include <Eigen/Eigenvalues>
#include <chrono>

#include "parkade/mapping/synthetic_plan.hpp"

namespace parkade {
namespace {

using testing::makePlan;
using testing::ObserverNoise;
using testing::Plan;
using testing::PlanObserver;

constexpr double kDegree = M_PI / 180.0;

// A submap of the drive from x = 20 to 25 m along the first aisle, in the frame of its start.
Submap drivenSubmap(const PlanObserver& observer, Random& random) {
  Submap submap;
  for (int k = 0; k < 20; ++k) {
    const SE2 local(0.0, {0.25 * k, 0.0});
    submap.add(observer.observe(0, SE2(0.0, {20.0, 0.0}) * local, random, false), local);
  }
  return submap;
}

const SE2 kOrigin(0.0, {20.0, 0.0});

double positionError(const SE2& a, const SE2& b) {
  return (a.translation() - b.translation()).norm();
}

TEST(Registration, WithoutNoiseItIsExact) {
  Random random(1);
  const PlanObserver observer(makePlan(1, 60.0, 0.6, 3), {});
  const Submap submap = drivenSubmap(observer, random);
  for (int round = 0; round < 20; ++round) {
    const SE2 truth(random.uniform(-0.3, 0.3),
                    {random.uniform(0.0, 8.0), random.uniform(-1.0, 1.0)});
    const SE2 prior = truth * SE2::exp({random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3),
                                        random.uniform(-2.0, 2.0) * kDegree});
    const Registration r =
        registerFrame(observer.observe(0, kOrigin * truth, random, false), submap, prior, {});
    ASSERT_TRUE(r.accepted) << r.reason;
    EXPECT_EQ(r.observable, 3);
    EXPECT_LT(positionError(r.T_map_vehicle, truth), 1e-3) << round;
    EXPECT_LT(std::abs(wrapAngle(r.T_map_vehicle.angle() - truth.angle())), 0.01 * kDegree);
  }
}

TEST(Registration, WithNoiseItIsCentimetresAndSaysSo) {
  ObserverNoise noise;
  noise.line_sigma = 0.015;
  noise.corner_sigma = 0.03;
  noise.object_sigma = 0.05;
  noise.attitude_sigma = 0.1 * kDegree;
  noise.dropout = 0.3;
  noise.outliers = 0.1;
  Random random(2);
  const PlanObserver observer(makePlan(1, 60.0, 0.6, 3), noise);
  double squares = 0.0;
  double nees = 0.0;
  double yaw_squares = 0.0;
  constexpr int kRounds = 60;
  for (int round = 0; round < kRounds; ++round) {
    const Submap submap = drivenSubmap(observer, random);
    const SE2 truth(random.uniform(-0.2, 0.2),
                    {random.uniform(2.0, 9.0), random.uniform(-1.0, 1.0)});
    const SE2 prior = truth * SE2::exp({random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2),
                                        random.uniform(-1.0, 1.0) * kDegree});
    const Registration r =
        registerFrame(observer.observe(0, kOrigin * truth, random, false), submap, prior, {});
    ASSERT_TRUE(r.accepted) << r.reason;
    const Eigen::Vector3d error = (truth.inverse() * r.T_map_vehicle).log();
    squares += error.head<2>().squaredNorm();
    nees += error.dot(r.information * error) / kRounds;
    EXPECT_LT(error.head<2>().norm(), 0.05);
    yaw_squares += error.z() * error.z() / kRounds;
  }
  const double rmse = std::sqrt(squares / kRounds);
  const double yaw_rmse = std::sqrt(yaw_squares);
  std::printf("registration: position RMSE %.1f mm, yaw RMSE %.3f deg, mean NEES %.2f of 3\n",
              1e3 * rmse, yaw_rmse / kDegree, nees);
  EXPECT_LT(yaw_rmse, 0.2 * kDegree);
  EXPECT_LT(rmse, 0.02);
  // Not overconfident; somewhat cautious on purpose.
  EXPECT_LT(nees, 3.6);
  EXPECT_GT(nees, 0.3);
}

TEST(Registration, LoneLineFixesNoPositionAlongItself) {
  Plan plan;
  plan.min = {-30.0, -10.0};
  plan.max = {60.0, 10.0};
  plan.lines.push_back({{-30.0, 2.0}, {60.0, 2.0}, 0.12, SemanticClass::kLaneLine});
  Random random(3);
  const PlanObserver observer(plan, {});
  const Submap submap = drivenSubmap(observer, random);
  const SE2 truth(0.1, {4.0, 0.0});
  const SE2 prior = truth * SE2::exp({0.25, 0.1, 0.5 * kDegree});
  const Registration r =
      registerFrame(observer.observe(0, kOrigin * truth, random, false), submap, prior, {});
  ASSERT_TRUE(r.accepted) << r.reason;
  EXPECT_EQ(r.observable, 2);
  EXPECT_NEAR(r.T_map_vehicle.translation().y(), 0.0, 2e-3);
  EXPECT_NEAR(r.T_map_vehicle.angle(), 0.1, 0.05 * kDegree);
  // Along the line the prior stays, and there is no information.
  EXPECT_NEAR(r.T_map_vehicle.translation().x(), prior.translation().x(), 0.03);
  const Eigen::Vector2d along =
      r.T_map_vehicle.rotationMatrix().transpose() * Eigen::Vector2d::UnitX();
  const Eigen::Vector3d direction(along.x(), along.y(), 0.0);
  EXPECT_LT(direction.dot(r.information * direction), 1.0);
}

TEST(Registration, OtherClassesAndOtherPlacesDoNotFit) {
  Random random(4);
  const PlanObserver observer(makePlan(1, 60.0, 0.6, 3), {});
  const Submap submap = drivenSubmap(observer, random);
  SemanticFrame frame = observer.observe(0, kOrigin, random, false);
  for (LinePoint& point : frame.line_points) point.semantic_class = SemanticClass::kLaneLine;
  frame.slots.clear();
  EXPECT_FALSE(registerFrame(frame, submap, SE2(), {}).accepted);
  // Half a slot off: the search must not pull it anywhere and call that a fit.
  frame = observer.observe(0, kOrigin, random, false);
  const Registration r = registerFrame(frame, submap, SE2(0.2, {1.25, 1.0}), {});
  EXPECT_FALSE(r.accepted && positionError(r.T_map_vehicle, SE2()) > 0.05);
  EXPECT_FALSE(registerFrame(SemanticFrame(), submap, SE2(), {}).accepted);
  EXPECT_FALSE(registerFrame(frame, Submap(), SE2(), {}).accepted);
}

TEST(Registration, LevellingErrorIsEstimatedNotTakenForMotion) {
  ObserverNoise noise;
  noise.attitude_sigma = 0.5 * kDegree;
  Random random(5);
  const Plan plan = makePlan(1, 60.0, 0.3, 3);
  const Submap submap = drivenSubmap(PlanObserver(plan, {}), random);
  const PlanObserver observer(plan, noise);
  double with = 0.0;
  double without = 0.0;
  constexpr int kRounds = 20;
  for (int round = 0; round < kRounds; ++round) {
    SemanticFrame frame = observer.observe(0, kOrigin, random, false);
    with += positionError(registerFrame(frame, submap, SE2(), {}).T_map_vehicle, SE2()) / kRounds;
    frame.attitude_sigma = 0.0;
    without +=
        positionError(registerFrame(frame, submap, SE2(), {}).T_map_vehicle, SE2()) / kRounds;
  }
  std::printf("levelling off by 0.5 deg: %.1f mm with its estimate, %.1f mm without\n", 1e3 * with,
              1e3 * without);
  EXPECT_LT(with, 0.5 * without);
  EXPECT_LT(with, 0.01);
}

TEST(Registration, TimeIsTold) {
  ObserverNoise noise;
  noise.line_sigma = 0.01;
  Random random(6);
  const PlanObserver observer(makePlan(1, 60.0, 0.3, 3), noise);
  const Submap submap = drivenSubmap(observer, random);
  const SemanticFrame frame = observer.observe(0, kOrigin, random, false);
  const auto begin = std::chrono::steady_clock::now();
  constexpr int kRounds = 20;
  for (int k = 0; k < kRounds; ++k) {
    EXPECT_TRUE(registerFrame(frame, submap, SE2(0.01, {0.1, 0.1}), {}).accepted);
  }
  const double ms =
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count() /
      kRounds;
  std::printf("registration of %zu line points: %.2f ms\n", frame.line_points.size(), ms);
}

}  // namespace
}  // namespace parkade
