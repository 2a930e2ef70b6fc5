// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/eval/consistency.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <map>

namespace parkade {
namespace {

constexpr double kPrecision = 1e-15;
constexpr int kMaxTerms = 100000;

// The common factor of both expansions: x^a e^-x / Gamma(a + 1).
double gammaFactor(double a, double x) {
  return std::exp(a * std::log(x) - x - std::lgamma(a + 1.0));
}

// Regularised lower incomplete gamma function by its series (Abramowitz and Stegun 6.5.29).
double gammaSeries(double a, double x) {
  double term = 1.0;
  double sum = 1.0;
  for (int n = 1; n < kMaxTerms && term > kPrecision * sum; ++n) {
    term *= x / (a + n);
    sum += term;
  }
  return gammaFactor(a, x) * sum;
}

// Regularised upper incomplete gamma function by its continued fraction (Abramowitz and Stegun
// 6.5.31 in its even form), evaluated from the front by Lentz's method.
double gammaFraction(double a, double x) {
  constexpr double kTiny = std::numeric_limits<double>::min() / kPrecision;
  double b = x + 1.0 - a;
  double c = 1.0 / kTiny;
  double d = 1.0 / b;
  double fraction = d;
  for (int n = 1; n < kMaxTerms; ++n) {
    const double numerator = -n * (n - a);
    b += 2.0;
    d = numerator * d + b;
    if (std::abs(d) < kTiny) d = kTiny;
    c = b + numerator / c;
    if (std::abs(c) < kTiny) c = kTiny;
    d = 1.0 / d;
    const double factor = c * d;
    fraction *= factor;
    if (std::abs(factor - 1.0) < kPrecision) break;
  }
  return gammaFactor(a, x) * a * fraction;
}

}  // namespace

Vector6d poseError(const SE3& T_estimate, const SE3& T_truth) {
  return (T_estimate.inverse() * T_truth).log();
}

Result<double> nees(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance) {
  if (covariance.rows() != error.size() || covariance.cols() != error.size()) {
    return Error{fmt::format("an error of {} parts has a covariance of {} x {}", error.size(),
                             covariance.rows(), covariance.cols())};
  }
  if (!error.allFinite() || !covariance.allFinite()) {
    return Error{"the error or its covariance holds a number that is not finite"};
  }
  const double scale = covariance.cwiseAbs().maxCoeff();
  if ((covariance - covariance.transpose()).cwiseAbs().maxCoeff() > 1e-9 * scale) {
    return Error{"the covariance is not symmetric"};
  }
  const Eigen::LLT<Eigen::MatrixXd> llt(covariance);
  if (llt.info() != Eigen::Success) {
    return Error{"the covariance is not positive definite"};
  }
  return error.dot(llt.solve(error));
}

double chiSquareCdf(double x, double dof) {
  PARKADE_CHECK(dof > 0.0, "{} degrees of freedom", dof);
  if (!(x > 0.0)) return 0.0;
  const double a = 0.5 * dof;
  // Each expansion converges fast on its side of x = a + 1.
  return 0.5 * x < a + 1.0 ? gammaSeries(a, 0.5 * x) : 1.0 - gammaFraction(a, 0.5 * x);
}

double chiSquareQuantile(double p, double dof) {
  PARKADE_CHECK(p > 0.0 && p < 1.0, "p = {}", p);
  PARKADE_CHECK(dof > 0.0, "{} degrees of freedom", dof);
  double low = 0.0;
  double high = dof + 1.0;
  while (chiSquareCdf(high, dof) < p) {
    low = high;
    high *= 2.0;
  }
  // Bisection: the function is monotone, and 60 halvings cost nothing here.
  while (high - low > 1e-12 * high) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    (chiSquareCdf(middle, dof) < p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

Result<NeesTest> neesTest(const std::vector<double>& nees_of_runs, int dof, double probability) {
  PARKADE_CHECK(dof > 0, "{} degrees of freedom", dof);
  PARKADE_CHECK(probability > 0.0 && probability < 1.0, "probability = {}", probability);
  if (nees_of_runs.empty()) return Error{"no run to test the consistency of"};
  NeesTest test;
  test.runs = nees_of_runs.size();
  test.dof = dof;
  const double n = static_cast<double>(test.runs);
  for (const double value : nees_of_runs) test.mean += value / n;
  // The sum of n independent chi-square variables of dof each is one of n * dof.
  const double tail = 0.5 * (1.0 - probability);
  test.lower = chiSquareQuantile(tail, n * dof) / n;
  test.upper = chiSquareQuantile(1.0 - tail, n * dof) / n;
  return test;
}

Result<PoseConsistency> poseConsistency(const Trajectory& estimate,
                                        const PoseCovariances& covariances,
                                        const Trajectory& reference,
                                        AssociationOptions association) {
  association.interpolate = true;
  const Result<Association> pairs = associate(estimate, reference, association);
  if (!pairs) return pairs.error();
  std::map<TimeNs, const Matrix6d*> covariance_at;
  const TimeNs offset = fromSeconds(association.offset_s);
  for (const auto& row : covariances) covariance_at[row.t_ns + offset] = &row.covariance;

  const SE3 T_reference_estimate =
      pairs->reference.front().T_world_body * pairs->estimate.front().T_world_body.inverse();
  PoseConsistency result;
  for (std::size_t i = 1; i < pairs->size(); ++i) {
    const auto found = covariance_at.find(pairs->estimate[i].t_ns);
    if (found == covariance_at.end()) continue;
    const SE3 T_estimate = T_reference_estimate * pairs->estimate[i].T_world_body;
    const Vector6d error = poseError(T_estimate, pairs->reference[i].T_world_body);
    const Eigen::Vector3d up =
        T_estimate.rotation().inverse() * Eigen::Vector3d::UnitZ();  // picks the yaw
    const double variance = up.dot(found->second->block<3, 3>(3, 3) * up);
    const Result<double> position = nees(error.head<3>(), found->second->topLeftCorner<3, 3>());
    if (!position || !(variance > 0.0)) continue;
    const double yaw = up.dot(error.tail<3>());
    result.position += *position;
    result.yaw += yaw * yaw / variance;
    ++result.poses;
  }
  if (result.poses == 0) return Error{"no pose has a covariance that can be judged"};
  result.position /= static_cast<double>(result.poses);
  result.yaw /= static_cast<double>(result.poses);
  return result;
}

}  // namespace parkade
