// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <vector>

#include "parkade/types/track.hpp"
#include "parkade/vio/options.hpp"
#include "parkade/vio/triangulation.hpp"
#include "parkade/vio/window.hpp"

namespace parkade {

/// What the gate found in a new frame.
struct GateResult {
  int checked = 0;
  int rejected = 0;
  std::vector<int> cameras;  ///< that contradict the prediction as a whole
  /// Half of the cameras or more do, and at least two: then the prediction is not believed, nothing
  /// is rejected, and no feature's failures are counted until the next frame.
  bool contradicted = false;
};

/// Keeps the window's features: takes observations in, refuses those that contradict the IMU's
/// prediction, places points, chooses which take part, removes what misses after a solve.
class FeatureManager {
 public:
  explicit FeatureManager(const VioOptions& options) : options_(options) {}

  /// Turns one frame set's tracks into observations; those without a ray are left out.
  static Observations observationsOf(const std::vector<VioCamera>& cameras, const TrackSet& tracks,
                                     int frame_id);

  void add(Window& window, const Observations& observations);

  /// Compares the newest frame's observations of placed features with the predicted state. `spread`
  /// is the covariance of the newest frame's pose relative to the frames before it (position,
  /// rotation). A camera most of whose features miss loses all of them: a car that fills its view
  /// moves its features alike, so that a robust loss alone would follow it. Where most cameras
  /// would, the frame is left as it is.
  GateResult gateNewest(Window& window, const Eigen::Matrix<double, 6, 6>& spread,
                        bool is_sure = false);

  /// Places features without a point.
  void triangulateNew(Window& window);

  /// The features of the next solve: those of the last one, filled up to the budget, spread over
  /// cameras and image regions, longest tracks first. Where next to none of them is in sight, those
  /// unseen for long make room.
  std::vector<WindowFeature*> select(Window& window);

  /// Removes observations that miss by more than the limit; returns how many. What the others miss
  /// their landmarks by becomes the landmarks' noise factors (docs/math/residuals.md, eq. 3b).
  int rejectOutliers(Window& window, const std::vector<WindowFeature*>& features);

  /// Forgets failures, for the states that caused them have been replaced.
  void forgive(Window& window);
  void clear() {
    banned_.clear();
    contradicted_ = false;
  }

 private:
  VioOptions options_;
  std::set<std::uint64_t> banned_;  ///< features that contradicted too often, while still tracked
  bool contradicted_ = false;       ///< the newest frame's prediction
};

}  // namespace parkade
