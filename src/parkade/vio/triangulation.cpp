// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/vio/triangulation.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "parkade/geometry/robust.hpp"
#include "parkade/vio/reprojection.hpp"

namespace parkade {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kNoiseMargin = 4.0;  // parallax that noise alone does not make, in its sigmas
constexpr double kLeastInverseDistance = -0.05;  // far points and noise
constexpr int kIterations = 6;

struct View {
  const WindowObservation* observation;
  PoseMatrices imu;
  SE3 T_imu_cam;  // when its row was read
  Vector3d centre_odom = Vector3d::Zero();
  Vector3d ray_odom = Vector3d::UnitZ();
};

std::vector<View> collectViews(const Window& window, const WindowFeature& feature) {
  std::vector<View> views;
  views.reserve(feature.observations.size());
  for (const WindowObservation& observation : feature.observations) {
    const WindowFrame* frame = window.find(observation.frame_id);
    if (frame == nullptr) continue;
    const VioCamera& camera = window.cameras[static_cast<std::size_t>(observation.camera)];
    View view{&observation, PoseMatrices(frame->state), cameraPlace(camera, *frame, observation)};
    view.centre_odom = view.imu.R * view.T_imu_cam.translation() + view.imu.p;
    view.ray_odom = view.imu.R * (view.T_imu_cam.rotation() * observation.ray);
    views.push_back(view);
  }
  return views;
}

// Sum of robust squared errors, with the normal equations of the landmark's coordinates.
bool evaluate(const Window& window, const std::vector<View>& views, const Vector3d& direction,
              double inverse_distance, Matrix3d& H, Vector3d& b, double& worst, double& sum) {
  const VioCamera& anchor_camera =
      window.cameras[static_cast<std::size_t>(views.front().observation->camera)];
  H.setZero();
  H(2, 2) = kPriorInverseDistanceInformation;
  b.setZero();
  b(2) = kPriorInverseDistanceInformation * (inverse_distance - kPriorInverseDistance);
  worst = 0.0;
  sum = 0.0;
  for (const View& view : views) {
    Eigen::Vector2d pixel;
    ReprojectionJacobians j;
    if (!reproject(anchor_camera,
                   window.cameras[static_cast<std::size_t>(view.observation->camera)],
                   view.T_imu_cam, views.front().imu, view.imu, views.front().imu, view.imu,
                   direction, inverse_distance, pixel, &j)) {
      return false;
    }
    const double weight = 1.0 / view.observation->sigma_px;
    const Eigen::Vector2d r = weight * (pixel - observedPixel(window, *view.observation));
    const Eigen::Matrix<double, 2, 3> J = weight * j.d_px_d_landmark;
    const double robust = huber(r.squaredNorm(), 3.0).weight;
    H += robust * J.transpose() * J;
    b += robust * J.transpose() * r;
    worst = std::max(worst, r.norm());
    sum += r.squaredNorm();
  }
  return true;
}

}  // namespace

bool triangulate(const Window& window, WindowFeature& feature, const TriangulationLimits& limits) {
  feature.has_point = false;
  const std::vector<View> views = collectViews(window, feature);
  if (views.size() < 2) return false;

  // 1. Midpoint of all rays, and the largest angle to the first.
  Matrix3d A = Matrix3d::Zero();
  Vector3d rhs = Vector3d::Zero();
  double cosine = 1.0;
  const View& anchor = views.front();
  for (const View& view : views) {
    const Matrix3d across = Matrix3d::Identity() - view.ray_odom * view.ray_odom.transpose();
    A += across;
    rhs += across * (view.centre_odom - anchor.centre_odom);
    cosine = std::min(cosine, anchor.ray_odom.dot(view.ray_odom));
  }
  const double parallax = std::acos(std::clamp(cosine, -1.0, 1.0));
  double inverse_distance = kPriorInverseDistance;
  const WindowObservation& first = *anchor.observation;
  const double ray_sigma =
      first.sigma_px / window.cameras[static_cast<std::size_t>(first.camera)].camera.focalLength();
  if (parallax >= std::max(limits.min_parallax, kNoiseMargin * std::sqrt(2.0) * ray_sigma)) {
    const Vector3d offset = A.ldlt().solve(rhs);
    const double depth = offset.dot(anchor.ray_odom);
    if (depth > limits.min_distance) inverse_distance = 1.0 / depth;
  } else if (static_cast<int>(views.size()) < limits.patience) {
    return false;
  }

  // 2. Gauss-Newton on the pixels.
  const VioCamera& first_camera = window.cameras[static_cast<std::size_t>(first.camera)];
  Vector3d direction = first.ray;
  if (first_camera.readout_time > 0.0) {
    direction =
        first_camera.T_imu_cam.rotation().inverse() * (anchor.T_imu_cam.rotation() * first.ray);
  }
  Matrix3d H;
  Vector3d b;
  double worst = 0.0;
  double sum = 0.0;
  for (int i = 0; i < kIterations; ++i) {
    if (!evaluate(window, views, direction, inverse_distance, H, b, worst, sum)) {
      ++feature.failures;
      return false;
    }
    const Vector3d step = -H.ldlt().solve(b);
    if (!step.allFinite()) return false;
    direction = (direction + tangentBasis(direction) * step.head<2>()).normalized();
    inverse_distance =
        std::clamp(inverse_distance + step.z(), kLeastInverseDistance, 1.0 / limits.min_distance);
    if (b.dot(step) > -1e-4) break;
  }
  if (!evaluate(window, views, direction, inverse_distance, H, b, worst, sum) ||
      std::sqrt(sum / static_cast<double>(views.size())) > limits.max_rms ||
      worst > limits.max_error || inverse_distance >= 1.0 / limits.min_distance) {
    ++feature.failures;
    return false;
  }
  feature.has_point = true;
  feature.anchor_frame_id = anchor.observation->frame_id;
  feature.anchor_camera = anchor.observation->camera;
  feature.direction = direction;
  feature.inverse_distance = inverse_distance;
  return true;
}

}  // namespace parkade
