// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/tracking/tracker.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <set>
#include <thread>
#include <vector>

#include "parkade/core/random.hpp"
#include "parkade/tracking/detector.hpp"
#include "parkade/tracking/outliers.hpp"
#include "parkade/tracking/overlap.hpp"
#include "parkade/tracking/patch.hpp"

namespace parkade {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 240;
constexpr double kFocal = 200.0;

// A smooth random texture on the plane: any resolution, exact everywhere, about 12 px fine.
double texture(double x, double y) {
  static const auto kWaves = [] {
    Random random(7);
    std::vector<Eigen::Vector4d> waves;
    for (int i = 0; i < 60; ++i) {
      const double angle = random.uniform(0.0, 6.283);
      const double k = random.uniform(0.15, 0.9);
      waves.emplace_back(k * std::cos(angle), k * std::sin(angle), random.uniform(0.0, 6.283),
                         random.uniform(0.3, 1.0));
    }
    return waves;
  }();
  double sum = 0.0;
  for (const Eigen::Vector4d& w : kWaves) sum += w[3] * std::sin(w[0] * x + w[1] * y + w[2]);
  return 128.0 + 14.0 * sum;
}

Camera pinhole() {
  PinholeEquidistant::Parameters p;
  p.fx = kFocal;
  p.fy = kFocal;
  p.cx = 0.5 * (kWidth - 1);
  p.cy = 0.5 * (kHeight - 1);
  return Camera(PinholeEquidistant(p), kWidth, kHeight);
}

// Cameras that look along z of the vehicle frame, side by side.
Rig makeRig(const std::vector<double>& places) {
  Rig rig;
  rig.name = "test";
  for (const double x : places) {
    RigCamera camera;
    camera.name = "cam" + std::to_string(rig.cameras.size());
    camera.camera = pinhole();
    camera.T_vehicle_cam = SE3(SO3(), Eigen::Vector3d(x, 0.0, 0.0));
    rig.cameras.push_back(camera);
  }
  return rig;
}

// What a camera sees of the textured plane z = depth.
cv::Mat render(const RigCamera& camera, const SE3& T_world_vehicle, double depth,
               double brightness = 1.0, double noise = 0.0, std::uint64_t seed = 1) {
  const SE3 T_world_cam = T_world_vehicle * camera.T_vehicle_cam;
  Random random(seed);
  cv::Mat image(kHeight, kWidth, CV_8UC1);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      Eigen::Vector3d ray;
      double grey = 0.0;
      if (camera.camera.unproject(Eigen::Vector2d(x, y), ray)) {
        const Eigen::Vector3d d = T_world_cam.rotation() * ray;
        const double s = (depth - T_world_cam.translation().z()) / d.z();
        const Eigen::Vector3d p = T_world_cam.translation() + s * d;
        const double scale = kFocal / depth;  // texture units per metre
        grey = brightness * texture(p.x() * scale, p.y() * scale) + noise * random.normal();
      }
      image.at<std::uint8_t>(y, x) =
          static_cast<std::uint8_t>(std::clamp(std::lround(grey), 0L, 255L));
    }
  }
  return image;
}

FrameSet frameSet(const Rig& rig, const SE3& T_world_vehicle, double depth, int index,
                  double brightness = 1.0, double noise = 0.0) {
  FrameSet frames;
  frames.index = index;
  frames.t_ns = 1'000'000'000 + index * 50'000'000LL;
  for (const RigCamera& camera : rig.cameras) {
    frames.images.push_back(render(camera, T_world_vehicle, depth, brightness, noise,
                                   static_cast<std::uint64_t>(index + 1)));
    frames.image_t_ns.push_back(frames.t_ns);
  }
  return frames;
}

SE3 poseAt(int frame) {
  const double s = frame;
  return {SO3::exp(Eigen::Vector3d(0.002 * s, -0.004 * s, 0.006 * s)),
          Eigen::Vector3d(0.03 * s, 0.01 * s, 0.02 * s)};
}

