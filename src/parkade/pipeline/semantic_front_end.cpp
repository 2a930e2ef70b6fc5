// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/pipeline/semantic_front_end.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

#include "parkade/core/check.hpp"
#include "parkade/core/units.hpp"
#include "parkade/geometry/se2.hpp"
#include "parkade/pipeline/stitched_views.hpp"
#include "parkade/semantics/networks/segmentation.hpp"
#include "parkade/types/level_frame.hpp"

namespace parkade {
namespace {

using Clock = std::chrono::steady_clock;

double since(Clock::time_point begin) {
  return millisecondsBetween(begin, Clock::now());
}

// About the vehicle's z: of all cameras, the mean of what each has turned.
double commonTurn(const std::vector<SE3>& before, const std::vector<SE3>& after) {
  double sum = 0.0;
  for (std::size_t c = 0; c < before.size(); ++c) {
    sum += (after[c].rotation() * before[c].rotation().inverse()).log().z();
  }
  return before.empty() ? 0.0 : sum / static_cast<double>(before.size());
}

// What goes by which camera shows what.
struct Sight {
  Sight(const BevStitcher& stitcher, const Rig& rig, const std::vector<bool>& present,
        const SemanticFrontEndOptions& options)
      : views(viewsOf(stitcher, rig, present)),
        objects(stitcher.geometry(), views, options.objects),
        smear(stitcher.geometry(), views, options.smear) {}

  BevViews views;
  ObjectExtractor objects;
  SmearFinder smear;
};

}  // namespace

struct SemanticFrontEnd::Impl {
  Impl(const Rig& r, const SemanticFrontEndOptions& o, SegmentationNetwork n)
      : options(o),
        rig(r),
        stitcher(r, o.bev),
        network(std::move(n)),
        ground(o.ground),
        tracker(o.agents) {}

  // Of the cameras that gave a picture: others' places show what they would have shown.
  const Sight& sightOf(const FrameSet& frames) {
    constexpr std::size_t kMost = 16;  // of cameras that fail by turns
    std::vector<bool> present;
    for (const cv::Mat& image : frames.images) present.push_back(!image.empty());
    if (sights.size() >= kMost && sights.count(present) == 0) sights.clear();
    std::unique_ptr<Sight>& sight = sights[present];
    if (sight == nullptr) sight = std::make_unique<Sight>(stitcher, rig, present, options);
    return *sight;
  }

  // Sight lines begin where cameras sit, which their labels' edges do not tell to a centimetre.
  void renewSights() {
    constexpr double kStep = 5e-3;  // m
    bool moved = false;
    for (std::size_t c = 0; c < cameras.size(); ++c) {
      const Eigen::Vector3d& before = rig.cameras[c].T_vehicle_cam.translation();
      moved = moved || (cameras[c].translation() - before).norm() >= kStep;
    }
    if (!moved) return;
    for (std::size_t c = 0; c < cameras.size(); ++c) rig.cameras[c].T_vehicle_cam = cameras[c];
    sights.clear();
  }

  // Tells what reads a camera's own pictures where it was.
  void placeReaders(int camera, const SE3& T_vehicle_cam, const Vector6d& twist);

  struct View {
    GroundPlaneEstimate floor;
    PoseEstimate now;
    std::vector<RaisedPoint> raised;
  };
  View nextView();
  // What the stitched picture shows.
  Result<SemanticFrame> lookDown(const FrameSet& frames, const View& view);
  void extract(const FrameSet& frames, const View& view, SemanticFrame& frame);

