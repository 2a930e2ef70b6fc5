// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/pipeline/repeated_pictures.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

namespace parkade {
namespace {

FrameSet frameSet(int first, int second) {
  FrameSet frames;
  for (const int seed : {first, second}) {
    cv::RNG pixels(static_cast<unsigned>(seed));
    cv::Mat image(64, 48, CV_8UC3);
    pixels.fill(image, cv::RNG::UNIFORM, 0, 256);
    frames.images.push_back(image);
    frames.gray.emplace_back(64, 48, CV_8UC1, cv::Scalar(1));
    frames.image_t_ns.push_back(5);
  }
  return frames;
}

Rig twoCameras() {
  Rig rig;
  rig.cameras.resize(2);
  return rig;
}

TEST(RepeatedPictures, AreTakenOutWhereTheCarMoves) {
  RepeatedPictures pictures(twoCameras());
  FrameSet frames = frameSet(1, 2);
  EXPECT_EQ(pictures.drop(frames, true), 0);
  frames = frameSet(1, 3);
  EXPECT_EQ(pictures.drop(frames, true), 1);
  EXPECT_TRUE(frames.images[0].empty());
  EXPECT_TRUE(frames.gray[0].empty());
  EXPECT_EQ(frames.image_t_ns[0], 0);
  EXPECT_FALSE(frames.images[1].empty());
  // Again and again, until a new one comes.
  frames = frameSet(1, 4);
  EXPECT_EQ(pictures.drop(frames, true), 1);
  frames = frameSet(5, 6);
  EXPECT_EQ(pictures.drop(frames, true), 0);
}

TEST(RepeatedPictures, StayWhereTheCarMayStand) {
  RepeatedPictures pictures(twoCameras());
  FrameSet frames = frameSet(1, 2);
  pictures.drop(frames, true);
  frames = frameSet(1, 2);
  EXPECT_EQ(pictures.drop(frames, false), 0);
  EXPECT_FALSE(frames.images[0].empty());
  EXPECT_EQ(pictures.drop(frames, true), 2);
}

TEST(RepeatedPictures, ACameraThatGivesNothingInBetweenIsRemembered) {
  RepeatedPictures pictures(twoCameras());
  FrameSet frames = frameSet(1, 2);
  pictures.drop(frames, true);
  frames = frameSet(1, 3);
  frames.images[0] = cv::Mat();
  EXPECT_EQ(pictures.drop(frames, true), 0);
  frames = frameSet(1, 4);
  EXPECT_EQ(pictures.drop(frames, true), 1);
}

TEST(RepeatedPictures, WheelsAndTheOdometryTellWhetherTheCarMoves) {
  EXPECT_FALSE(saysMotion(std::vector<WheelSample>{}));
  EXPECT_FALSE(saysMotion({{0, 0.1, NAN, NAN}, {1, NAN, NAN, NAN}}));
  EXPECT_TRUE(saysMotion({{0, 0.0, 0.0, NAN}, {1, NAN, -0.2, NAN}}));
  MotionPrior prior;
  prior.T_previous_current = SE3(SO3(), {0.1, 0.0, 0.0});
  EXPECT_FALSE(saysMotion(prior));
  prior.valid = true;
  EXPECT_FALSE(saysMotion(prior));
  prior.translation_valid = true;
  EXPECT_TRUE(saysMotion(prior));
  prior.T_previous_current = SE3(SO3::exp({0.0, 0.0, 0.01}), Eigen::Vector3d::Zero());
  EXPECT_TRUE(saysMotion(prior));
}

}  // namespace
}  // namespace parkade
