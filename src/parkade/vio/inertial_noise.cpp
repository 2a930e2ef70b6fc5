// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/vio/inertial_noise.hpp"

#include <algorithm>
#include <cmath>

namespace parkade {
namespace {

constexpr double kMostFactor = 100.0;

}  // namespace

InertialNoise::InertialNoise(const ImuNoise& told, double headroom)
    : told_(told), headroom_(headroom) {}

void InertialNoise::Memory::add(double more_squares, double more_freedom) {
  squares = kept * squares + more_squares;
  freedom = kept * freedom + more_freedom;
}

void InertialNoise::learn(const Vector15d& residual, double factor) {
  const double scale = headroom_ * factor;
  const double missed =
      scale * scale * residual.segment<3>(Preintegration::kRotation).squaredNorm();
  if (!std::isfinite(missed)) return;
  short_.add(missed, 3.0);
  long_.add(missed, 3.0);
}

double InertialNoise::factor() const {
  const double variance = std::max(short_.variance(), long_.variance());
  return std::clamp(std::sqrt(variance), 1.0, kMostFactor);
}

ImuNoise InertialNoise::noise() const {
  const double f = factor();
  ImuNoise noise = told_;
  noise.gyroscope_noise_density *= headroom_ * f;
  noise.accelerometer_noise_density *= headroom_ * f;
  // What is no noise repeats: biases that may wander take it over, and the factor comes down again.
  noise.gyroscope_random_walk *= f * f * f;
  noise.accelerometer_random_walk *= f * f * f;
  return noise;
}

}  // namespace parkade
