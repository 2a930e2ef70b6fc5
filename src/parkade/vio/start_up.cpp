// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/vio/start_up.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>

#include "parkade/core/median.hpp"
#include "parkade/geometry/robust.hpp"

namespace parkade {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kPairSpan = 0.15;        // s between the frames whose bearings are compared
constexpr double kBearingSigma = 2.5e-3;  // rad, of an epipolar residual
constexpr int kBiasIterations = 8;
constexpr int kMinPairFeatures = 8;
constexpr int kMinFeatures = 12;
constexpr int kReweightings = 4;

// Rotation, and motion without gravity and first velocity, of every frame in the first imu frame.
struct Dead {
  Matrix3d R = Matrix3d::Identity();
  Vector3d p = Vector3d::Zero();
  Vector3d v = Vector3d::Zero();
  double t = 0.0;
};

std::vector<Preintegration> sumReadings(const std::vector<StartUpFrame>& frames,
                                        const ReadingBuffer& readings, const ImuNoise& noise,
                                        const ImuBias& bias, TimeNs gap_ns) {
  std::vector<Preintegration> sums;
  for (std::size_t i = 0; i + 1 < frames.size(); ++i) {
    Preintegration sum(noise, bias);
    sum.integrate(readings.between(frames[i].t_ns, frames[i + 1].t_ns), gap_ns);
    sums.push_back(sum);
  }
  return sums;
}

struct BearingPair {
  Vector3d a;  // imu axes at the first frame
  Vector3d b;  // imu axes at the second
};

struct EpipolarGroup {
  std::size_t first = 0;
  std::size_t second = 0;
  std::vector<BearingPair> bearings;
};

// Features of one camera in two frames some time apart; each group has its own direction of motion.
std::vector<EpipolarGroup> epipolarGroups(const std::vector<VioCamera>& cameras,
                                          const std::vector<StartUpFrame>& frames) {
  std::vector<EpipolarGroup> groups;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    std::size_t j = i + 1;
    while (j < frames.size() && toSeconds(frames[j].t_ns - frames[i].t_ns) < kPairSpan) ++j;
    if (j >= frames.size()) break;
    std::map<std::pair<std::uint64_t, int>, Vector3d> seen;
    for (const auto& [id, o] : frames[i].observations) seen[{id, o.camera}] = o.ray;
    std::vector<EpipolarGroup> by_camera(cameras.size());
    for (const auto& [id, o] : frames[j].observations) {
      const auto it = seen.find({id, o.camera});
      if (it == seen.end()) continue;
      const auto camera = static_cast<std::size_t>(o.camera);
      const SO3& R_imu_cam = cameras[camera].T_imu_cam.rotation();
      by_camera[camera].bearings.push_back({R_imu_cam * it->second, R_imu_cam * o.ray});
    }
    for (EpipolarGroup& group : by_camera) {
      if (static_cast<int>(group.bearings.size()) < kMinPairFeatures) continue;
      group.first = i;
      group.second = j;
      groups.push_back(std::move(group));
    }
  }
  return groups;
}

// Adds one group's share of the normal equations for a change of gyro bias; start_up.md, eq. (3).
void addGroup(const EpipolarGroup& group, const Matrix3d& R, const Matrix3d& d_rotation_d_bias,
              Matrix3d& H, Vector3d& b) {
  const std::size_t count = group.bearings.size();
  std::vector<Vector3d> normals(count);
  std::vector<double> weights(count, 1.0);
  for (std::size_t k = 0; k < count; ++k) {
    normals[k] = group.bearings[k].a.cross(R * group.bearings[k].b);
  }
  Vector3d direction = Vector3d::UnitX();
  for (int round = 0; round < 2; ++round) {
    Matrix3d M = Matrix3d::Zero();
    for (std::size_t k = 0; k < count; ++k) {
      M += weights[k] * normals[k] * normals[k].transpose();
    }
    direction = Eigen::SelfAdjointEigenSolver<Matrix3d>(M).eigenvectors().col(0);
    for (std::size_t k = 0; k < count; ++k) {
      const double r = direction.dot(normals[k]) / kBearingSigma;
      weights[k] = cauchy(r * r, 2.0).weight;
    }
  }
  const Eigen::Matrix<double, 3, 2> basis = tangentBasis(direction);
  Matrix3d H_bias = Matrix3d::Zero();
  Eigen::Matrix<double, 3, 2> H_cross = Eigen::Matrix<double, 3, 2>::Zero();
  Eigen::Matrix2d H_direction = 1e-3 * Eigen::Matrix2d::Identity();
  Vector3d b_bias = Vector3d::Zero();
  Eigen::Vector2d b_direction = Eigen::Vector2d::Zero();
  for (std::size_t k = 0; k < count; ++k) {
    const double scale = std::sqrt(weights[k]) / kBearingSigma;
    const double r = scale * direction.dot(normals[k]);
    const Matrix3d d_normal =
        -hat(group.bearings[k].a) * R * hat(group.bearings[k].b) * d_rotation_d_bias;
    const Eigen::RowVector3d by_bias = scale * direction.transpose() * d_normal;
    const Eigen::RowVector2d by_direction = scale * normals[k].transpose() * basis;
    H_bias += by_bias.transpose() * by_bias;
    H_cross += by_bias.transpose() * by_direction;
    H_direction += by_direction.transpose() * by_direction;
    b_bias += by_bias.transpose() * r;
    b_direction += by_direction.transpose() * r;
  }
  const Eigen::Matrix2d inverse = H_direction.inverse();
  H += H_bias - H_cross * inverse * H_cross.transpose();
  b += b_bias - H_cross * inverse * b_direction;
}

