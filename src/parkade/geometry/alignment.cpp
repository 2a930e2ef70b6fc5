// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/geometry/alignment.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "parkade/core/check.hpp"

namespace parkade {
namespace {

// Below this ratio of width to length a point set counts as a line (1 cm in 100 m), however well
// both sets agree. The rotation is still the least-squares one.
constexpr double kLineWidthRatio = 1e-4;
// A wider set, up to this ratio, is a line where its deviations leave its roll so uncertain (1
// degree): as much as the rotation errors that one wants to see.
constexpr double kNarrow = 0.1;
constexpr double kOpenRoll = 0.02;  // rad
// Below this ratio of singular values the least-squares rotation is not unique in double precision.
constexpr double kRankRatio = 1e-12;

struct Moments {
  Eigen::Vector3d mean_source = Eigen::Vector3d::Zero();
  Eigen::Vector3d mean_target = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< E[(target - mean)(source - mean)']
  double variance_source = 0.0;                          ///< E[|source - mean|^2]
};

Moments momentsOf(const Points3d& source, const Points3d& target) {
  PARKADE_CHECK(source.size() == target.size(), "{} source points but {} target points",
                source.size(), target.size());
  Moments m;
  if (source.empty()) return m;
  const double n = static_cast<double>(source.size());
  for (std::size_t i = 0; i < source.size(); ++i) {
    m.mean_source += source[i] / n;
    m.mean_target += target[i] / n;
  }
  for (std::size_t i = 0; i < source.size(); ++i) {
    const Eigen::Vector3d d_source = source[i] - m.mean_source;
    m.covariance += (target[i] - m.mean_target) * d_source.transpose() / n;
    m.variance_source += d_source.squaredNorm() / n;
  }
  PARKADE_CHECK(m.covariance.allFinite(), "a point to align is not finite");
  return m;
}

// Rounding of coordinates far from the origin leaves this much variance in coincident points.
double varianceFloor(const Moments& m) {
  constexpr double kEpsilon = 1e-14;
  return kEpsilon * kEpsilon * (m.mean_source.squaredNorm() + m.mean_target.squaredNorm());
}

void setResidual(const Points3d& source, const Points3d& target, Alignment& alignment) {
  double sum = 0.0;
  for (std::size_t i = 0; i < source.size(); ++i) {
    sum += (target[i] - alignment * source[i]).squaredNorm();
  }
  if (!source.empty()) alignment.rmse = std::sqrt(sum / static_cast<double>(source.size()));
}

// Whether deviations leave the rotation about a narrow set's long axis (a unit vector in the
// target) open: docs/math/alignment.md, "What the points leave open".
bool isRollOpen(const Points3d& source, const Points3d& target, const Moments& m,
                const Alignment& alignment, const Eigen::Vector3d& axis) {
  const auto across = [&axis](const Eigen::Vector3d& p) -> Eigen::Vector3d {
    return p - axis * axis.dot(p);
  };
  const double n = static_cast<double>(source.size());
  const Eigen::Vector3d mean = alignment * m.mean_source;
  double length2 = 0.0;
  double width2 = 0.0;
  double deviation2 = 0.0;
  for (std::size_t i = 0; i < source.size(); ++i) {
    const Eigen::Vector3d fitted = alignment * source[i];
    const double along = axis.dot(fitted - mean);
    length2 += along * along / n;
    width2 += across(fitted - mean).squaredNorm() / n;
    deviation2 += across(target[i] - fitted).squaredNorm();
  }
  if (width2 > kNarrow * kNarrow * length2) return false;
  deviation2 /= std::max(1.0, 2.0 * n - 5.0);  // two coordinates a point; the fit used up five
  return deviation2 > kOpenRoll * kOpenRoll * width2;
}

Alignment alignPoints(const Points3d& source, const Points3d& target, bool with_scale) {
  const Moments m = momentsOf(source, target);
  Alignment result;
  if (source.empty()) {
    result.degeneracy = Degeneracy::kTooFewPoints;
    return result;
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(m.covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d& d = svd.singularValues();  // descending
  SO3 rotation;
  if (d[0] <= varianceFloor(m)) {
    result.degeneracy = Degeneracy::kCoincident;
  } else {
    // Equation (43): the sign of the smallest direction makes it a rotation, not a reflection.
    Eigen::Vector3d sign(1.0, 1.0, 1.0);
    if (svd.matrixU().determinant() * svd.matrixV().determinant() < 0.0) sign[2] = -1.0;
    if (d[1] <= kRankRatio * d[0]) {
      rotation = SO3::fromTwoVectors(svd.matrixV().col(0), svd.matrixU().col(0));
    } else {
      rotation = SO3(Eigen::Matrix3d(svd.matrixU() * sign.asDiagonal() *
                                     svd.matrixV().transpose()));  // equation (40)
    }
    if (with_scale) result.scale = d.dot(sign) / m.variance_source;  // equation (42)
    if (std::sqrt(d[1]) <= kLineWidthRatio * std::sqrt(d[0])) {
      result.degeneracy = Degeneracy::kCollinear;
    }
  }
  // Equation (41)
  result.T_target_source = SE3(rotation, m.mean_target - result.scale * (rotation * m.mean_source));
  if (source.size() < 3) {
    result.degeneracy = Degeneracy::kTooFewPoints;
  } else if (result.degeneracy == Degeneracy::kNone &&
             isRollOpen(source, target, m, result, svd.matrixU().col(0))) {
    result.degeneracy = Degeneracy::kCollinear;
  }
  setResidual(source, target, result);
  return result;
}

}  // namespace

const char* toString(Degeneracy degeneracy) {
  switch (degeneracy) {
    case Degeneracy::kNone:
      return "none";
    case Degeneracy::kTooFewPoints:
      return "too few points";
    case Degeneracy::kCoincident:
      return "all points at one place";
    case Degeneracy::kCollinear:
      return "all points on one line";
  }
  return "unknown";
}

Alignment alignSE3(const Points3d& source, const Points3d& target) {
  return alignPoints(source, target, false);
}

Alignment alignSim3(const Points3d& source, const Points3d& target) {
  return alignPoints(source, target, true);
}

Alignment alignYaw(const Points3d& source, const Points3d& target) {
  const Moments m = momentsOf(source, target);
  Alignment result;
  if (source.empty()) {
    result.degeneracy = Degeneracy::kTooFewPoints;
    return result;
  }
  // docs/math/alignment.md, equations (6) and (7).
  const double a = m.covariance(0, 0) + m.covariance(1, 1);
  const double b = m.covariance(1, 0) - m.covariance(0, 1);
  double yaw = 0.0;
  if (std::hypot(a, b) <= varianceFloor(m)) {
    result.degeneracy = Degeneracy::kCoincident;
  } else {
    yaw = std::atan2(b, a);
  }
  const SO3 rotation = SO3::fromYawPitchRoll(yaw, 0.0, 0.0);
  result.T_target_source = SE3(rotation, m.mean_target - rotation * m.mean_source);
  setResidual(source, target, result);
  return result;
}

Alignment alignOrigin(const SE3& T_source_body, const SE3& T_target_body) {
  Alignment result;
  result.T_target_source = T_target_body * T_source_body.inverse();
  return result;
}

}  // namespace parkade
