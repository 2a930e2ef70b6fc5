// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/markings/painted_numbers.hpp"

#include <gtest/gtest.h>

#include "parkade/core/random.hpp"
#include "parkade/semantics/markings/painted_number_test_support.hpp"
#include "parkade/semantics/texts/text_patch.hpp"

namespace parkade {
namespace {

TEST(PaintedNumbers, AreMeasuredAlongTheirSlotsEntrance) {
  for (const double turn : {0.0, 0.3, -0.2}) {
    NumberedSlot slot;
    slot.turn = turn;
    const std::vector<PaintedNumber> found = findPaintedNumbers(slot.frame(), {});
    ASSERT_EQ(found.size(), 1U) << turn;
    EXPECT_EQ(found[0].object, 0U);
    EXPECT_EQ(found[0].slot, 0U);
    EXPECT_NEAR((found[0].right - slot.right()).norm(), 0.0, 1e-9);
    EXPECT_NEAR((found[0].up() - slot.up()).norm(), 0.0, 1e-9);
    // To a pixel of the labels.
    EXPECT_LT((found[0].center - slot.center).norm(), 0.04) << turn;
    EXPECT_NEAR(found[0].width, NumberedSlot::kWidth, 0.06) << turn;
    EXPECT_NEAR(found[0].height, NumberedSlot::kHeight, 0.06) << turn;
  }
}

TEST(PaintedNumbers, OutsideSlotsOrOfOtherSizesAreNone) {
  const NumberedSlot slot;
  SemanticFrame frame = slot.frame();
  PaintedNumberOptions options;
  options.max_height_m = 0.5;
  EXPECT_TRUE(findPaintedNumbers(frame, options).empty());
  options = {};
  options.min_height_m = 0.7;
  EXPECT_TRUE(findPaintedNumbers(frame, options).empty());
  for (Eigen::Vector2d& corner : frame.slots[0].corners) corner.x() += 3.0;
  EXPECT_TRUE(findPaintedNumbers(frame, {}).empty());
  frame = slot.frame();
  frame.objects[0].semantic_class = SemanticClass::kWheelStop;
  EXPECT_TRUE(findPaintedNumbers(frame, {}).empty());
}

TEST(PaintedNumbers, ResolutionInACamerasPicture) {
  const NumberedSlot slot;
  const RigCamera eye = NumberedSlot::camera();
  const PaintedNumber number = findPaintedNumbers(slot.frame(), {}).at(0);
  const double near = seenHeight(number, eye.camera, {}, eye.T_vehicle_cam);
  EXPECT_GT(near, 15.0);
  PaintedNumber far = number;
  far.center.y() += 1.5;
  const double less = seenHeight(far, eye.camera, {}, eye.T_vehicle_cam);
  EXPECT_GT(less, 5.0);
  EXPECT_LT(less, 0.6 * near);
  far.center.y() = -3.0;  // behind the camera
  EXPECT_EQ(seenHeight(far, eye.camera, {}, eye.T_vehicle_cam), 0.0);
  cv::Mat mask(400, 640, CV_8UC1, cv::Scalar(255));
  EXPECT_EQ(seenHeight(number, eye.camera, mask, eye.T_vehicle_cam), near);
  mask.colRange(0, 320).setTo(cv::Scalar(0));
  EXPECT_EQ(seenHeight(number, eye.camera, mask, eye.T_vehicle_cam), 0.0);
}

// Correlation of a patch with the paint itself.
double likeness(const cv::Mat& patch, const NumberedSlot& slot, const PaintedNumber& number) {
  const double scale = std::min(34.0 / (number.height / 0.52),
                                80.0 / (number.width + number.height * (1.0 / 0.52 - 1.0)));
  double sums[5] = {};
  int count = 0;
  for (int v = 8; v < kZonePatchHeight - 8; ++v) {
    for (int u = 20; u < kZonePatchWidth - 20; ++u, ++count) {
      const Eigen::Vector2d p = slot.at((u + 0.5 - 48.0) / scale, (20.0 - v - 0.5) / scale);
      const double a = patch.at<cv::Vec3b>(v, u)[1];
      const double b = slot.inked(p) ? 1.0 : 0.0;
      sums[0] += a;
      sums[1] += b;
      sums[2] += a * a;
      sums[3] += b * b;
      sums[4] += a * b;
    }
  }
  return (sums[4] - sums[0] * sums[1] / count) /
         std::sqrt((sums[2] - sums[0] * sums[0] / count) * (sums[3] - sums[1] * sums[1] / count));
}

TEST(PaintedNumbers, AreStraightenedFromTheCamerasPicture) {
  const RigCamera eye = NumberedSlot::camera();
  Random random(4);
  for (const double noise : {0.0, 6.0}) {
    for (const double turn : {0.0, 0.25}) {
      NumberedSlot slot;
      slot.turn = turn;
      const PaintedNumber number = findPaintedNumbers(slot.frame(), {}).at(0);
      const cv::Mat image = slot.see(eye, noise, random);
      const cv::Mat patch = straightenNumber(number, image, eye.camera, eye.T_vehicle_cam);
      ASSERT_EQ(patch.type(), CV_8UC3);
      ASSERT_EQ(patch.size(), cv::Size(kZonePatchWidth, kZonePatchHeight));
      EXPECT_GT(likeness(patch, slot, number), noise > 0.0 ? 0.75 : 0.8) << turn;
      cv::Mat turned;
      cv::flip(patch, turned, -1);
      EXPECT_LT(likeness(turned, slot, number), 0.5) << turn;
    }
  }
}

}  // namespace
}  // namespace parkade
