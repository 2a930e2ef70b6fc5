// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "parkade/fusion/pose_filter.hpp"
#include "parkade/types/pose_estimate.hpp"
#include "parkade/types/trajectory.hpp"

namespace parkade {

/// All poses of an odometry, hung on anchors that move afterwards: what a run's final trajectory is
/// made of.
class AnchoredHistory {
 public:
  /// An anchor at the pose with this index; poses from there on lie between it and the next. Call
  /// it in the order of the poses.
  void beginAnchor(std::int64_t anchor, std::size_t at);
  void add(const PoseEstimate& odometry);
  [[nodiscard]] std::size_t size() const { return poses_.size(); }

  /// Every pose: the odometry's motion since the anchor before it, and back from the one after it,
  /// mixed by the share of poses in between; so that nothing jumps at anchors.
  [[nodiscard]] Trajectory trajectory(const std::function<GroundPose(std::int64_t)>& poseOf) const;

 private:
  struct Anchor {
    std::int64_t id = 0;
    std::size_t at = 0;  // index of its pose
  };
  std::vector<StampedPose> poses_;
  std::vector<Anchor> anchors_;
};

}  // namespace parkade