MotionPrior priorBetween(const SE3& before, const SE3& now) {
  MotionPrior prior;
  prior.valid = true;
  prior.T_previous_current = before.inverse() * now;
  return prior;
}

TrackingOptions smallOptions() {
  TrackingOptions options;
  options.detection.features = 60;
  return options;
}

// Where the point that a pixel of one pose shows on the plane appears at another pose.
Eigen::Vector2d transfer(const RigCamera& from, const RigCamera& to, const SE3& T_world_before,
                         const SE3& T_world_now, double depth, const Eigen::Vector2d& pixel) {
  Eigen::Vector3d ray;
  EXPECT_TRUE(from.camera.unproject(pixel, ray));
  const SE3 T_world_cam = T_world_before * from.T_vehicle_cam;
  const Eigen::Vector3d d = T_world_cam.rotation() * ray;
  const Eigen::Vector3d p =
      T_world_cam.translation() + (depth - T_world_cam.translation().z()) / d.z() * d;
  Eigen::Vector2d seen;
  EXPECT_TRUE(to.camera.project((T_world_now * to.T_vehicle_cam).inverse() * p, seen));
  return seen;
}

struct DriveResult {
  double rms_px = 0.0;
  double worst_px = 0.0;
  int compared = 0;
  double mean_tracks = 0.0;
};

// Tracks a drive over a plane and compares with where each first pixel must be.
DriveResult drive(const TrackingOptions& options, bool with_prior, double noise,
                  double dimming = 1.0) {
  const Rig rig = makeRig({0.0});
  constexpr double kDepth = 3.0;
  Tracker tracker(rig, options);
  std::map<std::uint64_t, std::pair<SE3, Eigen::Vector2d>> first;
  DriveResult result;
  double square = 0.0;
  constexpr int kFrames = 15;
  for (int i = 0; i < kFrames; ++i) {
    const TrackSet tracks =
        tracker.track(frameSet(rig, poseAt(i), kDepth, i, std::pow(dimming, i), noise),
                      with_prior && i > 0 ? priorBetween(poseAt(i - 1), poseAt(i)) : MotionPrior());
    result.mean_tracks += static_cast<double>(tracks.observations.size()) / kFrames;
    for (const TrackObservation& o : tracks.observations) {
      const auto [it, is_new] = first.try_emplace(o.id, poseAt(i), o.pixel);
      if (is_new) continue;
      const Eigen::Vector2d wanted = transfer(rig.cameras[0], rig.cameras[0], it->second.first,
                                              poseAt(i), kDepth, it->second.second);
      const double error = (wanted - o.pixel).norm();
      square += error * error;
      result.worst_px = std::max(result.worst_px, error);
      ++result.compared;
    }
  }
  result.rms_px = std::sqrt(square / std::max(result.compared, 1));
  return result;
}

TEST(Tracker, FollowsAPlaneToSubpixels) {
  const DriveResult result = drive(smallOptions(), true, 0.0);
  EXPECT_GT(result.compared, 500);
  EXPECT_GT(result.mean_tracks, 45);
  EXPECT_LT(result.rms_px, 0.05);
  EXPECT_LT(result.worst_px, 0.5);
}

TEST(Tracker, FollowsWithoutAPrior) {
  const DriveResult result = drive(smallOptions(), false, 0.0);
  EXPECT_GT(result.compared, 500);
  EXPECT_LT(result.rms_px, 0.06);
}

TEST(Tracker, PatchesKeepTracksFromCreepingInNoise) {
  TrackingOptions options = smallOptions();
  const DriveResult aligned = drive(options, true, 4.0);
  options.flow.refine = false;
  const DriveResult flow_only = drive(options, true, 4.0);
  EXPECT_LT(aligned.rms_px, 0.15);
  EXPECT_LT(aligned.rms_px, 0.8 * flow_only.rms_px);
}

