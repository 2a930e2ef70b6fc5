// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/bev_scale.hpp"

#include <gtest/gtest.h>

#include "parkade/semantics/features_test_support.hpp"

namespace parkade {
namespace {

TEST(BevScale, PointsStayWhereTheyAre) {
  PaintedFloor floor;
  const Eigen::Vector2d p(3.0, -2.0);
  floor.polygon({p + Eigen::Vector2d(-0.2, -0.2), p + Eigen::Vector2d(0.2, -0.2),
                 p + Eigen::Vector2d(0.2, 0.2), p + Eigen::Vector2d(-0.2, 0.2)},
                SemanticClass::kSlotLine, 200);
  const BevImage half = rescaled(floor.bev, 0.08);
  EXPECT_EQ(half.image.cols, floor.bev.image.cols / 2);
  EXPECT_DOUBLE_EQ(half.geometry.metres_per_px, 0.08);
  // The bright square's middle, from the grey values.
  double sum = 0.0;
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (int v = 0; v < half.image.rows; ++v) {
    for (int u = 0; u < half.image.cols; ++u) {
      const double bright = half.image.at<std::uint8_t>(v, u) - 90.0;
      sum += bright;
      middle += bright * half.geometry.toGround(Eigen::Vector2d(u, v));
    }
  }
  EXPECT_LT((middle / sum - p).norm(), 0.01);
}

TEST(BevScale, OddSizesKeepTheGround) {
  BevImage bev;
  bev.geometry = {600, 600, 10.0 / 600, Eigen::Vector2d::Zero()};
  bev.image = cv::Mat(600, 600, CV_8UC3, cv::Scalar(10, 20, 30));
  bev.valid = cv::Mat(600, 600, CV_8UC1, cv::Scalar(255));
  const BevImage out = rescaled(bev, 0.037);
  EXPECT_EQ(out.image.cols, 270);
  EXPECT_NEAR(out.geometry.metres_per_px * out.image.cols, 10.0, 1e-9);
  EXPECT_EQ(cv::countNonZero(out.valid), out.valid.rows * out.valid.cols);
}

}  // namespace
}  // namespace parkade
