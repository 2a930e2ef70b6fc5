// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <cmath>
#include <filesystem>
#include <optional>

#include "parkade/camera/calibration_yaml.hpp"
#include "parkade/camera/rig.hpp"

namespace parkade {
namespace {

// T_imu_cam of a camera: from its own entry, or through its neighbour's.
SE3 readExtrinsics(const YamlNode& node, const std::optional<SE3>& T_imu_previous) {
  if (node.has("T_cam_imu")) return readTransform(node.at("T_cam_imu")).inverse();
  if (node.has("T_imu_cam")) return readTransform(node.at("T_imu_cam"));
  if (T_imu_previous) return *T_imu_previous * readTransform(node.at("T_cn_cnm1")).inverse();
  // A chain that was calibrated without an IMU: its first camera is the origin.
  return {};
}

Rig readCamchain(const YamlNode& root, bool imu_required) {
  Rig rig;
  rig.name = std::filesystem::path(root.file()).stem().string();
  std::optional<SE3> T_imu_previous;
  for (const std::string& key : root.keys()) {
    const std::string expected = fmt::format("cam{}", rig.cameras.size());
    const YamlNode node = root.at(key);
    if (key != expected) {
      node.fail(
          fmt::format("expected '{}' here; a camera chain numbers cameras from cam0", expected));
    }
    node.allowOnly({"T_cam_imu", "T_imu_cam", "T_cn_cnm1", "cam_overlaps", "camera_model",
                    "intrinsics", "distortion_model", "distortion_coeffs", "resolution", "rostopic",
                    "timeshift_cam_imu"});
    const bool chained = node.has("T_cam_imu") || node.has("T_imu_cam") || T_imu_previous;
    if (imu_required && !chained) node.fail("missing key 'T_cam_imu': where is the IMU?");
    RigCamera camera;
    camera.name = key;
    camera.camera = readCamera(node, "distortion_coeffs");
    camera.T_vehicle_cam = readExtrinsics(node, T_imu_previous);
    if (node.has("timeshift_cam_imu")) {
      camera.time_offset_ns = fromSeconds(node.at("timeshift_cam_imu").asDouble());
    }
    T_imu_previous = camera.T_vehicle_cam;
    rig.cameras.push_back(camera);
  }
  if (rig.cameras.empty()) root.fail("the camera chain is empty");
  return rig;
}

ImuCalibration readKalibrImu(const YamlNode& root) {
  // Kalibr takes imu.yaml without, and gives imu-NAME.yaml with, a heading per IMU.
  const YamlNode node = root.has("imu0") ? root.at("imu0") : root;
  node.allowOnly({"T_i_b", "accelerometer_noise_density", "accelerometer_random_walk",
                  "gyroscope_noise_density", "gyroscope_random_walk", "model", "rostopic",
                  "time_offset", "update_rate"});
  if (node.has("model") && node.at("model").asString() != "calibrated") {
    node.at("model").fail(fmt::format(
        "IMU model '{}' is not supported, only 'calibrated': recalibrate with --imu-models "
        "calibrated",
        node.at("model").asString()));
  }
  ImuCalibration imu;
  // The body of the chain is its first IMU; anything else would need the other IMU's data.
  if (node.has("T_i_b") && readTransform(node.at("T_i_b")).log().norm() > 1e-9) {
    node.at("T_i_b").fail("expected the identity: imu0 is the body of the chain");
  }
  if (node.has("time_offset") && node.at("time_offset").asDouble() != 0.0) {
    node.at("time_offset").fail("expected 0: imu0 is the clock of the chain");
  }
  readImuNoise(node, imu);
  imu.rate_hz = readPositive(node.at("update_rate"));
  return imu;
}

}  // namespace

std::string kalibrImuFile(const std::string& camchain_path) {
  const std::filesystem::path path(camchain_path);
  std::string name = path.filename().string();
  for (const std::string_view part : {"camchain-imucam", "camchain"}) {
    const std::size_t at = name.find(part);
    if (at == std::string::npos) continue;
    return (path.parent_path() / name.replace(at, part.size(), "imu")).string();
  }
  return (path.parent_path() / "imu.yaml").string();
}

Result<Rig> readKalibr(const std::string& camchain_path, const std::string& imu_path) {
  Result<Rig> rig = parseYamlFile<Rig>(
      camchain_path, [&](const YamlNode& root) { return readCamchain(root, !imu_path.empty()); });
  if (!rig || imu_path.empty()) return rig;
  const Result<ImuCalibration> imu = parseYamlFile<ImuCalibration>(imu_path, readKalibrImu);
  if (!imu) return imu.error();
  rig->imu = *imu;
  return rig;
}

}  // namespace parkade
