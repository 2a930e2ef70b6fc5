// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/texts/zone_marker_faces.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "parkade/core/random.hpp"
#include "parkade/semantics/texts/zone_marker_outline.hpp"
#include "parkade/types/semantic_class.hpp"

namespace parkade {
namespace {

constexpr double kDegree = M_PI / 180.0;
constexpr auto kMarker = static_cast<std::uint8_t>(SemanticClass::kZoneMarker);

// The outline of a pillar of 1 x 1 marker heights whose nearest edge stands `depth` ahead, `x0`
// (over the depth) to the right; its left face turned by psi from straight across.
std::vector<MarkerColumn> pillarOutline(double x0, double depth, double psi, double middle,
                                        double& x_left, double& x_right) {
  const Eigen::Vector2d edge(x0 * depth, depth);
  const Eigen::Vector2d left = edge + Eigen::Vector2d(-std::cos(psi), std::sin(psi));
  const Eigen::Vector2d right = edge + Eigen::Vector2d(std::sin(psi), std::cos(psi));
  x_left = left.x() / left.y();
  x_right = right.x() / right.y();
  const auto along = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b, double x) {
    const Eigen::Vector2d d = b - a;  // where the ray (x, 1) meets the line
    const double s = (x * a.y() - a.x()) / (d.x() - x * d.y());
    return a.y() + s * d.y();
  };
  std::vector<MarkerColumn> columns;
  constexpr int kColumns = 40;
  for (int k = 0; k < kColumns; ++k) {
    const double x = x_left + (x_right - x_left) * (k + 0.5) / kColumns;
    const double at = x < x0 ? along(left, edge, x) : along(edge, right, x);
    columns.push_back({x, (middle - 0.5) / at, (middle + 0.5) / at});
  }
  return columns;
}

TEST(ZoneMarkerOutline, TwoFacesOfAPillarNearExact) {
  for (const double psi : {25.0, 45.0, 65.0}) {
    double x_left = 0.0;
    double x_right = 0.0;
    const auto columns = pillarOutline(0.02, 8.0, psi * kDegree, 1.5, x_left, x_right);
    const FittedMarker marker = fitMarker(columns, x_left, x_right, 1e-4);
    ASSERT_EQ(marker.faces.size(), 2U) << psi;
    // The grid is 5 degrees and a 24th of the outline.
    EXPECT_NEAR(marker.faces[0].width(), 1.0, 0.1) << psi;
    EXPECT_NEAR(marker.faces[1].width(), 1.0, 0.1) << psi;
    EXPECT_NEAR(marker.faces[0].depth_right, 8.0, 0.1) << psi;
    EXPECT_NEAR(marker.middle, 1.5, 0.03) << psi;
  }
}

TEST(ZoneMarkerOutline, OneFaceSeenFromAhead) {
  std::vector<MarkerColumn> columns;
  for (int k = 0; k < 20; ++k) columns.push_back({-0.05 + 0.005 * (k + 0.5), 0.10, 0.20});
  const FittedMarker marker = fitMarker(columns, -0.05, 0.05, 0.002);
  ASSERT_EQ(marker.faces.size(), 1U);
  EXPECT_NEAR(marker.faces[0].width(), 1.0, 1e-9);
  EXPECT_NEAR(marker.faces[0].slant(), 0.0, 1e-9);
  EXPECT_NEAR(marker.middle, 1.5, 1e-9);
}

TEST(ZoneMarkerOutline, NoiseDoesNotMakeEdges) {
  Random random(5);
  int split = 0;
  constexpr double kSigma = 0.004;
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<MarkerColumn> columns;
    for (int k = 0; k < 20; ++k) {
      const double noise = 0.5 * random.normal(0.0, kSigma);
      columns.push_back({-0.05 + 0.005 * (k + 0.5), 0.10 - noise, 0.20 + noise});
    }
    split += fitMarker(columns, -0.05, 0.05, kSigma).faces.size() == 2 ? 1 : 0;
  }
  EXPECT_LE(split, 5);
}

TEST(ZoneMarkerOutline, TellsTheOtherWayToPartIt) {
  double x_left = 0.0;
  double x_right = 0.0;
  const auto columns = pillarOutline(0.02, 8.0, 45.0 * kDegree, 1.5, x_left, x_right);
  const FittedMarker marker = fitMarker(columns, x_left, x_right, 0.006);
  ASSERT_EQ(marker.faces.size(), 2U);
  EXPECT_EQ(marker.other_faces.size(), 1U);
  EXPECT_TRUE(fitMarker(columns, x_left, x_right, 0.006, false).other_faces.empty());
}

