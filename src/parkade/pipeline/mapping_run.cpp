// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/pipeline/mapping_run.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <future>
#include <opencv2/core/utility.hpp>
#include <optional>
#include <utility>

#include "parkade/core/check.hpp"
#include "parkade/pipeline/frame_packets.hpp"
#include "parkade/pipeline/late_cameras.hpp"
#include "parkade/pipeline/pace.hpp"
#include "parkade/pipeline/repeated_pictures.hpp"
#include "parkade/pipeline/semantic_parts.hpp"
#include "parkade/pipeline/semantic_queue.hpp"
#include "parkade/pipeline/settling.hpp"
#include "parkade/pipeline/thread_pool.hpp"
#include "parkade/tracking/overlap.hpp"
#include "parkade/vio/rig_error.hpp"

namespace parkade {
namespace {

using Clock = BusyTime::Clock;

bool hasPicture(const FrameSet& frames) {
  return std::any_of(frames.images.begin(), frames.images.end(),
                     [](const cv::Mat& image) { return !image.empty(); });
}

}  // namespace

class MappingRun::Impl {
 public:
  Impl(const Rig& rig, const PipelineOptions& options, int threads)
      : tracker(rig, options.tracking),
        estimator_(rig, options.vio),
        T_vehicle_imu_(rig.imu.T_vehicle_imu),
        repeated_(rig),
        semantics_delay_(options.semantics_delay),
        pace_(options.pace),
        live_(options.live),
        pool_(threads - 1) {
    tracker.setParallel([this](int count, const std::function<void(int)>& body) {
      pool_.parallelFor(count, body);
    });
    summary.images.assign(rig.cameras.size(), 0);
  }

  Status run(SensorSource& source, const ProgressCallback& progress);
  [[nodiscard]] const VioEstimator& estimator() const { return estimator_; }

  Tracker tracker;
  std::vector<PipelineObserver*> observers;
  RunSummary summary;
  Trajectory trajectory;
  Trajectory odometry;
  std::unique_ptr<SemanticMapper> mapper;
  std::unique_ptr<SemanticQueue> semantics;  // where there is a mapper
  std::unique_ptr<DeadReckoning> reckoning;  // instead of key points
  bool in_saved_map = false;

 private:
  // The estimator's part of one frame set; runs beside the tracking of the next.
  struct Estimation {
    FramePacket packet;
    int number = 0;  // counts frame sets
    TrackSet tracks;
    MotionPredictor state;  // after it
    std::future<void> done;
    Clock::time_point begin;
    Clock::time_point end;
  };

  void process(FramePacket packet);
  TrackSet track(FramePacket& packet);
  void finishEstimation();
  void settle();
  void estimate(Estimation& work);
  PoseEstimate odometryOf(const Estimation& work);
  void offerPictures(Estimation& work, const PoseEstimate& odometry_pose);
  MotionPrior predict(const FramePacket& packet);
  void summarise(Clock::time_point begin);

