// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "parkade/core/check.hpp"

namespace parkade::sim {

/// A uniform quintic B-spline (C4) over vectors: control point i belongs to time start + i * step.
/// Its control points are samples of a curve; the spline is then that curve slightly smoothed (by a
/// variance of step^2 / 2), and where it is declared the truth it is so with exact derivatives.
template <int Size>
class UniformSpline {
 public:
  using Vector = Eigen::Matrix<double, Size, 1>;
  static constexpr int kMargin = 3;  ///< control points needed beyond both ends of the domain

  UniformSpline() = default;
  UniformSpline(double start, double step, std::vector<Vector> control_points)
      : start_(start), step_(step), points_(std::move(control_points)) {
    PARKADE_CHECK(points_.size() >= 6, "a quintic spline needs 6 control points, has {}",
                  points_.size());
  }

  [[nodiscard]] double begin() const { return start_ + 2.0 * step_; }
  [[nodiscard]] double end() const {
    return start_ + (static_cast<double>(points_.size()) - 3.0) * step_;
  }

  /// Value (order 0) or derivative (order 1 to 3) at t, clamped into [begin(), end()].
  [[nodiscard]] Vector evaluate(double t, int order = 0) const {
    const double x = (std::clamp(t, begin(), end()) - start_) / step_;
    const int last = static_cast<int>(points_.size()) - 4;
    const int i = std::clamp(static_cast<int>(std::floor(x)), 2, last);
    const std::array<double, 6> weights = basis(x - i, order);
    Vector sum = Vector::Zero();
    for (int k = 0; k < 6; ++k) sum += weights[k] * points_[i - 2 + k];
    return sum / std::pow(step_, order);
  }

 private:
  // Weights of the six control points around u in [0, 1), oldest first, by de Boor's recursion. The
  // derivative of order n of a quintic is the n-th difference of splines of degree 5 - n.
  static std::array<double, 6> basis(double u, int order) {
    std::array<double, 6> b{1.0, 0, 0, 0, 0, 0};
    const int degree = 5 - order;
    for (int d = 1; d <= degree; ++d) {
      for (int k = d; k >= 0; --k) {
        const double left = k > 0 ? (u + d - k) * b[k - 1] : 0.0;
        const double right = k < d ? (1.0 + k - u) * b[k] : 0.0;
        b[k] = (left + right) / d;
      }
    }
    for (int n = 0; n < order; ++n) {
      for (int k = degree + n + 1; k >= 0; --k) {
        b[k] = (k > 0 ? b[k - 1] : 0.0) - (k <= degree + n ? b[k] : 0.0);
      }
    }
    return b;
  }

  double start_ = 0.0;
  double step_ = 1.0;
  std::vector<Vector> points_;
};

}  // namespace parkade::sim