TEST(Tracker, BearsLightThatFades) {
  const DriveResult result = drive(smallOptions(), true, 0.0, 0.9);  // to 23 % in the end
  EXPECT_GT(result.compared, 450);
  EXPECT_LT(result.rms_px, 0.12);
}

TEST(Tracker, SeesInDarkImages) {
  const Rig rig = makeRig({0.0});
  TrackingOptions options = smallOptions();
  options.detection.min_gradient = 5.0;
  Tracker tracker(rig, options);
  options.contrast.mode = "off";
  Tracker blind(rig, options);
  const FrameSet dark = frameSet(rig, SE3(), 3.0, 0, 0.08);
  EXPECT_GT(tracker.track(dark, {}).observations.size(), 40U);
  EXPECT_LT(blind.track(dark, {}).observations.size(), 10U);
}

TEST(Tracker, BlackAndMissingImagesAreNotOk) {
  const Rig rig = makeRig({0.0, 1.0});
  Tracker tracker(rig, smallOptions());
  FrameSet frames = frameSet(rig, SE3(), 3.0, 0);
  frames.images[1] = cv::Mat();
  TrackSet tracks = tracker.track(frames, {});
  EXPECT_EQ(tracks.camera_ok, (std::vector<std::uint8_t>{1, 0}));
  frames = frameSet(rig, SE3(), 3.0, 1);
  frames.images[0].setTo(3);
  tracks = tracker.track(frames, priorBetween(SE3(), SE3()));
  EXPECT_EQ(tracks.camera_ok, (std::vector<std::uint8_t>{0, 1}));
  for (const TrackObservation& o : tracks.observations) EXPECT_EQ(o.camera, 1);
  EXPECT_GT(tracks.observations.size(), 40U);
}

TEST(Tracker, KeepsFeaturesOverALostPicture) {
  const Rig rig = makeRig({0.0});
  Tracker tracker(rig, smallOptions());
  std::set<std::uint64_t> before;
  for (const TrackObservation& o :
       tracker.track(frameSet(rig, poseAt(0), 3.0, 0), {}).observations) {
    before.insert(o.id);
  }
  for (int i = 1; i <= 3; ++i) {
    FrameSet lost = frameSet(rig, poseAt(i), 3.0, i);
    lost.images[0] = cv::Mat();
    EXPECT_TRUE(tracker.track(lost, priorBetween(poseAt(i - 1), poseAt(i))).observations.empty());
  }
  const TrackSet after =
      tracker.track(frameSet(rig, poseAt(4), 3.0, 4), priorBetween(poseAt(3), poseAt(4)));
  const auto kept = std::count_if(after.observations.begin(), after.observations.end(),
                                  [&](const TrackObservation& o) { return before.contains(o.id); });
  EXPECT_GT(kept, 30);
}

TEST(Tracker, SharesIdsBetweenCamerasThatOverlap) {
  const Rig rig = makeRig({0.0, 0.3});
  constexpr double kDepth = 2.5;
  Tracker tracker(rig, smallOptions());
  int shared = 0;
  int total = 0;
  for (int i = 0; i < 4; ++i) {
    const TrackSet tracks =
        tracker.track(frameSet(rig, poseAt(i), kDepth, i),
                      i > 0 ? priorBetween(poseAt(i - 1), poseAt(i)) : MotionPrior());
    std::map<std::uint64_t, Eigen::Vector2d> left;
    for (const TrackObservation& o : tracks.observations) {
      if (o.camera == 0) {
        left[o.id] = o.pixel;
        ++total;
      } else if (const auto it = left.find(o.id); it != left.end()) {
        const Eigen::Vector2d wanted =
            transfer(rig.cameras[0], rig.cameras[1], poseAt(i), poseAt(i), kDepth, it->second);
        EXPECT_LT((wanted - o.pixel).norm(), 0.4) << "id " << o.id << " frame " << i;
        ++shared;
      }
    }
  }
  EXPECT_GT(shared, total / 2);
}

