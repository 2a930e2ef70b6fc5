// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

#include "parkade/vio/linear_system.hpp"
#include "parkade/vio/window.hpp"

namespace parkade {

/// What a frame that left the window is, given the frames that stayed:
/// delta = -(offset + gain * deltas of frame_ids and, last, of the globals).
struct FrameConditional {
  int frame_id = 0;
  TimeNs t_ns = 0;
  NavState lin_state;
  std::vector<int> frame_ids;
  Eigen::Matrix<double, 15, Eigen::Dynamic> gain;
  Vector15d offset = Vector15d::Zero();
};

/// Takes one frame out of the window and turns all that was known of it into the window's prior:
/// the old prior, the readings before and after it, its motion terms, and the given landmarks with
/// all their observations (which must lie in keyframes; they are erased). Other landmarks lose
/// their observations of that frame. Frames that the new prior refers to get their point of
/// linearisation fixed. docs/math/marginalisation.md, eqs. (1) to (4).
FrameConditional marginaliseFrame(Window& window, int frame_id,
                                  const std::vector<WindowFeature*>& landmarks,
                                  const WindowLoss& loss, const StillSigma& still);

/// Removes a frame that no prior refers to, and its observations; `imu` are the readings between
/// its neighbours.
void dropFrame(Window& window, int frame_id, const Preintegration& imu);

}  // namespace parkade
