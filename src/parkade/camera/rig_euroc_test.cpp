// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "parkade/camera/rig.hpp"
#include "parkade/camera/test_folder.hpp"

namespace parkade {
namespace {

using testing::HasSubstr;

const char* const kCamera = R"(# General sensor definitions.
sensor_type: camera
comment: VI-Sensor cam0 (MT9M034)

# Sensor extrinsics wrt. the body-frame.
T_BS:
  cols: 4
  rows: 4
  data: [0.0, 0.0, 1.0, 0.3,
         -1.0, 0.0, 0.0, 0.2,
         0.0, -1.0, 0.0, 0.1,
         0.0, 0.0, 0.0, 1.0]

rate_hz: 20
resolution: [752, 480]
camera_model: pinhole
intrinsics: [458.654, 457.296, 367.215, 248.375] #fu, fv, cu, cv
distortion_model: radial-tangential
distortion_coefficients: [-0.28340811, 0.07395907, 0.00019359, 1.76187114e-05]
)";

const char* const kImu = R"(sensor_type: imu
comment: VI-Sensor IMU (ADIS16448)
T_BS:
  cols: 4
  rows: 4
  data: [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]
rate_hz: 200
gyroscope_noise_density: 1.6968e-04
gyroscope_random_walk: 1.9393e-05
accelerometer_noise_density: 2.0000e-3
accelerometer_random_walk: 3.0000e-3
)";

class Euroc : public TestFolder {
 protected:
  void writeSequence(const std::string& camera, const std::string& imu) const {
    write("mav0/cam0/sensor.yaml", camera);
    write("mav0/imu0/sensor.yaml", imu);
  }
  std::string errorOf(const std::string& camera, const std::string& imu) const {
    writeSequence(camera, imu);
    const Result<Rig> rig = readEurocRig(path(""));
    EXPECT_FALSE(rig.ok());
    return rig.ok() ? "" : rig.error().message;
  }
};

TEST_F(Euroc, ReadsSensorFilesAsTheyAre) {
  writeSequence(kCamera, kImu);
  // Cameras come by number, not by letters; other folders do not count.
  write("mav0/cam10/sensor.yaml", kCamera);
  write("mav0/cam2/sensor.yaml", kCamera);
  write("mav0/camera/notes.txt", "");
  const Result<Rig> rig = readSequenceRig(path(""));
  ASSERT_TRUE(rig.ok()) << rig.error().message;
  ASSERT_EQ(rig->cameras.size(), 3U);
  EXPECT_EQ(rig->cameras[0].name, "cam0");
  EXPECT_EQ(rig->cameras[1].name, "cam2");
  EXPECT_EQ(rig->cameras[2].name, "cam10");
  EXPECT_EQ(rig->cameras[0].rate_hz, 20.0);
  // T_BS carries sensor points into the body.
  EXPECT_LT(
      (rig->cameras[0].T_vehicle_cam * Eigen::Vector3d(0, 0, 1) - Eigen::Vector3d(1.3, 0.2, 0.1))
          .norm(),
      1e-12);
  EXPECT_EQ(rig->imu.rate_hz, 200.0);
  EXPECT_EQ(rig->imu.accelerometer_random_walk, 3e-3);
  EXPECT_FALSE(rig->vehicle.has_value());
}

TEST_F(Euroc, RigYamlOfASequenceComesFirst) {
  writeSequence(kCamera, kImu);
  write("rig.yaml", "name: broken\n");
  const Result<Rig> rig = readSequenceRig(path(""));
  ASSERT_FALSE(rig.ok());
  EXPECT_THAT(rig.error().message, HasSubstr("rig.yaml:1: missing key 'cameras'"));
}

TEST_F(Euroc, RefusesBadSensorFiles) {
  EXPECT_THAT(
      errorOf(replaced(kCamera, "data: [0.0, 0.0, 1.0", "data: [0.0, 0.1, 1.0"), kImu),
      HasSubstr("mav0/cam0/sensor.yaml:7: T_BS: the upper left 3x3 block is not a rotation"));
  EXPECT_THAT(errorOf(replaced(kCamera, "pinhole", "fisheye"), kImu),
              HasSubstr("cam0/sensor.yaml:16: camera_model: unknown value 'fisheye'"));
  EXPECT_THAT(errorOf(replaced(kCamera, "rate_hz", "rate"), kImu),
              HasSubstr("cam0/sensor.yaml:14: unknown key 'rate'"));
  EXPECT_THAT(errorOf(replaced(kCamera, "sensor_type: camera", "sensor_type: lidar"), kImu),
              HasSubstr("cam0/sensor.yaml:2: sensor_type: expected 'camera', found 'lidar'"));
  EXPECT_THAT(errorOf(kCamera, replaced(kImu, "1.6968e-04", "nan")),
              HasSubstr("imu0/sensor.yaml:8: gyroscope_noise_density: expected a finite number"));
}

TEST_F(Euroc, NamesWhatIsMissing) {
  Result<Rig> rig = readEurocRig(path(""));
  ASSERT_FALSE(rig.ok());
  EXPECT_THAT(rig.error().message, HasSubstr("mav0: no such folder"));
  write("mav0/imu0/sensor.yaml", kImu);
  rig = readEurocRig(path(""));
  ASSERT_FALSE(rig.ok());
  EXPECT_THAT(rig.error().message, HasSubstr("no camera folders"));
  write("mav0/cam0/data.csv", "");
  rig = readEurocRig(path(""));
  ASSERT_FALSE(rig.ok());
  EXPECT_THAT(rig.error().message, HasSubstr("cam0/sensor.yaml"));
}

TEST(EurocRecording, IsRead) {
  const char* folder = std::getenv("PARKADE_TEST_DATA");
  const std::filesystem::path data =
      folder != nullptr ? std::filesystem::path(folder)
                        : std::filesystem::path(PARKADE_SOURCE_DIR) / ".." / "shared" / "data";
  const std::filesystem::path sequence = data / "euroc_mh01_16s";
  if (!std::filesystem::exists(sequence)) GTEST_SKIP() << sequence << " is absent";
  const Result<Rig> rig = readSequenceRig(sequence.string());
  ASSERT_TRUE(rig.ok()) << rig.error().message;
  EXPECT_EQ(rig->name, "euroc_mh01_16s");
  ASSERT_EQ(rig->cameras.size(), 2U);
  const SE3 T_cam0_cam1 = rig->cameras[0].T_vehicle_cam.inverse() * rig->cameras[1].T_vehicle_cam;
  EXPECT_NEAR(T_cam0_cam1.translation().x(), 0.11, 1e-3);  // the known stereo baseline
  EXPECT_NEAR(T_cam0_cam1.rotation().log().norm(), 0.0, 0.03);
}

}  // namespace
}  // namespace parkade
