// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <deque>
#include <opencv2/core.hpp>
#include <stdexcept>
#include <thread>

#include "parkade/core/random.hpp"
#include "parkade/pipeline/mapping_run.hpp"

namespace parkade {
namespace {

// A rig of one camera in a box of random dots, driven by hand: images and exact IMU readings.
class DotSource : public SensorSource {
 public:
  DotSource() {
    PinholeRadtan::Parameters p;
    p.fx = p.fy = 200.0;
    p.cx = 159.5;
    p.cy = 119.5;
    RigCamera camera;
    camera.name = "cam0";
    camera.camera = Camera(PinholeRadtan(p), 320, 240);
    // The camera looks along the vehicle's x axis.
    Eigen::Matrix3d axes;
    axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    camera.T_vehicle_cam = SE3(SO3(axes), Eigen::Vector3d(0.1, 0.0, 0.0));
    rig.name = "dots";
    rig.cameras = {camera};
    rig.imu.rate_hz = 200.0;
    Random random(11);
    for (int i = 0; i < 500; ++i) {
      dots_.emplace_back(random.uniform(3.0, 8.0), random.uniform(-5.0, 5.0),
                         random.uniform(-4.0, 4.0));
      greys_.push_back(random.uniform(90.0, 255.0));
    }
    info_.name = "dots";
    info_.num_cameras = 1;
    info_.end_ns = fromSeconds(kSeconds);
    for (int i = 0; i <= static_cast<int>(kSeconds * 200); ++i) {
      events_.push_back(imuAt(i * 5 * kNsPerMs));
      if (i % 20 == 0 && i > 0) events_.push_back(framesAt(i * 5 * kNsPerMs, i / 20 - 1));
    }
  }
  [[nodiscard]] const SensorSourceInfo& info() const override { return info_; }
  Result<std::optional<SensorEvent>> next() override {
    if (next_ == fail_at) return Error{"data.csv:7: the disk is gone"};
    if (next_ == events_.size()) return std::optional<SensorEvent>();
    return std::optional<SensorEvent>(events_[next_++]);
  }

  // The pictures of these instants become the one before them.
  void freeze(double from_s, double to_s) {
    cv::Mat last;
    for (SensorEvent& event : events_) {
      auto* frames = std::get_if<FrameSet>(&event);
      if (frames == nullptr) continue;
      const double t = toSeconds(frames->t_ns);
      if (t < from_s) last = frames->images[0];
      if (t >= from_s && t < to_s) frames->images[0] = last.clone();
    }
  }
  [[nodiscard]] static Eigen::Vector3d positionAt(double t) {
    return {0.3 * std::sin(1.5 * t), 0.4 * std::sin(2.0 * t), 0.2 * std::sin(2.5 * t)};
  }

  Rig rig;
  std::size_t fail_at = 1'000'000;
  static constexpr double kSeconds = 2.5;

 private:
  ImuSample imuAt(TimeNs t_ns) const {
    const double t = toSeconds(t_ns);
    ImuSample sample;
    sample.t_ns = t_ns;
    sample.accel = Eigen::Vector3d(-0.3 * 2.25 * std::sin(1.5 * t), -1.6 * std::sin(2.0 * t),
                                   -0.2 * 6.25 * std::sin(2.5 * t) + 9.81);
    return sample;
  }
  FrameSet framesAt(TimeNs t_ns, int index) const {
    cv::Mat image(240, 320, CV_8UC1, cv::Scalar(40));
    const SE3 T_world_vehicle(SO3(), positionAt(toSeconds(t_ns)));
    const SE3 T_cam_world = (T_world_vehicle * rig.cameras[0].T_vehicle_cam).inverse();
    for (std::size_t i = 0; i < dots_.size(); ++i) {
      Eigen::Vector2d p;
      if (!rig.cameras[0].camera.project(T_cam_world * dots_[i], p)) continue;
      // A smooth blob at its exact place.
      for (int y = static_cast<int>(p.y()) - 5; y <= static_cast<int>(p.y()) + 6; ++y) {
        for (int x = static_cast<int>(p.x()) - 5; x <= static_cast<int>(p.x()) + 6; ++x) {
          if (x < 0 || y < 0 || x >= 320 || y >= 240) continue;
          const double square = (Eigen::Vector2d(x, y) - p).squaredNorm();
          const double grey = 40.0 + (greys_[i] - 40.0) * std::exp(-square / 6.0);
          auto& pixel = image.at<std::uint8_t>(y, x);
          pixel = std::max(pixel, static_cast<std::uint8_t>(grey));
        }
      }
    }
    FrameSet frames;
    frames.t_ns = t_ns;
    frames.index = index;
    frames.images = {image};
    frames.image_t_ns = {t_ns};
    return frames;
  }

