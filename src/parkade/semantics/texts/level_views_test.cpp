// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/texts/level_views.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "parkade/types/semantic_class.hpp"

namespace parkade {
namespace {

constexpr int kPillar = static_cast<int>(SemanticClass::kPillar);
constexpr int kUnknown = static_cast<int>(SemanticClass::kUnknown);

/// A camera on the left side of a car that leans, and a square pillar of 0.6 m before it.
class LevelViewOfAPillar : public testing::Test {
 protected:
  LevelViewOfAPillar() {
    PinholeEquidistant::Parameters p;
    p.fx = p.fy = 200.0;
    p.cx = 319.5;
    p.cy = 199.5;
    camera_ = Camera(PinholeEquidistant(p), 640, 400);
    Eigen::Matrix3d left;  // looks along +y of the vehicle
    left << 1, 0, 0, 0, 0, 1, 0, -1, 0;
    T_level_cam_ = SE3(SO3::exp({0.0, 0.03, 0.0}) * SO3::exp({-0.05, 0.0, 0.0}), {0.0, 0.0, 0.02}) *
                   SE3(SO3(left), {1.5, 0.9, 0.9});
    // Labelled ray by ray, at half the camera's size.
    labels_ = cv::Mat(200, 320, CV_8UC1, cv::Scalar(kUnknown));
    for (int v = 0; v < labels_.rows; ++v) {
      for (int u = 0; u < labels_.cols; ++u) {
        Eigen::Vector3d ray;
        if (!camera_.unproject({2.0 * u + 0.5, 2.0 * v + 0.5}, ray)) continue;
        ray = T_level_cam_.rotation() * ray;
        const Eigen::Vector3d eye = T_level_cam_.translation();
        const double depth = pillar_.y() - 0.3 - eye.y();  // of its near face
        const Eigen::Vector3d at = eye + depth / ray.y() * ray;
        if (ray.y() > 0.0 && std::abs(at.x() - pillar_.x()) < 0.3 && at.z() > 0.0 && at.z() < 2.0) {
          labels_.at<std::uint8_t>(v, u) = kPillar;
        }
      }
    }
  }
  [[nodiscard]] Eigen::Vector3d onFace(double x, double z) const {
    return {pillar_.x() + x, pillar_.y() - 0.3, z};
  }

  Camera camera_;
  SE3 T_level_cam_;
  cv::Mat labels_;
  Eigen::Vector2d pillar_{3.0, 4.6};
};

TEST_F(LevelViewOfAPillar, ShowsEachLabelInItsDirection) {
  const LevelView view = levelView(labels_, {}, camera_, T_level_cam_);
  EXPECT_LT((view.eye - T_level_cam_.translation()).norm(), 1e-12);
  for (const double x : {-0.2, 0.0, 0.2}) {
    for (double z = 0.15; z < 1.9; z += 0.1) {
      EXPECT_EQ(view.at(onFace(x, z)), kPillar) << x << " " << z;
      // The same direction at any distance.
      const Eigen::Vector3d far = view.eye + 3.0 * (onFace(x, z) - view.eye);
      EXPECT_EQ(view.at(far), kPillar);
    }
  }
  EXPECT_EQ(view.at(onFace(-0.42, 1.0)), kUnknown);
  EXPECT_EQ(view.at(onFace(0.42, 1.0)), kUnknown);
  EXPECT_EQ(view.at(onFace(0.0, 2.2)), kUnknown);
  EXPECT_EQ(view.at(onFace(0.0, -0.2)), kUnknown);
}

TEST_F(LevelViewOfAPillar, TellsWhatTheCameraDoesNotSee) {
  cv::Mat mask(camera_.height(), camera_.width(), CV_8UC1, cv::Scalar(255));
  mask.rowRange(0, 200).setTo(0);
  const LevelView view = levelView(labels_, mask, camera_, T_level_cam_);
  EXPECT_EQ(view.at(onFace(0.0, 1.7)), LevelView::kNotSeen);
  EXPECT_EQ(view.at(onFace(0.0, 0.3)), kPillar);
  EXPECT_EQ(view.at({1.5, -3.0, 0.9}), LevelView::kNotSeen);  // behind
  EXPECT_EQ(view.at({1.5, 4.0, 9.0}), LevelView::kNotSeen);   // above
  EXPECT_EQ(view.at(view.eye), LevelView::kNotSeen);          // no direction
  EXPECT_EQ(LevelView().at({1.0, 0.0, 0.0}), LevelView::kNotSeen);
}

TEST_F(LevelViewOfAPillar, CamerasThatLookDownAreAskedAllAround) {
  Eigen::Matrix3d down;
  down << 0, -1, 0, -1, 0, 0, 0, 0, -1;
  const SE3 T_level_cam(SO3(down), {1.0, 0.0, 2.5});
  const cv::Mat floor(200, 320, CV_8UC1, cv::Scalar(kPillar));
  const LevelView view = levelView(floor, {}, camera_, T_level_cam);
  for (double bearing = -3.1; bearing < 3.1; bearing += 0.05) {
    const Eigen::Vector3d p(1.0 + 6.0 * std::cos(bearing), 6.0 * std::sin(bearing), 0.0);
    Eigen::Vector2d pixel(-100.0, -100.0);
    ASSERT_TRUE(camera_.project(T_level_cam.inverse() * p, pixel));
    if (camera_.inImage(pixel, 8.0)) {
      EXPECT_EQ(view.at(p), kPillar) << bearing;
    }
    if (!camera_.inImage(pixel, -8.0)) {
      EXPECT_EQ(view.at(p), LevelView::kNotSeen) << bearing;
    }
  }
}

}  // namespace
}  // namespace parkade
