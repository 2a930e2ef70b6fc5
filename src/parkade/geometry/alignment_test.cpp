// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/geometry/alignment.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "parkade/core/check.hpp"
#include "parkade/core/random.hpp"

namespace parkade {
namespace {

Eigen::Vector3d randomVector(Random& random, double sigma) {
  return {random.normal(0.0, sigma), random.normal(0.0, sigma), random.normal(0.0, sigma)};
}

SE3 randomPose(Random& random) {
  return {SO3::exp(randomVector(random, 1.0)), randomVector(random, 20.0)};
}

// Points of a given spread per axis, around a place away from the origin.
Points3d cloud(Random& random, int count, const Eigen::Vector3d& spread) {
  Points3d points;
  for (int i = 0; i < count; ++i) {
    points.push_back(Eigen::Vector3d(50.0, -20.0, 3.0) +
                     spread.cwiseProduct(randomVector(random, 1.0)));
  }
  return points;
}

Points3d mapped(const Points3d& source, const SE3& T, double scale) {
  Points3d target;
  for (const auto& p : source) target.push_back(T * Eigen::Vector3d(scale * p));
  return target;
}

double distanceBetween(const SE3& a, const SE3& b) {
  return (a.inverse() * b).log().norm();
}

double sumOfSquares(const Points3d& source, const Points3d& target, const SE3& T, double scale) {
  double sum = 0.0;
  for (std::size_t i = 0; i < source.size(); ++i) {
    sum += (target[i] - T * Eigen::Vector3d(scale * source[i])).squaredNorm();
  }
  return sum;
}

TEST(Alignment, RecoversRigidMotionAndScaleExactly) {
  Random random(1);
  for (int trial = 0; trial < 50; ++trial) {
    const SE3 T = randomPose(random);
    const double scale = random.uniform(0.1, 10.0);
    // A volume, a plane (rank 2) and the smallest sample.
    for (const auto& [count, spread] : {std::pair{100, Eigen::Vector3d(10.0, 7.0, 2.0)},
                                        std::pair{100, Eigen::Vector3d(10.0, 7.0, 0.0)},
                                        std::pair{3, Eigen::Vector3d(10.0, 7.0, 2.0)}}) {
      const Points3d source = cloud(random, count, spread);
      const Alignment rigid = alignSE3(source, mapped(source, T, 1.0));
      EXPECT_LT(distanceBetween(rigid.T_target_source, T), 1e-9);
      EXPECT_EQ(rigid.scale, 1.0);
      EXPECT_LT(rigid.rmse, 1e-10);
      EXPECT_FALSE(rigid.degenerate()) << toString(rigid.degeneracy);
      const Alignment similar = alignSim3(source, mapped(source, T, scale));
      EXPECT_LT(distanceBetween(similar.T_target_source, T), 1e-8);
      EXPECT_NEAR(similar.scale, scale, 1e-10 * scale);
      EXPECT_FALSE(similar.degenerate());
    }
  }
}

// A flat set's mirror image is a half turn away in space: an exact fit without a reflection.
TEST(Alignment, FlatMirrorImageIsAHalfTurn) {
  const Points3d source = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}};
  const Points3d target = {{0, 0, 0}, {-1, 0, 0}, {0, 2, 0}};
  const Alignment a = alignSim3(source, target);
  EXPECT_NEAR(a.T_target_source.rotation().matrix().determinant(), 1.0, 1e-12);
  EXPECT_NEAR(a.rmse, 0.0, 1e-9);
  EXPECT_NEAR(a.scale, 1.0, 1e-9);
}

TEST(Alignment, MirroredVolumeStillGivesTheBestRotation) {
  Random random(2);
  const Points3d source = cloud(random, 60, {5.0, 4.0, 3.0});
  Points3d target;
  for (const auto& p : source) target.emplace_back(p.x(), p.y(), -p.z());
  const Alignment best = alignSE3(source, target);
  EXPECT_NEAR(best.T_target_source.rotation().matrix().determinant(), 1.0, 1e-12);
  EXPECT_GT(best.rmse, 0.1);
  const double cost = sumOfSquares(source, target, best.T_target_source, 1.0);
  for (int trial = 0; trial < 200; ++trial) {
    const SE3 near =
        best.T_target_source * SE3(SO3::exp(randomVector(random, 0.05)), randomVector(random, 0.1));
    EXPECT_GE(sumOfSquares(source, target, near, 1.0), cost);
    const SE3 far(SO3::exp(randomVector(random, 2.0)), best.T_target_source.translation());
    EXPECT_GE(sumOfSquares(source, target, far, 1.0), cost);
  }
}