  SensorSourceInfo info_;
  std::vector<Eigen::Vector3d> dots_;
  std::vector<double> greys_;
  std::vector<SensorEvent> events_;
  std::size_t next_ = 0;
};

class Counter : public PipelineObserver {
 public:
  void onTracks(const TracksEvent& event) override {
    tracks.push_back(event.frames.index);
    priors += event.prior.valid ? 1 : 0;
  }
  void onPose(const PoseEvent& event) override { poses.push_back(event.index); }
  std::vector<int> tracks;
  std::vector<int> poses;
  int priors = 0;
};

TEST(MappingRun, SamePosesOnAnyNumberOfThreads) {
  Trajectory reference;
  for (const int threads : {1, 2, 4}) {
    DotSource source;
    auto run = MappingRun::create(source.rig, {}, threads);
    ASSERT_TRUE(run.ok());
    Counter counter;
    (*run)->addObserver(&counter);
    ASSERT_TRUE((*run)->run(source).ok());
    EXPECT_EQ((*run)->summary().frame_sets, 25);
    EXPECT_EQ(counter.tracks.size(), 25U);
    EXPECT_EQ(counter.poses, counter.tracks);
    EXPECT_EQ(counter.priors, 24);  // all but the first: the gyroscope speaks before start-up
    EXPECT_EQ((*run)->summary().stages[1].count, 25);
    const Trajectory& poses = (*run)->trajectory();
    EXPECT_GT(poses.size(), 10U);
    if (reference.empty()) reference = poses;
    ASSERT_EQ(poses.size(), reference.size());
    for (std::size_t i = 0; i < poses.size(); ++i) {
      EXPECT_EQ(poses[i].t_ns, reference[i].t_ns);
      EXPECT_EQ(poses[i].T_world_body.matrix(), reference[i].T_world_body.matrix()) << "pose " << i;
    }
  }
}

// Largest error of what the odometry says of the way since its first pose, m.
double worstError(const Trajectory& poses) {
  const StampedPose& first = poses.front();
  const Eigen::Vector3d begin = DotSource::positionAt(toSeconds(first.t_ns));
  double worst = 0.0;
  for (const StampedPose& pose : poses) {
    const Eigen::Vector3d moved = DotSource::positionAt(toSeconds(pose.t_ns)) - begin;
    const SE3 told = first.T_world_body.inverse() * pose.T_world_body;
    worst = std::max(worst, (told.translation() - moved).norm());
  }
  return worst;
}

TEST(MappingRun, PicturesThatStandStillDoNotHoldACarThatMoves) {
  double worst[2] = {};
  for (const bool frozen : {false, true}) {
    DotSource source;
    if (frozen) source.freeze(1.6, 2.1);
    auto run = MappingRun::create(source.rig, {}, 1);
    ASSERT_TRUE(run.ok());
    ASSERT_TRUE((*run)->run(source).ok());
    EXPECT_EQ((*run)->summary().pictures_repeated, frozen ? 5 : 0);
    EXPECT_EQ((*run)->summary().images[0], frozen ? 20 : 25);
    worst[frozen ? 1 : 0] = worstError((*run)->odometry());
  }
  EXPECT_LT(worst[0], 0.02);
  EXPECT_LT(worst[1], 0.04);
}

TEST(MappingRun, APaceChangesTheTimeOnly) {
  Trajectory reference;
  for (const double pace : {0.0, 5.0}) {
    DotSource source;
    PipelineOptions options;
    options.pace = pace;
    auto run = MappingRun::create(source.rig, options, 2);
    ASSERT_TRUE(run.ok());
    ASSERT_TRUE((*run)->run(source).ok());
    // 24 gaps of 0.1 s between the frame sets.
    EXPECT_GE((*run)->summary().wall_s, pace > 0.0 ? 2.4 / pace : 0.0);
    const Trajectory& poses = (*run)->trajectory();
    if (reference.empty()) reference = poses;
    ASSERT_EQ(poses.size(), reference.size());
    for (std::size_t i = 0; i < poses.size(); ++i) {
      EXPECT_EQ(poses[i].T_world_body.matrix(), reference[i].T_world_body.matrix()) << "pose " << i;
    }
  }
}

class Onlooker : public PipelineObserver {
 public:
  void onFeatures(const FeaturesEvent& event) override {
    EXPECT_EQ(event.picture.image.size(), event.features.labels.labels.size());
    EXPECT_EQ(event.picture.t_ns, event.features.labels.t_ns);
    seen.push_back(event.features.labels.t_ns);
  }
  void onMap(const MapEvent& event) override {
    ASSERT_NE(event.local_map, nullptr);
    entered.push_back(event.features.labels.t_ns);
    places.push_back(event.T_odom_vehicle);
  }
  std::vector<TimeNs> seen;
  std::vector<TimeNs> entered;
  std::vector<SE3> places;
};

TEST(MappingRun, ShowsFeaturesAsTheyAreSeenAndAsTheyEnterTheMap) {
  DotSource source;
  auto run = MappingRun::create(source.rig, {}, 2, RunMethod::kFused);
  ASSERT_TRUE(run.ok()) << run.error().message;
  Onlooker onlooker;
  (*run)->addObserver(&onlooker);
  const Status status = (*run)->run(source);
  ASSERT_TRUE(status.ok()) << status.error().message;
  EXPECT_GT(onlooker.seen.size(), 3U);
  EXPECT_TRUE(std::is_sorted(onlooker.seen.begin(), onlooker.seen.end()));
  EXPECT_EQ(onlooker.entered, onlooker.seen);
  for (std::size_t i = 0; i < onlooker.entered.size(); ++i) {
    const Trajectory& odometry = (*run)->odometry();
    const auto at = std::find_if(odometry.begin(), odometry.end(), [&](const StampedPose& pose) {
      return pose.t_ns == onlooker.entered[i];
    });
    ASSERT_NE(at, odometry.end());
    EXPECT_EQ(at->T_world_body.matrix(), onlooker.places[i].matrix());
  }
}

TEST(MappingRun, ALiveRunPassesPicturesOverRatherThanWait) {
  class Slow : public Onlooker {
   public:
    void onFeatures(const FeaturesEvent& event) override {
      Onlooker::onFeatures(event);
      std::this_thread::sleep_for(std::chrono::milliseconds(600));
    }
  };
  int poses = 0;
  for (const bool live : {false, true}) {
    DotSource source;
    PipelineOptions options;
    options.pace = 1.0;
    options.live = live;
    options.semantics.distance_m = 0.0;  // every picture is due
    auto run = MappingRun::create(source.rig, options, 2, RunMethod::kFused);
    ASSERT_TRUE(run.ok()) << run.error().message;
    Slow onlooker;
    (*run)->addObserver(&onlooker);
    ASSERT_TRUE((*run)->run(source).ok());
    const RunSummary& summary = (*run)->summary();
    if (!live) poses = summary.poses;
    EXPECT_GT(poses, 10);
    EXPECT_EQ(summary.poses + summary.frame_sets_passed_over, poses);
    EXPECT_EQ(onlooker.entered, onlooker.seen);
    EXPECT_FALSE(onlooker.seen.empty());
    const int pictures = static_cast<int>(onlooker.seen.size());
    EXPECT_EQ(summary.pictures_passed_over + pictures, summary.poses);
    if (live) {
      EXPECT_GT(summary.pictures_passed_over, 0);
    } else {
      EXPECT_EQ(summary.pictures_passed_over, 0);
    }
  }
}

TEST(MappingRun, ALiveRunThatLagsBehindPassesFrameSetsOver) {
  class Slow : public PipelineObserver {
   public:
    void onTracks(const TracksEvent&) override {
      std::this_thread::sleep_for(std::chrono::milliseconds(250));
    }
  };
  int all = 0;
  for (const bool live : {false, true}) {
    DotSource source;
    PipelineOptions options;
    options.pace = 1.0;
    options.live = live;
    auto run = MappingRun::create(source.rig, options, 2);
    ASSERT_TRUE(run.ok());
    Slow onlooker;
    (*run)->addObserver(&onlooker);
    ASSERT_TRUE((*run)->run(source).ok());
    const RunSummary& summary = (*run)->summary();
    if (!live) {
      all = summary.frame_sets;
      EXPECT_EQ(summary.frame_sets_passed_over, 0);
      continue;
    }
    // 2.4 s of pictures at 10 Hz, one takes a quarter of a second.
    EXPECT_GT(summary.frame_sets_passed_over, 5);
    EXPECT_EQ(summary.frame_sets + summary.frame_sets_passed_over, all);
    const Trajectory& poses = (*run)->trajectory();
    EXPECT_GT(poses.size(), 3U);
    EXPECT_EQ(static_cast<int>(poses.size()), summary.poses);
  }
}

TEST(MappingRun, KeepsWhatItHasWhenTheSourceFails) {
  DotSource source;
  source.fail_at = 400;
  auto run = MappingRun::create(source.rig, {}, 2);
  ASSERT_TRUE(run.ok());
  const Status status = (*run)->run(source);
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().message, "data.csv:7: the disk is gone");
  EXPECT_GT((*run)->summary().frame_sets, 15);
  EXPECT_GT((*run)->trajectory().size(), 5U);
}

TEST(MappingRun, NothingUsesAnObserverAfterAnExceptionEndedTheRun) {
  class Slow : public Onlooker {
   public:
    explicit Slow(std::atomic<int>& running) : running_(running) {}
    void onTracks(const TracksEvent&) override {
      if (++tracks_ > 12) throw std::runtime_error("the observer gives up");
    }
    void onPose(const PoseEvent&) override { work(); }
    void onFeatures(const FeaturesEvent&) override { work(); }

   private:
    void work() {
      ++running_;
      std::this_thread::sleep_for(std::chrono::milliseconds(60));
      --running_;
    }
    std::atomic<int>& running_;
    int tracks_ = 0;
  };
  DotSource source;
  PipelineOptions options;
  options.semantics.distance_m = 0.0;  // every picture is due
  auto run = MappingRun::create(source.rig, options, 2, RunMethod::kFused);
  ASSERT_TRUE(run.ok()) << run.error().message;
  std::atomic<int> running{0};
  Slow observer(running);
  (*run)->addObserver(&observer);
  EXPECT_THROW((void)(*run)->run(source), std::runtime_error);
  for (int k = 0; k < 40; ++k) {
    EXPECT_EQ(running, 0);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

TEST(MappingRun, RefusesAMaskThatIsMissing) {
  DotSource source;
  source.rig.cameras[0].mask_path = "/nonexistent/mask.png";
  const auto run = MappingRun::create(source.rig, {}, 1);
  ASSERT_FALSE(run.ok());
  EXPECT_NE(run.error().message.find("/nonexistent/mask.png"), std::string::npos);
}

}  // namespace
}  // namespace parkade
