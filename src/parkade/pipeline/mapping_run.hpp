// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "parkade/camera/rig.hpp"
#include "parkade/core/options.hpp"
#include "parkade/core/progress.hpp"
#include "parkade/core/result.hpp"
#include "parkade/fusion/dead_reckoning.hpp"
#include "parkade/pipeline/avp_slam.hpp"
#include "parkade/pipeline/fused_mapper.hpp"
#include "parkade/pipeline/semantic_front_end.hpp"
#include "parkade/pipeline/stage_clock.hpp"
#include "parkade/tracking/options.hpp"
#include "parkade/tracking/tracker.hpp"
#include "parkade/types/pose_estimate.hpp"
#include "parkade/types/sensor_source.hpp"
#include "parkade/types/trajectory.hpp"
#include "parkade/vio/estimator.hpp"

namespace parkade {

struct PipelineOptions {
  TrackingOptions tracking;
  VioOptions vio;
  SemanticFrontEndOptions semantics;
  FusedMapperOptions fusion;
  DeadReckoningOptions reckoning;
  AvpSlamOptions avp_slam;
  int semantics_delay = 2;
  double pace = 0.0;
  bool live = false;

  void visit(OptionVisitor& v) {
    v.group("tracking", tracking);
    v.group("vio", vio);
    v.group("semantics", semantics);
    v.group("fusion", fusion);
    v.group("reckoning", reckoning);
    v.group("avp_slam", avp_slam);
    v.field(
        "semantics_delay", semantics_delay, "count",
        "Features of a frame set correct the pose this many frame sets later, however fast they "
        "are: poses wait for networks only where these take longer than that.",
        0, 50);
    v.field("pace", pace, "ratio",
            "Frame sets are taken no faster than so many times the pace of their stamps, as a "
            "car's cameras give them at 1; 0: as fast as they can be read. Changes no result.",
            0.0, 1000.0);
    v.field("live", live,
            "Poses never wait for features: late ones enter when they are ready, and pictures are "
            "passed over meanwhile; so are frame sets that the odometry is late for. Changes "
            "results where the computer does not keep up.");
  }
};

/// What the front end made of one frame set.
struct TracksEvent {
  const FrameSet& frames;
  const MotionPrior& prior;
  const TrackSet& tracks;
  const TrackingReport& report;
};

/// What the estimator made of it.
struct PoseEvent {
  int index = 0;  ///< of the frame set
  int num_tracks = 0;
  const PoseEstimate& estimate;  ///< no pose yet while the health is kInitialising
  const VioStatistics& statistics;
  const PoseEstimate& odometry;  ///< that the estimate rests on; the same where nothing else does
  RigSigma rig_sigma;            ///< by then
};

/// What was seen on the ground in one frame set.
struct FeaturesEvent {
  const BevImage& picture;  ///< all cameras stitched
  const SemanticFrame& features;
};

/// Features have entered the map.
struct MapEvent {
  const SemanticFrame& features;
  const SE3& T_odom_vehicle;  ///< of their frame set
  const LocalMap* local_map;  ///< in the odometry's frame; null where the method keeps none
};

/// What a run works with.
enum class RunMethod {
  kVis,       ///< key points and the inertial unit
  kFused,     ///< and semantic features, with a map
  kSemantic,  ///< wheels, gyroscope and semantic features, with a map; no key points
  kAvpSlam,   ///< wheels, gyroscope and semantic points by AVP-SLAM's scheme
};

/// Looks on while a run goes. The frame sets come in their order to each of the four; with two
/// threads or more, onPose and onMap come from another thread than onTracks, and onFeatures from a
/// third one. The last two come only with methods that use semantics, and not for every frame set.
class PipelineObserver {
 public:
  virtual ~PipelineObserver() = default;
  virtual void onTracks(const TracksEvent&) {}
  virtual void onPose(const PoseEvent&) {}
  virtual void onFeatures(const FeaturesEvent&) {}
  virtual void onMap(const MapEvent&) {}
};

/// What a run did, apart from its poses.
struct RunSummary {
  int frame_sets = 0;  ///< that poses were looked for in
  int poses = 0;
  double recorded_s = 0.0;    ///< between the first and the last frame set
  double processing_s = 0.0;  ///< wall time in which tracking, estimation or semantics were at work
  double reading_s = 0.0;     ///< wall time spent waiting for the source
  double wall_s = 0.0;
  double mean_tracks = 0.0;         ///< observations per frame set
  std::vector<StageTiming> stages;  ///< in their order; the last: latency, frame set to pose
  std::vector<int> images;          ///< usable images per camera
  int pictures_passed_over = 0;     ///< of these, what a live run took no time to map by
  int frame_sets_passed_over = 0;   ///< beside these: a live run lagged behind
  int pictures_repeated = 0;        ///< of a camera that gave its last one again, left out
};

/// The mapping run: source -> tracker -> estimator. The only owner of threads but for readers and
/// writers of recordings: tracking of frame set k runs beside the estimation of k - 1, and cameras
/// are shared out to threads that are idle.
///
/// The tracker's prior always comes from the state after frame set k - 2 and the IMU readings
/// since, whether k - 1 is done or not: the same input gives the same poses on any number of
/// threads. At most two frame sets are held, and as many more as pictures wait for
/// their features (semantics_delay). A frame set is processed when the first IMU reading
/// after it has come, so that the readings can be interpolated at its instant.
class MappingRun {
 public:
  /// Fails where the rig names a mask that cannot be read, or a network is missing or does not fit.
  static Result<std::unique_ptr<MappingRun>> create(const Rig& rig, const PipelineOptions& options,
                                                    int threads,
                                                    RunMethod method = RunMethod::kVis);
  ~MappingRun();

  /// Before run(): the world is to be that of a saved map, in which the car has to be found.
  /// trajectory() begins there; until then poses have the health kInitialising. Fails with methods
  /// that cannot.
  Status locateIn(const ParkingMap& map);
  /// Not owned; must live as long as run() does.
  void addObserver(PipelineObserver* observer);

  /// Reads the source to its end. An Error of the source ends the run; what was done until then
  /// stays in summary(), trajectory() and finalTrajectory().
  Status run(SensorSource& source, const ProgressCallback& progress = {});

  [[nodiscard]] const RunSummary& summary() const;
  /// The poses as they were known at their frame sets: fused ones where the method fuses.
  [[nodiscard]] const Trajectory& trajectory() const;
  /// The odometry's poses, as they were known at their frame sets.
  [[nodiscard]] const Trajectory& odometry() const;
  /// What made the map, finished when run() is over; null where the method has none.
  [[nodiscard]] const SemanticMapper* mapper() const;
  /// The same instants, estimated with all that came after.
  [[nodiscard]] Trajectory finalTrajectory() const;
  [[nodiscard]] std::vector<Landmark> landmarks() const;
  /// The cameras' calibration as refined while driving; empty where it is not refined.
  [[nodiscard]] std::vector<CameraCalibrationEstimate> calibration() const;

 private:
  class Impl;
  explicit MappingRun(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace parkade
