// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "parkade/fusion/pose_filter.hpp"
#include "parkade/mapping/layers/wall_points.hpp"
#include "parkade/mapping/submap.hpp"
#include "parkade/pipeline/anchored_history.hpp"
#include "parkade/pipeline/fused_mapper.hpp"

// Inside of the fusing mapper: fused_mapper.cpp holds the flow and the map, fused_registration.cpp
// what corrects the pose, fused_relocalisation.cpp what finds the car in a saved map.

namespace parkade {

class FusedMapper::Impl {
 public:
  /// A stretch of the drive: an anchor of the filter, and what was seen from there on.
  struct Stretch {
    std::int64_t anchor = 0;
    TimeNs t_ns = 0;
    double begin_m = 0.0;  // way travelled
    double end_m = 0.0;
    Submap submap;
    GroundPose pose;        // as last known
    SE2 applied;            // that the map was made with
    double rig_turn = 0.0;  // mean of the frames in the submap
    SE3 T_odom_vehicle;
  };
  /// Where a picture was taken: an anchor that the filter holds until its features come.
  struct View {
    std::int64_t anchor = 0;
    PoseEstimate odometry;
    double travelled = 0.0;
    double turned = 0.0;
    std::size_t at = 0;  // pose of the history
  };

  /// A saved map that the car is to be found in, and then held to.
  struct Saved {
    explicit Saved(const ParkingMap& file) : map(file) {}
    SavedMap map;
    std::int64_t place = -1;    // of its origin, in the filter, once the car is found
    double found_at = 0.0;      // way travelled then
    bool told = false;          // frames have since said the same: poses are given out
    double confirmed_at = 0.0;  // way travelled when a picture last fitted there
    bool lost = false;          // the odometry lost the way there: it is searched anew
    double lost_at = 0.0;       // way travelled then
    bool gone = false;          // just now: what is seen from here on is looked for by itself
    double last_search = -1e9;
    std::optional<SE2> T_map_world;  // by the last search that told one
    std::string reason;              // why the last one told none
  };

  Impl(const FusedMapperOptions& o, std::vector<Eigen::Vector3d> cameras)
      : options(o),
        viewpoints(std::move(cameras)),
        compass(o.compass),
        compass_scatter(o.compass.sigma_deg * kDegree),
        rows(o.rows),
        local(o.local_map),
        global(o.global_map),
        slots(o.slots),
        objects(o.objects) {}

  PoseEstimate estimate() const;
  void predict(const PoseEstimate& odometry);
  void hold();
  void beginStretch(const View& view);
  void enterSubmap(const SemanticFrame& frame, const View& view);
  void enterMaps(const SemanticFrame& frame, const std::vector<LevelView>& level_views,
                 const View& view);
  void followCorrections();
  [[nodiscard]] std::vector<Eigen::Vector3d> wallPlaces() const;

  void readCompass(const SemanticFrame& frame, const View& view);
  void turnTo(double heading, double sigma, const View& view);
  void registerFrameToSubmaps(const SemanticFrame& frame, const View& view);
  void tryStretch(const SemanticFrame& frame, const View& view, std::size_t index, bool revisit);
  /// Lays a frame on a submap where it is expected, or, where that is known too badly and
  /// may_search, searches around it.
  [[nodiscard]] Registration registerAround(const SemanticFrame& frame, const Submap& submap,
                                            const SE2& expected, const Eigen::Matrix4d& covariance,
                                            bool may_search) const;
  void addLoopEdge(const Stretch& stretch, const Registration& fit, const View& view);

  void locate(const SemanticFrame& frame, const View& view);
  void searchSavedMap(const View& view);
  void settleInSavedMap(const Registration& fit, const View& view);
  void confirmPlace(const View& view);
  void lose(const View& view);
  void givePlaceUp(const std::string& reason);
  bool comeBack(const Registration& fit, const View& view);
  [[nodiscard]] bool isMapped(const View& view) const;
  void registerToSavedMap(const SemanticFrame& frame, const View& view);
  [[nodiscard]] Surroundings surroundings(const View& view) const;
  void rebase(const SE2& T_new_world, double dz);
  [[nodiscard]] bool located() const { return saved && saved->place >= 0; }

  Stretch& open() { return stretches.back(); }
  [[nodiscard]] SE2 poseOf(const View& view) const {
    return filter.anchor(view.anchor).T_world_vehicle;
  }
  /// Where a stretch's map belongs: cameras that are now known to be turned drew it turned.
  [[nodiscard]] SE2 placeOf(const Stretch& s) const {
    return s.pose.T_world_vehicle * SE2(rig_turn - s.rig_turn, {0.0, 0.0});
  }
  /// The view seen from an anchor.
  [[nodiscard]] SE2 between(std::int64_t anchor, const View& view) const {
    return filter.anchor(anchor).T_world_vehicle.inverse() * poseOf(view);
  }

  FusedMapperOptions options;
  std::vector<Eigen::Vector3d> viewpoints;
  Compass compass;
  CompassScatter compass_scatter;
  RowCompass rows;
  std::int64_t axes = -1;      // heading reference of the filter, once the compass has learned
  double axes_heading = 0.0;   // of that reference as it was then
  double axes_rig_turn = 0.0;  // and of the cameras
  double rig_turn = 0.0;       // of the newest frame
  PoseFilter filter;
  std::optional<Saved> saved;
  std::optional<PoseEstimate> odometry;  // newest
  std::optional<PoseEstimate> tracked;   // newest with a pose: odometry may start again
  AnchoredHistory history;
  double travelled = 0.0;
  double turned = 0.0;
  double turned_at_stretch = 0.0;
  std::deque<View> views;
  std::vector<Stretch> stretches;
  std::vector<PoseGraphEdge> edges;
  double last_entered = -1e9;
  double last_registered = -1e9;
  double last_judged = -1e9;  // way travelled when looks from there began to count
  int looks_here = 0;
  bool corrected = false;
  LocalMap local;
  GlobalMap global;
  SlotRegistry slots;
  ObjectRegistry objects;
  WallPoints wall_points;
  TimeNs last_t_ns = 0;
  FusedMapperStatistics statistics;
};

}  // namespace parkade
