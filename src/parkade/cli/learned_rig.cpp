// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/cli/learned_rig.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <system_error>

#include "parkade/core/check.hpp"
#include "parkade/io/file.hpp"
#include "parkade/io/rig_report.hpp"

namespace parkade::cli {
namespace {

nlohmann::json matrixJson(const SE3& T) {
  nlohmann::json rows;
  const Eigen::Matrix4d m = T.matrix();
  for (int row = 0; row < 4; ++row) rows.push_back({m(row, 0), m(row, 1), m(row, 2), m(row, 3)});
  return rows;
}

}  // namespace

Result<std::string> rigFileOf(const std::string& path) {
  std::error_code code;
  if (!std::filesystem::is_directory(path, code)) return path;
  const std::string file = joinPath(path, "rig.yaml");
  if (std::filesystem::is_regular_file(file, code)) return file;
  return Error{
      fmt::format("{}: holds no rig.yaml; a run writes one where it has a pose and refines its "
                  "cameras' places, clocks or readout times (vio.calibration)",
                  path)};
}

Rig learnedRig(const Rig& told, const std::vector<CameraCalibrationEstimate>& learned) {
  PARKADE_CHECK(told.cameras.size() == learned.size(), "{} cameras, {} learned",
                told.cameras.size(), learned.size());
  Rig rig = told;
  for (std::size_t c = 0; c < learned.size(); ++c) {
    RigCamera& camera = rig.cameras[c];
    camera.T_vehicle_cam = learned[c].T_vehicle_cam;
    const auto& sigma = learned[c].sigma;
    if (!sigma.head<6>().isZero()) {  // of one camera alone only the clock is refined
      camera.position_sigma = sigma.head<3>().norm() / std::sqrt(3.0);
      camera.rotation_sigma = sigma.segment<3>(3).norm() / std::sqrt(3.0);
    }
    // To the microsecond: an offset that is not refined is held to a few nanoseconds.
    camera.time_offset_ns += 1000 * std::llround(1e6 * learned[c].time_offset);
    if (camera.readout_time > 0.0 && sigma(7) > 0.0) {
      const double to_microsecond = std::round(1e6 * learned[c].readout_time) / 1e6;
      camera.readout_time = std::clamp(to_microsecond, 1e-6, kMaxReadoutTime);
    }
    if (camera.mask_path.empty()) continue;
    std::error_code code;  // the file that names it will lie elsewhere
    const std::filesystem::path mask = std::filesystem::absolute(camera.mask_path, code);
    if (!code) camera.mask_path = mask.lexically_normal().string();
  }
  return rig;
}

nlohmann::json calibrationJson(const RigCamera& told, const CameraCalibrationEstimate& learned) {
  const SE3& before = told.T_vehicle_cam;
  const SE3& after = learned.T_vehicle_cam;
  const Eigen::Vector3d turned = (after.rotation() * before.rotation().inverse()).log();
  nlohmann::json json{{"camera", told.name}, {"time_offset_s", learned.time_offset}};
  json["T_vehicle_cam"] = matrixJson(after);
  json["told_T_vehicle_cam"] = matrixJson(before);
  json["moved_m"] = vectorJson(after.translation() - before.translation());
  json["turned_rad"] = vectorJson(turned);
  json["position_sigma_m"] = vectorJson(learned.sigma.head<3>());
  json["rotation_sigma_rad"] = vectorJson(learned.sigma.segment<3>(3));
  json["time_offset_sigma_s"] = learned.sigma(6);
  if (told.readout_time > 0.0) {
    json["readout_time_s"] = learned.readout_time;
    json["told_readout_time_s"] = told.readout_time;
    json["readout_time_sigma_s"] = learned.sigma(7);
  }
  return json;
}

}  // namespace parkade::cli