/// A camera before a square pillar with a chequered marker, ray by ray.
class PillarScene : public testing::Test {
 protected:
  PillarScene() {
    PinholeEquidistant::Parameters p;
    p.fx = p.fy = 290.0;
    p.cx = 319.5;
    p.cy = 199.5;
    camera_ = Camera(PinholeEquidistant(p), 640, 400);
    // Looks along +x of the level frame, 15 degrees down.
    Eigen::Matrix3d axes;
    axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    R_level_cam_ = SO3::fromYawPitchRoll(0.0, 15.0 * kDegree, 0.0) * SO3(axes);
  }

  // The pillar: 0.7 m square, its middle `ahead` metres ahead and 1.5 m to the left, turned; the
  // marker 0.6 m high, its middle 0.9 m above the camera. Each face is white left and black right.
  void draw(double ahead, double turned) {
    labels_ = cv::Mat::zeros(400, 640, CV_8UC1);
    image_ = cv::Mat(400, 640, CV_8UC3, cv::Scalar::all(90));
    const Eigen::Vector2d middle(ahead, 1.5);
    Eigen::Matrix2d R;
    R << std::cos(turned), -std::sin(turned), std::sin(turned), std::cos(turned);
    for (int v = 0; v < 400; ++v) {
      for (int u = 0; u < 640; ++u) {
        Eigen::Vector3d ray;
        if (!camera_.unproject({u, v}, ray)) continue;
        ray = R_level_cam_ * ray;
        paint(u, v, R.transpose() * middle, R.transpose() * ray.head<2>(), ray.z());
      }
    }
  }
  void paint(int u, int v, const Eigen::Vector2d& middle, const Eigen::Vector2d& ray, double rise) {
    constexpr double kHalf = 0.35;
    double nearest = 1e9;
    std::uint8_t colour = 0;
    for (int axis = 0; axis < 2; ++axis) {
      const int other = 1 - axis;
      const double side = ray[axis] > 0.0 ? -kHalf : kHalf;  // the face towards the camera
      const double s = (middle[axis] + side) / ray[axis];
      const double across = s * ray[other] - middle[other];
      if (s <= 0.0 || std::abs(across) > kHalf || s >= nearest) continue;
      nearest = s;
      // Left as the camera sees it.
      const double left =
          axis == 0 ? across * (ray[0] > 0.0 ? 1.0 : -1.0) : across * (ray[1] > 0.0 ? -1.0 : 1.0);
      colour = left > 0.0 ? 250 : 10;
    }
    if (nearest > 1e8 || std::abs(nearest * rise - 0.9) > 0.3) return;
    labels_.at<std::uint8_t>(v, u) = kMarker;
    image_.at<cv::Vec3b>(v, u) = {colour, colour, colour};
  }

  Camera camera_;
  SO3 R_level_cam_;
  cv::Mat labels_;
  cv::Mat image_;
};

TEST_F(PillarScene, BothFacesAreStraightened) {
  draw(4.0, 60.0 * kDegree);
  const auto sights = findZoneMarkers(labels_, image_, {}, camera_, R_level_cam_, {});
  ASSERT_EQ(sights.size(), 1U);
  const ZoneMarkerSight& sight = sights[0];
  EXPECT_FALSE(sight.cut);
  ASSERT_EQ(sight.faces.size(), 2U);
  for (const ZoneMarkerFace& face : sight.faces) {
    ASSERT_EQ(face.patch.size(), cv::Size(kZonePatchWidth, kZonePatchHeight));
    // White left, black right, the change in the middle.
    const cv::Mat left = face.patch(cv::Rect(32, 10, 12, 20));
    const cv::Mat right = face.patch(cv::Rect(52, 10, 12, 20));
    EXPECT_GT(cv::mean(left)[0], 150.0);
    EXPECT_LT(cv::mean(right)[0], 110.0);
  }
  const Eigen::Vector3d middle = Eigen::Vector3d(4.0, 1.5, 0.9).normalized();
  // The outline's middle lies off the axis by what ZoneMarkerTrackerOptions::place_sigma_m says.
  EXPECT_NEAR(std::acos(std::min(1.0, middle.dot(sight.ray_level))), 0.0, 2.0 * 0.08 / 4.0);
  // Its height over the distance of the nearest faces.
  EXPECT_NEAR(sight.height_ratio, 0.6 / (std::hypot(4.0, 1.5) - 0.35), 0.02);
}

