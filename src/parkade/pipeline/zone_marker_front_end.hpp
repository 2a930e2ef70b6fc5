// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "parkade/camera/rig.hpp"
#include "parkade/core/options.hpp"
#include "parkade/core/result.hpp"
#include "parkade/pipeline/sign_follower.hpp"
#include "parkade/semantics/texts/zone_marker_faces.hpp"
#include "parkade/semantics/texts/zone_marker_tracker.hpp"
#include "parkade/semantics/texts/zone_text_reader.hpp"
#include "parkade/types/level_view.hpp"
#include "parkade/types/pose_estimate.hpp"
#include "parkade/types/samples.hpp"
#include "parkade/types/semantic_features.hpp"

namespace parkade {

struct ZoneMarkerFrontEndOptions {
  bool enabled = true;
  std::string network;
  std::string reader;
  std::string letters = kZoneLetters;
  int views = 1;
  ZoneMarkerFaceOptions faces;
  ZoneMarkerTrackerOptions tracker;
  SignFollowerOptions signs;

  void visit(OptionVisitor& v) {
    v.field("enabled", enabled, "Whether zone markers are looked for in the cameras' pictures.");
    v.field("network", network,
            "Class map of the network for camera views; empty: the one that comes along.");
    v.field("reader", reader, "Network that reads zone texts; empty: the one that comes along.");
    v.field("letters", letters, "Characters that zones are named with.");
    v.field("views", views, "count",
            "Cameras whose pictures are looked at each time; all take their turns.", 1, 64);
    v.group("faces", faces);
    v.group("tracker", tracker);
    v.group("signs", signs);
  }
};

/// Zone markers on pillars and signs, from the cameras' own pictures: labels some of them in turn,
/// reads what is in sight and places it by several views. Not thread-safe.
class ZoneMarkerFrontEnd {
 public:
  /// Null where it is switched off, or where Parkade's own networks are not installed (which is
  /// logged). Fails where a network that the options name cannot be used, or one that is installed
  /// is broken. masks: of the own body, one a camera, empty ones for those that have none
  /// (readBodyMasks()).
  static Result<std::unique_ptr<ZoneMarkerFrontEnd>> create(
      const Rig& rig, std::vector<cv::Mat> masks, const ZoneMarkerFrontEndOptions& options);
  ~ZoneMarkerFrontEnd();

  /// The camera sits elsewhere than the rig said.
  void moveCamera(int camera, const SE3& T_vehicle_cam);

  /// The markers and signs that have become well enough known by this frame set, in its levelled
  /// vehicle frame; each rests on views of its own. odometry: of this frame set. In order of time.
  Result<std::vector<ObjectObservation>> look(const FrameSet& frames, const PoseEstimate& odometry,
                                              const GroundAttitude& attitude);

  /// The labels of the cameras that the last look() looked at.
  [[nodiscard]] const std::vector<LevelView>& views() const;

 private:
  struct Impl;
  explicit ZoneMarkerFrontEnd(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace parkade
