// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/vio/window_solver.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <utility>

#include "parkade/vio/reprojection.hpp"

namespace parkade {
namespace {

constexpr double kMaxDamping = 1e6;

// What a step changes, to be able to take it back.
struct Backup {
  struct Frame {
    NavState state;
    ImuBias bias;
    Vector15d delta;
  };
  std::vector<Frame> frames;
  WindowGravity gravity;
  std::vector<VioCamera> cameras;
  std::vector<CameraRefinement> refinements;
  std::vector<std::pair<Eigen::Vector3d, double>> landmarks;

  void save(const Window& window, const std::vector<WindowFeature*>& features) {
    frames.clear();
    landmarks.clear();
    gravity = window.gravity;
    refinements = window.refinements;
    if (!refinements.empty()) cameras = window.cameras;
    for (const WindowFrame& f : window.frames) frames.push_back({f.state, f.bias, f.delta});
    for (const WindowFeature* f : features) {
      landmarks.emplace_back(f->direction, f->inverse_distance);
    }
  }
  void restore(Window& window, const std::vector<WindowFeature*>& features) const {
    window.gravity = gravity;
    window.refinements = refinements;
    if (!refinements.empty()) window.cameras = cameras;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      window.frames[i].state = frames[i].state;
      window.frames[i].bias = frames[i].bias;
      window.frames[i].delta = frames[i].delta;
    }
    for (std::size_t i = 0; i < features.size(); ++i) {
      features[i]->direction = landmarks[i].first;
      features[i]->inverse_distance = landmarks[i].second;
    }
  }
};

// The marginal of the newest frame and the globals needs only the end of the Cholesky factor.
void setCovariance(const Eigen::LLT<Eigen::MatrixXd, Eigen::Lower>& llt, Eigen::Index globals,
                   SolveSummary& summary) {
  const Eigen::Index size = kState + globals;
  const Eigen::MatrixXd corner = llt.matrixLLT().bottomRightCorner(size, size);
  const Eigen::MatrixXd corner_inverse =
      corner.triangularView<Eigen::Lower>().solve(Eigen::MatrixXd::Identity(size, size));
  const Eigen::MatrixXd covariance = corner_inverse.transpose() * corner_inverse;
  summary.newest_covariance = covariance.topLeftCorner<kState, kState>();
  summary.global_covariance = covariance.bottomRightCorner(globals, globals);
  summary.has_covariance = true;
}

// Whether a step moves no frame so far that the terms would have to be linearised again.
bool isSettled(const Eigen::VectorXd& step, std::size_t frames, const SolveOptions& options) {
  for (std::size_t i = 0; i < frames; ++i) {
    const Vector15d of_frame = step.segment<kState>(kState * static_cast<Eigen::Index>(i));
    if (!(of_frame.head<3>().norm() < options.settled_position)) return false;
    if (!(of_frame.segment<3>(3).norm() < options.settled_rotation)) return false;
  }
  return true;
}

}  // namespace

SolveSummary solveWindow(Window& window, const std::vector<WindowFeature*>& features,
                         const SolveOptions& options) {
  SolveSummary summary;
  if (window.frames.empty()) return summary;
  FactorSelection selection = FactorSelection::all(window);
  selection.features = features;
  LinearSystem system(options.loss, options.still);
  LinearSystem trial(options.loss, options.still);
  Backup backup;
  double damping = 0.0;
  bool rejected = false;  // a step before
  system.linearise(window, selection);
  summary.initial_cost = system.cost();
  summary.final_cost = system.cost();
  summary.observations = system.numObservations();

  while (summary.iterations < options.max_iterations) {
    ++summary.iterations;
    system.reduce(damping);
    const Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> llt(system.reducedH());
    if (llt.info() != Eigen::Success) {
      if (damping > kMaxDamping) break;
      damping = std::max(1e-4, 10.0 * damping);
      continue;
    }
    const Eigen::VectorXd step = -llt.solve(system.reducedB());
    if (!step.allFinite()) break;

    backup.save(window, features);
    double gradient_dot_step = system.gradient().dot(step);
    system.applyToLandmarks(step, gradient_dot_step);
    for (std::size_t i = 0; i < window.frames.size(); ++i) {
      window.frames[i].apply(step.segment<kState>(kState * static_cast<Eigen::Index>(i)));
    }
    window.applyGlobals(step.tail(window.globalSize()));
    const double decrease = -0.5 * gradient_dot_step;
    // Damping would pass for knowledge of where the whole window is.
    if (damping == 0.0) setCovariance(llt, window.globalSize(), summary);
    summary.ok = true;
    const bool last = decrease < options.min_decrease ||
                      summary.iterations == options.max_iterations ||
                      isSettled(step, window.frames.size(), options);
    if (last && !rejected) {
      summary.final_cost = system.cost() - decrease;
      break;
    }
    trial.linearise(window, selection);
    if (trial.cost() <= system.cost() + options.min_decrease) {
      std::swap(system, trial);
      damping = damping > 1e-4 ? 0.1 * damping : 0.0;
      summary.final_cost = system.cost();
    } else {
      backup.restore(window, features);
      rejected = true;
      damping = std::max(1e-4, 10.0 * damping);
    }
    if (last || damping > kMaxDamping) break;
  }
  return summary;
}

