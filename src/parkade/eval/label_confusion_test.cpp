// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/eval/label_confusion.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "parkade/core/check.hpp"

namespace parkade {
namespace {

using enum SemanticClass;

std::uint8_t valueOf(SemanticClass c) {
  return static_cast<std::uint8_t>(c);
}

// Ten floor pixels and five of lines; three line pixels are called floor, one floor pixel line.
class Counted : public testing::Test {
 protected:
  Counted() : truth_(1, 15, CV_8UC1), found_(1, 15, CV_8UC1) {
    for (int u = 0; u < 15; ++u) {
      truth_.at<std::uint8_t>(0, u) = valueOf(u < 10 ? kFloor : kSlotLine);
      found_.at<std::uint8_t>(0, u) = valueOf(u < 9 || u >= 12 ? kFloor : kSlotLine);
    }
    confusion_.add(truth_, found_);
  }
  cv::Mat truth_;
  cv::Mat found_;
  LabelConfusion confusion_;
};

TEST_F(Counted, IouIsHitsOverUnion) {
  EXPECT_EQ(confusion_.count(kSlotLine, kFloor), 3);
  EXPECT_EQ(confusion_.truePixels(kFloor), 10);
  EXPECT_DOUBLE_EQ(confusion_.iou(kFloor), 9.0 / 13.0);
  EXPECT_DOUBLE_EQ(confusion_.iou(kSlotLine), 2.0 / 6.0);
  EXPECT_DOUBLE_EQ(confusion_.iou(std::vector{kFloor, kSlotLine}), 1.0);
}

TEST_F(Counted, ClassesThatDoNotOccurHaveNoScore) {
  EXPECT_TRUE(std::isnan(confusion_.iou(kArrow)));
  EXPECT_DOUBLE_EQ(confusion_.meanIou({kFloor, kSlotLine, kArrow}), 0.5 * (9.0 / 13.0 + 2.0 / 6.0));
  EXPECT_TRUE(std::isnan(confusion_.meanIou({kArrow})));
}

TEST_F(Counted, MasksAndSums) {
  cv::Mat mask(1, 15, CV_8UC1, cv::Scalar(255));
  mask.colRange(9, 15).setTo(0);
  LabelConfusion part;
  part.add(truth_, found_, mask);
  EXPECT_DOUBLE_EQ(part.iou(kFloor), 1.0);
  part.add(confusion_);
  EXPECT_EQ(part.truePixels(kFloor), 19);
}

TEST_F(Counted, RefusesOtherSizesAndValues) {
  EXPECT_THROW(confusion_.add(truth_, cv::Mat(2, 15, CV_8UC1, cv::Scalar(0))), CheckError);
  EXPECT_THROW(confusion_.add(truth_, cv::Mat(1, 15, CV_8UC1, cv::Scalar(200))), CheckError);
}

}  // namespace
}  // namespace parkade
