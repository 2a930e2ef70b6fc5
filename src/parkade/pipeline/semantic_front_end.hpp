// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "parkade/bev/ground_plane.hpp"
#include "parkade/bev/stitcher.hpp"
#include "parkade/core/options.hpp"
#include "parkade/core/result.hpp"
#include "parkade/pipeline/late_cameras.hpp"
#include "parkade/pipeline/painted_number_front_end.hpp"
#include "parkade/pipeline/stage_clock.hpp"
#include "parkade/pipeline/thread_pool.hpp"
#include "parkade/pipeline/zone_marker_front_end.hpp"
#include "parkade/semantics/lines/label_lines.hpp"
#include "parkade/semantics/lines/line_extraction.hpp"
#include "parkade/semantics/slots/slot_extraction.hpp"
#include "parkade/semantics/standing/agent_tracker.hpp"
#include "parkade/semantics/standing/object_extraction.hpp"
#include "parkade/semantics/standing/raised_points.hpp"
#include "parkade/semantics/standing/smear_finder.hpp"
#include "parkade/types/landmark.hpp"
#include "parkade/types/pose_estimate.hpp"
#include "parkade/types/semantic_features.hpp"

namespace parkade {

struct SemanticFrontEndOptions {
  std::string network;
  double distance_m = 0.4;
  double interval_s = 0.5;
  BevOptions bev;
  GroundPlaneOptions ground;
  LabelLineOptions lines;
  LineOptions slot_lines;
  SlotOptions slots;
  ObjectOptions objects;
  SmearOptions smear;
  RaisedPointOptions raised_points;
  AgentTrackerOptions agents;
  ZoneMarkerFrontEndOptions zone_markers;
  PaintedNumberFrontEndOptions painted_numbers;

  void visit(OptionVisitor& v) {
    v.field("network", network,
            "Class map of the network to use; empty: the one that comes along.");
    v.field("distance_m", distance_m, "m", "The car moves this far between two pictures.", 0.0,
            10.0);
    v.field("interval_s", interval_s, "s", "Or this time passes.", 0.01, 60.0);
    v.group("bev", bev);
    v.group("ground", ground);
    v.group("lines", lines);
    v.group("slot_lines", slot_lines);
    v.group("slots", slots);
    v.group("objects", objects);
    v.group("smear", smear);
    v.group("raised_points", raised_points);
    v.group("agents", agents);
    v.group("zone_markers", zone_markers);
    v.group("painted_numbers", painted_numbers);
  }
};

/// From the cameras' pictures to semantic features: stitches them on the floor that the odometry's
/// landmarks tell, labels the picture, and draws features from the labels; zone markers and
/// the numbers of slots come from the cameras' own pictures.
class SemanticFrontEnd {
 public:
  /// masks: of the own body, one a camera, empty ones for those that have none (readBodyMasks()).
  /// Fails where there is no network.
  static Result<std::unique_ptr<SemanticFrontEnd>> create(const Rig& rig,
                                                          const std::vector<cv::Mat>& masks,
                                                          const SemanticFrontEndOptions& options);
  ~SemanticFrontEnd();

  /// Takes the odometry of every frame set, in order; true where its pictures are due.
  bool addOdometry(const PoseEstimate& odometry, const std::vector<Landmark>& landmarks);
  /// The pictures of the last frame set will be looked at: look() must be called with them, once,
  /// in the order of these calls; in another thread if need be.
  void take();
  /// Where the cameras sit by what is known now, one a camera, and how the car moves: from the next
  /// look() on. Small moves are left until they add up.
  void placeCameras(const CamerasAtStamp& cameras);
  /// The features of the first frame set that was taken. The stitched picture and the cameras'
  /// own are looked at beside each other, by the caller and `beside`.
  Result<SemanticFrame> look(const FrameSet& frames, ThreadPool& beside);

  /// The stitched picture that the last look() saw.
  [[nodiscard]] const BevImage& picture() const;
  /// The labels of the cameras whose own pictures the last look() saw labelled; often a part of
  /// them.
  [[nodiscard]] const std::vector<LevelView>& views() const;

  [[nodiscard]] std::vector<StageTiming> timings() const;

 private:
  struct Impl;
  explicit SemanticFrontEnd(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace parkade