Vector3d estimateGyroBias(const std::vector<EpipolarGroup>& groups,
                          const std::vector<StartUpFrame>& frames, const ReadingBuffer& readings,
                          const ImuNoise& noise, double prior_sigma, TimeNs gap_ns) {
  Vector3d bias = Vector3d::Zero();
  for (int iteration = 0; iteration < kBiasIterations; ++iteration) {
    const std::vector<Preintegration> sums =
        sumReadings(frames, readings, noise, {bias, Vector3d::Zero()}, gap_ns);
    const double information = 1.0 / (prior_sigma * prior_sigma);
    Matrix3d H = information * Matrix3d::Identity();
    Vector3d b = information * bias;
    for (const EpipolarGroup& group : groups) {
      Matrix3d R = Matrix3d::Identity();
      Matrix3d by_bias = Matrix3d::Zero();
      for (std::size_t k = group.first; k < group.second; ++k) {
        const Matrix3d step = sums[k].deltaRotation().matrix();
        R = R * step;
        by_bias =
            step.transpose() * by_bias +
            sums[k].transition().block<3, 3>(Preintegration::kRotation, Preintegration::kBiasGyro);
      }
      addGroup(group, R, by_bias, H, b);
    }
    const Vector3d step = -H.ldlt().solve(b);
    if (!step.allFinite()) break;
    bias += step;
    if (step.norm() < 1e-5) break;
  }
  return bias;
}

std::vector<Dead> deadReckon(const std::vector<Preintegration>& sums) {
  std::vector<Dead> result(1);
  for (const Preintegration& sum : sums) {
    const Dead& last = result.back();
    Dead next;
    const double dt = sum.duration();
    next.t = last.t + dt;
    next.R = last.R * sum.deltaRotation().matrix();
    next.v = last.v + last.R * sum.deltaVelocity();
    next.p = last.p + last.v * dt + last.R * sum.deltaPosition();
    result.push_back(next);
  }
  return result;
}

struct LinearFeature {
  struct View {
    std::size_t frame = 0;
    Matrix3d R_cam_first;  // camera axes by first imu axes
    Vector3d t_cam;        // constant part of p_cam, eq. (5)
    Eigen::Matrix<double, 3, 2> basis;
    Vector3d ray;
  };
  std::vector<View> views;
  std::vector<double> depths;  // of the last solution
  double weight = 1.0;
};

std::vector<LinearFeature> linearFeatures(const std::vector<VioCamera>& cameras,
                                          const std::vector<StartUpFrame>& frames,
                                          const std::vector<Dead>& dead) {
  std::map<std::uint64_t, LinearFeature> features;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    for (const auto& [id, o] : frames[i].observations) {
      const SE3& T_imu_cam = cameras[static_cast<std::size_t>(o.camera)].T_imu_cam;
      const Matrix3d R_cam_imu = T_imu_cam.rotation().matrix().transpose();
      LinearFeature::View view;
      view.frame = i;
      view.R_cam_first = R_cam_imu * dead[i].R.transpose();
      view.t_cam = -view.R_cam_first * dead[i].p - R_cam_imu * T_imu_cam.translation();
      view.basis = tangentBasis(o.ray);
      view.ray = o.ray;
      features[id].views.push_back(view);
    }
  }
  std::vector<LinearFeature> result;
  for (auto& [id, feature] : features) {
    if (feature.views.size() < 3 || feature.views.front().frame == feature.views.back().frame) {
      continue;
    }
    feature.depths.assign(feature.views.size(), 1.0);
    result.push_back(std::move(feature));
  }
  return result;
}

