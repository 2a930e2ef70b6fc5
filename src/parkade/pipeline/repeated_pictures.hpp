// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "parkade/camera/rig.hpp"
#include "parkade/types/motion_prior.hpp"
#include "parkade/types/samples.hpp"

namespace parkade {

/// Takes out the pictures that a camera, or what reads it, gives again instead of new ones: they
/// would say that the car stands, and show what was around it before. A sensor's noise never gives
/// the same picture twice, but a simulator without noise does where nothing moves; a repeated
/// picture is therefore left where the car may stand.
class RepeatedPictures {
 public:
  explicit RepeatedPictures(const Rig& rig);

  /// Compares with each camera's last picture, every 16th row of it. moves: other sensors say that
  /// the car does. Empties what repeats then; returns how many these are.
  int drop(FrameSet& frames, bool moves);

 private:
  struct Last {
    std::string camera;
    std::size_t rows = 0;  // hash of what was compared
    bool said = false;     // in the log, once for each time that pictures stop
  };
  std::vector<Last> last_;
};

/// Whether wheels turn faster than they seem to at rest.
bool saysMotion(const std::vector<WheelSample>& wheels);

/// Whether the car moves between two frame sets, by the odometry's state and the inertial unit; far
/// above what both say of one that stands.
bool saysMotion(const MotionPrior& prior);

}  // namespace parkade