TEST(Tracker, DoesNotMatchCamerasThatLookApart) {
  Rig rig = makeRig({0.0, 0.3});
  rig.cameras[1].T_vehicle_cam.rotation() = SO3::exp(Eigen::Vector3d(0.0, 2.5, 0.0));
  const auto overlap = computeOverlap(rig);
  EXPECT_EQ(overlap[0][1], 0.0);
  EXPECT_GT(computeOverlap(makeRig({0.0, 0.3}))[0][1], 0.8);
}

bool sameTracks(const TrackSet& a, const TrackSet& b) {
  return a.observations.size() == b.observations.size() &&
         std::equal(a.observations.begin(), a.observations.end(), b.observations.begin(),
                    [](const TrackObservation& x, const TrackObservation& y) {
                      return x.id == y.id && x.camera == y.camera && x.pixel == y.pixel &&
                             x.age == y.age && x.sigma_px == y.sigma_px;
                    });
}

TEST(Tracker, SameTracksOnAnyNumberOfThreads) {
  const Rig rig = makeRig({0.0, 0.3, 0.6});
  Tracker one(rig, smallOptions());
  Tracker many(rig, smallOptions());
  many.setParallel([](int count, const std::function<void(int)>& body) {
    std::vector<std::thread> threads;
    for (int i = count - 1; i >= 0; --i) threads.emplace_back(body, i);
    for (std::thread& thread : threads) thread.join();
  });
  for (int i = 0; i < 4; ++i) {
    const FrameSet frames = frameSet(rig, poseAt(i), 2.5, i, 1.0, 2.0);
    const MotionPrior prior = i > 0 ? priorBetween(poseAt(i - 1), poseAt(i)) : MotionPrior();
    EXPECT_TRUE(sameTracks(one.track(frames, prior), many.track(frames, prior))) << "frame " << i;
  }
}

TEST(Tracker, OrdersByCameraThenIdAndCountsAge) {
  const Rig rig = makeRig({0.0, 0.3});
  Tracker tracker(rig, smallOptions());
  tracker.track(frameSet(rig, poseAt(0), 2.5, 0), {});
  const TrackSet tracks =
      tracker.track(frameSet(rig, poseAt(1), 2.5, 1), priorBetween(poseAt(0), poseAt(1)));
  EXPECT_TRUE(std::is_sorted(tracks.observations.begin(), tracks.observations.end(),
                             [](const TrackObservation& a, const TrackObservation& b) {
                               return std::pair(a.camera, a.id) < std::pair(b.camera, b.id);
                             }));
  const auto old = std::count_if(tracks.observations.begin(), tracks.observations.end(),
                                 [](const TrackObservation& o) { return o.age == 2; });
  EXPECT_GT(old, static_cast<std::ptrdiff_t>(tracks.observations.size() / 2));
}

TEST(Tracker, MasksHideFeatures) {
  const Rig rig = makeRig({0.0});
  Tracker tracker(rig, smallOptions());
  cv::Mat body(kHeight, kWidth, CV_8UC1, cv::Scalar(255));
  body.rowRange(160, kHeight).setTo(0);
  tracker.setMask(0, body);
  cv::Mat people(kHeight, kWidth, CV_8UC1, cv::Scalar(255));
  people.colRange(0, 100).setTo(0);
  tracker.setDynamicMask(0, people);
  TrackSet tracks = tracker.track(frameSet(rig, SE3(), 3.0, 0), {});
  ASSERT_GT(tracks.observations.size(), 15U);
  for (const TrackObservation& o : tracks.observations) {
    EXPECT_LT(o.pixel.y(), 152.0) << "a patch must not show the body";
    EXPECT_GE(o.pixel.x(), 100.0);
  }
  tracks = tracker.track(frameSet(rig, SE3(), 3.0, 1), priorBetween(SE3(), SE3()));
  const auto left = std::count_if(tracks.observations.begin(), tracks.observations.end(),
                                  [](const TrackObservation& o) { return o.pixel.x() < 100.0; });
  EXPECT_GT(left, 5) << "a dynamic mask holds for one frame set only";
}

