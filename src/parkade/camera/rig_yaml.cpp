// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <utility>

#include "parkade/camera/calibration_yaml.hpp"
#include "parkade/camera/rig.hpp"
#include "parkade/core/units.hpp"

namespace parkade {
namespace {

namespace fs = std::filesystem;

// A path as written is relative to the folder of the file that holds it.
std::string resolved(const std::string& path, const std::string& file) {
  if (path.empty() || fs::path(path).is_absolute()) return path;
  return (fs::path(file).parent_path() / path).lexically_normal().string();
}

std::string relative(const std::string& path, const std::string& file) {
  const fs::path folder = fs::path(file).parent_path().lexically_normal();
  const fs::path shorter = fs::path(path).lexically_normal().lexically_relative(folder);
  if (shorter.empty() || *shorter.begin() == "..") return path;
  return shorter.string();
}

RigCamera readRigCamera(const YamlNode& node) {
  node.allowOnly({"name", "camera_model", "intrinsics", "distortion_model", "distortion_coeffs",
                  "cam2world_coeffs", "resolution", "T_vehicle_cam", "position_sigma",
                  "rotation_sigma_deg", "time_offset", "readout_time", "rate", "mask"});
  RigCamera camera;
  camera.name = node.at("name").asString();
  if (camera.name.empty() || camera.name.find('/') != std::string::npos) {
    node.at("name").fail(fmt::format("'{}' cannot name a folder", camera.name));
  }
  camera.camera = readCamera(node, "distortion_coeffs");
  camera.T_vehicle_cam = readTransform(node.at("T_vehicle_cam"));
  if (node.has("position_sigma")) camera.position_sigma = readPositive(node.at("position_sigma"));
  if (node.has("rotation_sigma_deg")) {
    camera.rotation_sigma = readPositive(node.at("rotation_sigma_deg")) * kDegree;
  }
  if (node.has("time_offset")) {
    const double seconds = node.at("time_offset").asDouble();
    constexpr double kMaxSeconds = 1e6;
    if (std::abs(seconds) > kMaxSeconds) {
      node.at("time_offset").fail(fmt::format("{} s is beyond {} s", seconds, kMaxSeconds));
    }
    camera.time_offset_ns = fromSeconds(seconds);
  }
  if (node.has("readout_time")) {
    camera.readout_time = readPositive(node.at("readout_time"));
    if (camera.readout_time > kMaxReadoutTime) {
      node.at("readout_time")
          .fail(fmt::format("{} s from the first row to the last is beyond {} s (is it in ms?)",
                            camera.readout_time, kMaxReadoutTime));
    }
  }
  if (node.has("rate")) camera.rate_hz = readPositive(node.at("rate"));
  if (node.has("mask")) camera.mask_path = resolved(node.at("mask").asString(), node.file());
  return camera;
}

ImuCalibration readImu(const YamlNode& node) {
  node.allowOnly({"T_vehicle_imu", "gyroscope_noise_density", "gyroscope_random_walk",
                  "accelerometer_noise_density", "accelerometer_random_walk", "rate"});
  ImuCalibration imu;
  imu.T_vehicle_imu = readTransform(node.at("T_vehicle_imu"));
  readImuNoise(node, imu);
  imu.rate_hz = readPositive(node.at("rate"));
  return imu;
}

VehicleShape readVehicle(const YamlNode& node) {
  node.allowOnly({"wheelbase", "track", "front_overhang", "rear_overhang", "width", "height"});
  VehicleShape shape;
  shape.wheelbase = readPositive(node.at("wheelbase"));
  shape.track = readPositive(node.at("track"));
  shape.front_overhang = readPositive(node.at("front_overhang"));
  shape.rear_overhang = readPositive(node.at("rear_overhang"));
  shape.width = readPositive(node.at("width"));
  shape.height = readPositive(node.at("height"));
  return shape;
}

Rig readRigNode(const YamlNode& root) {
  root.allowOnly({"name", "vehicle", "cameras", "imu"});
  Rig rig;
  rig.name = root.at("name").asString();
  if (root.has("vehicle")) rig.vehicle = readVehicle(root.at("vehicle"));
  const YamlNode cameras = root.at("cameras");
  if (!cameras.isSequence() || cameras.size() == 0) cameras.fail("expected a list of cameras");
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    RigCamera camera = readRigCamera(cameras.at(i));
    if (rig.find(camera.name) >= 0) {
      cameras.at(i).at("name").fail(fmt::format("two cameras are named '{}'", camera.name));
    }
    rig.cameras.push_back(std::move(camera));
  }
  rig.imu = readImu(root.at("imu"));
  return rig;
}

// Text as a YAML scalar.
std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + "\"";
}

