// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/io/sensor_yaml.hpp"

#include <fmt/core.h>

#include "parkade/camera/calibration_yaml.hpp"

namespace parkade {
namespace {

// EuRoC writes matrices as {cols, rows, data}.
std::string transformYaml(const SE3& T_body_sensor) {
  const Eigen::Matrix4d m = T_body_sensor.matrix();
  std::string text = "T_BS:\n  cols: 4\n  rows: 4\n  data: [";
  for (int i = 0; i < 4; ++i) {
    text += fmt::format("{}, {}, {}, {}{}", m(i, 0), m(i, 1), m(i, 2), m(i, 3),
                        i < 3 ? ",\n         " : "]\n");
  }
  return text;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t place = text.find(from);
  return place == std::string::npos ? text : text.replace(place, from.size(), to);
}

}  // namespace

std::string cameraSensorYaml(const RigCamera& camera, double rate_hz) {
  std::string model = writeCamera(camera.camera, "");
  model = replaced(model, "distortion_model: radtan", "distortion_model: radial-tangential");
  model = replaced(model, "distortion_coeffs:", "distortion_coefficients:");
  return fmt::format("sensor_type: camera\ncomment: {}\n{}rate_hz: {}\n{}", camera.name,
                     transformYaml(camera.T_vehicle_cam),
                     camera.rate_hz > 0.0 ? camera.rate_hz : rate_hz, model);
}

std::string imuSensorYaml(const ImuCalibration& imu) {
  return fmt::format(
      "sensor_type: imu\ncomment: imu0\n{}rate_hz: {}\ngyroscope_noise_density: {}\n"
      "gyroscope_random_walk: {}\naccelerometer_noise_density: {}\n"
      "accelerometer_random_walk: {}\n",
      transformYaml(imu.T_vehicle_imu), imu.rate_hz, imu.gyroscope_noise_density,
      imu.gyroscope_random_walk, imu.accelerometer_noise_density, imu.accelerometer_random_walk);
}

std::string wheelSensorYaml() {
  return "sensor_type: wheel\ncomment: speeds of the rear wheels and angle of the front wheels\n" +
         transformYaml(SE3());
}

std::string groundTruthSensorYaml() {
  return "sensor_type: visual-inertial\ncomment: pose of the body frame, velocity, biases\n" +
         transformYaml(SE3());
}

}  // namespace parkade
