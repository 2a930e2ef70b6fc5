// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "parkade/camera/rig.hpp"
#include "parkade/camera/test_folder.hpp"

namespace parkade {
namespace {

using testing::HasSubstr;

// As kalibr_calibrate_imu_camera writes it.
const char* const kCamchain = R"(cam0:
  T_cam_imu:
  - [0.0, -1.0, 0.0, 0.01]
  - [0.0, 0.0, -1.0, 0.02]
  - [1.0, 0.0, 0.0, 0.03]
  - [0.0, 0.0, 0.0, 1.0]
  cam_overlaps: [1]
  camera_model: pinhole
  distortion_coeffs: [-0.28, 0.07, 0.0001, 0.00002]
  distortion_model: radtan
  intrinsics: [458.0, 457.0, 367.0, 248.0]
  resolution: [752, 480]
  rostopic: /cam0/image_raw
  timeshift_cam_imu: -0.0056
cam1:
  T_cn_cnm1:
  - [1.0, 0.0, 0.0, -0.11]
  - [0.0, 1.0, 0.0, 0.0]
  - [0.0, 0.0, 1.0, 0.0]
  - [0.0, 0.0, 0.0, 1.0]
  cam_overlaps: [0]
  camera_model: omni
  distortion_coeffs: [0.1, 0.2, 0.0003, 0.0004]
  distortion_model: radtan
  intrinsics: [1.8, 900.0, 901.0, 376.0, 240.0]
  resolution: [752, 480]
  rostopic: /cam1/image_raw
)";

const char* const kImu = R"(#Accelerometers
accelerometer_noise_density: 1.86e-03
accelerometer_random_walk:   4.33e-04
gyroscope_noise_density:     1.87e-04
gyroscope_random_walk:       2.66e-05
rostopic:                    /imu0
update_rate:                 150.0
)";

const char* const kImuChain = R"(imu0:
  T_i_b:
  - [1.0, 0.0, 0.0, 0.0]
  - [0.0, 1.0, 0.0, 0.0]
  - [0.0, 0.0, 1.0, 0.0]
  - [0.0, 0.0, 0.0, 1.0]
  accelerometer_noise_density: 0.002
  accelerometer_random_walk: 0.0004
  gyroscope_noise_density: 0.0002
  gyroscope_random_walk: 2.0e-05
  model: calibrated
  rostopic: /imu0
  time_offset: 0.0
  update_rate: 200.0
)";

class Kalibr : public TestFolder {
 protected:
  std::string errorOf(const std::string& camchain, const std::string& imu) const {
    const Result<Rig> rig = readKalibr(write("camchain.yaml", camchain), write("imu.yaml", imu));
    EXPECT_FALSE(rig.ok());
    return rig.ok() ? "" : rig.error().message;
  }
};

TEST_F(Kalibr, ReadsChainAndImu) {
  const Result<Rig> rig = readKalibr(write("camchain.yaml", kCamchain), write("imu.yaml", kImu));
  ASSERT_TRUE(rig.ok()) << rig.error().message;
  EXPECT_EQ(rig->name, "camchain");
  ASSERT_EQ(rig->cameras.size(), 2U);
  EXPECT_EQ(rig->cameras[0].name, "cam0");
  EXPECT_STREQ(rig->cameras[0].camera.modelName(), "pinhole-radtan");
  EXPECT_STREQ(rig->cameras[1].camera.modelName(), "omni-radtan");
  EXPECT_EQ(rig->cameras[0].time_offset_ns, -5'600'000);
  EXPECT_FALSE(rig->vehicle.has_value());
  // T_cam_imu carries IMU points into the camera; the vehicle frame is the IMU's.
  const Eigen::Vector3d p_imu(2.0, 0.3, -0.2);
  const Eigen::Vector3d p_cam0(-0.3 + 0.01, 0.2 + 0.02, 2.0 + 0.03);
  EXPECT_LT((rig->cameras[0].T_vehicle_cam * p_cam0 - p_imu).norm(), 1e-12);
  // cam1 follows from the chain: p_cam1 = T_cn_cnm1 p_cam0.
  const Eigen::Vector3d p_cam1 = p_cam0 - Eigen::Vector3d(0.11, 0.0, 0.0);
  EXPECT_LT((rig->cameras[1].T_vehicle_cam * p_cam1 - p_imu).norm(), 1e-12);
  EXPECT_EQ(rig->imu.T_vehicle_imu.translation(), Eigen::Vector3d::Zero());
  EXPECT_EQ(rig->imu.rate_hz, 150.0);
  EXPECT_EQ(rig->imu.gyroscope_noise_density, 1.87e-4);
  EXPECT_EQ(rig->imu.accelerometer_random_walk, 4.33e-4);
}