// Nanoseconds as decimal seconds, without a rounding.
std::string seconds(TimeNs t_ns) {
  return fmt::format("{}{}.{:09d}", t_ns < 0 ? "-" : "", std::abs(t_ns) / kNsPerSecond,
                     std::abs(t_ns) % kNsPerSecond);
}

std::string writeRigNode(const Rig& rig, const std::string& path) {
  std::string text = fmt::format("name: {}\n", quoted(rig.name));
  if (rig.vehicle) {
    const VehicleShape& v = *rig.vehicle;
    text += fmt::format(
        "vehicle:\n  wheelbase: {}\n  track: {}\n  front_overhang: {}\n  rear_overhang: {}\n"
        "  width: {}\n  height: {}\n",
        v.wheelbase, v.track, v.front_overhang, v.rear_overhang, v.width, v.height);
  }
  text += "cameras:\n";
  const std::string indent(4, ' ');
  for (const RigCamera& camera : rig.cameras) {
    text += fmt::format("  - name: {}\n", quoted(camera.name));
    text += writeCamera(camera.camera, indent);
    text += writeTransform("T_vehicle_cam", camera.T_vehicle_cam, indent);
    if (camera.position_sigma > 0.0) {
      text += fmt::format("{}position_sigma: {}\n", indent, camera.position_sigma);
    }
    if (camera.rotation_sigma > 0.0) {
      text += fmt::format("{}rotation_sigma_deg: {}\n", indent, camera.rotation_sigma / kDegree);
    }
    if (camera.time_offset_ns != 0) {
      text += fmt::format("{}time_offset: {}\n", indent, seconds(camera.time_offset_ns));
    }
    if (camera.readout_time > 0.0) {
      text += fmt::format("{}readout_time: {}\n", indent, camera.readout_time);
    }
    if (camera.rate_hz > 0.0) text += fmt::format("{}rate: {}\n", indent, camera.rate_hz);
    if (!camera.mask_path.empty()) {
      text += fmt::format("{}mask: {}\n", indent, quoted(relative(camera.mask_path, path)));
    }
  }
  text += "imu:\n" + writeTransform("T_vehicle_imu", rig.imu.T_vehicle_imu, "  ");
  text += fmt::format(
      "  gyroscope_noise_density: {}\n  gyroscope_random_walk: {}\n"
      "  accelerometer_noise_density: {}\n  accelerometer_random_walk: {}\n  rate: {}\n",
      rig.imu.gyroscope_noise_density, rig.imu.gyroscope_random_walk,
      rig.imu.accelerometer_noise_density, rig.imu.accelerometer_random_walk, rig.imu.rate_hz);
  return text;
}

Result<Rig> rigOf(const Result<YamlNode>& root) {
  if (!root) return root.error();
  try {
    return readRigNode(*root);
  } catch (const YamlError& error) {
    return Error{error.what()};
  }
}

}  // namespace

Result<Rig> readRig(const std::string& path) {
  const Result<YamlNode> root = openYaml(path);
  const bool is_kalibr = root && root->isMap() && root->has("cam0");
  return is_kalibr ? readKalibr(path, kalibrImuFile(path)) : rigOf(root);
}

Result<Rig> parseRig(const std::string& text, const std::string& path) {
  return rigOf(openYamlText(text, path));
}

// Whole or not at all: under another name first.
Status writeRig(const Rig& rig, const std::string& path) {
  const std::string part = path + ".tmp";
  std::ofstream stream(part, std::ios::binary | std::ios::trunc);
  if (!stream) return Error{fmt::format("{}: cannot open the file for writing", path)};
  stream << writeRigNode(rig, path);
  stream.close();
  std::error_code code;
  if (!stream) {
    fs::remove(part, code);
    return Error{fmt::format("{}: writing failed; is the disk full?", path)};
  }
  fs::rename(part, path, code);
  if (code) return Error{fmt::format("{}: cannot write the file: {}", path, code.message())};
  return {};
}

}  // namespace parkade
