// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "parkade/camera/calibration_yaml.hpp"
#include "parkade/camera/rig.hpp"

namespace parkade {
namespace {

namespace fs = std::filesystem;

void checkSensorType(const YamlNode& root, const char* expected) {
  const YamlNode type = root.at("sensor_type");
  if (type.asString() != expected) {
    type.fail(fmt::format("expected '{}', found '{}'", expected, type.asString()));
  }
}

RigCamera readCameraSensor(const YamlNode& root) {
  checkSensorType(root, "camera");
  root.allowOnly({"sensor_type", "comment", "T_BS", "rate_hz", "resolution", "camera_model",
                  "intrinsics", "distortion_model", "distortion_coefficients", "cam2world_coeffs"});
  RigCamera camera;
  camera.camera = readCamera(root, "distortion_coefficients");
  camera.T_vehicle_cam = readTransform(root.at("T_BS"));
  camera.rate_hz = readPositive(root.at("rate_hz"));
  return camera;
}

ImuCalibration readImuSensor(const YamlNode& root) {
  checkSensorType(root, "imu");
  root.allowOnly({"sensor_type", "comment", "T_BS", "rate_hz", "gyroscope_noise_density",
                  "gyroscope_random_walk", "accelerometer_noise_density",
                  "accelerometer_random_walk"});
  ImuCalibration imu;
  imu.T_vehicle_imu = readTransform(root.at("T_BS"));
  readImuNoise(root, imu);
  imu.rate_hz = readPositive(root.at("rate_hz"));
  return imu;
}

// cam0, cam1, ..., cam10: sub-folders named cam and a number, by number.
std::vector<std::string> cameraFolders(const fs::path& mav) {
  std::vector<std::pair<int, std::string>> found;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(mav, error)) {
    const std::string name = entry.path().filename().string();
    if (!entry.is_directory() || name.rfind("cam", 0) != 0) continue;
    const std::string digits = name.substr(3);
    const bool is_number = !digits.empty() && digits.size() <= 4 &&
                           digits.find_first_not_of("0123456789") == std::string::npos;
    if (is_number) found.emplace_back(std::stoi(digits), name);
  }
  std::sort(found.begin(), found.end());
  std::vector<std::string> names;
  for (const auto& [number, name] : found) names.push_back(name);
  return names;
}

}  // namespace

Result<Rig> readEurocRig(const std::string& sequence_path) {
  const fs::path mav = fs::path(sequence_path) / "mav0";
  std::error_code error;
  if (!fs::is_directory(mav, error)) {
    return Error{fmt::format("{}: no such folder; expected an EuRoC/ASL sequence", mav.string())};
  }
  Rig rig;
  rig.name = fs::weakly_canonical(sequence_path, error).filename().string();
  for (const std::string& name : cameraFolders(mav)) {
    Result<RigCamera> camera =
        parseYamlFile<RigCamera>((mav / name / "sensor.yaml").string(), readCameraSensor);
    if (!camera) return camera.error();
    camera->name = name;
    rig.cameras.push_back(*camera);
  }
  if (rig.cameras.empty()) {
    return Error{fmt::format("{}: no camera folders (cam0, cam1, ...)", mav.string())};
  }
  const Result<ImuCalibration> imu =
      parseYamlFile<ImuCalibration>((mav / "imu0" / "sensor.yaml").string(), readImuSensor);
  if (!imu) return imu.error();
  rig.imu = *imu;
  return rig;
}

Result<Rig> readSequenceRig(const std::string& sequence_path) {
  const fs::path rig_path = fs::path(sequence_path) / "rig.yaml";
  std::error_code error;
  if (fs::exists(rig_path, error)) return readRig(rig_path.string());
  return readEurocRig(sequence_path);
}

}  // namespace parkade
