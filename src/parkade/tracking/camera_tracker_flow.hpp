// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/types.hpp>

#include "parkade/tracking/camera_tracker.hpp"

// Internal to the camera's tracker, which is written in two sources.

namespace parkade {

/// Features nearer to the image's border are let go, px.
inline constexpr double kTrackBorderPx = 2.0;

/// A view on its way into the new picture.
struct CameraTracker::Flow {
  FeatureView view;
  Eigen::Vector2d predicted = Eigen::Vector2d::Zero();
  cv::Point2f found;
  bool alive = true;
  bool follows_prediction = true;  ///< a point or ray was predicted, not just the old place
  TrackLoss why = TrackLoss::kFlow;

  void drop(TrackLoss reason) {
    if (!alive) return;
    alive = false;
    why = reason;
  }
};

}  // namespace parkade
