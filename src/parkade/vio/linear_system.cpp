// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/vio/linear_system.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

namespace parkade {
namespace {

// Noise may push a far point beyond infinity. Stopping it at zero would pull all far points, and
// with them the scale, to one side; the projection is smooth there.
constexpr double kMinInverseDistance = -0.1;
constexpr double kMaxInverseDistance = 20.0;
constexpr double kBodyVelocityBend = 0.3;  // sigma, of Huber's loss
// Whitened error that stands for an observation that cannot be projected at all.
constexpr double kInvisibleCost = 50.0;

}  // namespace

FactorSelection FactorSelection::all(const Window& window) {
  FactorSelection s = none(window);
  s.prior = true;
  s.calibration = true;
  std::fill(s.imu.begin(), s.imu.end(), 1);
  std::fill(s.still.begin(), s.still.end(), 1);
  std::fill(s.unary.begin(), s.unary.end(), 1);
  return s;
}

FactorSelection FactorSelection::none(const Window& window) {
  FactorSelection s;
  s.prior = false;
  s.calibration = false;
  s.imu.assign(window.frames.size(), 0);
  s.still.assign(window.frames.size(), 0);
  s.unary.assign(window.frames.size(), 0);
  return s;
}

double LinearSystem::linearise(const Window& window, const FactorSelection& selection) {
  const int count = static_cast<int>(window.frames.size());
  globals_ = kState * count;
  const Eigen::Index size = globals_ + window.globalSize();
  H_.setZero(size, size);
  b_.setZero(size);
  cost_ = 0.0;
  num_observations_ = 0;
  landmarks_.clear();
  couplings_.clear();
  camera_couplings_.clear();
  poses_.resize(window.frames.size());
  poses_lin_.resize(window.frames.size());
  slot_.assign(window.frames.size(), -1);
  for (std::size_t i = 0; i < window.frames.size(); ++i) {
    poses_[i] = PoseMatrices(window.frames[i].state);
    poses_lin_[i] = PoseMatrices(window.frames[i].jacobianState());
  }
  if (selection.prior) addPrior(window);
  addImu(window, selection);
  addMotion(window, selection);
  if (selection.calibration) addCalibration(window);
  for (WindowFeature* feature : selection.features) {
    addFeature(window, *feature, selection.inverse_distance_information);
  }
  return cost_;
}

void LinearSystem::addPrior(const Window& window) {
  const WindowPrior& prior = window.prior;
  const int count = static_cast<int>(prior.frame_ids.size());
  if (count == 0) return;
  const Eigen::Index globals = window.globalSize();
  Eigen::VectorXd delta(kState * count + globals);
  delta.tail(globals) = window.globalDelta();
  std::vector<int> index(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    index[static_cast<std::size_t>(i)] =
        window.indexOf(prior.frame_ids[static_cast<std::size_t>(i)]);
    delta.segment<kState>(kState * i) =
        window.frames[static_cast<std::size_t>(index[static_cast<std::size_t>(i)])].delta;
  }
  const Eigen::VectorXd H_delta = prior.H * delta;
  const Eigen::VectorXd gradient = prior.b + H_delta;
  cost_ += 0.5 * delta.dot(H_delta) + prior.b.dot(delta);
  for (int i = 0; i < count; ++i) {
    const int row = kState * index[static_cast<std::size_t>(i)];
    b_.segment<kState>(row) += gradient.segment<kState>(kState * i);
    for (int j = 0; j <= i; ++j) {
      const int column = kState * index[static_cast<std::size_t>(j)];
      // Frame ids rise with the index, so this stays in the lower triangle.
      H_.block<kState, kState>(row, column) +=
          prior.H.block<kState, kState>(kState * i, kState * j);
    }
    H_.block(globals_, row, globals, kState) +=
        prior.H.block(kState * count, kState * i, globals, kState);
  }
  b_.tail(globals) += gradient.tail(globals);
  H_.bottomRightCorner(globals, globals) += prior.H.bottomRightCorner(globals, globals);
}

void LinearSystem::addPair(int i, int j, const Matrix15d& hii, const Matrix15d& hji,
                           const Matrix15d& hjj) {
  H_.block<kState, kState>(kState * i, kState * i) += hii;
  H_.block<kState, kState>(kState * j, kState * i) += hji;
  H_.block<kState, kState>(kState * j, kState * j) += hjj;
}

void LinearSystem::addImu(const Window& window, const FactorSelection& selection) {
  for (std::size_t k = 1; k < window.frames.size(); ++k) {
    if (selection.imu[k] == 0 || !window.frames[k].imu) continue;
    const int i = static_cast<int>(k) - 1;
    const int j = static_cast<int>(k);
    Matrix15d by_i;
    Matrix15d by_j;
    Matrix15x2d by_gravity;
    Vector15d r = imuResidual(window.frames[k - 1], window.frames[k], window.gravity, &by_i, &by_j,
                              &by_gravity);
    cost_ += 0.5 * r.head<9>().squaredNorm();
    // Biases wander, and now and then they jump.
    for (const int walk : {Preintegration::kBiasGyro, Preintegration::kBiasAccel}) {
      const RobustValue term = logarithmic(r.segment<3>(walk).squaredNorm(), loss_.bias_step);
      cost_ += 0.5 * term.rho;
      const double root = std::sqrt(term.weight);
      r.segment<3>(walk) *= root;
      by_i.middleRows<3>(walk) *= root;
      by_j.middleRows<3>(walk) *= root;
      by_gravity.middleRows<3>(walk) *= root;
    }
    b_.segment<kState>(kState * i).noalias() += by_i.transpose() * r;
    b_.segment<kState>(kState * j).noalias() += by_j.transpose() * r;
    addPair(i, j, by_i.transpose() * by_i, by_j.transpose() * by_i, by_j.transpose() * by_j);
    b_.segment<2>(globals_).noalias() += by_gravity.transpose() * r;
    H_.block<2, kState>(globals_, kState * i).noalias() += by_gravity.transpose() * by_i;
    H_.block<2, kState>(globals_, kState * j).noalias() += by_gravity.transpose() * by_j;
    H_.block<2, 2>(globals_, globals_).noalias() += by_gravity.transpose() * by_gravity;
  }
}

void LinearSystem::addStart(const Window& window, const WindowFrame& frame, int index) {
  Matrix15d by_frame;
  const Vector15d r = startResidual(frame, window.start, &by_frame);
  cost_ += 0.5 * r.squaredNorm();
  b_.segment<kState>(kState * index).noalias() += by_frame.transpose() * r;
  H_.block<kState, kState>(kState * index, kState * index) += by_frame.transpose() * by_frame;
  Eigen::Matrix2d by_gravity;
  const Eigen::Vector2d tilt = gravityResidual(window.gravity, window.start, &by_gravity);
  cost_ += 0.5 * tilt.squaredNorm();
  b_.segment<2>(globals_) += by_gravity.transpose() * tilt;
  H_.block<2, 2>(globals_, globals_) += by_gravity.transpose() * by_gravity;
}

void LinearSystem::addCalibration(const Window& window) {
  for (std::size_t c = 0; c < window.refinements.size(); ++c) {
    CalibrationMatrix by_camera;
    const CalibrationVector off =
        calibrationResidual(window.cameras[c], window.refinements[c], &by_camera);
    const Eigen::Index row = cameraRow(static_cast<int>(c));
    cost_ += 0.5 * off.squaredNorm();
    b_.segment<kCalibration>(row) += by_camera.transpose() * off;
    H_.block<kCalibration, kCalibration>(row, row) += by_camera.transpose() * by_camera;
  }
}

void LinearSystem::addMotion(const Window& window, const FactorSelection& selection) {
  for (std::size_t k = 0; k < window.frames.size(); ++k) {
    const WindowFrame& frame = window.frames[k];
    const int j = static_cast<int>(k);
    if (selection.unary[k] != 0 && frame.id == window.start.frame_id) {
      addStart(window, frame, j);
    }
    if (selection.unary[k] != 0 && frame.body_velocity_sigma.maxCoeff() > 0.0) {
      Matrix3x15d by_frame;
      const Eigen::Vector3d r = bodyVelocityResidual(frame, window.T_imu_vehicle, &by_frame);
      // Wheels slip and cars cross bumps: bounded influence here as well.
      const RobustValue term = huber(r.squaredNorm(), kBodyVelocityBend);
      cost_ += 0.5 * term.rho;
      b_.segment<kState>(kState * j).noalias() += term.weight * by_frame.transpose() * r;
      H_.block<kState, kState>(kState * j, kState * j) +=
          term.weight * by_frame.transpose() * by_frame;
    }
    if (selection.still[k] != 0 && frame.still_since >= 0 && frame.still_since < frame.id) {
      const int i = window.indexOf(frame.still_since);
      if (i < 0) continue;
      Matrix9x15d by_rest;
      Matrix9x15d by_now;
      const Vector9d r = stillResidual(window.frames[static_cast<std::size_t>(i)], frame, still_,
                                       &by_rest, &by_now);
      cost_ += 0.5 * r.squaredNorm();
      b_.segment<kState>(kState * i).noalias() += by_rest.transpose() * r;
      b_.segment<kState>(kState * j).noalias() += by_now.transpose() * r;
      addPair(i, j, by_rest.transpose() * by_rest, by_now.transpose() * by_rest,
              by_now.transpose() * by_now);
    }
  }
}

void LinearSystem::addFeature(const Window& window, WindowFeature& feature,
                              double prior_information) {
  const int a = window.indexOf(feature.anchor_frame_id);
  if (a < 0) return;
  const auto anchor = static_cast<std::size_t>(a);
  const VioCamera& anchor_camera = window.cameras[static_cast<std::size_t>(feature.anchor_camera)];
  LandmarkBlock landmark;
  landmark.feature = &feature;
  landmark.first = static_cast<int>(couplings_.size());
  landmark.first_camera = static_cast<int>(camera_couplings_.size());
  const bool refine = !window.refinements.empty();
  CameraJacobians cameras;
  const double off_prior = feature.inverse_distance - kPriorInverseDistance;
  landmark.V(2, 2) = prior_information;
  landmark.b(2) = prior_information * off_prior;
  cost_ += 0.5 * prior_information * off_prior * off_prior;

  const auto coupling = [&](int frame) -> Matrix63d& {
    int& slot = slot_[static_cast<std::size_t>(frame)];
    if (slot < 0) {
      slot = static_cast<int>(couplings_.size());
      couplings_.push_back({frame, Matrix63d::Zero()});
    }
    return couplings_[static_cast<std::size_t>(slot)].W;
  };

  int last_frame_id = -1;
  int t = -1;
  for (WindowObservation& observation : feature.observations) {
    if (observation.frame_id != last_frame_id) {
      last_frame_id = observation.frame_id;
      t = window.indexOf(last_frame_id);
    }
    if (t < 0) continue;
    const auto target = static_cast<std::size_t>(t);
    Eigen::Vector2d pixel;
    ReprojectionJacobians j;
    const VioCamera& camera = window.cameras[static_cast<std::size_t>(observation.camera)];
    if (!reproject(anchor_camera, camera, cameraPlace(camera, window.frames[target], observation),
                   poses_[anchor], poses_[target], poses_lin_[anchor], poses_lin_[target],
                   feature.direction, feature.inverse_distance, pixel, &j,
                   refine ? &cameras : nullptr)) {
      cost_ += kInvisibleCost;
      continue;
    }
    ++num_observations_;
    if (refine) {
      const WindowFrame& frame = window.frames[target];
      Eigen::Matrix<double, 6, 1> motion;
      motion << frame.state.v_odom, frame.gyro - frame.bias.gyro;
      observation.pixel_rate = j.d_px_d_target * motion;
    }
    const double weight = 1.0 / (feature.noise_factor * observation.sigma_px);
    Eigen::Vector2d r = weight * (pixel - observedPixel(window, observation));
    const RobustValue term = loss_.views(r.squaredNorm());
    cost_ += 0.5 * term.rho;
    const double root = std::sqrt(term.weight);
    r *= root;
    j.d_px_d_landmark *= weight * root;
    landmark.V.noalias() += j.d_px_d_landmark.transpose() * j.d_px_d_landmark;
    landmark.b.noalias() += j.d_px_d_landmark.transpose() * r;
    j.d_px_d_anchor *= weight * root;
    j.d_px_d_target *= weight * root;
    if (refine) {
      addCameras(cameras, observation, weight * root, feature.anchor_camera, a, t, r, j, landmark);
    }
    if (t == a) continue;  // within one frame set the poses have no part
    coupling(a).noalias() += j.d_px_d_anchor.transpose() * j.d_px_d_landmark;
    coupling(t).noalias() += j.d_px_d_target.transpose() * j.d_px_d_landmark;
    b_.segment<6>(kState * a).noalias() += j.d_px_d_anchor.transpose() * r;
    b_.segment<6>(kState * t).noalias() += j.d_px_d_target.transpose() * r;
    H_.block<6, 6>(kState * a, kState * a).noalias() +=
        j.d_px_d_anchor.transpose() * j.d_px_d_anchor;
    H_.block<6, 6>(kState * t, kState * t).noalias() +=
        j.d_px_d_target.transpose() * j.d_px_d_target;
    if (t > a) {
      H_.block<6, 6>(kState * t, kState * a).noalias() +=
          j.d_px_d_target.transpose() * j.d_px_d_anchor;
    } else {
      H_.block<6, 6>(kState * a, kState * t).noalias() +=
          j.d_px_d_anchor.transpose() * j.d_px_d_target;
    }
  }
  landmark.count = static_cast<int>(couplings_.size()) - landmark.first;
  landmark.camera_count = static_cast<int>(camera_couplings_.size()) - landmark.first_camera;
  for (int k = landmark.first; k < landmark.first + landmark.count; ++k) {
    slot_[static_cast<std::size_t>(couplings_[static_cast<std::size_t>(k)].frame)] = -1;
  }
  landmarks_.push_back(landmark);
}

// The terms of the two cameras' calibration in one observation; j's Jacobians are whitened.
void LinearSystem::addCameras(const CameraJacobians& cameras, const WindowObservation& observation,
                              double weight, int anchor_camera, int anchor, int target,
                              const Eigen::Vector2d& r, const ReprojectionJacobians& j,
                              LandmarkBlock& landmark) {
  struct Part {
    int camera;
    PixelByCalibration J;
  };
  std::array<Part, 2> parts{Part{anchor_camera, PixelByCalibration::Zero()},
                            Part{observation.camera, PixelByCalibration::Zero()}};
  parts[0].J.leftCols<6>() = weight * cameras.d_px_d_anchor_camera;
  parts[1].J.leftCols<6>() = weight * cameras.d_px_d_target_camera;
  parts[1].J.col(6) = weight * observation.pixel_rate;
  parts[1].J.col(7) = weight * observation.row_share * observation.pixel_rate;
  int count = 2;
  if (parts[0].camera == parts[1].camera) {
    parts[0].J += parts[1].J;
    count = 1;
  }
  for (int k = 0; k < count; ++k) {
    const Part& part = parts[static_cast<std::size_t>(k)];
    const Eigen::Index row = cameraRow(part.camera);
    b_.segment<kCalibration>(row).noalias() += part.J.transpose() * r;
    H_.block<kCalibration, kCalibration>(row, row).noalias() += part.J.transpose() * part.J;
    if (target != anchor) {
      H_.block<kCalibration, 6>(row, kState * anchor).noalias() +=
          part.J.transpose() * j.d_px_d_anchor;
      H_.block<kCalibration, 6>(row, kState * target).noalias() +=
          part.J.transpose() * j.d_px_d_target;
    }
    const auto begin = camera_couplings_.begin() + landmark.first_camera;
    auto it = std::find_if(begin, camera_couplings_.end(),
                           [&](const CameraCoupling& c) { return c.camera == part.camera; });
    if (it == camera_couplings_.end()) {
      it = camera_couplings_.insert(camera_couplings_.end(),
                                    {part.camera, CalibrationByLandmark::Zero()});
    }
    it->W.noalias() += part.J.transpose() * j.d_px_d_landmark;
  }
  if (count == 2) {
    const bool ordered = parts[0].camera > parts[1].camera;
    const Part& low = parts[ordered ? 0 : 1];  // the lower triangle
    const Part& high = parts[ordered ? 1 : 0];
    H_.block<kCalibration, kCalibration>(cameraRow(low.camera), cameraRow(high.camera)).noalias() +=
        low.J.transpose() * high.J;
  }
}

void LinearSystem::reduceCameras(const LandmarkBlock& landmark, const Eigen::Vector3d& V_b) {
  const auto begin = camera_couplings_.begin() + landmark.first_camera;
  const auto end = begin + landmark.camera_count;
  for (auto row = begin; row != end; ++row) {
    const Eigen::Index at = cameraRow(row->camera);
    const CalibrationByLandmark Y = row->W * landmark.V_inverse;
    reduced_b_.segment<kCalibration>(at).noalias() -= row->W * V_b;
    for (int n = landmark.first; n < landmark.first + landmark.count; ++n) {
      const CouplingBlock& column = couplings_[static_cast<std::size_t>(n)];
      reduced_H_.block<kCalibration, 6>(at, kState * column.frame).noalias() -=
          Y * column.W.transpose();
    }
    for (auto column = begin; column != end; ++column) {
      if (column->camera > row->camera) continue;
      reduced_H_.block<kCalibration, kCalibration>(at, cameraRow(column->camera)).noalias() -=
          Y * column->W.transpose();
    }
  }
}

void LinearSystem::reduce(double damping) {
  reduced_H_ = H_;
  reduced_b_ = b_;
  reduced_H_.diagonal() *= 1.0 + damping;
  for (LandmarkBlock& landmark : landmarks_) {
    Eigen::Matrix3d V = landmark.V;
    V.diagonal() *= 1.0 + damping;
    landmark.V_inverse = V.inverse();
    const Eigen::Vector3d V_b = landmark.V_inverse * landmark.b;
    const auto first = static_cast<std::size_t>(landmark.first);
    const auto last = first + static_cast<std::size_t>(landmark.count);
    for (std::size_t m = first; m < last; ++m) {
      const CouplingBlock& row = couplings_[m];
      const Matrix63d Y = row.W * landmark.V_inverse;
      reduced_b_.segment<6>(kState * row.frame).noalias() -= row.W * V_b;
      for (std::size_t n = first; n < last; ++n) {
        const CouplingBlock& column = couplings_[n];
        if (column.frame > row.frame) continue;
        reduced_H_.block<6, 6>(kState * row.frame, kState * column.frame).noalias() -=
            Y * column.W.transpose();
      }
    }
    if (landmark.camera_count > 0) reduceCameras(landmark, V_b);
  }
}

void LinearSystem::applyToLandmarks(const Eigen::VectorXd& frame_step, double& gradient_dot_step) {
  for (LandmarkBlock& landmark : landmarks_) {
    Eigen::Vector3d right = landmark.b;
    const auto first = static_cast<std::size_t>(landmark.first);
    const auto last = first + static_cast<std::size_t>(landmark.count);
    for (std::size_t k = first; k < last; ++k) {
      right.noalias() +=
          couplings_[k].W.transpose() * frame_step.segment<6>(kState * couplings_[k].frame);
    }
    for (int k = landmark.first_camera; k < landmark.first_camera + landmark.camera_count; ++k) {
      const CameraCoupling& c = camera_couplings_[static_cast<std::size_t>(k)];
      right.noalias() += c.W.transpose() * frame_step.segment<kCalibration>(cameraRow(c.camera));
    }
    const Eigen::Vector3d step = -(landmark.V_inverse * right);
    gradient_dot_step += landmark.b.dot(step);
    WindowFeature& feature = *landmark.feature;
    feature.direction =
        (feature.direction + tangentBasis(feature.direction) * step.head<2>()).normalized();
    feature.inverse_distance =
        std::clamp(feature.inverse_distance + step.z(), kMinInverseDistance, kMaxInverseDistance);
  }
}

}  // namespace parkade
