// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/vio/history.hpp"

#include <algorithm>

namespace parkade {
namespace {

SE3 poseOf(const NavState& state) {
  return {state.R_odom_imu, state.p_odom};
}

SE3 moved(const NavState& state, const Vector15d& delta) {
  return {state.R_odom_imu * SO3::exp(delta.segment<3>(Preintegration::kRotation)),
          state.p_odom + delta.segment<3>(Preintegration::kPosition)};
}

// Turns gravity downwards, without a turn about the vertical.
SO3 levelOf(const Eigen::Vector3d& gravity) {
  return SO3::fromTwoVectors(gravity, -Eigen::Vector3d::UnitZ());
}

}  // namespace

void VioHistory::addDropped(const WindowFrame& frame, const WindowFrame& reference) {
  relatives_.push_back(
      {frame.t_ns, reference.id, poseOf(reference.state).inverse() * poseOf(frame.state)});
}

void VioHistory::addMarginalised(FrameConditional conditional, const Window& window) {
  conditionals_.push_back(std::move(conditional));
  if (conditionals_.size() <= max_conditionals_) return;
  // A quarter at once, so that the pass over all of them is rare.
  const std::map<int, Plain> poses = smoothed(window);
  const std::size_t keep = max_conditionals_ - max_conditionals_ / 4;
  while (conditionals_.size() > keep) {
    const int id = conditionals_.front().frame_id;
    plain_.emplace(id, poses.at(id));
    conditionals_.pop_front();
  }
}

void VioHistory::freeze(const Window& window) {
  for (const auto& [id, pose] : smoothed(window)) plain_.emplace(id, pose);
  conditionals_.clear();
  for (const WindowFrame& frame : window.frames) {
    plain_.emplace(frame.id, Plain{frame.t_ns, poseOf(frame.state)});
  }
}

std::map<int, VioHistory::Plain> VioHistory::smoothed(const Window& window) const {
  const Eigen::VectorXd globals = window.globalDelta();
  std::map<int, Vector15d> deltas;
  for (const WindowFrame& frame : window.frames) {
    if (frame.linearised) deltas.emplace(frame.id, frame.delta);
  }
  std::map<int, Plain> poses;
  for (auto it = conditionals_.rbegin(); it != conditionals_.rend(); ++it) {
    Vector15d delta = -it->offset - it->gain.rightCols(globals.size()) * globals;
    for (std::size_t k = 0; k < it->frame_ids.size(); ++k) {
      const auto known = deltas.find(it->frame_ids[k]);
      if (known == deltas.end()) continue;
      delta -= it->gain.middleCols<15>(15 * static_cast<Eigen::Index>(k)) * known->second;
    }
    deltas.emplace(it->frame_id, delta);
    poses.emplace(it->frame_id, Plain{it->t_ns, moved(it->lin_state, delta)});
  }
  return poses;
}

Trajectory VioHistory::trajectory(const Window& window) const {
  std::map<int, Plain> poses = smoothed(window);
  poses.insert(plain_.begin(), plain_.end());
  for (const WindowFrame& frame : window.frames) {
    poses.emplace(frame.id, Plain{frame.t_ns, poseOf(frame.state)});
  }
  const SE3 level(levelOf(window.gravity.vector), Eigen::Vector3d::Zero());
  Trajectory trajectory;
  for (const auto& [id, pose] : poses) {
    trajectory.push_back({pose.t_ns, level * pose.T_odom_imu * window.T_imu_vehicle});
  }
  for (const Relative& relative : relatives_) {
    const auto reference = poses.find(relative.reference_id);
    if (reference == poses.end()) continue;
    trajectory.push_back({relative.t_ns, level * reference->second.T_odom_imu *
                                             relative.T_reference_frame * window.T_imu_vehicle});
  }
  std::sort(trajectory.begin(), trajectory.end(),
            [](const StampedPose& a, const StampedPose& b) { return a.t_ns < b.t_ns; });
  return trajectory;
}

}  // namespace parkade