SolveSummary solveAtRest(Window& window, const std::vector<WindowFeature*>& features,
                         std::size_t first_free, const SolveOptions& options) {
  SolveSummary summary;
  FactorSelection selection = FactorSelection::all(window);
  LinearSystem system(options.loss, options.still);
  // Without images nothing tells where the cameras sit: only gravity moves of the globals, else the
  // prior would pull the cameras away from what the window's pictures have shown.
  constexpr Eigen::Index kGravity = Window::kGravitySize;
  const auto begin = kState * static_cast<Eigen::Index>(first_free);
  const auto free_rows =
      kState * static_cast<Eigen::Index>(window.frames.size() - first_free) + kGravity;
  summary.initial_cost = system.linearise(window, selection);
  for (; summary.iterations < options.max_iterations; ++summary.iterations) {
    system.reduce(0.0);
    const Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> llt(
        system.reducedH().block(begin, begin, free_rows, free_rows));
    if (llt.info() != Eigen::Success) return summary;
    const Eigen::VectorXd step = -llt.solve(system.reducedB().segment(begin, free_rows));
    if (!step.allFinite()) return summary;
    for (std::size_t i = first_free; i < window.frames.size(); ++i) {
      window.frames[i].apply(
          step.segment<kState>(kState * static_cast<Eigen::Index>(i - first_free)));
    }
    Eigen::VectorXd globals = Eigen::VectorXd::Zero(window.globalSize());
    globals.head<kGravity>() = step.tail<kGravity>();
    window.applyGlobals(globals);
    const double promised = -0.5 * system.gradient().segment(begin, free_rows).dot(step);
    summary.final_cost = system.linearise(window, selection);
    if (promised < options.min_decrease) break;
  }
  summary.ok = true;
  selection.features = features;
  system.linearise(window, selection);
  summary.observations = system.numObservations();
  system.reduce(0.0);
  const Eigen::LLT<Eigen::MatrixXd, Eigen::Lower> llt(system.reducedH());
  if (llt.info() == Eigen::Success) setCovariance(llt, window.globalSize(), summary);
  return summary;
}

double whitenedError(const Window& window, const WindowFeature& feature,
                     const WindowObservation& observation) {
  const WindowFrame* anchor = window.find(feature.anchor_frame_id);
  const WindowFrame* target = window.find(observation.frame_id);
  if (anchor == nullptr || target == nullptr) return std::numeric_limits<double>::infinity();
  const PoseMatrices anchor_pose(anchor->state);
  const PoseMatrices target_pose(target->state);
  Eigen::Vector2d pixel;
  const VioCamera& camera = window.cameras[static_cast<std::size_t>(observation.camera)];
  if (!reproject(window.cameras[static_cast<std::size_t>(feature.anchor_camera)], camera,
                 cameraPlace(camera, *target, observation), anchor_pose, target_pose, anchor_pose,
                 target_pose, feature.direction, feature.inverse_distance, pixel)) {
    return std::numeric_limits<double>::infinity();
  }
  return (pixel - observedPixel(window, observation)).norm() / observation.sigma_px;
}

Eigen::Matrix3d landmarkCovariance(const Window& window, const WindowFeature& feature) {
  const WindowFrame* anchor = window.find(feature.anchor_frame_id);
  if (anchor == nullptr) return Eigen::Matrix3d::Zero();
  const VioCamera& anchor_camera = window.cameras[static_cast<std::size_t>(feature.anchor_camera)];
  const PoseMatrices anchor_pose(anchor->state);
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  information(2, 2) = kPriorInverseDistanceInformation;
  for (const WindowObservation& o : feature.observations) {
    const WindowFrame* target = window.find(o.frame_id);
    if (target == nullptr) continue;
    const PoseMatrices target_pose(target->state);
    Eigen::Vector2d pixel;
    ReprojectionJacobians j;
    const VioCamera& camera = window.cameras[static_cast<std::size_t>(o.camera)];
    if (!reproject(anchor_camera, camera, cameraPlace(camera, *target, o), anchor_pose, target_pose,
                   anchor_pose, target_pose, feature.direction, feature.inverse_distance, pixel,
                   &j)) {
      continue;
    }
    const double sigma = feature.noise_factor * o.sigma_px;
    information += j.d_px_d_landmark.transpose() * j.d_px_d_landmark / (sigma * sigma);
  }
  // p = R (direction / rho): along the ray the inverse distance counts with -1 / rho^2.
  const double rho = feature.inverse_distance;
  Eigen::Matrix3d by_landmark;
  by_landmark.leftCols<2>() = tangentBasis(feature.direction) / rho;
  by_landmark.col(2) = -feature.direction / (rho * rho);
  const Eigen::Matrix3d J =
      anchor_pose.R * anchor_camera.T_imu_cam.rotation().matrix() * by_landmark;
  return J * information.inverse() * J.transpose();
}

}  // namespace parkade
