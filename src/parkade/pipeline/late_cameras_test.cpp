// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/pipeline/late_cameras.hpp"

#include <gtest/gtest.h>

namespace parkade {
namespace {

TEST(LateCameras, StandWhereTheCarWasWhenTheyTookTheirPictures) {
  const SO3 R_vehicle_imu = SO3::exp({0.0, 0.0, 0.5});
  PoseEstimate pose;
  pose.T_odom_vehicle = SE3(SO3::exp({0.0, 0.0, 1.0}), {3.0, 4.0, 0.0});
  pose.velocity_odom = pose.T_odom_vehicle.rotation() * Eigen::Vector3d(4.0, 0.0, 0.0);
  pose.bias_gyro = {0.01, 0.0, 0.02};
  const Eigen::Vector3d gyro = R_vehicle_imu.inverse() * Eigen::Vector3d(0.0, 0.0, 0.3);
  CameraCalibrationEstimate camera;
  camera.T_vehicle_cam = SE3(SO3::exp({0.1, 0.2, 0.3}), {1.0, 0.5, 0.8});
  CameraCalibrationEstimate late = camera;
  late.time_offset = -0.02;  // what is stamped now was taken 20 ms ago
  const CamerasAtStamp there =
      camerasAtStamp({camera, late}, pose, gyro + pose.bias_gyro, R_vehicle_imu);
  const std::vector<SE3>& places = there.T_vehicle_cam;
  ASSERT_EQ(places.size(), 2u);
  EXPECT_TRUE(places[0].matrix().isApprox(camera.T_vehicle_cam.matrix(), 1e-12));
  const SE3 T_now_then(SO3::exp({0.0, 0.0, -0.006}), {-0.08, 0.0, 0.0});
  EXPECT_TRUE(places[1].matrix().isApprox((T_now_then * camera.T_vehicle_cam).matrix(), 1e-3));
  EXPECT_NEAR(places[1].translation().x(), 1.0 - 0.08 + 0.006 * 0.5, 1e-3);
}

TEST(LateCameras, RowsAreReadFromWhereTheCarIsThen) {
  RigCamera camera;
  camera.camera = Camera(PinholeEquidistant({300.0, 300.0, 319.5, 200.0}), 640, 401);
  Eigen::Matrix3d optical;  // columns: right, down, ahead
  optical << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  camera.T_vehicle_cam =
      SE3(SO3::fromYawPitchRoll(M_PI / 2, 0.3, 0.0) * SO3(optical), {2.0, 0.9, 1.0});
  const double horizon = rowOf(camera, 1000.0, 1.0);
  EXPECT_NEAR(horizon, 200.0 - 300.0 * 0.3, 0.1);
  EXPECT_GT(rowOf(camera, 3.0, 0.0), horizon + 50.0);
  EXPECT_EQ(rowOf(camera, 1.0, 1000.0), 0.0);

  Vector6d twist;
  twist << 4.0, 0.0, 0.0, 0.0, 0.0, 0.0;
  EXPECT_EQ(cameraAtRow(camera, camera.T_vehicle_cam, 0.0, twist).translation().x(), 2.0);
  camera.readout_time = 0.03;
  EXPECT_NEAR(cameraAtRow(camera, camera.T_vehicle_cam, 0.0, twist).translation().x(), 1.94, 1e-9);
  EXPECT_NEAR(cameraAtRow(camera, camera.T_vehicle_cam, 400.0, twist).translation().x(), 2.06,
              1e-9);
}

}  // namespace
}  // namespace parkade
