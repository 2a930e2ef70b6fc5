// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/localization/registration.hpp"

#include <fmt/core.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "parkade/geometry/robust.hpp"

namespace parkade {
namespace {

using Vector5 = Eigen::Matrix<double, 5, 1>;
using Matrix5 = Eigen::Matrix<double, 5, 5>;
using Matrix25 = Eigen::Matrix<double, 2, 5>;

// A feature of the frame with what its levelling error does to it.
struct Item {
  Eigen::Vector2d p = Eigen::Vector2d::Zero();
  Eigen::Matrix2d d_p_d_tilt = Eigen::Matrix2d::Zero();
  Eigen::Vector2d normal = Eigen::Vector2d::Zero();      // lines
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  // points
  double sigma = 0.0;                                    // lines
  double weight = 1.0;
  SemanticClass semantic_class = SemanticClass::kSlotLine;
  std::string text;
};

// Equation (3): the ground point that a camera at c sees moves along its ray when pitch and roll
// tilt the ground.
Eigen::Matrix2d tiltJacobian(const Eigen::Vector2d& p,
                             const std::vector<Eigen::Vector3d>& cameras) {
  const Eigen::Vector3d* nearest = &cameras.front();
  for (const Eigen::Vector3d& c : cameras) {
    if ((c.head<2>() - p).squaredNorm() < (nearest->head<2>() - p).squaredNorm()) nearest = &c;
  }
  const double height = std::max(0.3, nearest->z());
  return (p - nearest->head<2>()) / height * Eigen::RowVector2d(-p.x(), p.y());
}

class Problem {
 public:
  Problem(const SemanticFrame& frame, const Submap& submap, const RegistrationOptions& options,
          const std::vector<Eigen::Vector3d>& viewpoints);

  Registration solve(const SE2& prior);

 private:
  struct System {
    Matrix5 H = Matrix5::Zero();
    Vector5 b = Vector5::Zero();
    int line_matches = 0;
    int line_inliers = 0;
    int point_inliers = 0;
    double squares = 0.0;
    double weights = 0.0;
  };
  System build(double radius) const;
  bool step(const System& system);
  void judge(const System& system, Registration& result) const;

