// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>

#include "parkade/tracking/tracker.hpp"

namespace parkade {

/// A picture of what the front end saw: all cameras tiled; features as dots with the way they came,
/// from blue (new) to red (followed for 40 frames and more), with a ring where another camera
/// shares them and a number where their depth is known (metres); crosses where one was lost, by
/// reason. previous gives the ways (may be empty); caption stands in the first line. CV_8UC3.
cv::Mat drawTracks(const FrameSet& frames, const TrackSet& tracks, const TrackSet& previous,
                   const TrackingReport& report, const MotionPrior& prior, const Rig& rig,
                   const std::string& caption);

}  // namespace parkade
