// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>

namespace parkade {

/// The x in [lo, hi] where a growing function reaches target: Newton steps from start, kept in a
/// bracket that shrinks (bisection where a step would leave it). value_and_slope(x, slope) returns
/// the value and writes the derivative. The caller makes sure that target lies in the range.
template <class Function>
double solveMonotonic(const Function& value_and_slope, double target, double lo, double hi,
                      double start) {
  constexpr int kMaxIterations = 100;
  constexpr double kTolerance = 1e-15;
  double x = start >= lo && start <= hi ? start : 0.5 * (lo + hi);
  for (int i = 0; i < kMaxIterations; ++i) {
    double slope = 0.0;
    const double error = value_and_slope(x, slope) - target;
    (error > 0.0 ? hi : lo) = x;
    double next = x - error / slope;
    if (!(next >= lo && next <= hi)) next = 0.5 * (lo + hi);
    const double step = std::abs(next - x);
    x = next;
    if (step <= kTolerance * (1.0 + std::abs(x))) break;
  }
  return x;
}

/// Fisheye models stop short of the direction opposite to the optical axis, where all sides meet.
inline constexpr double kMaxFisheyeAngle = std::numbers::pi - 1e-6;

/// How far from 0, and at most to limit, grows_at(x) holds without a break (sampled, then refined).
template <class Predicate>
double growingRange(const Predicate& grows_at, double limit) {
  constexpr int kSamples = 2048;
  double inside = 0.0;
  for (int i = 1; i <= kSamples; ++i) {
    double outside = limit * i / kSamples;
    if (!grows_at(outside)) {
      while (outside - inside > 1e-12) {
        const double middle = 0.5 * (inside + outside);
        (grows_at(middle) ? inside : outside) = middle;
      }
      return inside;
    }
    inside = outside;
  }
  return limit;
}

}  // namespace parkade
