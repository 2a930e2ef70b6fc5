// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <map>
#include <vector>

#include "parkade/types/trajectory.hpp"
#include "parkade/vio/marginalisation.hpp"
#include "parkade/vio/window.hpp"

namespace parkade {

/// Frames that left the window. Each marginalised frame is kept as what it is given the frames that
/// stayed, so that later knowledge flows back to it (back-substitution;
/// docs/math/marginalisation.md, eq. (6)); other frames are kept relative to the keyframe before
/// them. Only the newest max_conditionals matrices are kept, older frames become plain poses:
/// memory is bounded but for one pose per frame.
class VioHistory {
 public:
  explicit VioHistory(std::size_t max_conditionals = 200) : max_conditionals_(max_conditionals) {}

  /// A frame that was dropped, relative to a frame that is still in the window.
  void addDropped(const WindowFrame& frame, const WindowFrame& reference);
  void addMarginalised(FrameConditional conditional, const Window& window);
  /// The window is given up: its frames and all before become plain poses.
  void freeze(const Window& window);

  /// All vehicle poses in the order of time, given the window as it is now, turned about the
  /// odom frame's origin so that z points up.
  [[nodiscard]] Trajectory trajectory(const Window& window) const;

 private:
  struct Relative {
    TimeNs t_ns = 0;
    int reference_id = 0;
    SE3 T_reference_frame;
  };
  struct Plain {
    TimeNs t_ns = 0;
    SE3 T_odom_imu;
  };
  /// Poses of the conditionals by frame id, newest knowledge included.
  [[nodiscard]] std::map<int, Plain> smoothed(const Window& window) const;

  std::size_t max_conditionals_;
  std::deque<FrameConditional> conditionals_;
  std::map<int, Plain> plain_;
  std::vector<Relative> relatives_;
};

}  // namespace parkade