  const Submap& submap_;
  const RegistrationOptions& options_;
  std::vector<Item> lines_;
  std::vector<Item> points_;
  double tilt_information_;
  SE2 pose_;
  Eigen::Vector2d tilt_ = Eigen::Vector2d::Zero();
};

Problem::Problem(const SemanticFrame& frame, const Submap& submap,
                 const RegistrationOptions& options, const std::vector<Eigen::Vector3d>& viewpoints)
    : submap_(submap), options_(options) {
  std::vector<Eigen::Vector3d> cameras = viewpoints;
  if (cameras.empty()) {
    const Eigen::Vector2d& c = frame.labels.geometry.center;
    cameras.emplace_back(c.x(), c.y(), 1.0);
  }
  constexpr double kLeastTilt = 1e-5;
  const double tilt_sigma = std::max(kLeastTilt, frame.attitude_sigma);
  tilt_information_ = 1.0 / (tilt_sigma * tilt_sigma);
  // Points of one metre of a line err together: each metre counts as one measurement.
  using Metre = std::tuple<int, int, int, int>;
  std::map<Metre, int> in_metre;
  const auto metreOf = [](const LinePoint& point) -> Metre {
    const double direction = std::atan2(point.normal.y(), point.normal.x());
    constexpr double kBin = M_PI / 4.0;
    const int bin = static_cast<int>(std::lround(direction / kBin) + 8) % 4;
    return {static_cast<int>(std::floor(point.p_level.x())),
            static_cast<int>(std::floor(point.p_level.y())), bin,
            static_cast<int>(point.semantic_class)};
  };
  for (const LinePoint& point : frame.line_points) ++in_metre[metreOf(point)];
  for (const LinePoint& point : frame.line_points) {
    Item item;
    item.p = point.p_level;
    item.normal = point.normal;
    item.sigma = std::hypot(point.sigma, options.line_floor_m);
    item.semantic_class = point.semantic_class;
    item.weight = 1.0 / in_metre[metreOf(point)];
    item.d_p_d_tilt = tiltJacobian(item.p, cameras);
    lines_.push_back(item);
  }
  const auto addPoint = [&](const Eigen::Vector2d& p, const Eigen::Matrix2d& covariance,
                            SemanticClass c, const std::string& text, double weight) {
    Item item;
    item.p = p;
    item.covariance =
        covariance + options.line_floor_m * options.line_floor_m * Eigen::Matrix2d::Identity();
    item.semantic_class = c;
    item.text = text;
    item.weight = weight;
    item.d_p_d_tilt = tiltJacobian(p, cameras);
    points_.push_back(item);
  };
  for (const SlotObservation& slot : frame.slots) {
    for (int i = 0; i < 2; ++i) {
      // A corner is two lines' crossing, and neighbours share it: it is half new at most.
      constexpr double kNew = 0.25;
      addPoint(slot.corners[static_cast<std::size_t>(i)],
               slot.entrance_covariance.block<2, 2>(2 * i, 2 * i), SemanticClass::kSlotLine, "",
               kNew * slot.confidence);
    }
  }
  for (const ObjectObservation& object : frame.objects) {
    if (!isPointLandmark(object.semantic_class)) continue;
    addPoint(object.position.head<2>(), object.covariance.topLeftCorner<2, 2>(),
             object.semantic_class, object.text, object.confidence);
  }
}

Problem::System Problem::build(double radius) const {
  System s;
  const Eigen::Matrix2d R = pose_.rotationMatrix();
  const auto jacobian = [&](const Item& item, const Eigen::Vector2d& p) {
    Matrix25 J;
    J.leftCols<2>() = R;
    J.col(2) = R * Eigen::Vector2d(-p.y(), p.x());
    J.rightCols<2>() = R * item.d_p_d_tilt;
    return J;
  };
  constexpr double kInlier = 3.0;
  for (const Item& item : lines_) {
    const Eigen::Vector2d p = item.p + item.d_p_d_tilt * tilt_;
    const Eigen::Vector2d q = pose_ * p;
    const LineFeature* match =
        submap_.lines().nearest(q, R * item.normal, item.semantic_class, radius);
    if (match == nullptr) continue;
    ++s.line_matches;
    const double sigma = std::sqrt(item.sigma * item.sigma + 1.0 / match->weight);
    const double residual = match->normal.dot(q - match->p) / sigma;
    const double w = item.weight * cauchy(residual * residual, options_.robust_sigma).weight;
    const Eigen::Matrix<double, 1, 5> J = match->normal.transpose() * jacobian(item, p) / sigma;
    s.H.noalias() += w * J.transpose() * J;
    s.b.noalias() -= w * residual * J.transpose();
    if (std::abs(residual) < kInlier) {
      ++s.line_inliers;
      s.squares += item.weight * residual * residual;
      s.weights += item.weight;
    }
  }
  for (const Item& item : points_) {
    const Eigen::Vector2d p = item.p + item.d_p_d_tilt * tilt_;
    const Eigen::Vector2d q = pose_ * p;
    // Look-alike corners stand metres apart: a wider search than for lines is safe.
    const PointFeature* match =
        submap_.nearestPoint(q, item.semantic_class, item.text, std::max(0.3, radius));
    if (match == nullptr) continue;
    const Eigen::Matrix2d covariance = R * item.covariance * R.transpose() + match->covariance;
    const Eigen::Matrix2d information = covariance.inverse();
    const Eigen::Vector2d residual = q - match->p;
    const double square = residual.dot(information * residual);
    const double w = item.weight * cauchy(square, options_.robust_sigma).weight;
    const Matrix25 J = jacobian(item, p);
    s.H.noalias() += w * J.transpose() * information * J;
    s.b.noalias() -= w * J.transpose() * information * residual;
    constexpr double kGate = 9.2;  // 99 % of chi2(2)
    if (square < kGate) ++s.point_inliers;
  }
  s.H(3, 3) += tilt_information_;
  s.H(4, 4) += tilt_information_;
  s.b.tail<2>() -= tilt_information_ * tilt_;
  return s;
}

// The pose's own information: the tilt is marginalised.
Eigen::Matrix3d marginal(const Matrix5& H) {
  const Eigen::Matrix2d tilt = H.bottomRightCorner<2, 2>();
  const Eigen::Matrix<double, 3, 2> cross = H.topRightCorner<3, 2>();
  return H.topLeftCorner<3, 3>() - cross * tilt.inverse() * cross.transpose();
}

bool Problem::step(const System& s) {
  const Eigen::Matrix2d tilt_inverse = s.H.bottomRightCorner<2, 2>().inverse();
  const Eigen::Matrix<double, 3, 2> cross = s.H.topRightCorner<3, 2>();
  const Eigen::Vector3d scale(1.0, 1.0, 1.0 / options_.lever_m);
  const Eigen::Matrix3d H = scale.asDiagonal() * marginal(s.H) * scale.asDiagonal();
  const Eigen::Vector3d b =
      scale.asDiagonal() * (s.b.head<3>() - cross * (tilt_inverse * s.b.tail<2>()));
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(H);
  const double least = 1.0 / (options_.max_sigma_m * options_.max_sigma_m);
  Eigen::Vector3d delta = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    if (eigen.eigenvalues()[k] < least) continue;  // stays at the prior
    const Eigen::Vector3d direction = eigen.eigenvectors().col(k);
    delta += direction * (direction.dot(b) / eigen.eigenvalues()[k]);
  }
  const Eigen::Vector3d d_pose = scale.asDiagonal() * delta;
  const Eigen::Vector2d d_tilt = tilt_inverse * (s.b.tail<2>() - cross.transpose() * d_pose);
  pose_ = pose_ * SE2::exp(d_pose);
  tilt_ += d_tilt;
  constexpr double kSmall = 1e-5;
  return delta.norm() > kSmall;
}

void Problem::judge(const System& s, Registration& result) const {
  const Eigen::Vector3d scale(1.0, 1.0, 1.0 / options_.lever_m);
  const Eigen::Matrix3d H = scale.asDiagonal() * marginal(s.H) * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(H);
  result.rms = s.weights > 0.0 ? std::sqrt(s.squares / s.weights) : 0.0;
  const double inflation = std::max(1.0, result.rms * result.rms);
  const double least = 1.0 / (options_.max_sigma_m * options_.max_sigma_m);
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  for (int k = 0; k < 3; ++k) {
    const double lambda = eigen.eigenvalues()[k];
    if (lambda < least) continue;
    ++result.observable;
    const Eigen::Vector3d direction = eigen.eigenvectors().col(k);
    const double variance = inflation / lambda + options_.floor_m * options_.floor_m;
    information += direction * direction.transpose() / variance;
  }
  const Eigen::Vector3d unscale = scale.cwiseInverse();
  result.information = unscale.asDiagonal() * information * unscale.asDiagonal();
  result.T_map_vehicle = pose_;
  result.pitch = tilt_.x();
  result.roll = tilt_.y();
  result.line_matches = s.line_matches;
  result.line_inliers = s.line_inliers;
  result.point_inliers = s.point_inliers;
}

Registration Problem::solve(const SE2& prior) {
  Registration result;
  pose_ = prior;
  double radius = options_.search_radius_m;
  bool moving = true;
  for (; result.iterations < options_.max_iterations; ++result.iterations) {
    if (!moving && radius <= options_.final_radius_m) break;
    moving = step(build(radius));
    constexpr double kNarrow = 0.7;
    radius = std::max(options_.final_radius_m, kNarrow * radius);
  }
  judge(build(options_.final_radius_m), result);
  // How many points find a line at all, and how many of those fit, by the first radius.
  const System wide = build(options_.search_radius_m);
  result.overlap =
      lines_.empty() ? 0.0
                     : static_cast<double>(wide.line_matches) / static_cast<double>(lines_.size());
  result.inlier_share =
      wide.line_matches > 0 ? static_cast<double>(result.line_inliers) / wide.line_matches : 0.0;
  if (wide.line_matches < options_.min_matches) {
    result.reason = fmt::format("{} line points matched", wide.line_matches);
  } else if (result.overlap < options_.min_overlap) {
    result.reason = fmt::format("{:.0f} % overlap", 100.0 * result.overlap);
  } else if (result.inlier_share < options_.min_inlier_share) {
    result.reason = fmt::format("{:.0f} % of the matches fit", 100.0 * result.inlier_share);
  } else if (result.rms > options_.max_rms) {
    result.reason = fmt::format("residuals of {:.1f} sigma", result.rms);
  } else if (result.observable == 0) {
    result.reason = "no direction is observable";
  }
  result.accepted = result.reason.empty();
  return result;
}

}  // namespace

Registration registerFrame(const SemanticFrame& frame, const Submap& submap,
                           const SE2& T_map_vehicle_prior, const RegistrationOptions& options,
                           const std::vector<Eigen::Vector3d>& viewpoints) {
  return Problem(frame, submap, options, viewpoints).solve(T_map_vehicle_prior);
}

}  // namespace parkade