TEST_F(Kalibr, AChainIsKnownWhereARigIsReadAndItsImuByItsName) {
  write("garage-imu.yaml", kImu);
  const Result<Rig> rig = readRig(write("garage-camchain-imucam.yaml", kCamchain));
  ASSERT_TRUE(rig.ok()) << rig.error().message;
  EXPECT_GT(rig->cameras.size(), 1U);
  EXPECT_GT(rig->imu.rate_hz, 0.0);
  const Result<Rig> alone = readRig(write("camchain.yaml", kCamchain));
  ASSERT_FALSE(alone.ok());
  EXPECT_THAT(alone.error().message, testing::HasSubstr("imu.yaml"));
}

TEST_F(Kalibr, ReadsTheImuFileThatItWrites) {
  const Result<Rig> rig =
      readKalibr(write("camchain.yaml", kCamchain), write("imu.yaml", kImuChain));
  ASSERT_TRUE(rig.ok()) << rig.error().message;
  EXPECT_EQ(rig->imu.rate_hz, 200.0);
  EXPECT_EQ(rig->imu.accelerometer_noise_density, 0.002);
}

TEST_F(Kalibr, ReadsAChainWithoutAnImu) {
  const std::string cameras_only =
      "cam0:" + std::string(kCamchain).substr(std::string(kCamchain).find("\n  cam_overlaps"));
  const Result<Rig> rig = readKalibr(write("camchain.yaml", cameras_only), "");
  ASSERT_TRUE(rig.ok()) << rig.error().message;
  EXPECT_EQ(rig->cameras[0].T_vehicle_cam.translation(), Eigen::Vector3d::Zero());
  EXPECT_EQ(rig->cameras[1].T_vehicle_cam.translation(), Eigen::Vector3d(0.11, 0.0, 0.0));
  EXPECT_THAT(errorOf(cameras_only, kImu),
              HasSubstr("camchain.yaml:2: cam0: missing key 'T_cam_imu'"));
}

TEST_F(Kalibr, ReadsTheInverseThatOpenVinsWrites) {
  const std::string text = replaced(kCamchain, "T_cam_imu", "T_imu_cam");
  const Result<Rig> rig = readKalibr(write("camchain.yaml", text), "");
  ASSERT_TRUE(rig.ok()) << rig.error().message;
  EXPECT_EQ(rig->cameras[0].T_vehicle_cam.translation(), Eigen::Vector3d(0.01, 0.02, 0.03));
}

TEST_F(Kalibr, RefusesBadChains) {
  EXPECT_THAT(errorOf(replaced(kCamchain, "cam1:", "cam2:"), kImu),
              HasSubstr("camchain.yaml:16: cam2: expected 'cam1'"));
  EXPECT_THAT(
      errorOf(replaced(kCamchain, "[0.0, -1.0, 0.0, 0.01]", "[0.0, -1.1, 0.0, 0.01]"), kImu),
      HasSubstr("camchain.yaml:3: cam0.T_cam_imu: the upper left 3x3 block is not a rot"));
  EXPECT_THAT(errorOf(replaced(kCamchain, "camera_model: omni", "camera_model: ds"), kImu),
              HasSubstr("camchain.yaml:22: cam1.camera_model: unknown value 'ds'"));
  EXPECT_THAT(errorOf(replaced(kCamchain, "rostopic:", "topic:"), kImu),
              HasSubstr("camchain.yaml:13: cam0: unknown key 'topic'"));
  EXPECT_THAT(errorOf(replaced(kCamchain, "-0.0056", ".inf"), kImu),
              HasSubstr("camchain.yaml:14: cam0.timeshift_cam_imu: expected a finite number"));
}

TEST_F(Kalibr, RefusesBadImuFiles) {
  EXPECT_THAT(errorOf(kCamchain, replaced(kImu, "1.87e-04", "0")),
              HasSubstr("imu.yaml:4: gyroscope_noise_density: expected a number > 0, found 0"));
  EXPECT_THAT(errorOf(kCamchain, replaced(kImu, "update_rate:", "rate:")),
              HasSubstr("imu.yaml:7: unknown key 'rate'"));
  EXPECT_THAT(errorOf(kCamchain, replaced(kImuChain, "calibrated", "scale-misalignment")),
              HasSubstr("imu.yaml:11: imu0.model: IMU model 'scale-misalignment'"));
  EXPECT_THAT(
      errorOf(kCamchain, replaced(kImuChain, "[1.0, 0.0, 0.0, 0.0]", "[1.0, 0.0, 0.0, 0.1]")),
      HasSubstr("imu.yaml:3: imu0.T_i_b: expected the identity"));
  EXPECT_THAT(errorOf(kCamchain, replaced(kImuChain, "time_offset: 0.0", "time_offset: 0.1")),
              HasSubstr("imu.yaml:13: imu0.time_offset: expected 0"));
  const Result<Rig> rig = readKalibr(write("camchain.yaml", kCamchain), path("none.yaml"));
  ASSERT_FALSE(rig.ok());
  EXPECT_THAT(rig.error().message, HasSubstr("none.yaml"));
}

}  // namespace
}  // namespace parkade
