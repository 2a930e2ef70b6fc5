// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "parkade/camera/rig.hpp"
#include "parkade/core/options.hpp"
#include "parkade/core/result.hpp"
#include "parkade/semantics/bev_views.hpp"
#include "parkade/semantics/markings/painted_numbers.hpp"
#include "parkade/semantics/texts/speed_limits.hpp"
#include "parkade/types/pose_estimate.hpp"
#include "parkade/types/samples.hpp"
#include "parkade/types/semantic_features.hpp"

namespace parkade {

struct PaintedNumberFrontEndOptions {
  bool enabled = true;
  std::string reader;
  std::string letters = "0123456789";
  std::string limits = kUsualLimits;
  double distance_m = 0.3;
  int max_reads = 3;
  PaintedNumberOptions numbers;

  void visit(OptionVisitor& v) {
    v.field("enabled", enabled, "Whether numbers painted in slots and speed limits are read.");
    v.field("reader", reader, "Network that reads them; empty: the one that comes along.");
    v.field(
        "letters", letters,
        "What numbers are made of: letters look like digits. Empty: all that the network knows.");
    v.field("limits", limits, "What painted speed limits may say.");
    v.field("distance_m", distance_m, "m", "The car moves this far between two readings.", 0.0,
            10.0);
    v.field("max_reads", max_reads, "count", "Numbers that are read each time, best seen first.", 1,
            1000);
    v.group("numbers", numbers);
  }
};

/// Reads the numbers painted in slots, and painted speed limits, from the cameras' own pictures,
/// which are finer than the stitched one near the car. A garage's numbers all face the same way,
/// who enters or who leaves a slot: which, the readings tell together. Limits are read
/// whichever way they face. Not thread-safe.
class PaintedNumberFrontEnd {
 public:
  /// Null where it is switched off, or where Parkade's own reader is not installed (which is
  /// logged). Fails where a network that the options name cannot be used, or one that is installed
  /// is broken. masks: of the own body, one a camera, empty ones for those that have none.
  static Result<std::unique_ptr<PaintedNumberFrontEnd>> create(
      const Rig& rig, std::vector<cv::Mat> masks, const PaintedNumberFrontEndOptions& options);
  ~PaintedNumberFrontEnd();

  /// The camera sits elsewhere than the rig said.
  void moveCamera(int camera, const SE3& T_vehicle_cam);

  /// Enters what is read in the frame's slots and painted numbers. views: of the stitched picture
  /// that the frame comes from, by camera of the rig. odometry: of this frame set.
  Status read(const FrameSet& frames, const BevViews& views, const PoseEstimate& odometry,
              SemanticFrame& frame);

 private:
  struct Impl;
  explicit PaintedNumberFrontEnd(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace parkade
