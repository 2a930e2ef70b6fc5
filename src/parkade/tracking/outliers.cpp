// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/tracking/outliers.hpp"

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "parkade/core/check.hpp"
#include "parkade/core/median.hpp"
#include "parkade/core/random.hpp"

namespace parkade {
namespace {

using Rays = std::vector<Eigen::Vector3d>;

constexpr double kRotationSigma = 0.01;    // rad: gyro bias of 0.1 rad/s over a frame of 0.1 s
constexpr double kUnknownSigma = 1.0;      // rad, without a prior
constexpr double kMinParallaxSine = 1e-4;  // below, a pair of features says nothing on direction
constexpr int kRefinements = 6;

// Sine of the angle between ray f and the plane through t and g.
double planeDistance(const Eigen::Vector3d& f, const Eigen::Vector3d& g, const Eigen::Vector3d& t) {
  const Eigen::Vector3d normal = t.cross(g);
  const double length = normal.norm();
  // Near the epipole any direction is in the plane: then the rays themselves must agree.
  if (length < 1e-3) return std::min((f - g).norm(), 1.0);
  return f.dot(normal) / length;
}

double truncatedCost(const Rays& f, const Rays& g, const Eigen::Vector3d& t, double limit) {
  double cost = 0.0;
  for (std::size_t i = 0; i < f.size(); ++i) {
    const double d = planeDistance(f[i], g[i], t);
    cost += std::min(d * d, limit * limit);
  }
  return cost;
}

// The rotation that best turns rays b onto rays a, robustly (Kabsch with Cauchy weights).
SO3 alignRays(const Rays& a, const Rays& b) {
  SO3 rotation;
  std::vector<double> weight(a.size(), 1.0);
  for (int iteration = 0; iteration < 8; ++iteration) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < a.size(); ++i) sum += weight[i] * a[i] * b[i].transpose();
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Vector3d sign(1.0, 1.0, (svd.matrixU() * svd.matrixV().transpose()).determinant());
    rotation = SO3(Eigen::Matrix3d(svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose()));
    std::vector<double> distance(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) distance[i] = (a[i] - rotation * b[i]).norm();
    const double scale = std::max(median(distance), 1e-4);
    for (std::size_t i = 0; i < a.size(); ++i) {
      weight[i] = 1.0 / (1.0 + (distance[i] / scale) * (distance[i] / scale));
    }
  }
  return rotation;
}

void turn(const SO3& rotation, const Rays& rays, Rays& turned) {
  turned.resize(rays.size());
  for (std::size_t i = 0; i < rays.size(); ++i) turned[i] = rotation * rays[i];
}

// Two directions that span the plane across t.
Eigen::Matrix<double, 3, 2> tangentBasis(const Eigen::Vector3d& t) {
  Eigen::Index smallest = 0;
  t.cwiseAbs().minCoeff(&smallest);
  const Eigen::Vector3d a = t.cross(Eigen::Vector3d::Unit(smallest)).normalized();
  Eigen::Matrix<double, 3, 2> basis;
  basis << a, t.cross(a);
  return basis;
}