TEST(GridDetector, SpreadsCorners) {
  const cv::Mat image = render(makeRig({0.0}).cameras[0], SE3(), 3.0);
  DetectionOptions options;
  options.features = 48;
  const GridDetector detector(options, kWidth, kHeight);
  const std::vector<Corner> corners = detector.detect(image, {}, {});
  EXPECT_GT(corners.size(), 40U);
  std::vector<int> quarter(4, 0);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d& p = corners[i].pixel;
    ++quarter[static_cast<std::size_t>((p.x() > kWidth / 2.0 ? 1 : 0) +
                                       (p.y() > kHeight / 2.0 ? 2 : 0))];
    for (std::size_t k = 0; k < i; ++k) {
      EXPECT_GE((p - corners[k].pixel).norm(), options.min_distance_px - 0.5);
    }
  }
  for (const int count : quarter) EXPECT_GT(count, 8);
  EXPECT_TRUE(detector.detect(cv::Mat(kHeight, kWidth, CV_8UC1, cv::Scalar(90)), {}, {}).empty());
}

TEST(GridDetector, NoiseMakesNoCorners) {
  DetectionOptions options;
  options.features = 48;
  const GridDetector detector(options, kWidth, kHeight);
  for (const double sigma : {0.0, 2.0, 8.0}) {
    cv::Mat image(kHeight, kWidth, CV_8UC1, cv::Scalar(60));
    cv::rectangle(image, cv::Rect(90, 70, 80, 60), cv::Scalar(160), cv::FILLED);
    cv::GaussianBlur(image, image, cv::Size(), 1.0);
    cv::Mat noise(kHeight, kWidth, CV_16SC1);
    cv::theRNG().state = 7;
    cv::randn(noise, 0.0, sigma);
    cv::add(image, noise, image, cv::noArray(), CV_8U);
    const std::vector<Corner> corners = detector.detect(image, {}, {});
    int real = 0;
    for (const Corner& corner : corners) {
      for (const Eigen::Vector2d& p : {Eigen::Vector2d(90.0, 70.0), Eigen::Vector2d(169.0, 70.0),
                                       Eigen::Vector2d(90.0, 129.0), Eigen::Vector2d(169.0, 129.0)})
        if ((corner.pixel - p).norm() < 4.0) ++real;
    }
    EXPECT_EQ(real, 4) << "noise of " << sigma;
    EXPECT_LE(corners.size(), 6U) << "noise of " << sigma;
  }
}

TEST(Patch, AlignsWarpGainAndOffset) {
  cv::Mat image(200, 200, CV_8UC1);
  cv::Mat other(200, 200, CV_8UC1);
  Eigen::Matrix2d warp;
  warp << 1.08, 0.10, -0.06, 0.95;
  const Eigen::Vector2d shift(0.73, -0.41);
  const Eigen::Vector2d centre(100.0, 100.0);
  for (int y = 0; y < 200; ++y) {
    for (int x = 0; x < 200; ++x) {
      image.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(0.6 * texture(x, y) + 20.0);
      const Eigen::Vector2d from =
          centre + warp.inverse() * (Eigen::Vector2d(x, y) - centre - shift);
      other.at<std::uint8_t>(y, x) =
          cv::saturate_cast<std::uint8_t>(0.4 * texture(from.x(), from.y()) + 50.0);
    }
  }
  const auto patch = Patch::sample(image, centre);
  ASSERT_NE(patch, nullptr);
  const PatchAlignment found = patch->align(other, centre, Eigen::Matrix2d::Identity(), 0.5, 30);
  EXPECT_TRUE(found.converged);
  EXPECT_LT((found.pixel - centre - shift).norm(), 0.03);
  EXPECT_LT((found.warp - warp).norm(), 0.02);
  EXPECT_GT(found.correlation, 0.99);
  EXPECT_EQ(Patch::sample(image, {3.0, 3.0}), nullptr);
  EXPECT_EQ(Patch::sample(cv::Mat(200, 200, CV_8UC1, cv::Scalar(9)), centre), nullptr);
}

