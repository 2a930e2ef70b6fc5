// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gmock/gmock.h>

#include <Eigen/Core>
#include <sstream>

// For tests only: a numeric Jacobian and a matcher that shows both matrices.

namespace parkade::testing {

/// Jacobian of f at x by central differences; f maps VectorXd to VectorXd.
template <class Function>
Eigen::MatrixXd numericJacobian(const Function& f, const Eigen::VectorXd& x, double step = 1e-6) {
  const Eigen::VectorXd y = f(x);
  Eigen::MatrixXd jacobian(y.size(), x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    Eigen::VectorXd above = x;
    Eigen::VectorXd below = x;
    above[i] += step;
    below[i] -= step;
    jacobian.col(i) = (f(above) - f(below)) / (2.0 * step);
  }
  return jacobian;
}

MATCHER_P2(EigenMatrixNear, expected, tolerance, "") {
  if (arg.rows() != expected.rows() || arg.cols() != expected.cols()) {
    *result_listener << "size " << arg.rows() << " x " << arg.cols() << " instead of "
                     << expected.rows() << " x " << expected.cols();
    return false;
  }
  const double worst = (arg - expected).cwiseAbs().maxCoeff();
  if (worst <= tolerance) return true;
  std::ostringstream text;
  text << "differs by " << worst << " (tolerance " << tolerance << ")\nexpected\n"
       << expected << "\nfound\n"
       << arg;
  *result_listener << text.str();
  return false;
}

}  // namespace parkade::testing