TEST(Alignment, IsTheMinimumUnderNoise) {
  Random random(3);
  const SE3 T = randomPose(random);
  const Points3d source = cloud(random, 80, {10.0, 10.0, 1.0});
  Points3d target = mapped(source, T, 1.3);
  for (auto& p : target) p += randomVector(random, 0.2);
  const Alignment a = alignSim3(source, target);
  EXPECT_NEAR(a.scale, 1.3, 0.02);
  EXPECT_NEAR(a.rmse, 0.2 * std::sqrt(3.0), 0.05);
  const double cost = sumOfSquares(source, target, a.T_target_source, a.scale);
  for (int trial = 0; trial < 100; ++trial) {
    const SE3 other =
        a.T_target_source * SE3(SO3::exp(randomVector(random, 0.01)), randomVector(random, 0.05));
    EXPECT_GE(sumOfSquares(source, target, other, a.scale * random.uniform(0.99, 1.01)), cost);
  }
}

TEST(Alignment, YawOnlyRecoversYawAndKeepsTilt) {
  Random random(4);
  for (const double yaw : {0.0, 0.4, -2.9, 3.1}) {
    const SE3 T(SO3::fromYawPitchRoll(yaw, 0.0, 0.0), {3.0, -7.0, 1.5});
    const Points3d source = cloud(random, 40, {10.0, 4.0, 0.5});
    const Alignment a = alignYaw(source, mapped(source, T, 1.0));
    EXPECT_LT(distanceBetween(a.T_target_source, T), 1e-9);
    EXPECT_FALSE(a.degenerate());
  }
  // A tilt that yaw cannot take away stays in the residual, and the yaw is still the best one.
  const SE3 tilted(SO3::fromYawPitchRoll(0.7, 0.05, -0.03), {1.0, 2.0, 3.0});
  const Points3d source = cloud(random, 40, {10.0, 4.0, 0.5});
  const Points3d target = mapped(source, tilted, 1.0);
  const Alignment a = alignYaw(source, target);
  EXPECT_GT(a.rmse, 0.01);
  EXPECT_NEAR(a.T_target_source.rotation().yawPitchRoll().y(), 0.0, 1e-12);
  EXPECT_NEAR(a.T_target_source.rotation().yawPitchRoll().z(), 0.0, 1e-12);
  Eigen::Vector3d mean_source = Eigen::Vector3d::Zero();
  Eigen::Vector3d mean_target = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < source.size(); ++i) {
    mean_source += source[i] / 40.0;
    mean_target += target[i] / 40.0;
  }
  const double cost = sumOfSquares(source, target, a.T_target_source, 1.0);
  for (const double step : {-0.1, -1e-3, 1e-3, 0.1}) {
    const SO3 R = SO3::fromYawPitchRoll(a.T_target_source.rotation().yaw() + step, 0.0, 0.0);
    EXPECT_GT(sumOfSquares(source, target, SE3(R, mean_target - R * mean_source), 1.0), cost);
  }
}

TEST(Alignment, OriginPutsOnePoseOntoTheOther) {
  Random random(5);
  const SE3 a = randomPose(random);
  const SE3 b = randomPose(random);
  EXPECT_LT(distanceBetween(alignOrigin(a, b) * a, b), 1e-12);
}

TEST(Alignment, SaysWhatThePointsLeaveOpen) {
  const Points3d none;
  EXPECT_EQ(alignSE3(none, none).degeneracy, Degeneracy::kTooFewPoints);
  EXPECT_EQ(alignYaw(none, none).degeneracy, Degeneracy::kTooFewPoints);

  const Points3d two = {{0, 0, 0}, {1, 0, 0}};
  const Points3d two_turned = {{1, 1, 1}, {1, 2, 1}};
  const Alignment pair = alignSE3(two, two_turned);
  EXPECT_EQ(pair.degeneracy, Degeneracy::kTooFewPoints);
  EXPECT_LT(pair.rmse, 1e-12);
  EXPECT_FALSE(alignYaw(two, two_turned).degenerate());

  const Points3d heap(10, Eigen::Vector3d(1e6, -2e6, 3.3));
  const Points3d other_heap(10, Eigen::Vector3d(4.1, 5.2, 6.3));
  for (const Alignment& a :
       {alignSE3(heap, other_heap), alignSim3(heap, other_heap), alignYaw(heap, other_heap)}) {
    EXPECT_EQ(a.degeneracy, Degeneracy::kCoincident);
    EXPECT_EQ(a.scale, 1.0);
    EXPECT_LT(a.T_target_source.rotation().log().norm(), 1e-12);
    EXPECT_LT(a.rmse, 1e-8);
  }

  const Points3d pole = {{1, 2, 0}, {1, 2, 5}, {1, 2, 9}};
  EXPECT_EQ(alignYaw(pole, pole).degeneracy, Degeneracy::kCoincident);
}

