// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "parkade/camera/rig.hpp"
#include "parkade/tracking/options.hpp"
#include "parkade/types/motion_prior.hpp"
#include "parkade/types/samples.hpp"
#include "parkade/types/track.hpp"

namespace parkade {

/// Runs body(0) .. body(count - 1) in any order, possibly at once, and returns when all are done.
/// The pipeline passes one with threads; without one the tracker works in the caller's thread.
using ParallelFor = std::function<void(int count, const std::function<void(int)>& body)>;

/// Why a feature ended.
enum class TrackLoss { kFlow, kBackward, kPatch, kMotion, kEpipolar, kMask };
const char* toString(TrackLoss loss);

/// What happened in the last frame set besides the tracks: for pictures, figures and tests.
struct TrackingReport {
  struct Lost {
    int camera = 0;
    std::uint64_t id = 0;
    Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< where it was, or would have been
    TrackLoss why = TrackLoss::kFlow;
  };
  struct CrossMatched {
    std::uint64_t id = 0;
    int from_camera = 0;
    int to_camera = 0;
    double inverse_depth = 0.0;  ///< 1/m along the first camera's ray
  };
  std::vector<Lost> lost;
  std::vector<CrossMatched> matched;  ///< new in this frame set
  std::vector<double> motion_rms_px;  ///< per camera: epipolar distance of the features kept
  int detected = 0;
  int renewed = 0;  ///< features that took a new patch
};

/// The front end: turns images into tracks. Corners spread over each image, followed by pyramidal
/// flow from a predicted start, aligned with the patch of their first picture, judged by the
/// camera's motion, and shared between cameras that overlap. docs/math/tracking.md.
///
/// The result depends on the images, priors and options alone, not on the threads.
class Tracker {
 public:
  Tracker(const Rig& rig, const TrackingOptions& options);
  ~Tracker();
  Tracker(Tracker&&) noexcept;
  Tracker& operator=(Tracker&&) noexcept;

  /// Follows all features into this frame set. The prior speaks of the motion since the previous
  /// frame set given (valid = false where nothing is known). Images of another size than the rig's
  /// count as absent.
  TrackSet track(const FrameSet& frames, const MotionPrior& prior);

  /// Hides a part of a camera's images for good (0: hidden; CV_8UC1 of the image's size), such as
  /// the own body, and what lies so near to it that a feature's patch would show it;
  /// readBodyMasks() reads those of a rig.
  void setMask(int camera, const cv::Mat& mask);
  /// The same for the next frame set only: vehicles and people.
  void setDynamicMask(int camera, const cv::Mat& mask);
  void setParallel(ParallelFor parallel);

  [[nodiscard]] const TrackingReport& report() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace parkade
