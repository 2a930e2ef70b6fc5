// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/camera_errors.hpp"

#include <fmt/core.h>

#include <cmath>
#include <exception>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "parkade/camera/rig.hpp"
#include "parkade/core/units.hpp"
#include "parkade/io/file.hpp"

namespace parkade::cli {
namespace {

using Json = nlohmann::json;
using Vector6 = Eigen::Matrix<double, 6, 1>;

SE3 transform(const Json& rows) {
  Eigen::Matrix4d m;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column)
      m(row, column) = rows.at(row).at(column).get<double>();
  }
  return SE3(m);
}

Eigen::Vector3d vector(const Json& json) {
  return {json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
}

// As the sigmas are told: of a camera's place along the axes of the inertial unit, and of its turn
// about the camera's.
Vector6 errorOf(const SE3& T_vehicle_cam, const SE3& truth, const SO3& R_vehicle_imu) {
  Vector6 error;
  error << R_vehicle_imu.inverse() * (T_vehicle_cam.translation() - truth.translation()),
      (truth.rotation().inverse() * T_vehicle_cam.rotation()).log();
  return error;
}

struct Sums {
  Vector6 told = Vector6::Zero();  // squares
  Vector6 found = Vector6::Zero();
  Vector6 nees = Vector6::Zero();
  int cameras = 0;
};

void add(const Json& entry, const SE3& truth, const SO3& R_vehicle_imu, Sums& sums) {
  Vector6 sigma;
  sigma << vector(entry.at("position_sigma_m")), vector(entry.at("rotation_sigma_rad"));
  const auto error = [&](const char* name) {
    return errorOf(transform(entry.at(name)), truth, R_vehicle_imu);
  };
  const Vector6 found = error("T_vehicle_cam");
  sums.told += error("told_T_vehicle_cam").cwiseAbs2();
  sums.found += found.cwiseAbs2();
  sums.nees += found.cwiseQuotient(sigma).cwiseAbs2();
  ++sums.cameras;
}

CameraErrors errorsOf(const Sums& sums) {
  const double n = sums.cameras;
  const auto rms = [n](const auto& squares) { return std::sqrt(squares.sum() / (3.0 * n)); };
  CameraErrors errors;
  errors.cameras = sums.cameras;
  errors.told_m = rms(sums.told.head<3>());
  errors.told_deg = rms(sums.told.tail<3>()) / kDegree;
  errors.found_m = rms(sums.found.head<3>());
  errors.found_deg = rms(sums.found.tail<3>()) / kDegree;
  errors.nees_place = sums.nees.head<3>().sum() / n;
  errors.nees_turn = sums.nees.tail<3>().sum() / n;
  return errors;
}

}  // namespace

Status judgeCameras(const std::string& folder, const std::string& sequence,
                    Evaluation& evaluation) {
  const std::string metrics = joinPath(folder, "metrics.json");
  const std::string truth = joinPath(joinPath(sequence, "truth"), "rig.yaml");
  if (!std::filesystem::is_regular_file(metrics) || !std::filesystem::is_regular_file(truth)) {
    return {};
  }
  const Result<std::string> text = readFile(metrics);
  if (!text) return text.error();
  const Result<Rig> rig = readRig(truth);
  if (!rig) return rig.error();
  Sums sums;
  try {
    const Json json = Json::parse(*text);
    if (!json.contains("calibration")) return {};
    for (const Json& entry : json["calibration"]) {
      if (!entry.contains("told_T_vehicle_cam")) return {};  // of an earlier build
      const int camera = rig->find(entry.at("camera"));
      if (camera < 0) {
        return Error{fmt::format("{}: the run's camera '{}' is none of {}", metrics,
                                 entry.at("camera").get<std::string>(), truth)};
      }
      add(entry, rig->cameras[static_cast<std::size_t>(camera)].T_vehicle_cam,
          rig->imu.T_vehicle_imu.rotation(), sums);
    }
  } catch (const std::exception& error) {  // what is missing, or no number, or no rotation
    return Error{fmt::format("{}: cannot be read: {}", metrics, error.what())};
  }
  if (sums.cameras > 0) evaluation.cameras = errorsOf(sums);
  return {};
}

}  // namespace parkade::cli