TEST(Alignment, StraightLineTakesTheSmallestRotation) {
  Points3d source;
  Points3d target;
  const SO3 turn = SO3::fromYawPitchRoll(0.3, 0.0, 0.0);
  for (int i = 0; i < 100; ++i) {
    source.emplace_back(1000.0 + 0.37 * i, -500.0 + 0.11 * i, 2.0);
    target.push_back(turn * source.back() + Eigen::Vector3d(3.0, 4.0, 5.0));
  }
  const Alignment rigid = alignSE3(source, target);
  EXPECT_EQ(rigid.degeneracy, Degeneracy::kCollinear);
  EXPECT_LT(rigid.rmse, 1e-8);
  EXPECT_NEAR(angleBetween(rigid.T_target_source.rotation(), turn), 0.0, 1e-6);
  const Alignment similar = alignSim3(source, target);
  EXPECT_NEAR(similar.scale, 1.0, 1e-9);

  // With a little width the rotation is the least-squares one, and still reported as weak.
  for (std::size_t i = 0; i < source.size(); ++i) {
    const Eigen::Vector3d bump(0.0, 0.0, (i % 2 == 0 ? 1e-4 : -1e-4));
    source[i] += bump;
    target[i] += turn * bump;
  }
  EXPECT_EQ(alignSE3(source, target).degeneracy, Degeneracy::kCollinear);
}

// A straight drive of a metre that wobbles by a millimetre, told to a fraction of one: what it says
// about the roll is those deviations.
TEST(Alignment, ALineIsALineAsFarAsThePointsAgree) {
  struct Case {
    double width;  // of the route across its 1 m
    double noise;
    Degeneracy expected;
  };
  for (const Case& c :
       {Case{1e-3, 2e-4, Degeneracy::kCollinear},
        Case{1e-3, 1e-6, Degeneracy::kNone},  // rolls by 0.1 degrees at most
        Case{3e-2, 2e-4, Degeneracy::kNone}, Case{3e-2, 6e-3, Degeneracy::kCollinear},
        // A route with corners and a bad estimate is no line.
        Case{0.5, 0.1, Degeneracy::kNone}}) {
    Random random(7);
    const SE3 T = randomPose(random);
    Points3d source;
    for (int i = 0; i < 40; ++i) {
      source.emplace_back(0.025 * i, c.width * std::sin(0.2 * i),
                          0.3 * c.width * std::cos(0.5 * i));
    }
    Points3d target = mapped(source, T, 1.0);
    for (auto& p : target) p += randomVector(random, c.noise);
    const Alignment rigid = alignSE3(source, target);
    EXPECT_EQ(rigid.degeneracy, c.expected) << c.width << " m wide, noise " << c.noise;
    EXPECT_EQ(alignSim3(source, target).degeneracy, c.expected);
    const SO3 roll = T.rotation().inverse() * rigid.T_target_source.rotation();
    if (c.expected == Degeneracy::kNone && c.width < 0.1) {
      EXPECT_LT(roll.log().norm(), 0.02);
    }
  }
}

// Errors along the line (a wrong scale, late stamps) say nothing about the roll.
TEST(Alignment, ErrorsAlongALineLeaveItsRollKnown) {
  Points3d source;
  Points3d target;
  for (int i = 0; i < 100; ++i) {
    source.emplace_back(1.0 * i, std::sin(0.1 * i), 0.0);
    target.emplace_back(1.01 * i, std::sin(0.1 * i), 0.0);
  }
  const Alignment a = alignSE3(source, target);
  EXPECT_GT(a.rmse, 0.2);
  EXPECT_EQ(a.degeneracy, Degeneracy::kNone);
}

TEST(Alignment, RefusesListsThatDoNotMatch) {
  const Points3d two = {{0, 0, 0}, {1, 0, 0}};
  const Points3d three = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  EXPECT_THROW(static_cast<void>(alignSE3(two, three)), CheckError);
  EXPECT_THROW(static_cast<void>(alignYaw(two, three)), CheckError);
  const Points3d bad = {{0, 0, 0}, {std::nan(""), 0, 0}, {0, 1, 0}};
  EXPECT_THROW(static_cast<void>(alignSE3(bad, three)), CheckError);
}

}  // namespace
}  // namespace parkade
