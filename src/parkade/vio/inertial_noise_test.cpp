// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/vio/inertial_noise.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "parkade/core/random.hpp"

namespace parkade {
namespace {

constexpr double kHeadroom = 2.0;

// Residuals of readings whose errors are `times` as large as told.
void feed(InertialNoise& noise, double times, int count, Random& random) {
  for (int i = 0; i < count; ++i) {
    const double factor = noise.factor();
    Vector15d residual = Vector15d::Zero();
    for (int axis = 0; axis < 3; ++axis) {
      residual(Preintegration::kRotation + axis) = times / (kHeadroom * factor) * random.normal();
    }
    noise.learn(residual, factor);
  }
}

TEST(InertialNoise, NoiseThatIsAsToldIsKept) {
  InertialNoise noise(ImuNoise{}, kHeadroom);
  Random random(1);
  feed(noise, 0.7, 200, random);  // pictures give in to readings a little
  EXPECT_EQ(noise.factor(), 1.0);
  EXPECT_DOUBLE_EQ(noise.noise().gyroscope_noise_density,
                   kHeadroom * ImuNoise{}.gyroscope_noise_density);
  EXPECT_DOUBLE_EQ(noise.noise().accelerometer_random_walk, ImuNoise{}.accelerometer_random_walk);
}

TEST(InertialNoise, LargerErrorsAreLearnedAndForgotten) {
  InertialNoise noise(ImuNoise{}, kHeadroom);
  Random random(2);
  feed(noise, 8.0, 15, random);
  EXPECT_GT(noise.factor(), 4.0);
  feed(noise, 8.0, 200, random);
  EXPECT_NEAR(noise.factor(), 8.0, 1.5);
  const double walk = noise.noise().gyroscope_random_walk;
  EXPECT_NEAR(walk, std::pow(noise.factor(), 3.0) * ImuNoise{}.gyroscope_random_walk, 1e-12);
  feed(noise, 0.7, 200, random);
  EXPECT_EQ(noise.factor(), 1.0);
}

TEST(InertialNoise, WhatIsNotFiniteTeachesNothing) {
  InertialNoise noise(ImuNoise{}, kHeadroom);
  noise.learn(Vector15d::Constant(std::nan("")), 1.0);
  EXPECT_EQ(noise.factor(), 1.0);
}

}  // namespace
}  // namespace parkade
