// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/sim/drive/speed_profile.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace parkade::sim {
namespace {

Path blockAndBack() {
  PathLeg forward;
  forward.vertices = {{0, 0}, {30, 0}, {30, 40}, {70, 40}};
  PathLeg back;
  back.reverse = true;
  back.vertices = {{70, 40}, {60, 40}, {60, 31}};
  back.corners = {4.5, 4.5, 2.0, 2.0};
  return std::move(buildPath({forward, back})).value();
}

TEST(UniformSpline, DerivativesAgreeWithDifferences) {
  std::vector<Eigen::Matrix<double, 1, 1>> points;
  for (int i = 0; i < 40; ++i) points.emplace_back(std::sin(0.7 * i) + 0.01 * i * i);
  const UniformSpline<1> spline(0.0, 0.1, points);
  const double h = 1e-5;
  for (double t = 0.31; t < 3.4; t += 0.013) {
    for (int order = 0; order < 3; ++order) {
      const double difference =
          (spline.evaluate(t + h, order)[0] - spline.evaluate(t - h, order)[0]) / (2 * h);
      EXPECT_NEAR(spline.evaluate(t, order + 1)[0], difference, 1e-4 * (1 + std::abs(difference)));
    }
  }
}

TEST(UniformSpline, ReproducesALine) {
  std::vector<Eigen::Matrix<double, 1, 1>> points;
  for (int i = 0; i < 12; ++i) points.emplace_back(3.0 + 0.2 * i);
  const UniformSpline<1> spline(-1.0, 0.5, points);
  EXPECT_NEAR(spline.evaluate(1.7)[0], 3.0 + 0.2 * 5.4, 1e-13);
  EXPECT_NEAR(spline.evaluate(1.7, 1)[0], 0.4, 1e-13);
  EXPECT_NEAR(spline.evaluate(1.7, 2)[0], 0.0, 1e-12);
}

TEST(SpeedProfile, KeepsItsLimits) {
  const Path path = blockAndBack();
  const SpeedOptions options;
  const SpeedProfile profile(path, {{50.0, 2.0}}, {{10.0, 20.0, 2.0}}, options);
  double top = 0.0;
  double last_acceleration = 0.0;
  for (double t = 0.0; t <= profile.duration(); t += 0.01) {
    const double v = profile.speed(t);
    const PathPoint point = path.at(profile.distance(t));
    top = std::max(top, v);
    EXPECT_LE(v * v * std::abs(point.curvature), 1.5);
    EXPECT_LE(std::abs(profile.acceleration(t)), 1.0);
    EXPECT_LE(std::abs(profile.acceleration(t) - last_acceleration) / 0.01, 3.0);
    EXPECT_LE(v, point.direction < 0 ? options.max_reverse_speed + 1e-9 : options.max_speed + 1e-9);
    last_acceleration = profile.acceleration(t);
  }
  EXPECT_LE(top, options.max_speed + 1e-9);
  EXPECT_GT(top, 3.5);
}

TEST(SpeedProfile, StandsAtStartStopsGearChangeAndEnd) {
  const Path path = blockAndBack();
  const SpeedOptions options;
  const SpeedProfile profile(path, {{50.0, 2.0}}, {}, options);
  EXPECT_EQ(profile.distance(0.0), 0.0);
  EXPECT_NEAR(profile.distance(profile.duration()), path.length(), 1e-9);
  const auto timeAtRest = [&](double s) {
    int count = 0;
    for (double t = 0.0; t <= profile.duration(); t += 0.01) {
      count += std::abs(profile.distance(t) - s) < 1e-6 && profile.speed(t) < 1e-6 ? 1 : 0;
    }
    return count * 0.01;
  };
  EXPECT_NEAR(timeAtRest(0.0), options.start_standstill, 0.25);
  EXPECT_NEAR(timeAtRest(50.0), 2.0, 0.25);
  ASSERT_EQ(path.gearChanges().size(), 1U);
  EXPECT_NEAR(timeAtRest(path.gearChanges()[0]), options.gear_standstill, 0.25);
  EXPECT_NEAR(timeAtRest(path.length()), options.end_standstill, 0.25);
}

}  // namespace
}  // namespace parkade::sim
