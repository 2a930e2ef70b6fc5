// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/pipeline/anchored_history.hpp"

#include "parkade/core/check.hpp"
#include "parkade/fusion/odometry.hpp"

namespace parkade {
namespace {

// The pose that the odometry's motion from (or back to) an anchor tells.
GroundPose carried(const GroundPose& anchor, const SE3& T_odom_anchor, const SE3& T_odom_vehicle) {
  GroundPose pose;
  pose.T_world_vehicle =
      anchor.T_world_vehicle * SE2::fromSE3(T_odom_anchor).inverse() * SE2::fromSE3(T_odom_vehicle);
  pose.z = anchor.z + T_odom_vehicle.translation().z() - T_odom_anchor.translation().z();
  return pose;
}

}  // namespace

void AnchoredHistory::beginAnchor(std::int64_t anchor, std::size_t at) {
  PARKADE_CHECK(at < poses_.size() && (anchors_.empty() || at >= anchors_.back().at),
                "an anchor at pose {} of {}", at, poses_.size());
  anchors_.push_back({anchor, at});
}

void AnchoredHistory::add(const PoseEstimate& odometry) {
  poses_.push_back({odometry.t_ns, odometry.T_odom_vehicle});
}

Trajectory AnchoredHistory::trajectory(
    const std::function<GroundPose(std::int64_t)>& poseOf) const {
  Trajectory result;
  if (anchors_.empty()) return poses_;
  std::vector<GroundPose> anchors;
  for (const Anchor& anchor : anchors_) anchors.push_back(poseOf(anchor.id));
  std::size_t next = 0;  // the first anchor after the pose
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    while (next < anchors_.size() && anchors_[next].at <= i) ++next;
    const SE3& T_odom_vehicle = poses_[i].T_world_body;
    const auto from = [&](std::size_t k) {
      return carried(anchors[k], poses_[anchors_[k].at].T_world_body, T_odom_vehicle);
    };
    GroundPose pose = from(next == 0 ? 0 : next - 1);
    if (next > 0 && next < anchors_.size()) {
      const GroundPose back = from(next);
      // next is the first anchor beyond i, so that the two differ.
      const double share = static_cast<double>(i - anchors_[next - 1].at) /
                           static_cast<double>(anchors_[next].at - anchors_[next - 1].at);
      const Eigen::Vector3d step = (pose.T_world_vehicle.inverse() * back.T_world_vehicle).log();
      pose.T_world_vehicle = pose.T_world_vehicle * SE2::exp(share * step);
      pose.z += share * (back.z - pose.z);
    }
    result.push_back({poses_[i].t_ns, liftPose(pose.T_world_vehicle, pose.z, T_odom_vehicle)});
  }
  return result;
}

}  // namespace parkade