// Gauss-Newton on rotation (left perturbation) and direction, Cauchy weights.
void refine(const Rays& f, const Rays& previous, double scale, double rotation_sigma, SO3& rotation,
            Eigen::Vector3d& t) {
  const SO3 prior = rotation;
  Rays g;
  for (int iteration = 0; iteration < kRefinements; ++iteration) {
    turn(rotation, previous, g);
    const Eigen::Matrix<double, 3, 2> basis = tangentBasis(t);
    Eigen::Matrix<double, 5, 5> hessian = Eigen::Matrix<double, 5, 5>::Zero();
    Eigen::Matrix<double, 5, 1> rhs = Eigen::Matrix<double, 5, 1>::Zero();
    for (std::size_t i = 0; i < f.size(); ++i) {
      const Eigen::Vector3d normal = t.cross(g[i]);
      const double length = normal.norm();
      if (length < 1e-2) continue;
      const double residual = f[i].dot(normal) / length;
      Eigen::Matrix<double, 5, 1> row;
      row.head<3>() = g[i].cross(f[i].cross(t)) / length;
      row.tail<2>() = basis.transpose() * (g[i].cross(f[i])) / length;
      const double weight = 1.0 / (scale * scale + residual * residual);
      hessian += weight * row * row.transpose();
      rhs -= weight * residual * row;
    }
    const Eigen::Vector3d turned = (rotation * prior.inverse()).log();
    const double prior_weight = 1.0 / (rotation_sigma * rotation_sigma);
    hessian.topLeftCorner<3, 3>().diagonal().array() += prior_weight;
    rhs.head<3>() -= prior_weight * turned;
    // The direction has no meaning where the camera only turned: keep it from running away.
    hessian.bottomRightCorner<2, 2>().diagonal().array() += 1.0;
    const Eigen::Matrix<double, 5, 1> step = hessian.ldlt().solve(rhs);
    rotation = SO3::exp(step.head<3>()) * rotation;
    t = (t + basis * step.tail<2>()).normalized();
    if (step.norm() < 1e-7) break;
  }
}

}  // namespace

MotionConsensus findConsensus(const Rays& rays_previous, const Rays& rays_current,
                              const CameraMotion& motion, double focal_px,
                              const OutlierOptions& options, std::uint64_t seed) {
  PARKADE_CHECK(rays_previous.size() == rays_current.size(), "{} and {} rays", rays_previous.size(),
                rays_current.size());
  MotionConsensus consensus;
  const std::size_t count = rays_current.size();
  consensus.inlier.assign(count, 1);
  if (!options.enabled || count < static_cast<std::size_t>(options.min_features)) return consensus;
  const double threshold = options.max_epipolar_px / focal_px;
  // 1. Turn the old rays as the IMU says, or as they themselves say.
  SO3 rotation =
      motion.rotation_valid ? motion.R_current_previous : alignRays(rays_current, rays_previous);
  Rays g;
  turn(rotation, rays_previous, g);
  // 2. The direction of travel: the prior's, or the best of the pairs' (looser, as the rotation is
  // not refined yet).
  const double loose = 3.0 * threshold;
  Eigen::Vector3d t = Eigen::Vector3d::UnitZ();
  double best = truncatedCost(rays_current, g, t, loose);
  const auto propose = [&](const Eigen::Vector3d& candidate) {
    const double cost = truncatedCost(rays_current, g, candidate, loose);
    if (cost < best) {
      best = cost;
      t = candidate;
    }
  };
  if (motion.translation_valid && motion.t_current_previous.norm() > 1e-3) {
    propose(motion.t_current_previous.normalized());
  }
  Random random(seed);
  for (int i = 0; i < options.iterations; ++i) {
    const std::size_t a = random.index(count);
    const std::size_t b = random.index(count);
    const Eigen::Vector3d across = g[a].cross(rays_current[a]).cross(g[b].cross(rays_current[b]));
    if (a == b || across.norm() < kMinParallaxSine * kMinParallaxSine) continue;
    propose(across.normalized());
  }
  // 3. Refine both together, then judge.
  refine(rays_current, rays_previous, threshold,
         motion.rotation_valid ? kRotationSigma : kUnknownSigma, rotation, t);
  turn(rotation, rays_previous, g);
  double square_sum = 0.0;
  int inliers = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double d = planeDistance(rays_current[i], g[i], t);
    consensus.inlier[i] = std::abs(d) < threshold ? 1 : 0;
    if (consensus.inlier[i] == 0) continue;
    square_sum += d * d;
    ++inliers;
  }
  consensus.judged = true;
  consensus.rms_px = inliers > 0 ? focal_px * std::sqrt(square_sum / inliers) : 0.0;
  // A consensus of a minority is none: the estimator's robust loss must sort that out.
  if (2 * inliers < static_cast<int>(count)) {
    consensus.inlier.assign(count, 1);
    consensus.judged = false;
  }
  return consensus;
}

}  // namespace parkade
