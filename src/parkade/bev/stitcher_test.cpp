// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/bev/stitcher.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "parkade/core/check.hpp"

namespace parkade {
namespace {

// A smooth ground texture, different everywhere.
double texture(double x, double y) {
  return 120.0 + 50.0 * std::sin(1.7 * x) * std::cos(1.3 * y) + 30.0 * std::sin(0.9 * x + 2.1 * y);
}

// Four wide cameras around a car, looking down at 30 deg.
Rig testRig() {
  Rig rig;
  rig.vehicle = VehicleShape{};
  const PinholeEquidistant model({.fx = 230.0, .fy = 230.0, .cx = 319.5, .cy = 199.5});
  const auto add = [&](const char* name, double x, double y, double yaw) {
    RigCamera camera;
    camera.name = name;
    camera.camera = Camera(model, 640, 400);
    Eigen::Matrix3d optical;  // columns: x right, y down, z forward, in a frame that looks along x
    optical << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    camera.T_vehicle_cam =
        SE3(SO3::fromYawPitchRoll(yaw, 0.52, 0.0) * SO3(optical), Eigen::Vector3d(x, y, 0.9));
    rig.cameras.push_back(camera);
  };
  add("front", 3.7, 0.0, 0.0);
  add("left", 2.0, 0.95, M_PI / 2);
  add("rear", -1.0, 0.0, M_PI);
  add("right", 2.0, -0.95, -M_PI / 2);
  return rig;
}

// What the cameras see of the textured ground when the body stands at an attitude over its plane.
FrameSet renderGround(const Rig& rig, const GroundAttitude& attitude,
                      const GroundRelief& relief = {}, const GroundMotion& motion = {}) {
  const SE3 T_ground_stamp(SO3::fromYawPitchRoll(0.0, attitude.pitch, attitude.roll),
                           Eigen::Vector3d(0.0, 0.0, attitude.height));
  FrameSet frames;
  for (const RigCamera& camera : rig.cameras) {
    cv::Mat image = cv::Mat::zeros(camera.camera.height(), camera.camera.width(), CV_8UC1);
    for (int v = 0; v < image.rows; ++v) {
      const double late = camera.rowTime(v);
      const SE3 T_stamp_row(SO3::exp({0.0, 0.0, late * motion.yaw_rate}),
                            {late * motion.velocity.x(), late * motion.velocity.y(), 0.0});
      const SE3 T_ground_cam = T_ground_stamp * T_stamp_row * camera.T_vehicle_cam;
      for (int u = 0; u < image.cols; ++u) {
        Eigen::Vector3d ray;
        if (!camera.camera.unproject(Eigen::Vector2d(u, v), ray)) continue;
        ray = T_ground_cam.rotation() * ray;
        if (ray.z() > -0.01) continue;
        const Eigen::Vector3d& eye = T_ground_cam.translation();
        Eigen::Vector3d p = eye - eye.z() / ray.z() * ray;
        for (int k = 0; k < 8 && !relief.isFlat(); ++k) {
          p = eye + (relief.at(p.head<2>()) - eye.z()) / ray.z() * ray;
        }
        image.at<std::uint8_t>(v, u) =
            static_cast<std::uint8_t>(std::lround(texture(p.x(), p.y())));
      }
    }
    frames.images.push_back(image);
    frames.image_t_ns.push_back(0);
  }
  return frames;
}

// Root mean square difference to the true texture over the valid pixels within a range of the car.
double rmsError(const BevImage& bev, double range) {
  double sum = 0.0;
  int count = 0;
  for (int v = 0; v < bev.image.rows; ++v) {
    for (int u = 0; u < bev.image.cols; ++u) {
      const Eigen::Vector2d p = bev.geometry.toGround(Eigen::Vector2d(u, v));
      if (bev.valid.at<std::uint8_t>(v, u) == 0 || (p - bev.geometry.center).norm() > range)
        continue;
      const double difference = bev.image.at<std::uint8_t>(v, u) - texture(p.x(), p.y());
      sum += difference * difference;
      ++count;
    }
  }
  EXPECT_GT(count, 1000);
  return std::sqrt(sum / count);
}

double coverage(const BevImage& bev) {
  return cv::countNonZero(bev.valid) / static_cast<double>(bev.valid.total());
}

TEST(BevGeometry, PixelsAndGroundAreInverse) {
  BevGeometry geometry;
  geometry.center = {1.4, 0.0};
  const Eigen::Vector2d ahead_left = geometry.toPixel({5.0, 2.0});
  EXPECT_LT(ahead_left.x(), 191.5);
  EXPECT_LT(ahead_left.y(), 191.5);
  EXPECT_LT((geometry.toGround(ahead_left) - Eigen::Vector2d(5.0, 2.0)).norm(), 1e-12);
}

TEST(BevStitcher, AgreesWithTheTrueGround) {
  const Rig rig = testRig();
  BevStitcher stitcher(rig, {});
  const BevImage bev = stitcher.stitch(renderGround(rig, {}));
  EXPECT_LT(rmsError(bev, 6.0), 0.8);  // rounding twice and interpolating once
  EXPECT_GT(coverage(bev), 0.85);
}

TEST(BevStitcher, CorrectsARollingShutter) {
  Rig rig = testRig();
  for (RigCamera& camera : rig.cameras) camera.readout_time = 0.06;
  const GroundMotion motion{{4.0, 0.1}, 0.4};
  const FrameSet frames = renderGround(rig, {}, {}, motion);
  BevStitcher stitcher(rig, {});
  const double uncorrected = rmsError(stitcher.stitch(frames), 6.0);
  const double corrected = rmsError(stitcher.stitch(frames, {}, {}, motion), 6.0);
  EXPECT_GT(uncorrected, 1.5);
  EXPECT_LT(corrected, 0.8);  // as of a car that stands
}

TEST(BevStitcher, CorrectsPitchRollAndHeight) {
  const Rig rig = testRig();
  const GroundAttitude attitude{0.5 * M_PI / 180.0, -0.4 * M_PI / 180.0, -0.02};
  const FrameSet frames = renderGround(rig, attitude);
  BevStitcher stitcher(rig, {});
  const double uncorrected = rmsError(stitcher.stitch(frames), 6.0);
  const double corrected = rmsError(stitcher.stitch(frames, attitude), 6.0);
  EXPECT_GT(uncorrected, 4.0);
  EXPECT_LT(corrected, 1.0);
}

TEST(BevStitcher, FollowsTheFloorsRelief) {
  const Rig rig = testRig();
  GroundRelief ridge;  // under the car; the floor falls by 2 % ahead and behind, by 1 % to the left
  ridge.first.setConstant(-10.0);
  ridge.step_m = 2.0;
  ridge.heights.resize(11, 11);
  for (int i = 0; i < 11; ++i) {
    for (int j = 0; j < 11; ++j) {
      ridge.heights(i, j) = -0.02 * std::abs(2.0 * i - 10.0) - 0.01 * std::max(0.0, 2.0 * j - 10.0);
    }
  }
  EXPECT_NEAR(ridge.at({3.0, 1.0}), -0.07, 1e-12);
  EXPECT_NEAR(ridge.at({50.0, 0.0}), -0.2, 1e-12);  // as at the edge
  const FrameSet frames = renderGround(rig, {}, ridge);
  BevStitcher stitcher(rig, {});
  const double as_plane = rmsError(stitcher.stitch(frames), 6.0);
  const double with_relief = rmsError(stitcher.stitch(frames, {}, ridge), 6.0);
  EXPECT_GT(as_plane, 8.0);
  EXPECT_LT(with_relief, 1.5);
}

TEST(BevStitcher, CamerasMovedToWhereTheySitGiveThePictureOfTheTrueRig) {
  const Rig rig = testRig();
  const FrameSet frames = renderGround(rig, {});
  cv::Mat mask(rig.cameras[1].camera.height(), rig.cameras[1].camera.width(), CV_8UC1,
               cv::Scalar(255));
  mask.rowRange(350, mask.rows).setTo(0);
  BevStitcher right(rig, {});
  right.setMask(1, mask);
  const BevImage expected = right.stitch(frames);

  Rig told = rig;
  told.cameras[0].T_vehicle_cam.rotation() =
      told.cameras[0].T_vehicle_cam.rotation() * SO3::exp({0.01, 0.0, 0.0});
  told.cameras[1].T_vehicle_cam.translation().z() += 0.03;
  BevStitcher moved(told, {});
  moved.setMask(1, mask);
  EXPECT_GT(rmsError(moved.stitch(frames), 6.0), 2.0);
  BevStitcher mended(told, {});
  mended.setMask(1, mask);
  mended.moveCamera(0, rig.cameras[0].T_vehicle_cam);
  mended.moveCamera(1, rig.cameras[1].T_vehicle_cam);
  const BevImage found = mended.stitch(frames);
  EXPECT_EQ(cv::norm(found.image, expected.image, cv::NORM_INF), 0.0);
  EXPECT_EQ(cv::norm(found.valid, expected.valid, cv::NORM_INF), 0.0);
}

TEST(BevStitcher, OwnCarAndUnseenGroundAreNotValid) {
  const Rig rig = testRig();
  BevStitcher stitcher(rig, {});
  const BevImage bev = stitcher.stitch(renderGround(rig, {}));
  const Eigen::Vector2d car = bev.geometry.toPixel({1.0, 0.3});
  EXPECT_EQ(bev.valid.at<std::uint8_t>(static_cast<int>(car.y()), static_cast<int>(car.x())), 0);
}

TEST(BevStitcher, OwnBodyIsLeftToTheNeighbours) {
  const Rig rig = testRig();
  BevStitcher plain(rig, {});
  BevStitcher masked(rig, {});
  FrameSet frames = renderGround(rig, {});
  // The left third of the front camera's picture is the own body, painted white.
  const cv::Rect body(0, 0, 213, 400);
  cv::Mat mask(400, 640, CV_8UC1, cv::Scalar(255));
  mask(body).setTo(0);
  masked.setMask(0, mask);
  const BevImage clean = plain.stitch(frames);
  frames.images[0](body).setTo(255);
  const BevImage with = masked.stitch(frames);
  // Wherever something is still seen it is the ground, not the body.
  cv::Mat difference;
  cv::absdiff(clean.image, with.image, difference);
  difference.setTo(0, with.valid == 0);
  double worst = 0.0;
  cv::minMaxLoc(difference, nullptr, &worst);
  EXPECT_LT(worst, 12.0);
  EXPECT_LT(cv::countNonZero(with.valid), cv::countNonZero(clean.valid));
  EXPECT_GT(cv::countNonZero(with.valid), cv::countNonZero(clean.valid) * 8 / 10);
}

TEST(BevStitcher, AMissingCameraLeavesAHoleOnly) {
  const Rig rig = testRig();
  BevStitcher stitcher(rig, {});
  FrameSet frames = renderGround(rig, {});
  const double all = coverage(stitcher.stitch(frames));
  frames.images[0] = cv::Mat();
  const BevImage bev = stitcher.stitch(frames);
  EXPECT_LT(coverage(bev), all);
  EXPECT_GT(coverage(bev), 0.5);
  EXPECT_LT(rmsError(bev, 6.0), 0.8);
  for (cv::Mat& image : frames.images) image = cv::Mat();
  EXPECT_EQ(coverage(stitcher.stitch(frames)), 0.0);
}

TEST(BevStitcher, BalancesBrightness) {
  const Rig rig = testRig();
  FrameSet frames = renderGround(rig, {});
  frames.images[1] *= 0.7;  // the left camera is darker
  BevStitcher stitcher(rig, {});
  static_cast<void>(stitcher.stitch(frames));
  const std::vector<double> gains = stitcher.gains();
  for (const int other : {0, 2, 3}) EXPECT_NEAR(gains[1] / gains[other], 1.0 / 0.7, 0.03);
}

TEST(BevStitcher, SameInputSameBytes) {
  const Rig rig = testRig();
  const FrameSet frames = renderGround(rig, {});
  BevStitcher a(rig, {});
  BevStitcher b(rig, {});
  const BevImage first = a.stitch(frames);
  const BevImage second = b.stitch(frames);
  EXPECT_EQ(cv::norm(first.image, second.image, cv::NORM_INF), 0.0);
}

TEST(BevStitcher, RefusesImagesOfAnotherSize) {
  const Rig rig = testRig();
  BevStitcher stitcher(rig, {});
  FrameSet frames = renderGround(rig, {});
  frames.images[2] = cv::Mat::zeros(10, 10, CV_8UC1);
  EXPECT_THROW(static_cast<void>(stitcher.stitch(frames)), CheckError);
}

}  // namespace
}  // namespace parkade
