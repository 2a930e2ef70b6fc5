// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/texts/text_patch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "parkade/camera/camera.hpp"
#include "parkade/core/units.hpp"

namespace parkade {
namespace {

// A wall about 1 m before a fisheye camera, turned away from it, at the picture's side: nearer, and
// bent more, than texts are.
class FisheyePatch : public testing::Test {
 protected:
  FisheyePatch() : camera_(PinholeEquidistant({290.0, 290.0, 319.5, 199.5, {}}), 640, 400) {}

  [[nodiscard]] Eigen::Vector2d pixelAt(double u, double v) const {
    constexpr double kTurn = 50.0 * kDegree;
    constexpr double kScale = 60.0;  // px of the patch a metre
    const Eigen::Vector3d along(std::cos(kTurn), 0.0, std::sin(kTurn));
    const Eigen::Vector3d p =
        Eigen::Vector3d(1.0, 0.0, 1.5) + u / kScale * along + v / kScale * Eigen::Vector3d::UnitY();
    Eigen::Vector2d pixel;
    return camera_.project(p, pixel) ? pixel : kNoPixel;
  }

  Camera camera_;
};

TEST_F(FisheyePatch, SamplesWhereItIsTold) {
  // Pictures of their own columns and rows tell where a sample was taken.
  for (const int axis : {0, 1}) {
    cv::Mat ramp(400, 640, CV_32FC1);
    for (int v = 0; v < ramp.rows; ++v) {
      for (int u = 0; u < ramp.cols; ++u) {
        ramp.at<float>(v, u) = static_cast<float>(axis == 0 ? u : v);
      }
    }
    const cv::Mat patch = sampleTextPatch(ramp, kTallPatchHeight, 2,
                                          [this](double u, double v) { return pixelAt(u, v); });
    ASSERT_EQ(patch.size(), cv::Size(kZonePatchWidth, kTallPatchHeight));
    double worst = 0.0;
    for (int v = 0; v < patch.rows; ++v) {
      for (int u = 0; u < patch.cols; ++u) {
        const double told = patch.at<cv::Vec3f>(v, u)[0];
        const Eigen::Vector2d true_pixel =
            pixelAt(u + 0.5 - 0.5 * kZonePatchWidth, v + 0.5 - 0.5 * kTallPatchHeight);
        worst = std::max(worst, std::abs(told - true_pixel[axis]));
      }
    }
    // remap() itself takes places to 1/32 px.
    EXPECT_LT(worst, 0.12) << "axis " << axis;
  }
}

TEST_F(FisheyePatch, PlacesOfNoPixelAreBlack) {
  const cv::Mat white(400, 640, CV_8UC1, cv::Scalar(255));
  const cv::Mat patch = sampleTextPatch(white, kZonePatchHeight, 1, [this](double u, double v) {
    return u < 0.0 ? kNoPixel : pixelAt(u, v);
  });
  EXPECT_EQ(patch.at<cv::Vec3f>(20, 10), cv::Vec3f(0.0F, 0.0F, 0.0F));
  EXPECT_EQ(patch.at<cv::Vec3f>(20, 60), cv::Vec3f(255.0F, 255.0F, 255.0F));
}

}  // namespace
}  // namespace parkade