  SemanticFrontEndOptions options;
  Rig rig;
  BevStitcher stitcher;
  SegmentationNetwork network;
  GroundPlaneEstimator ground;
  std::map<std::vector<bool>, std::unique_ptr<Sight>> sights;  // by the cameras present
  AgentTracker tracker;
  std::unique_ptr<ZoneMarkerFrontEnd> zone_markers;  // null: there are no networks for it
  std::unique_ptr<PaintedNumberFrontEnd> numbers;    // null likewise
  std::vector<SE3> cameras;                          // where they are taken to sit
  std::vector<SE3> told;                             // and where the calibration says
  GroundMotion motion;                               // while rows are read
  std::optional<View> newest;                        // of the last addOdometry()
  std::optional<PoseEstimate> last_look;
  // Taken by take(), used by look(), which may work in another thread meanwhile.
  std::mutex views_mutex;
  std::deque<View> views;
  BevImage bev;
  StageClock stitch_clock{"bev"};
  StageClock segment_clock{"segment"};
  StageClock feature_clock{"features"};
  StageClock number_clock{"slot numbers"};
  StageClock zone_clock{"zone markers"};
};

SemanticFrontEnd::Impl::View SemanticFrontEnd::Impl::nextView() {
  const std::lock_guard lock(views_mutex);
  PARKADE_CHECK(!views.empty(), "no picture was taken");
  View view = std::move(views.front());
  views.pop_front();
  return view;
}

Result<SemanticFrame> SemanticFrontEnd::Impl::lookDown(const FrameSet& frames, const View& view) {
  Clock::time_point begin = Clock::now();
  bev = stitcher.stitch(frames, view.floor.attitude, view.floor.relief, motion);
  stitch_clock.add(since(begin));
  begin = Clock::now();
  Result<BevLabels> labels = network.segment(bev);
  if (!labels) return labels.error();
  segment_clock.add(since(begin));
  begin = Clock::now();
  SemanticFrame frame;
  frame.labels = std::move(labels).value();
  frame.labels.t_ns = frames.t_ns;
  extract(frames, view, frame);
  feature_clock.add(since(begin));
  if (numbers == nullptr) return frame;
  begin = Clock::now();
  const Status read = numbers->read(frames, sightOf(frames).views, view.now, frame);
  if (!read) return read.error();
  number_clock.add(since(begin));
  return frame;
}

// Features of the labels.
void SemanticFrontEnd::Impl::extract(const FrameSet& frames, const View& view,
                                     SemanticFrame& frame) {
  frame.attitude = view.floor.attitude;
  frame.relief = view.floor.relief;
  frame.rig_turn = commonTurn(told, cameras);
  frame.attitude_sigma = std::max(view.floor.sigma_pitch, view.floor.sigma_roll);
  const Sight& sight = sightOf(frames);
  frame.line_points =
      linePointsFromLabels(frame.labels, sight.views, frame.attitude_sigma, options.lines);
  frame.line_segments = segmentsOf(frame.line_points);
  // Slots need lines to a fraction of a pixel; registration has done better with the labels' own.
  const Lines lines = extractLines(bev, frame.labels, frame.attitude_sigma, options.slot_lines);
  frame.slots =
      extractSlots(bev, frame.labels, lines.segments, sight.views,
                   {std::hypot(frame.attitude_sigma, options.slot_lines.sight_sigma_deg * kDegree),
                    view.floor.sigma_height},
                   options.slots);
  FoundObjects found = sight.objects.extract(frame.labels, frame.slots, frame.attitude_sigma);
  frame.objects = std::move(found.objects);
  frame.moving = tracker.update(found.agents, SE2::fromSE3(view.now.T_odom_vehicle), frames.t_ns);
  frame.raised = view.raised;
  frame.smear = sight.smear.find(frame.labels, frame.raised);
}

SemanticFrontEnd::SemanticFrontEnd(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SemanticFrontEnd::~SemanticFrontEnd() = default;

Result<std::unique_ptr<SemanticFrontEnd>> SemanticFrontEnd::create(
    const Rig& rig, const std::vector<cv::Mat>& masks, const SemanticFrontEndOptions& options) {
  Result<SegmentationNetwork> network =
      SegmentationNetwork::loadOrOwn(options.network, kBevNetwork);
  if (!network) return network.error();
  if (options.slots.min_width_m > options.slots.max_width_m) {
    return Error{fmt::format("semantics.slots.min_width_m={:g} is more than max_width_m={:g}",
                             options.slots.min_width_m, options.slots.max_width_m)};
  }
  auto impl = std::make_unique<Impl>(rig, options, std::move(network).value());
  const Status taken = impl->network.takes(impl->stitcher.geometry());
  if (!taken) return taken.error();
  for (std::size_t c = 0; c < masks.size(); ++c) {
    if (!masks[c].empty()) impl->stitcher.setMask(static_cast<int>(c), masks[c]);
  }
  for (const RigCamera& camera : rig.cameras) impl->cameras.push_back(camera.T_vehicle_cam);
  impl->told = impl->cameras;
  auto zone_markers = ZoneMarkerFrontEnd::create(rig, masks, options.zone_markers);
  if (!zone_markers) return zone_markers.error();
  impl->zone_markers = std::move(zone_markers).value();
  auto numbers = PaintedNumberFrontEnd::create(rig, masks, options.painted_numbers);
  if (!numbers) return numbers.error();
  impl->numbers = std::move(numbers).value();
  return std::unique_ptr<SemanticFrontEnd>(new SemanticFrontEnd(std::move(impl)));
}

bool SemanticFrontEnd::addOdometry(const PoseEstimate& odometry,
                                   const std::vector<Landmark>& landmarks) {
  Impl& m = *impl_;
  if (odometry.health == Health::kInitialising) return false;
  m.newest = {m.ground.update(odometry, landmarks), odometry, {}};
  if (m.last_look) {
    const Eigen::Vector3d step =
        odometry.T_odom_vehicle.translation() - m.last_look->T_odom_vehicle.translation();
    if (step.norm() < m.options.distance_m &&
        toSeconds(odometry.t_ns - m.last_look->t_ns) < m.options.interval_s) {
      return false;
    }
  }
  const SE3 T_level_odom = levelFrom(m.newest->floor.attitude) * odometry.T_odom_vehicle.inverse();
  m.newest->raised =
      raisedPoints(landmarks, T_level_odom, m.newest->floor.relief, m.options.raised_points);
  return true;
}

void SemanticFrontEnd::take() {
  Impl& m = *impl_;
  PARKADE_CHECK(m.newest, "no odometry yet");
  m.last_look = m.newest->now;
  const std::lock_guard lock(m.views_mutex);
  m.views.push_back(*m.newest);
}

void SemanticFrontEnd::Impl::placeReaders(int camera, const SE3& T_vehicle_cam,
                                          const Vector6d& twist) {
  const RigCamera& eye = rig.cameras[static_cast<std::size_t>(camera)];
  // What stands upright shows about the horizon, what is painted on the floor below it.
  constexpr double kMarker[2] = {6.0, 1.5};  // m before the camera, m high
  constexpr double kPaint[2] = {3.0, 0.0};
  const auto at = [&](const double(&place)[2]) {
    return cameraAtRow(eye, T_vehicle_cam, rowOf(eye, place[0], place[1]), twist);
  };
  if (zone_markers != nullptr) zone_markers->moveCamera(camera, at(kMarker));
  if (numbers != nullptr) numbers->moveCamera(camera, at(kPaint));
}

void SemanticFrontEnd::placeCameras(const CamerasAtStamp& cameras) {
  // Moves a point of the floor at 5 m by 4 mm, and at 8 m by 1 cm, from a camera 1 m high.
  constexpr double kTurn = 1.75e-4;  // rad
  constexpr double kStep = 1e-3;     // m
  Impl& m = *impl_;
  m.motion = cameras.motion();
  for (std::size_t c = 0; c < m.cameras.size(); ++c) {
    const bool known = c < cameras.T_vehicle_cam.size();
    const SE3 now = known ? cameras.T_vehicle_cam[c] : m.cameras[c];
    const bool moved = angleBetween(now.rotation(), m.cameras[c].rotation()) >= kTurn ||
                       (now.translation() - m.cameras[c].translation()).norm() >= kStep;
    const int camera = static_cast<int>(c);
    const bool rolling = m.rig.cameras[c].readout_time > 0.0;
    if (moved) {
      m.cameras[c] = now;
      m.stitcher.moveCamera(camera, now);
    }
    if (rolling && known) {
      m.rig.cameras[c].readout_time = cameras.readout_time[c];
      m.stitcher.setReadoutTime(camera, cameras.readout_time[c]);
    }
    if (moved || rolling) m.placeReaders(camera, now, cameras.twist);
  }
  m.renewSights();
}

Result<SemanticFrame> SemanticFrontEnd::look(const FrameSet& frames, ThreadPool& beside) {
  Impl& m = *impl_;
  const Impl::View view = m.nextView();
  // Markers need nothing of the stitched picture, and take about as long.
  Result<SemanticFrame> frame = SemanticFrame();
  Result<std::vector<ObjectObservation>> markers = std::vector<ObjectObservation>();
  beside.parallelFor(m.zone_markers == nullptr ? 1 : 2, [&](int part) {
    if (part == 0) {
      frame = m.lookDown(frames, view);
      return;
    }
    const Clock::time_point begin = Clock::now();
    markers = m.zone_markers->look(frames, view.now, view.floor.attitude);
    m.zone_clock.add(since(begin));
  });
  if (!frame) return frame.error();
  if (!markers) return markers.error();
  for (ObjectObservation& marker : *markers) frame->objects.push_back(std::move(marker));
  return frame;
}

const BevImage& SemanticFrontEnd::picture() const {
  return impl_->bev;
}

const std::vector<LevelView>& SemanticFrontEnd::views() const {
  static const std::vector<LevelView> none;
  return impl_->zone_markers == nullptr ? none : impl_->zone_markers->views();
}

std::vector<StageTiming> SemanticFrontEnd::timings() const {
  return {impl_->stitch_clock.timing(), impl_->segment_clock.timing(),
          impl_->feature_clock.timing(), impl_->number_clock.timing(), impl_->zone_clock.timing()};
}

}  // namespace parkade
