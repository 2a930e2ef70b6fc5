// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/bev/floor_elevation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "parkade/core/random.hpp"

namespace parkade {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Floor = std::function<double(const Vector2d&)>;

// A smooth rise of 0.3 m over 16 m of x, from x = 0 on.
double ramp(const Vector2d& p) {
  const double u = std::clamp(p.x() / 16.0, 0.0, 1.0);
  return 0.3 * (u - std::sin(2.0 * M_PI * u) / (2.0 * M_PI));
}

std::vector<FloorSample> samplesOf(const Floor& floor, const Vector2d& around, int count,
                                   double noise, Random& random) {
  std::vector<FloorSample> samples;
  for (int i = 0; i < count; ++i) {
    const Vector2d p = around + Vector2d(random.uniform(-7.0, 7.0), random.uniform(-7.0, 7.0));
    samples.push_back({{p.x(), p.y(), floor(p) + noise * random.normal()}, 0.012});
  }
  return samples;
}

// Largest error within 5 m of the car.
double worstAround(const FloorElevation& elevation, const Floor& floor, const Vector2d& car) {
  double worst = 0.0;
  for (double x = -5.0; x <= 5.0; x += 0.5) {
    for (double y = -5.0; y <= 5.0; y += 0.5) {
      const Vector2d p = car + Vector2d(x, y);
      worst = std::max(worst, std::abs(elevation.at(p) - floor(p)));
    }
  }
  return worst;
}

TEST(FloorElevation, FollowsARampThatNoPlaneFits) {
  Random random(3);
  FloorElevation elevation({});
  double worst = 0.0;
  for (double x = -8.0; x < 20.0; x += 0.5) {
    const Vector2d car(x, 0.3);
    const SE3 T_odom_vehicle(SO3(), Vector3d(x, 0.3, ramp(car)));
    elevation.update(T_odom_vehicle, Vector3d::Zero(), samplesOf(ramp, car, 150, 0.01, random), {});
    worst = std::max(worst, worstAround(elevation, ramp, car));
  }
  EXPECT_LT(worst, 0.035);
}

TEST(FloorElevation, WhatStandsOnTheFloorDoesNotLiftIt) {
  Random random(4);
  FloorElevation elevation({});
  for (double x = -6.0; x < 16.0; x += 0.5) {
    const Vector2d car(x, 0.0);
    std::vector<FloorSample> samples = samplesOf(ramp, car, 100, 0.01, random);
    for (FloorSample& s : samplesOf(ramp, car, 60, 0.01, random)) {
      s.p_odom.z() += random.uniform(0.05, 1.0);
      samples.push_back(s);
    }
    elevation.update(SE3(SO3(), Vector3d(x, 0.0, ramp(car))), Vector3d::Zero(), samples, {});
    EXPECT_LT(worstAround(elevation, ramp, car), 0.05) << x;
  }
}

TEST(FloorElevation, ItIsThePlaneWhereNothingIsSeen) {
  FloorElevation elevation({});
  EXPECT_TRUE(elevation.isEmpty());
  const SE3 T_odom_vehicle(SO3::exp(Vector3d(0.0, 0.0, 0.8)), Vector3d(3.0, -2.0, 0.5));
  elevation.update(T_odom_vehicle, Vector3d::Zero(), {}, {});
  for (const Vector2d& p : {Vector2d(0.0, 0.0), Vector2d(6.0, 0.0), Vector2d(-4.0, 5.0)}) {
    EXPECT_NEAR(elevation.heightIn(T_odom_vehicle, p), 0.0, 1e-3);
  }
  elevation.reset();
  EXPECT_TRUE(elevation.isEmpty());
}

TEST(FloorElevation, SamplesFarOffTheFloorSayNothing) {
  FloorElevation elevation({});
  const SE3 T_odom_vehicle(SO3(), Vector3d::Zero());
  const std::vector<FloorSample> high(50, FloorSample{{2.0, 1.0, 0.3}, 0.01});
  elevation.update(T_odom_vehicle, Vector3d::Zero(), high, {});
  EXPECT_NEAR(elevation.at({2.0, 1.0}), 0.0, 1e-6);
}

}  // namespace
}  // namespace parkade
