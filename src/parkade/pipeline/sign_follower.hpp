// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "parkade/camera/camera.hpp"
#include "parkade/core/options.hpp"
#include "parkade/core/result.hpp"
#include "parkade/semantics/texts/speed_limits.hpp"
#include "parkade/semantics/texts/zone_marker_faces.hpp"
#include "parkade/semantics/texts/zone_marker_tracker.hpp"
#include "parkade/semantics/texts/zone_text_reader.hpp"
#include "parkade/types/semantic_class.hpp"

namespace parkade {

struct SignFollowerOptions {
  bool enabled = true;
  double text_confidence = 0.9;
  std::string limits = kUsualLimits;
  ZoneMarkerFaceOptions faces;
  ZoneMarkerTrackerOptions guide = hanging();
  ZoneMarkerTrackerOptions limit = plate();

  void visit(OptionVisitor& v) {
    v.field("enabled", enabled, "Whether guide signs and speed-limit signs are looked for.");
    v.field("text_confidence", text_confidence, "probability",
            "A sign's text is told when read this surely over all views.", 0.1, 0.999999);
    v.field("limits", limits, "Speed limits there are, with spaces between; others are misread.");
    v.group("faces", faces);
    v.group("guide", guide);
    v.group("limit", limit);
  }

  static ZoneMarkerTrackerOptions hanging() {
    ZoneMarkerTrackerOptions options;
    options.height_m = 0.45;
    options.height_sigma_m = 0.15;
    options.place_sigma_m = 0.15;  // what is seen of a wide one is seldom all of it
    options.told_sigma_m = 0.45;   // whoever drives at one sees little of how far it is
    options.told_views = 4;
    options.told_confidence = 0.0;
    return options;
  }
  static ZoneMarkerTrackerOptions plate() {
    ZoneMarkerTrackerOptions options = hanging();
    options.place_sigma_m = 0.08;
    options.told_views = 3;
    return options;
  }
};

/// A sign placed by several views.
struct FollowedSign {
  SemanticClass semantic_class = SemanticClass::kGuideSign;
  ZoneMarker sign;  ///< text: a limit's number, a guide sign's meaning; empty: not sure
};

/// Guide signs and speed-limit signs in the labels of the cameras' own pictures, followed and
/// placed as zone markers are. Not thread-safe.
class SignFollower {
 public:
  explicit SignFollower(const SignFollowerOptions& options);

  /// Takes one camera's picture; in order of time (checked). As findZoneMarkers(); T_up_cam: from
  /// the camera to a frame that stands still and has z up.
  Status add(const cv::Mat& labels, const cv::Mat& image, const cv::Mat& mask, const Camera& camera,
             const SE3& T_up_cam, TimeNs t_ns, ZoneTextReader& reader);

  /// The signs that have become well enough known since.
  std::vector<FollowedSign> takeTold();

 private:
  SignFollowerOptions options_;
  ZoneMarkerTracker guides_;
  ZoneMarkerTracker limits_;
  std::vector<std::string> limit_texts_;  ///< and that of a plain face
};

}  // namespace parkade
