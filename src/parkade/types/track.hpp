// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "parkade/core/time.hpp"

namespace parkade {

/// A feature as one camera sees it in one frame set. What the estimator consumes.
struct TrackObservation {
  std::uint64_t id = 0;  ///< of the feature; the same in every camera that was matched to it
  int camera = 0;        ///< index in the rig
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< distorted image, integer = pixel centre
  int age = 1;            ///< frames that this camera has followed it, this one counted
  double sigma_px = 1.0;  ///< standard deviation of each coordinate
};

/// Everything the front end says of one frame set.
struct TrackSet {
  TimeNs t_ns = 0;
  std::vector<TrackObservation> observations;  ///< ordered by camera, then id
  std::vector<std::uint8_t> camera_ok;  ///< 0: the camera gave no usable image (absent, dark)
};

}  // namespace parkade
