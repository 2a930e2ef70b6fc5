// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace parkade {

// Robust kernels on a squared, whitened residual s = r^2: rho(s) with rho(s) ~ s near zero, and
// the weight rho'(s) of iteratively re-weighted least squares. The scale is in standard deviations.
// Zhang, "Parameter estimation techniques", 1997, table 1.

struct RobustValue {
  double rho = 0.0;
  double weight = 1.0;
};

/// Quadratic inside the scale, linear outside.
inline RobustValue huber(double s, double scale) {
  const double limit = scale * scale;
  if (s <= limit) return {s, 1.0};
  const double r = std::sqrt(s);
  return {2.0 * scale * r - limit, scale / r};
}

/// Grows like a logarithm.
inline RobustValue cauchy(double s, double scale) {
  const double limit = scale * scale;
  const double ratio = 1.0 + s / limit;
  return {limit * std::log(ratio), 1.0 / ratio};
}

/// Quadratic inside the scale, like a logarithm outside.
inline RobustValue logarithmic(double s, double scale) {
  const double limit = scale * scale;
  if (s <= limit) return {s, 1.0};
  return {limit * (1.0 + std::log(s / limit)), limit / s};
}

/// Constant outside the scale: such residuals have no weight at all.
inline RobustValue tukey(double s, double scale) {
  const double limit = scale * scale;
  if (s >= limit) return {limit / 3.0, 0.0};
  const double inside = 1.0 - s / limit;
  return {limit / 3.0 * (1.0 - inside * inside * inside), inside * inside};
}

/// A kernel and its scale.
struct RobustLoss {
  enum class Kernel { kHuber, kCauchy };
  Kernel kernel = Kernel::kHuber;
  double scale = 2.0;  ///< standard deviations
  [[nodiscard]] RobustValue operator()(double s) const {
    return kernel == Kernel::kCauchy ? cauchy(s, scale) : huber(s, scale);
  }
};

}  // namespace parkade
