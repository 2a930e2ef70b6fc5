// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/tracking/grid_sampling.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "parkade/core/random.hpp"

namespace parkade {
namespace {

constexpr int kWidth = 60;
constexpr int kHeight = 50;

cv::Mat noise() {
  cv::Mat image(kHeight, kWidth, CV_8UC1);
  std::uint64_t n = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x)
      image.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(hash64(++n, 5) % 256);
  }
  return image;
}

std::vector<float> sample(const cv::Mat& image, const Eigen::Vector2d& pixel,
                          const Eigen::Matrix2d& warp, int radius) {
  const auto side = static_cast<std::size_t>(2 * radius + 1);
  std::vector<float> out(side * side, -1.0F);
  return sampleGrid(image, pixel, warp, radius, out.data()) ? out : std::vector<float>{};
}

double bilinear(const cv::Mat& image, const Eigen::Vector2d& p) {
  const int x = static_cast<int>(std::floor(p.x()));
  const int y = static_cast<int>(std::floor(p.y()));
  const double fx = p.x() - x;
  const double fy = p.y() - y;
  const auto at = [&](int dx, int dy) {
    return static_cast<double>(image.at<std::uint8_t>(y + dy, x + dx));
  };
  return (1.0 - fy) * ((1.0 - fx) * at(0, 0) + fx * at(1, 0)) +
         fy * ((1.0 - fx) * at(0, 1) + fx * at(1, 1));
}

const Eigen::Matrix2d kWarp = (Eigen::Matrix2d() << 1.1, -0.2, 0.3, 0.8).finished();

TEST(GridSampling, IsBilinear) {
  const cv::Mat image = noise();
  for (const int radius : {0, 1, 4, 7, 8}) {
    const Eigen::Vector2d pixel(27.3, 22.8);
    const std::vector<float> out = sample(image, pixel, kWarp, radius);
    ASSERT_FALSE(out.empty());
    std::size_t k = 0;
    for (int y = -radius; y <= radius; ++y) {
      for (int x = -radius; x <= radius; ++x, ++k)
        EXPECT_NEAR(out[k], bilinear(image, pixel + kWarp * Eigen::Vector2d(x, y)), 2e-3);
    }
  }
}

// The same pixels in the middle of a picture and at its right edge, where samples are taken singly.
TEST(GridSampling, ManyAtOnceAreTheSameToTheBit) {
  const cv::Mat image = noise();
  for (double x = 44.0; x < 48.0; x += 0.37) {
    const Eigen::Vector2d pixel(x, 20.2);
    const std::vector<float> whole = sample(image, pixel, kWarp, 7);
    ASSERT_FALSE(whole.empty());
    const int end = static_cast<int>(x + 7 * 1.3) + 3;
    EXPECT_EQ(sample(image.colRange(0, end), pixel, kWarp, 7), whole) << x;
    EXPECT_EQ(sample(image.colRange(0, end).clone(), pixel, kWarp, 7), whole) << x;
  }
}

TEST(GridSampling, StaysInsideThePicture) {
  const cv::Mat image = noise();
  const Eigen::Matrix2d same = Eigen::Matrix2d::Identity();
  EXPECT_FALSE(sample(image, {7.0, 7.0}, same, 7).empty());
  EXPECT_TRUE(sample(image, {6.9, 7.0}, same, 7).empty());
  EXPECT_TRUE(sample(image, {7.0, 6.9}, same, 7).empty());
  EXPECT_FALSE(sample(image, {kWidth - 8.1, kHeight - 8.1}, same, 7).empty());
  EXPECT_TRUE(sample(image, {kWidth - 8.0, 20.0}, same, 7).empty());
  EXPECT_TRUE(sample(image, {20.0, kHeight - 8.0}, same, 7).empty());
  EXPECT_TRUE(sample(image, {std::numeric_limits<double>::quiet_NaN(), 20.0}, same, 7).empty());
}

}  // namespace
}  // namespace parkade