// Lenses darken towards their edge: what moves across the picture gets a slope of brightness.
TEST(Patch, ASlopeOfBrightnessIsNoMotion) {
  cv::Mat image(200, 200, CV_8UC1);
  cv::Mat other(200, 200, CV_8UC1);
  const Eigen::Vector2d centre(100.0, 100.0);
  const auto blob = [&](const Eigen::Vector2d& p) {  // bright, as lamps in the dark
    return 90.0 + 80.0 * std::exp(-0.5 * (p - centre).squaredNorm() / (2.5 * 2.5));
  };
  for (int y = 0; y < 200; ++y) {
    for (int x = 0; x < 200; ++x) {
      const double value = blob({x, y});
      image.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(value);
      other.at<std::uint8_t>(y, x) =
          cv::saturate_cast<std::uint8_t>(value - 0.8 * (x - centre.x()) + 0.4 * (y - centre.y()));
    }
  }
  const auto patch = Patch::sample(image, centre);
  ASSERT_NE(patch, nullptr);
  const PatchAlignment found = patch->align(other, centre, Eigen::Matrix2d::Identity(), 1.0, 30);
  EXPECT_TRUE(found.converged);
  EXPECT_LT((found.pixel - centre).norm(), 0.03);
}

// Judges 80 points of which every fourth moves by itself.
void expectOutliersFound(bool with_prior, double step, int most_wrong) {
  Random random(3);
  const SO3 R_true = SO3::exp(Eigen::Vector3d(0.02, -0.03, 0.01));
  const Eigen::Vector3d t = step * Eigen::Vector3d(0.2, 0.05, 0.3);
  std::vector<Eigen::Vector3d> before;
  std::vector<Eigen::Vector3d> after;
  std::vector<int> wrong;
  for (int i = 0; i < 80; ++i) {
    const Eigen::Vector3d p(random.uniform(-6.0, 6.0), random.uniform(-3.0, 3.0),
                            random.uniform(2.0, 8.0));
    Eigen::Vector3d q = R_true * p + t;
    const bool moves = i % 4 == 0;
    wrong.push_back(moves ? 1 : 0);
    if (moves)
      q += step * Eigen::Vector3d(random.uniform(0.3, 0.6), random.uniform(-0.9, -0.5), 0.0);
    before.push_back(p.normalized());
    after.push_back(q.normalized());
  }
  CameraMotion motion;
  motion.rotation_valid = with_prior;
  // The gyro's bias turns the prior by 0.3 deg: more than the threshold.
  motion.R_current_previous = SO3::exp(Eigen::Vector3d(0.004, 0.003, -0.002)) * R_true;
  OutlierOptions options;
  options.iterations = 100;
  const MotionConsensus consensus = findConsensus(before, after, motion, 300.0, options, 5);
  EXPECT_TRUE(consensus.judged);
  int false_alarms = 0;
  int missed = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (wrong[i] == 0 && consensus.inlier[i] == 0) ++false_alarms;
    if (wrong[i] == 1 && consensus.inlier[i] == 1) ++missed;
  }
  EXPECT_LE(false_alarms, most_wrong) << "of 60";
  EXPECT_LE(missed, most_wrong) << "of 20";
}

TEST(Outliers, TellsWhatMovesByItself) {
  expectOutliersFound(true, 1.0, 3);
}

// The rotation is taken from the features then, which takes a motion that is small beside them.
TEST(Outliers, TellsWhatMovesWithoutAPrior) {
  expectOutliersFound(false, 0.2, 8);
}

}  // namespace
}  // namespace parkade