TEST_F(PillarScene, SmallLabelPicturesDo) {
  draw(5.0, 10.0 * kDegree);
  cv::Mat small;
  cv::resize(labels_, small, {320, 192}, 0, 0, cv::INTER_NEAREST);
  const auto sights = findZoneMarkers(small, image_, {}, camera_, R_level_cam_, {});
  ASSERT_EQ(sights.size(), 1U);
  const Eigen::Vector3d middle = Eigen::Vector3d(5.0, 1.5, 0.9).normalized();
  EXPECT_NEAR(std::acos(std::min(1.0, middle.dot(sights[0].ray_level))), 0.0, 0.02);
  EXPECT_FALSE(sights[0].faces.empty());
}

TEST_F(PillarScene, WhatIsCutAboveIsReadButPlacesLittle) {
  draw(4.0, 35.0 * kDegree);
  const auto whole = findZoneMarkers(labels_, image_, {}, camera_, R_level_cam_, {});
  const cv::Rect box = cv::boundingRect(labels_);
  cv::Mat mask(400, 640, CV_8UC1, cv::Scalar(255));
  mask(cv::Rect(0, 0, 640, box.y + box.height / 5)).setTo(0);
  labels_.setTo(0, mask == 0);
  const auto sights = findZoneMarkers(labels_, image_, mask, camera_, R_level_cam_, {});
  ASSERT_EQ(whole.size(), 1U);
  ASSERT_EQ(sights.size(), 1U);
  EXPECT_TRUE(sights[0].cut);
  EXPECT_EQ(sights[0].faces.size(), whole[0].faces.size());
  EXPECT_GT(sights[0].sigma, 10.0 * whole[0].sigma);
  EXPECT_GT(sights[0].height_sigma, 10.0 * whole[0].height_sigma);
}

// A car to the right of the marker, as high as half of it.
TEST_F(PillarScene, ACarHidesWhereThePillarGoesOnAboveIt) {
  draw(4.0, 35.0 * kDegree);
  const cv::Rect box = cv::boundingRect(labels_);
  const cv::Rect car(box.x + 2 * box.width / 3, box.y + box.height / 4, 2 * box.width, box.height);
  const auto label = [](SemanticClass c) { return cv::Scalar(static_cast<int>(c)); };
  cv::Mat hidden = labels_.clone();
  const cv::Rect shaft(box.x, 0, box.width, 400);
  hidden(shaft).setTo(label(SemanticClass::kPillar), hidden(shaft) == 0);
  hidden(car & cv::Rect(0, 0, 640, 400)).setTo(label(SemanticClass::kVehicle));
  auto sights = findZoneMarkers(hidden, image_, {}, camera_, R_level_cam_, {});
  ASSERT_EQ(sights.size(), 1U);
  EXPECT_FALSE(sights[0].legible);
  cv::Mat behind = labels_.clone();
  cv::Mat right = behind.colRange(box.br().x, std::min(640, box.br().x + 2 * box.width));
  right.rowRange(car.y, car.br().y).setTo(label(SemanticClass::kVehicle));
  sights = findZoneMarkers(behind, image_, {}, camera_, R_level_cam_, {});
  ASSERT_EQ(sights.size(), 1U);
  EXPECT_TRUE(sights[0].legible);
  EXPECT_FALSE(sights[0].cut);
}

TEST_F(PillarScene, WhatIsCutAsideIsNotLegible) {
  draw(4.0, 35.0 * kDegree);
  const cv::Rect box = cv::boundingRect(labels_);
  cv::Mat mask(400, 640, CV_8UC1, cv::Scalar(255));
  mask(cv::Rect(0, 0, box.x + box.width / 2, 400)).setTo(0);
  labels_.setTo(0, mask == 0);
  const auto sights = findZoneMarkers(labels_, image_, mask, camera_, R_level_cam_, {});
  ASSERT_EQ(sights.size(), 1U);
  EXPECT_TRUE(sights[0].cut);
  EXPECT_FALSE(sights[0].legible);
  EXPECT_FALSE(sights[0].faces.empty());  // a pillar's text may stand on the other face
  cv::Mat signs = labels_.clone();
  signs.setTo(static_cast<int>(SemanticClass::kSpeedLimitSign), labels_ != 0);
  const auto cut_signs =
      findSigns(signs, image_, mask, camera_, R_level_cam_, SemanticClass::kSpeedLimitSign, {});
  ASSERT_EQ(cut_signs.size(), 1U);
  EXPECT_TRUE(cut_signs[0].faces.empty());
  EXPECT_TRUE(
      findZoneMarkers(cv::Mat::zeros(400, 640, CV_8UC1), image_, {}, camera_, R_level_cam_, {})
          .empty());
}

}  // namespace
}  // namespace parkade