// Normal equations of one feature: its point (3), then velocity and gravity (6).
struct FeatureEquations {
  Matrix3d H_point = Matrix3d::Zero();
  Eigen::Matrix<double, 3, 6> H_cross = Eigen::Matrix<double, 3, 6>::Zero();
  Eigen::Matrix<double, 6, 6> H_motion = Eigen::Matrix<double, 6, 6>::Zero();
  Vector3d b_point = Vector3d::Zero();
  Eigen::Matrix<double, 6, 1> b_motion = Eigen::Matrix<double, 6, 1>::Zero();
};

FeatureEquations equationsOf(const LinearFeature& feature, const std::vector<Dead>& dead) {
  FeatureEquations e;
  for (std::size_t k = 0; k < feature.views.size(); ++k) {
    const LinearFeature::View& view = feature.views[k];
    const double t = dead[view.frame].t;
    // Dividing by the depth turns the residual into an angle.
    const double scale = feature.weight / std::max(feature.depths[k], 0.2);
    const Eigen::Matrix<double, 2, 3> by_point = scale * view.basis.transpose() * view.R_cam_first;
    Eigen::Matrix<double, 2, 6> by_motion;
    by_motion << -t * by_point, -0.5 * t * t * by_point;
    const Eigen::Vector2d r = scale * view.basis.transpose() * view.t_cam;
    e.H_point += by_point.transpose() * by_point;
    e.H_cross += by_point.transpose() * by_motion;
    e.H_motion += by_motion.transpose() * by_motion;
    e.b_point += by_point.transpose() * r;
    e.b_motion += by_motion.transpose() * r;
  }
  e.H_point.diagonal().array() += 1e-9;
  return e;
}

struct LinearSolution {
  bool ok = false;
  Vector3d velocity;
  Vector3d gravity;
};

LinearSolution solveLinear(std::vector<LinearFeature>& features, const std::vector<Dead>& dead,
                           double gravity) {
  LinearSolution solution;
  for (int round = 0; round < kReweightings; ++round) {
    Eigen::Matrix<double, 6, 6> H = Eigen::Matrix<double, 6, 6>::Zero();
    Eigen::Matrix<double, 6, 1> b = Eigen::Matrix<double, 6, 1>::Zero();
    std::vector<FeatureEquations> equations;
    for (const LinearFeature& feature : features) {
      equations.push_back(equationsOf(feature, dead));
      const FeatureEquations& e = equations.back();
      const Eigen::LDLT<Matrix3d> ldlt(e.H_point);
      H += e.H_motion - e.H_cross.transpose() * ldlt.solve(e.H_cross);
      b += e.b_motion - e.H_cross.transpose() * ldlt.solve(e.b_point);
    }
    const Matrix3d H_v = H.topLeftCorner<3, 3>() + 1e-9 * Matrix3d::Identity();
    const Eigen::LDLT<Matrix3d> ldlt_v(H_v);
    const Matrix3d H_vg = H.topRightCorner<3, 3>();
    const Matrix3d H_g = H.bottomRightCorner<3, 3>() - H_vg.transpose() * ldlt_v.solve(H_vg);
    const Vector3d b_g = b.tail<3>() - H_vg.transpose() * ldlt_v.solve(b.head<3>());
    solution.gravity = solveOnSphere(H_g, b_g, gravity);
    solution.velocity = -ldlt_v.solve(b.head<3>() + H_vg * solution.gravity);
    if (!solution.velocity.allFinite() || !solution.gravity.allFinite()) return solution;

    Eigen::Matrix<double, 6, 1> motion;
    motion << solution.velocity, solution.gravity;
    std::vector<double> errors;
    for (std::size_t f = 0; f < features.size(); ++f) {
      const FeatureEquations& e = equations[f];
      const Vector3d point = -e.H_point.ldlt().solve(e.b_point + e.H_cross * motion);
      double squared = 0.0;
      for (std::size_t k = 0; k < features[f].views.size(); ++k) {
        const LinearFeature::View& view = features[f].views[k];
        const double t = dead[view.frame].t;
        const Vector3d p_cam =
            view.R_cam_first * (point - t * solution.velocity - 0.5 * t * t * solution.gravity) +
            view.t_cam;
        features[f].depths[k] = std::clamp(p_cam.dot(view.ray), 0.2, 100.0);
        squared += (p_cam.normalized() - view.ray).squaredNorm();
      }
      errors.push_back(std::sqrt(squared / static_cast<double>(features[f].views.size())));
    }
    const double scale = std::max(1.5 * median(errors), 1e-3);
    for (std::size_t f = 0; f < features.size(); ++f) {
      features[f].weight = std::sqrt(cauchy(errors[f] * errors[f], scale).weight);
    }
  }
  solution.ok = true;
  return solution;
}

