// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/io/rig_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "parkade/io/sequence_test_support.hpp"

namespace parkade {
namespace {

using testing::HasSubstr;

constexpr double kDegree = std::numbers::pi / 180.0;

// A camera frame that looks along the vehicle's x-axis: x right, y down.
SO3 forward() {
  Eigen::Matrix3d R_vehicle_cam;
  R_vehicle_cam << 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
  return SO3(R_vehicle_cam);
}

TEST(RigReport, ViewDirectionIsWhatTheMountingSays) {
  const ViewDirection ahead = viewDirection(SE3(forward(), Eigen::Vector3d::Zero()));
  EXPECT_NEAR(ahead.yaw, 0.0, 1e-12);
  EXPECT_NEAR(ahead.pitch, 0.0, 1e-12);
  EXPECT_NEAR(ahead.roll, 0.0, 1e-12);
  // To the left, 20 degrees down: the optical axis points to +y and below the horizon.
  const SO3 left_down = SO3::fromYawPitchRoll(90.0 * kDegree, 20.0 * kDegree, 0.0) * forward();
  const Eigen::Vector3d axis = left_down * Eigen::Vector3d::UnitZ();
  EXPECT_GT(axis.y(), 0.9);
  EXPECT_LT(axis.z(), -0.3);
  const ViewDirection view = viewDirection(SE3(left_down, Eigen::Vector3d::Zero()));
  EXPECT_NEAR(view.yaw, 90.0 * kDegree, 1e-12);
  EXPECT_NEAR(view.pitch, 20.0 * kDegree, 1e-12);
}

TEST(RigReport, FieldOfViewOfAPinholeIsTwiceTheArcTangent) {
  PinholeRadtan::Parameters p;
  p.fx = p.fy = 100.0;
  p.cx = 100.0;
  p.cy = 50.0;
  const FieldOfView view = fieldOfView(Camera(PinholeRadtan(p), 201, 101));
  EXPECT_NEAR(view.horizontal, 2.0 * std::atan(1.0), 1e-9);
  EXPECT_NEAR(view.vertical, 2.0 * std::atan(0.5), 1e-9);
}

TEST(RigReport, FieldOfViewOfAFisheyePassesHalfATurn) {
  PinholeEquidistant::Parameters p;
  p.fx = p.fy = 100.0;
  p.cx = 170.0;
  p.cy = 100.0;
  const FieldOfView view = fieldOfView(Camera(PinholeEquidistant(p), 341, 201));
  EXPECT_NEAR(view.horizontal, 3.4, 1e-6);
  EXPECT_NEAR(view.vertical, 2.0, 1e-6);
}

TEST(RigReport, TextAndJsonSayTheSame) {
  const Rig rig = test::smallRig();
  EXPECT_THAT(rigText(rig), testing::AllOf(HasSubstr("2 cameras"), HasSubstr("pinhole-radtan"),
                                           HasSubstr("64 x 48"), HasSubstr("wheelbase 2.850 m")));
  const nlohmann::json json = rigJson(rig);
  EXPECT_EQ(json["cameras"].size(), 2u);
  EXPECT_EQ(json["cameras"][1]["name"], "cam1");
  EXPECT_EQ(json["imu"]["rate_hz"], 100.0);
}

}  // namespace
}  // namespace parkade
