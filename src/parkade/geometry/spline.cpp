// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/geometry/spline.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "parkade/core/check.hpp"

namespace parkade {
namespace {

// Cumulative basis of the uniform cubic B-spline for control points 1..3 of a segment, with its
// first two derivatives by u in [0, 1].
struct CumulativeBasis {
  Eigen::Vector3d value;
  Eigen::Vector3d first;
  Eigen::Vector3d second;
};

CumulativeBasis cumulativeBasis(double u) {
  const double u2 = u * u;
  const double u3 = u2 * u;
  CumulativeBasis b;
  b.value << (5.0 + 3.0 * u - 3.0 * u2 + u3) / 6.0, (1.0 + 3.0 * u + 3.0 * u2 - 2.0 * u3) / 6.0,
      u3 / 6.0;
  b.first << (3.0 - 6.0 * u + 3.0 * u2) / 6.0, (3.0 + 6.0 * u - 6.0 * u2) / 6.0, 0.5 * u2;
  b.second << u - 1.0, 1.0 - 2.0 * u, u;
  return b;
}

// Control points c of the cubic B-spline with natural ends through values v: the inner equations
// are (c[i] + 4 c[i+1] + c[i+2]) / 6 = v[i]; zero curvature at the ends makes c[1] = v[0].
std::vector<Eigen::Vector3d> interpolatingControl(const std::vector<Eigen::Vector3d>& v) {
  const std::size_t n = v.size();
  std::vector<Eigen::Vector3d> c(n + 2);
  c[1] = v.front();
  c[n] = v.back();
  if (n > 2) {
    // Thomas algorithm on c[2] .. c[n-1].
    const std::size_t m = n - 2;
    std::vector<double> diagonal(m, 4.0);
    std::vector<Eigen::Vector3d> right(m);
    for (std::size_t i = 0; i < m; ++i) right[i] = 6.0 * v[i + 1];
    right.front() -= c[1];
    right.back() -= c[n];
    for (std::size_t i = 1; i < m; ++i) {
      const double factor = 1.0 / diagonal[i - 1];
      diagonal[i] -= factor;
      right[i] -= factor * right[i - 1];
    }
    c[m + 1] = right[m - 1] / diagonal[m - 1];
    for (std::size_t i = m - 1; i-- > 0;) c[i + 2] = (right[i] - c[i + 3]) / diagonal[i];
  }
  c[0] = 2.0 * c[1] - c[2];
  c[n + 1] = 2.0 * c[n] - c[n - 1];
  return c;
}

}  // namespace

SplineSE3::SplineSE3(TimeNs start_ns, TimeNs dt_ns, std::vector<SE3> control)
    : start_ns_(start_ns), dt_ns_(dt_ns), control_(std::move(control)) {
  PARKADE_CHECK(control_.size() >= 4, "a cubic spline of {} control poses", control_.size());
  PARKADE_CHECK(dt_ns_ > 0, "knot distance {} ns", dt_ns_);
}

SplineSE3 SplineSE3::through(TimeNs start_ns, TimeNs dt_ns, const std::vector<SE3>& poses) {
  PARKADE_CHECK(poses.size() >= 2, "a spline through {} poses", poses.size());
  const std::size_t n = poses.size();
  std::vector<Eigen::Vector3d> positions(n);
  for (std::size_t i = 0; i < n; ++i) positions[i] = poses[i].translation();
  const std::vector<Eigen::Vector3d> translations = interpolatingControl(positions);

  std::vector<SE3> control(n + 2);
  for (std::size_t i = 0; i < n + 2; ++i) {
    const std::size_t nearest = std::clamp<std::size_t>(i, 1, n) - 1;
    control[i] = SE3(poses[nearest].rotation(), translations[i]);
  }
  // Rotations have no linear system: move each control rotation by what its pose misses, again and
  // again. On a commutative group this contracts by 1/3 a pass; ends mirror for zero curvature.
  constexpr int kMaxPasses = 100;
  constexpr double kDoneRad = 1e-14;
  for (int pass = 0; pass < kMaxPasses; ++pass) {
    const SplineSE3 spline(start_ns, dt_ns, control);
    double worst = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      const SO3 there = (i + 1 < n ? spline.evaluate(i, 0.0) : spline.evaluate(i - 1, 1.0))
                            .T_world_body.rotation();
      const Eigen::Vector3d miss = (there.inverse() * poses[i].rotation()).log();
      worst = std::max(worst, miss.norm());
      control[i + 1].rotation() = control[i + 1].rotation() * SO3::exp(miss);
    }
    const auto mirrored = [&](std::size_t end, std::size_t inner) {
      return control[end].rotation() *
             (control[inner].rotation().inverse() * control[end].rotation());
    };
    control[0].rotation() = mirrored(1, 2);
    control[n + 1].rotation() = mirrored(n, n - 1);
    if (worst < kDoneRad) break;
  }
  return {start_ns, dt_ns, std::move(control)};
}