// Turns the first imu frame so that gravity points down and the vehicle heads along x.
SO3 levelled(const Vector3d& up_imu, const SE3& T_imu_vehicle) {
  const SO3 R_level_imu = SO3::fromTwoVectors(up_imu, Vector3d::UnitZ());
  const double yaw = (R_level_imu * T_imu_vehicle.rotation()).yaw();
  return SO3::fromYawPitchRoll(-yaw, 0.0, 0.0) * R_level_imu;
}

}  // namespace

Vector3d solveOnSphere(const Matrix3d& H, const Vector3d& b, double radius) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(H);
  const Vector3d values = eigen.eigenvalues();
  const Vector3d c = -(eigen.eigenvectors().transpose() * b);
  const auto length = [&](double lambda) {
    return (c.array() / (values.array() + lambda)).matrix().norm();
  };
  // |g| falls monotonically for lambda above minus the smallest eigenvalue: bisection.
  const double spread = std::max(values(2), 1e-12);
  double low = -values(0) + 1e-12 * spread;
  double high = -values(0) + c.norm() / radius + spread;
  while (length(high) > radius) high += 2.0 * (high - low);
  for (int i = 0; i < 200 && high - low > 1e-15 * spread; ++i) {
    const double middle = 0.5 * (low + high);
    (length(middle) > radius ? low : high) = middle;
  }
  const double lambda = 0.5 * (low + high);
  Vector3d g = eigen.eigenvectors() * (c.array() / (values.array() + lambda)).matrix();
  return g * (radius / std::max(g.norm(), 1e-12));
}

NavState alignAtRest(const Vector3d& mean_accel, const SE3& T_imu_vehicle) {
  NavState state;
  state.R_odom_imu = levelled(mean_accel, T_imu_vehicle);
  state.p_odom = -(state.R_odom_imu * T_imu_vehicle.translation());
  return state;
}

StartUpAlignment alignInMotion(const std::vector<VioCamera>& cameras,
                               const std::vector<StartUpFrame>& frames,
                               const ReadingBuffer& readings, const ImuNoise& noise, double gravity,
                               const SE3& T_imu_vehicle, double bias_gyro_sigma, TimeNs gap_ns) {
  StartUpAlignment alignment;
  if (frames.size() < 3 || readings.empty()) return alignment;

  // 1. Gyro bias from epipolar planes, whatever the translation.
  const std::vector<EpipolarGroup> groups = epipolarGroups(cameras, frames);
  if (groups.empty()) return alignment;
  alignment.bias.gyro = estimateGyroBias(groups, frames, readings, noise, bias_gyro_sigma, gap_ns);

  // 2. Velocity, gravity and points, linearly.
  const std::vector<Dead> dead =
      deadReckon(sumReadings(frames, readings, noise, alignment.bias, gap_ns));
  std::vector<LinearFeature> features = linearFeatures(cameras, frames, dead);
  alignment.num_features = static_cast<int>(features.size());
  if (alignment.num_features < kMinFeatures) return alignment;
  const LinearSolution solution = solveLinear(features, dead, gravity);
  if (!solution.ok) return alignment;

  // 3. Into the odom frame.
  const SO3 R_odom_first = levelled(-solution.gravity, T_imu_vehicle);
  const Vector3d p_first = -(R_odom_first * T_imu_vehicle.translation());
  for (const Dead& d : dead) {
    NavState state;
    state.R_odom_imu = R_odom_first * SO3(d.R);
    state.p_odom = p_first + R_odom_first * Vector3d(d.p + d.t * solution.velocity +
                                                     0.5 * d.t * d.t * solution.gravity);
    state.v_odom = R_odom_first * Vector3d(d.v + solution.velocity + d.t * solution.gravity);
    alignment.states.push_back(state);
  }
  alignment.ok = true;
  return alignment;
}

}  // namespace parkade
