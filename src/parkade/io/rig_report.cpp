// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/io/rig_report.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

namespace parkade {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

// Angle from the optical axis of the outermost pixel with a ray, from `pixel` inwards by `step`.
double outermostAngle(const Camera& camera, Eigen::Vector2d pixel, const Eigen::Vector2d& step,
                      int count) {
  Eigen::Vector3d ray;
  for (int i = 0; i < count; ++i, pixel += step) {
    if (camera.unproject(pixel, ray)) return std::acos(std::clamp(ray.z(), -1.0, 1.0));
  }
  return 0.0;
}

// Degrees with one decimal; never "-0.0".
std::string degreesText(double radians) {
  const double tenths = std::round(radians * kDegrees * 10.0);
  return fmt::format("{:.1f}", tenths == 0.0 ? 0.0 : tenths / 10.0);
}

// Axes of a body that looks along x: x = z_cam, y = -x_cam, z = -y_cam.
SO3 bodyAxes() {
  Eigen::Matrix3d R_cam_body;
  R_cam_body << 0.0, -1.0, 0.0, 0.0, 0.0, -1.0, 1.0, 0.0, 0.0;
  return SO3(R_cam_body);
}

}  // namespace

nlohmann::json vectorJson(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

FieldOfView fieldOfView(const Camera& camera) {
  Eigen::Vector2d centre;
  if (!camera.project(Eigen::Vector3d::UnitZ(), centre)) {
    centre = {0.5 * (camera.width() - 1), 0.5 * (camera.height() - 1)};
  }
  const Eigen::Vector2d x(1.0, 0.0);
  const Eigen::Vector2d y(0.0, 1.0);
  const int columns = camera.width() / 2;
  const int rows = camera.height() / 2;
  FieldOfView view;
  view.horizontal = outermostAngle(camera, {0.0, centre.y()}, x, columns) +
                    outermostAngle(camera, {camera.width() - 1.0, centre.y()}, -x, columns);
  view.vertical = outermostAngle(camera, {centre.x(), 0.0}, y, rows) +
                  outermostAngle(camera, {centre.x(), camera.height() - 1.0}, -y, rows);
  return view;
}

ViewDirection viewDirection(const SE3& T_vehicle_cam) {
  const Eigen::Vector3d angles = (T_vehicle_cam.rotation() * bodyAxes()).yawPitchRoll();
  return {angles[0], angles[1], angles[2]};
}

std::string rigText(const Rig& rig) {
  std::string text = fmt::format("rig {}: {} cameras\n", rig.name, rig.cameras.size());
  text += fmt::format("  {:<10} {:<20} {:>11} {:>12} {:>22} {:>7} {:>7} {:>7}\n", "camera", "model",
                      "size px", "view deg", "x y z m", "yaw", "pitch", "roll deg");
  for (const RigCamera& c : rig.cameras) {
    const FieldOfView view = fieldOfView(c.camera);
    const ViewDirection direction = viewDirection(c.T_vehicle_cam);
    const Eigen::Vector3d& p = c.T_vehicle_cam.translation();
    text += fmt::format(
        "  {:<10} {:<20} {:>11} {:>12} {:>22} {:>7} {:>7} {:>7}{}{}{}{}\n", c.name,
        c.camera.modelName(), fmt::format("{} x {}", c.camera.width(), c.camera.height()),
        fmt::format("{:.0f} x {:.0f}", view.horizontal * kDegrees, view.vertical * kDegrees),
        fmt::format("{:.3f} {:.3f} {:.3f}", p.x(), p.y(), p.z()), degreesText(direction.yaw),
        degreesText(direction.pitch), degreesText(direction.roll),
        c.rate_hz > 0.0 ? fmt::format("  {:.4g} Hz", c.rate_hz) : "",
        c.time_offset_ns != 0 ? fmt::format("  offset {:.3f} ms", toSeconds(c.time_offset_ns) * 1e3)
                              : "",
        c.readout_time > 0.0 ? fmt::format("  rolling shutter {:.4g} ms", 1e3 * c.readout_time)
                             : "",
        c.mask_path.empty() ? "" : "  masked");
  }
  const Eigen::Vector3d& p = rig.imu.T_vehicle_imu.translation();
  const Eigen::Vector3d angles = rig.imu.T_vehicle_imu.rotation().yawPitchRoll();
  text += fmt::format(
      "  imu        {:.4g} Hz, at {:.3f} {:.3f} {:.3f} m, yaw {}, pitch {}, roll {} "
      "deg\n"
      "             noise: gyro {:.3g} rad/s/sqrt(Hz), walk {:.3g}; accel {:.3g} m/s^2/sqrt(Hz), "
      "walk {:.3g}\n",
      rig.imu.rate_hz, p.x(), p.y(), p.z(), degreesText(angles[0]), degreesText(angles[1]),
      degreesText(angles[2]), rig.imu.gyroscope_noise_density, rig.imu.gyroscope_random_walk,
      rig.imu.accelerometer_noise_density, rig.imu.accelerometer_random_walk);
  if (rig.vehicle) {
    const VehicleShape& v = *rig.vehicle;
    text += fmt::format(
        "  vehicle    {:.2f} x {:.2f} x {:.2f} m, wheelbase {:.3f} m, track {:.3f} m, overhang "
        "{:.2f} "
        "m in front, {:.2f} m behind\n",
        v.front_overhang + v.wheelbase + v.rear_overhang, v.width, v.height, v.wheelbase, v.track,
        v.front_overhang, v.rear_overhang);
  } else {
    text += "  vehicle    none: a recording without a car\n";
  }
  return text;
}

nlohmann::json rigJson(const Rig& rig) {
  nlohmann::json cameras = nlohmann::json::array();
  for (const RigCamera& c : rig.cameras) {
    const FieldOfView view = fieldOfView(c.camera);
    const ViewDirection direction = viewDirection(c.T_vehicle_cam);
    cameras.push_back({{"name", c.name},
                       {"model", c.camera.modelName()},
                       {"width", c.camera.width()},
                       {"height", c.camera.height()},
                       {"view_deg", {view.horizontal * kDegrees, view.vertical * kDegrees}},
                       {"position", vectorJson(c.T_vehicle_cam.translation())},
                       {"yaw_deg", direction.yaw * kDegrees},
                       {"pitch_deg", direction.pitch * kDegrees},
                       {"roll_deg", direction.roll * kDegrees},
                       {"rate_hz", c.rate_hz},
                       {"time_offset_ms", toSeconds(c.time_offset_ns) * 1e3},
                       {"readout_time_ms", 1e3 * c.readout_time},
                       {"masked", !c.mask_path.empty()}});
  }
  nlohmann::json json = {{"name", rig.name},
                         {"cameras", cameras},
                         {"imu",
                          {{"rate_hz", rig.imu.rate_hz},
                           {"position", vectorJson(rig.imu.T_vehicle_imu.translation())},
                           {"gyroscope_noise_density", rig.imu.gyroscope_noise_density},
                           {"gyroscope_random_walk", rig.imu.gyroscope_random_walk},
                           {"accelerometer_noise_density", rig.imu.accelerometer_noise_density},
                           {"accelerometer_random_walk", rig.imu.accelerometer_random_walk}}},
                         {"vehicle", nullptr}};
  if (rig.vehicle) {
    const VehicleShape& v = *rig.vehicle;
    json["vehicle"] = {{"wheelbase", v.wheelbase},
                       {"track", v.track},
                       {"front_overhang", v.front_overhang},
                       {"rear_overhang", v.rear_overhang},
                       {"width", v.width},
                       {"height", v.height}};
  }
  return json;
}

}  // namespace parkade
