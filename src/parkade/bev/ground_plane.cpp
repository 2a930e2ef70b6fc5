// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/bev/ground_plane.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "parkade/geometry/robust.hpp"
#include "parkade/types/level_frame.hpp"

namespace parkade {
namespace {

constexpr int kIterations = 8;
constexpr double kMaxLandmarkSigma = 0.08;  // m: less certain points say nothing
constexpr int kMinObservations = 3;
// The plane of the frame before holds for the next one but for slope changes and the body's motion.
constexpr double kLastTiltSigma = 0.01;     // rad
constexpr double kLastHeightSigma = 0.015;  // m
constexpr double kReliefStep = 2.0;         // m
constexpr double kCauchy = 1.5;             // sigmas: what stands on the floor must not lift it

struct FloorPoint {
  Eigen::Vector3d p_vehicle;
  double sigma;
};

// Nose down lifts the floor ahead, leaning right lifts it on the right.
GroundAttitude attitudeOver(const Eigen::Vector3d& plane) {
  GroundAttitude attitude;
  attitude.pitch = std::atan(plane.x());
  attitude.roll = std::atan(-plane.y() * std::cos(attitude.pitch));
  attitude.height = -plane.z() / std::sqrt(1.0 + plane.head<2>().squaredNorm());
  return attitude;
}

// The plane that fits best within 6 m, in the vehicle frame.
Eigen::Vector3d planeOf(const FloorElevation& elevation, const SE3& T_odom_vehicle) {
  constexpr double kReach = 6.0;  // m
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (double x = -kReach; x <= kReach; x += kReliefStep) {
    for (double y = -kReach; y <= kReach; y += kReliefStep) {
      const Eigen::Vector3d row(x, y, 1.0);
      H += row * row.transpose();
      b += row * elevation.heightIn(T_odom_vehicle, {x, y});
    }
  }
  return H.ldlt().solve(b);
}

// Errors of the elevation turn the lines on both sides of the car, where errors of a plane shear
// them: a floor that is nearly a plane is taken for one.
void fadeNearPlane(Eigen::MatrixXd& heights) {
  constexpr double kPlane = 0.006;  // m, RMS within 6 m
  constexpr double kRelief = 0.012;
  constexpr Eigen::Index kRim = 2;  // nodes beyond
  const auto inner =
      heights.block(kRim, kRim, heights.rows() - 2 * kRim, heights.cols() - 2 * kRim);
  const double rms = std::sqrt(inner.squaredNorm() / static_cast<double>(inner.size()));
  const double share = std::clamp((rms - kPlane) / (kRelief - kPlane), 0.0, 1.0);
  heights *= share * share * (3.0 - 2.0 * share);
}

GroundRelief reliefOf(const FloorElevation& elevation, const SE3& T_odom_level) {
  constexpr int kHalf = 5;  // nodes to either side: a picture reaches 9 m ahead
  GroundRelief relief = GroundRelief::around(kHalf, kReliefStep, [&](const Eigen::Vector2d& p) {
    return elevation.heightIn(T_odom_level, p);
  });
  fadeNearPlane(relief.heights);
  return relief;
}

}  // namespace

void GroundPlaneEstimator::reset() {
  points_.clear();
  has_plane_ = false;
  elevation_.reset();
}

void GroundPlaneEstimator::remember(const PoseEstimate& pose,
                                    const std::vector<Landmark>& landmarks) {
  const Eigen::Vector3d up = pose.T_odom_vehicle.rotation() * Eigen::Vector3d::UnitZ();
  for (const Landmark& landmark : landmarks) {
    if (landmark.num_observations < kMinObservations) continue;
    const double sigma = std::sqrt(std::max(0.0, up.dot(landmark.covariance * up)));
    if (sigma > kMaxLandmarkSigma) continue;
    points_[landmark.id] = {landmark.p_odom, sigma, pose.t_ns};
  }
  const double far = options_.max_distance_m + 1.0;
  for (auto it = points_.begin(); it != points_.end();) {
    const bool old = toSeconds(pose.t_ns - it->second.last_seen_ns) > options_.keep_s;
    const bool away = (it->second.p_odom - pose.T_odom_vehicle.translation()).norm() > far;
    it = old || away ? points_.erase(it) : std::next(it);
  }
}

// The floor's elevation, and with it the plane that fits it best and what is left over that.
void GroundPlaneEstimator::addRelief(const SE3& T_odom_vehicle, const Eigen::Vector3d& plane,
                                     GroundPlaneEstimate& estimate) {
  std::vector<std::pair<std::uint64_t, FloorSample>> near;  // by id: sums come out the same
  for (const auto& [id, point] : points_) {
    const Eigen::Vector2d beside = (point.p_odom - T_odom_vehicle.translation()).head<2>();
    if (beside.norm() > options_.max_distance_m) continue;
    near.push_back({id, {point.p_odom, std::hypot(point.sigma, options_.point_sigma_m)}});
  }
  std::sort(near.begin(), near.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<FloorSample> samples;
  for (const auto& [id, sample] : near) samples.push_back(sample);
  elevation_.update(T_odom_vehicle, plane, samples,
                    {options_.tilt_prior_deg * std::numbers::pi / 180.0, options_.height_prior_m});
  estimate.attitude = attitudeOver(planeOf(elevation_, T_odom_vehicle));
  estimate.relief = reliefOf(elevation_, T_odom_vehicle * levelFrom(estimate.attitude).inverse());
}

GroundPlaneEstimate GroundPlaneEstimator::update(const PoseEstimate& pose,
                                                 const std::vector<Landmark>& landmarks) {
  remember(pose, landmarks);
  const SE3 T_vehicle_odom = pose.T_odom_vehicle.inverse();

  // What is expected of z = a x + b y + c in the vehicle frame: the body at rest on a floor, and
  // the floor of the frame before, seen from the present pose.
  const double tilt = options_.tilt_prior_deg * std::numbers::pi / 180.0;
  Eigen::Matrix3d H_prior = Eigen::Vector3d(1.0 / (tilt * tilt), 1.0 / (tilt * tilt),
                                            std::pow(options_.height_prior_m, -2.0))
                                .asDiagonal();
  Eigen::Vector3d b_prior = Eigen::Vector3d::Zero();
  if (has_plane_) {
    const Eigen::Vector3d normal =
        T_vehicle_odom.rotation() *
        Eigen::Vector3d(-plane_odom_.x(), -plane_odom_.y(), 1.0).normalized();
    const Eigen::Vector3d foot = T_vehicle_odom * Eigen::Vector3d(0.0, 0.0, plane_odom_.z());
    const Eigen::Vector3d last(-normal.x() / normal.z(), -normal.y() / normal.z(),
                               normal.dot(foot) / normal.z());
    const Eigen::Vector3d information(std::pow(kLastTiltSigma, -2.0),
                                      std::pow(kLastTiltSigma, -2.0),
                                      std::pow(kLastHeightSigma, -2.0));
    H_prior += information.asDiagonal();
    b_prior += information.cwiseProduct(last);
  }
  const Eigen::Vector3d expected = H_prior.ldlt().solve(b_prior);

  // Ordered by id, so that sums come out the same whatever the map's order.
  std::vector<std::pair<std::uint64_t, FloorPoint>> near;
  for (const auto& [id, point] : points_) {
    const Eigen::Vector3d p = T_vehicle_odom * point.p_odom;
    if (p.head<2>().norm() > options_.max_distance_m) continue;
    const double off = p.z() - expected.dot(Eigen::Vector3d(p.x(), p.y(), 1.0));
    if (std::abs(off) > options_.max_off_plane_m) continue;
    near.push_back({id, {p, std::hypot(point.sigma, options_.point_sigma_m)}});
  }
  std::sort(near.begin(), near.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });

  Eigen::Vector3d plane = expected;
  Eigen::Matrix3d H = H_prior;
  int used = 0;
  for (int i = 0; i < kIterations; ++i) {
    H = H_prior;
    Eigen::Vector3d b = b_prior;
    used = 0;
    for (const auto& [id, point] : near) {
      const Eigen::Vector3d row(point.p_vehicle.x(), point.p_vehicle.y(), 1.0);
      const double whitened = (point.p_vehicle.z() - plane.dot(row)) / point.sigma;
      const double weight =
          cauchy(whitened * whitened, kCauchy).weight / (point.sigma * point.sigma);
      H += weight * row * row.transpose();
      b += weight * point.p_vehicle.z() * row;
      if (std::abs(whitened) < 2.5) ++used;
    }
    plane = H.ldlt().solve(b);
  }

  const Eigen::Matrix3d covariance = H.inverse();
  GroundPlaneEstimate estimate;
  estimate.attitude = attitudeOver(plane);
  estimate.sigma_pitch = std::sqrt(covariance(0, 0));
  estimate.sigma_roll = std::sqrt(covariance(1, 1));
  estimate.sigma_height = std::sqrt(covariance(2, 2));
  estimate.points = used;
  if (options_.elevation.curvature_sigma > 0.0) addRelief(pose.T_odom_vehicle, plane, estimate);

  const Eigen::Vector3d normal =
      pose.T_odom_vehicle.rotation() * Eigen::Vector3d(-plane.x(), -plane.y(), 1.0);
  const Eigen::Vector3d foot = pose.T_odom_vehicle * Eigen::Vector3d(0.0, 0.0, plane.z());
  plane_odom_ = {-normal.x() / normal.z(), -normal.y() / normal.z(), normal.dot(foot) / normal.z()};
  has_plane_ = true;
  return estimate;
}

}  // namespace parkade
