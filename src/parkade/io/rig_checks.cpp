// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/io/rig_checks.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "parkade/io/image_file.hpp"
#include "parkade/io/rig_report.hpp"

namespace parkade {
namespace {

constexpr double kDegreesPerRadian = 180.0 / std::numbers::pi;

// Intrinsics of the full picture for a halved one, or other units: the axis is off the picture's
// middle, or the picture shows next to nothing, or more than the model can.
Check checkIntrinsics(const RigCamera& c) {
  constexpr double kMaxOffset = 0.2;  // of the picture's size; cropped ones have some
  constexpr double kMinView = 0.17;   // rad, 10 degrees
  constexpr double kMaxView = 2.97;   // rad, 170 degrees: of a camera that maps to a plane
  const Camera& camera = c.camera;
  const FieldOfView view = fieldOfView(camera);
  std::string sees = fmt::format("sees {:.0f} x {:.0f} deg", view.horizontal * kDegreesPerRadian,
                                 view.vertical * kDegreesPerRadian);
  if (c.readout_time > 0.0) {
    sees += fmt::format(", rolling shutter of {:.4g} ms", 1e3 * c.readout_time);
  }
  Check check{CheckMark::kWarn, c.name + " intrinsics", ""};
  Eigen::Vector2d axis;
  if (!camera.project(Eigen::Vector3d::UnitZ(), axis)) {
    check.detail = "the model does not show what lies on its axis";
    return check;
  }
  const double right = axis.x() / camera.width() - 0.5;
  const double down = axis.y() / camera.height() - 0.5;
  const bool on_plane = std::string(camera.modelName()) == "pinhole-radtan";
  const double wide = std::max(view.horizontal, view.vertical);
  if (std::max(std::abs(right), std::abs(down)) > kMaxOffset) {
    check.detail = fmt::format(
        "the optical axis is at ({:.0f}, {:.0f}) px of {} x {}: intrinsics of another size?",
        axis.x(), axis.y(), camera.width(), camera.height());
  } else if (wide < kMinView || (on_plane && wide > kMaxView)) {
    check.detail = sees + ": focal length of another size, or another model?";
  } else {
    check.mark = CheckMark::kPass;
    check.detail = sees;
  }
  return check;
}

void checkMask(const RigCamera& c, std::vector<Check>& checks) {
  if (c.mask_path.empty()) return;
  const Result<cv::Mat> mask = readImage(c.mask_path, true);
  if (!mask) {
    checks.push_back({CheckMark::kFail, c.name + " mask", mask.error().message});
  } else if (mask->cols != c.camera.width() || mask->rows != c.camera.height()) {
    checks.push_back({CheckMark::kFail, c.name + " mask",
                      fmt::format("{}: {} x {} px, the calibration is for {} x {}", c.mask_path,
                                  mask->cols, mask->rows, c.camera.width(), c.camera.height())});
  }
}

void checkMounting(const RigCamera& c, std::vector<Check>& checks) {
  constexpr double kFurthest = 15.0;  // m
  const Eigen::Vector3d& p = c.T_vehicle_cam.translation();
  if (p.z() > 0.0 && p.norm() < kFurthest) return;
  checks.push_back(
      {CheckMark::kWarn, c.name + " mounting",
       fmt::format("sits at ({:.4g}, {:.4g}, {:.4g}) m in the vehicle frame, {}: millimetres, or "
                   "T_vehicle_cam the wrong way round?",
                   p.x(), p.y(), p.z(), p.z() > 0.0 ? "far from the car" : "below the ground")});
}

}  // namespace

std::vector<Check> checkRig(const Rig& rig) {
  std::vector<Check> checks;
  for (const RigCamera& camera : rig.cameras) {
    checks.push_back(checkIntrinsics(camera));
    checkMask(camera, checks);
    if (rig.vehicle) checkMounting(camera, checks);
  }
  return checks;
}

}  // namespace parkade