TimeNs SplineSE3::endNs() const {
  return start_ns_ + static_cast<TimeNs>(control_.size() - 3) * dt_ns_;
}

SplineSE3::Sample SplineSE3::at(TimeNs t_ns) const {
  PARKADE_CHECK(t_ns >= start_ns_ && t_ns <= endNs(), "time {} ns outside the spline's {} to {} ns",
                t_ns, start_ns_, endNs());
  const TimeNs since_start = t_ns - start_ns_;
  const auto last_segment = static_cast<TimeNs>(control_.size() - 4);
  const TimeNs segment = std::min(since_start / dt_ns_, last_segment);
  const double u =
      static_cast<double>(since_start - segment * dt_ns_) / static_cast<double>(dt_ns_);
  return evaluate(static_cast<std::size_t>(segment), u);
}

SplineSE3::Sample SplineSE3::atSeconds(double seconds_since_start) const {
  const double end = toSeconds(endNs() - start_ns_);
  PARKADE_CHECK(seconds_since_start >= 0.0 && seconds_since_start <= end,
                "time {} s outside the spline's 0 to {} s", seconds_since_start, end);
  const double knots = seconds_since_start / toSeconds(dt_ns_);
  const double segment = std::min(std::floor(knots), static_cast<double>(control_.size() - 4));
  return evaluate(static_cast<std::size_t>(segment), knots - segment);
}

SplineSE3::Sample SplineSE3::evaluate(std::size_t segment, double u) const {
  const CumulativeBasis b = cumulativeBasis(u);
  const double rate = 1.0 / toSeconds(dt_ns_);
  const SE3* c = &control_[segment];

  Eigen::Vector3d position = c[0].translation();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();
  SO3 rotation = c[0].rotation();
  Eigen::Vector3d omega = Eigen::Vector3d::Zero();  // body frame, per knot
  Eigen::Vector3d alpha = Eigen::Vector3d::Zero();
  for (int j = 0; j < 3; ++j) {
    const Eigen::Vector3d step = c[j + 1].translation() - c[j].translation();
    position += b.value[j] * step;
    velocity += b.first[j] * step;
    acceleration += b.second[j] * step;

    // Recursion of Sommer et al., eqs. (18) to (26), for body-frame rates.
    const Eigen::Vector3d d = (c[j].rotation().inverse() * c[j + 1].rotation()).log();
    const SO3 increment = SO3::exp(b.value[j] * d);
    const SO3 back = increment.inverse();
    const Eigen::Vector3d turned = back * omega;
    omega = turned + b.first[j] * d;
    alpha = back * alpha + b.first[j] * turned.cross(d) + b.second[j] * d;
    rotation = rotation * increment;
  }
  return {SE3(rotation, position), velocity * rate, acceleration * rate * rate, omega * rate,
          alpha * rate * rate};
}

}  // namespace parkade