  VioEstimator estimator_;
  RigErrorOnWay rig_error_;
  SE3 T_vehicle_imu_;
  MotionPredictor state_;            // after the last frame set that finishEstimation() saw
  std::vector<ImuSample> last_imu_;  // of the last packet, which that state does not know
  std::optional<TimeNs> last_t_ns_;
  TimeNs first_t_ns_ = 0;
  std::int64_t observations_ = 0;
  RepeatedPictures repeated_;
  Settling settling_;
  std::unique_ptr<Estimation> running_;
  StageClock read_clock_{"read"};
  StageClock track_clock_{"track"};
  StageClock estimate_clock_{"estimate"};
  StageClock latency_clock_{"latency"};
  BusyTime busy_;
  int semantics_delay_ = 0;
  Pace pace_;
  bool live_ = false;
  ThreadPool pool_;  // last: the pools' threads use what is above
};

MotionPrior MappingRun::Impl::predict(const FramePacket& packet) {
  if (!last_t_ns_) return {};
  // Always the state two frame sets back (the estimation of the last one may still run), so that
  // the prior does not depend on who is faster.
  for (const ImuSample& sample : last_imu_) state_.addImu(sample);
  for (const ImuSample& sample : packet.imu) state_.addImu(sample);
  const TimeNs now = std::max(*last_t_ns_, packet.frames.t_ns);
  if (state_.valid()) return state_.predict(*last_t_ns_, now);
  std::vector<ImuSample> readings = last_imu_;
  readings.insert(readings.end(), packet.imu.begin(), packet.imu.end());
  return turnByGyroscope(readings, T_vehicle_imu_, *last_t_ns_, now);
}

TrackSet MappingRun::Impl::track(FramePacket& packet) {
  TrackSet tracks;
  const MotionPrior prior = reckoning == nullptr ? predict(packet) : MotionPrior{};
  const bool moves = saysMotion(packet.wheel) || saysMotion(prior);
  summary.pictures_repeated += repeated_.drop(packet.frames, moves);
  if (reckoning != nullptr) {
    tracks.t_ns = packet.frames.t_ns;
    for (std::size_t c = 0; c < packet.frames.images.size() && c < summary.images.size(); ++c) {
      summary.images[c] += packet.frames.images[c].empty() ? 0 : 1;
    }
    return tracks;
  }
  const Clock::time_point begin = Clock::now();
  tracks = tracker.track(packet.frames, prior);
  const Clock::time_point end = Clock::now();
  track_clock_.add(millisecondsBetween(begin, end));
  observations_ += static_cast<std::int64_t>(tracks.observations.size());
  for (std::size_t c = 0; c < tracks.camera_ok.size(); ++c)
    summary.images[c] += tracks.camera_ok[c];
  for (PipelineObserver* observer : observers) {
    observer->onTracks({packet.frames, prior, tracks, tracker.report()});
  }
  return tracks;
}

void MappingRun::Impl::process(FramePacket packet) {
  const Clock::time_point begin = Clock::now();
  TrackSet tracks = track(packet);
  const Clock::time_point end = Clock::now();
  finishEstimation();
  busy_.add(begin, end);
  last_t_ns_ = packet.frames.t_ns;
  last_imu_ = packet.imu;
  packet.frames.gray.clear();
  if (mapper == nullptr) packet.frames.images.clear();  // else the estimation labels them
  running_ = std::make_unique<Estimation>();
  running_->packet = std::move(packet);
  running_->tracks = std::move(tracks);
  running_->number = summary.frame_sets;
  running_->done = pool_.submit([this, work = running_.get()] { estimate(*work); });
}

PoseEstimate MappingRun::Impl::odometryOf(const Estimation& work) {
  if (reckoning != nullptr) {
    for (const ImuSample& sample : work.packet.imu) reckoning->addImu(sample);
    for (const WheelSample& sample : work.packet.wheel) reckoning->addWheel(sample);
    return reckoning->poseAt(work.packet.frames.t_ns);
  }
  for (const ImuSample& sample : work.packet.imu) estimator_.addImu(sample);
  for (const WheelSample& sample : work.packet.wheel) estimator_.addWheel(sample);
  return estimator_.addTracks(work.tracks);
}

void MappingRun::Impl::estimate(Estimation& work) {
  work.begin = Clock::now();
  if (semantics != nullptr) semantics->enterDue(work.number);
  const PoseEstimate estimate = odometryOf(work);
  work.state = estimator_.predictor();
  PoseEstimate fused = mapper == nullptr ? estimate : mapper->addOdometry(estimate);
  if (mapper != nullptr && semantics_delay_ == 0) {
    offerPictures(work, estimate);
    semantics->enterDue(work.number);
    fused = mapper->estimate();
  }
  const RigSigma rig_sigma = estimator_.rigSigma();
  if (estimate.health != Health::kInitialising) {
    if (!in_saved_map) {  // which tells the place, whatever the way to it
      rig_error_.advance(estimate.T_odom_vehicle, fused.T_odom_vehicle, rig_sigma);
      rig_error_.addTo(fused);
    }
    odometry.push_back({estimate.t_ns, estimate.T_odom_vehicle});
    if (fused.health != Health::kInitialising) {
      trajectory.push_back({fused.t_ns, fused.T_odom_vehicle});
    }
  }
  work.end = Clock::now();
  for (PipelineObserver* observer : observers) {
    observer->onPose({work.packet.frames.index, static_cast<int>(work.tracks.observations.size()),
                      fused, estimator_.statistics(), estimate, rig_sigma});
  }
  if (mapper != nullptr && semantics_delay_ > 0) offerPictures(work, estimate);
  work.packet.frames.images.clear();
}

void MappingRun::Impl::offerPictures(Estimation& work, const PoseEstimate& odometry_pose) {
  const bool tracked = reckoning != nullptr || !work.tracks.observations.empty();
  const bool settled = settling_.settled(work.packet.frames.t_ns, tracked);
  if (!settled || !hasPicture(work.packet.frames)) return;
  const std::vector<Landmark> landmarks =
      reckoning != nullptr ? std::vector<Landmark>() : estimator_.landmarks();
  if (!semantics->wants(work.number, odometry_pose, landmarks)) return;
  const Eigen::Vector3d gyro =
      work.packet.imu.empty() ? odometry_pose.bias_gyro : work.packet.imu.back().gyro;
  semantics->take(
      std::move(work.packet.frames), work.number, odometry_pose.T_odom_vehicle,
      camerasAtStamp(estimator_.calibration(), odometry_pose, gyro, T_vehicle_imu_.rotation()));
}

void MappingRun::Impl::finishEstimation() {
  if (running_ == nullptr) return;
  running_->done.get();
  estimate_clock_.add(millisecondsBetween(running_->begin, running_->end));
  latency_clock_.add(millisecondsBetween(running_->packet.arrived, running_->end));
  busy_.add(running_->begin, running_->end);
  state_ = std::move(running_->state);
  running_.reset();
}

// Waits for what other threads are at, and forgets it: they must not use the caller's observers
// after an exception took the caller out of the run.
void MappingRun::Impl::settle() {
  if (running_ != nullptr && running_->done.valid()) running_->done.wait();
  running_.reset();
  if (semantics != nullptr) semantics->abandon();
}

Status MappingRun::Impl::run(SensorSource& source, const ProgressCallback& progress) {
  struct AtTheEnd {
    Impl& run;
    ~AtTheEnd() { run.settle(); }
  };
  const AtTheEnd at_the_end{*this};
  const Clock::time_point begin = Clock::now();
  const SensorSourceInfo& info = source.info();
  FramePackets packets(
      source, [this](TimeNs t_ns) { return pace_.awaitDue(t_ns); }, live_);
  Status status;
  while (true) {
    Result<std::optional<FramePacket>> packet = packets.next();
    if (!packet) {
      status = packet.error();
      break;
    }
    if (!packet->has_value()) break;
    const TimeNs t_ns = (*packet)->frames.t_ns;
    if (summary.frame_sets == 0) first_t_ns_ = t_ns;
    summary.recorded_s = toSeconds(t_ns - first_t_ns_);
    ++summary.frame_sets;
    read_clock_.add((*packet)->reading_ms);
    process(std::move(**packet));
    if (progress && info.end_ns > info.start_ns) {
      progress(std::clamp(toSeconds(t_ns - info.start_ns) / toSeconds(info.end_ns - info.start_ns),
                          0.0, 1.0));
    }
  }
  summary.reading_s = packets.readingSeconds();
  summary.frame_sets_passed_over = packets.passedOver();
  finishEstimation();
  if (mapper != nullptr) {
    semantics->finish();
    mapper->finish();
  }
  summarise(begin);
  if (status && semantics != nullptr) status = semantics->status();
  return status;
}

void MappingRun::Impl::summarise(Clock::time_point begin) {
  summary.poses = static_cast<int>(trajectory.size());
  if (semantics != nullptr) busy_.add(semantics->busy());
  summary.processing_s = busy_.seconds();
  summary.wall_s = 1e-3 * millisecondsBetween(begin, Clock::now());
  summary.mean_tracks =
      summary.frame_sets > 0 ? static_cast<double>(observations_) / summary.frame_sets : 0.0;
  summary.stages = {read_clock_.timing(), track_clock_.timing(), estimate_clock_.timing()};
  if (mapper != nullptr) {
    for (const StageTiming& stage : semantics->timings()) summary.stages.push_back(stage);
    summary.pictures_passed_over = semantics->passedOver();
  }
  summary.stages.push_back(latency_clock_.timing());
}

MappingRun::MappingRun(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
MappingRun::~MappingRun() = default;

Result<std::unique_ptr<MappingRun>> MappingRun::create(const Rig& rig,
                                                       const PipelineOptions& options, int threads,
                                                       RunMethod method) {
  PARKADE_CHECK(threads >= 1, "{} threads", threads);
  const Result<std::vector<cv::Mat>> masks = readBodyMasks(rig);
  if (!masks) return masks.error();
  // OpenCV must not start threads of its own beside ours.
  cv::setNumThreads(1);
  auto impl = std::make_unique<Impl>(rig, options, threads);
  for (std::size_t c = 0; c < masks->size(); ++c) {
    if (!(*masks)[c].empty()) impl->tracker.setMask(static_cast<int>(c), (*masks)[c]);
  }
  if (method == RunMethod::kVis) {
    return std::unique_ptr<MappingRun>(new MappingRun(std::move(impl)));
  }
  Result<SemanticParts> parts = makeSemanticParts(rig, *masks, options, method);
  if (!parts) return parts.error();
  impl->reckoning = std::move(parts->reckoning);
  impl->mapper = std::move(parts->mapper);
  impl->semantics = std::make_unique<SemanticQueue>(
      std::move(parts->front_end), *impl->mapper, impl->observers,
      SemanticQueueOptions{options.semantics_delay, options.live, threads > 1});
  return std::unique_ptr<MappingRun>(new MappingRun(std::move(impl)));
}

Status MappingRun::locateIn(const ParkingMap& map) {
  if (impl_->mapper == nullptr) return Error{"key points alone cannot find the car in a saved map"};
  impl_->in_saved_map = true;
  return impl_->mapper->locateIn(map);
}

void MappingRun::addObserver(PipelineObserver* observer) {
  impl_->observers.push_back(observer);
}

Status MappingRun::run(SensorSource& source, const ProgressCallback& progress) {
  return impl_->run(source, progress);
}

const RunSummary& MappingRun::summary() const {
  return impl_->summary;
}

const Trajectory& MappingRun::trajectory() const {
  return impl_->trajectory;
}

std::vector<CameraCalibrationEstimate> MappingRun::calibration() const {
  if (impl_->reckoning != nullptr) return {};
  return impl_->estimator().calibration();
}

const Trajectory& MappingRun::odometry() const {
  return impl_->odometry;
}

const SemanticMapper* MappingRun::mapper() const {
  return impl_->mapper.get();
}

Trajectory MappingRun::finalTrajectory() const {
  return impl_->mapper != nullptr ? impl_->mapper->finalTrajectory()
                                  : impl_->estimator().finalTrajectory();
}

std::vector<Landmark> MappingRun::landmarks() const {
  return impl_->estimator().landmarks();
}

}  // namespace parkade
