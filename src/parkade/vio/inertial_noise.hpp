// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parkade/imu/imu_types.hpp"
#include "parkade/imu/preintegration.hpp"

namespace parkade {

/// How many times larger the inertial unit's errors turn out to be than its noise says: told too
/// small, vibration, scale, a mounting that is turned, a bias that jumped. Learned from what the
/// readings and the window's rotations, which pictures tell well, contradict each other by over the
/// last seconds (docs/math/residuals.md, eq. 1b).
class InertialNoise {
 public:
  /// Readings are believed `headroom` times less than the noise told.
  InertialNoise(const ImuNoise& told, double headroom);

  /// residual: of one sum of readings, whitened by noise() as it was with that factor.
  void learn(const Vector15d& residual, double factor);

  /// At least 1.
  [[nodiscard]] double factor() const;
  /// The noise to sum readings with.
  [[nodiscard]] ImuNoise noise() const;

 private:
  // Of the last sums, each of which counts `kept` of what the one after it does.
  struct Memory {
    double kept;
    double prior;  // coordinates that the noise told weighs
    double squares = 0.0;
    double freedom = 0.0;
    void add(double more_squares, double more_freedom);
    [[nodiscard]] double variance() const { return (prior + squares) / (prior + freedom); }
  };
  ImuNoise told_;
  double headroom_;
  Memory short_{0.7, 6.0};  // before pictures have given in to readings that jumped
  Memory long_{0.95, 12.0};
};

}  // namespace parkade
