// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "parkade/camera/camera.hpp"
#include "parkade/core/result.hpp"
#include "parkade/core/time.hpp"
#include "parkade/geometry/se3.hpp"

namespace parkade {

inline constexpr double kMaxReadoutTime = 0.2;  ///< s; what takes longer is told in another unit

/// How long after the middle row one of height rows is taken, s, where all take readout_time. What
/// lies above or below the picture counts as its first or last row.
inline double rowTimeOf(double readout_time, double row, int height) {
  return height > 1 ? readout_time * (std::clamp(row / (height - 1), 0.0, 1.0) - 0.5) : 0.0;
}

/// One camera of a rig.
struct RigCamera {
  std::string name;  ///< folder name in a sequence: cam0, cam1, ...
  Camera camera;
  SE3 T_vehicle_cam;
  double position_sigma = 0.0;  ///< m, of T_vehicle_cam's place along each axis; 0: not told
  double rotation_sigma = 0.0;  ///< rad, of its turn about each axis; 0: not told
  TimeNs time_offset_ns = 0;    ///< added to a recorded stamp gives the time on the IMU's clock
  /// s from the first row to the last, of a rolling shutter; a stamp is then the middle row's. 0:
  /// all rows at once.
  double readout_time = 0.0;
  double rate_hz = 0.0;   ///< 0 where unknown
  std::string mask_path;  ///< 8-bit picture, 0 where the own body hides the world; or empty
  std::vector<std::uint8_t> mask_pixels;  ///< the same row by row where there is no file; or empty

  /// How long after the stamp a row is taken, s; before it where negative.
  [[nodiscard]] double rowTime(double row) const {
    return rowTimeOf(readout_time, row, camera.height());
  }
};

/// Where the IMU sits and how noisy it is (continuous-time densities, Kalibr's field names).
struct ImuCalibration {
  SE3 T_vehicle_imu;
  double gyroscope_noise_density = 2.44e-4;      ///< rad/s/sqrt(Hz)       (default: Bosch BMI088)
  double gyroscope_random_walk = 2.0e-5;         ///< rad/s^2/sqrt(Hz)
  double accelerometer_noise_density = 1.86e-3;  ///< m/s^2/sqrt(Hz)
  double accelerometer_random_walk = 2.0e-4;     ///< m/s^3/sqrt(Hz)
  double rate_hz = 200.0;
};

/// The car's body as a box on the ground plane, in the vehicle frame (origin below the rear axle).
struct VehicleShape {
  double wheelbase = 2.85;      ///< m
  double track = 1.6;           ///< m, between the wheels of an axle
  double front_overhang = 0.9;  ///< m, ahead of the front axle
  double rear_overhang = 1.0;   ///< m, behind the rear axle
  double width = 1.86;          ///< m
  double height = 1.48;         ///< m
};

/// All sensors of a car and how they sit on it.
struct Rig {
  std::string name;
  std::vector<RigCamera> cameras;
  ImuCalibration imu;
  std::optional<VehicleShape> vehicle;  ///< absent where the recording has no car

  /// Index of a camera by name, or -1.
  [[nodiscard]] int find(const std::string& camera_name) const;
  /// Only the named cameras, in the order given; fails on an unknown name (and lists the known).
  [[nodiscard]] Result<Rig> subset(const std::vector<std::string>& names) const;
};

/// Reads rig.yaml (docs/formats.md), or a Kalibr camera chain with the IMU file beside it
/// (kalibrImuFile()). Fails with file, line, key and value on a missing or unknown
/// key, an unknown model, a matrix that is no rotation, a number that is not finite.
Result<Rig> readRig(const std::string& path);
/// The same for the text of such a file; path is what messages call it.
Result<Rig> parseRig(const std::string& text, const std::string& path);

/// Writes a rig that readRig reads back: numbers to the same bits, rotations (written as matrices)
/// to their last digit. Masks below the file's folder are written relative to it.
Status writeRig(const Rig& rig, const std::string& path);

/// The IMU file that belongs to a Kalibr camera chain, by Kalibr's names: NAME-imu.yaml beside
/// NAME-camchain-imucam.yaml, imu.yaml beside camchain.yaml.
std::string kalibrImuFile(const std::string& camchain_path);

/// Reads a Kalibr camera chain and, where not empty, a Kalibr IMU file, as Kalibr writes them. The
/// vehicle frame is then the IMU's; for a chain that was calibrated without an IMU, cam0's.
Result<Rig> readKalibr(const std::string& camchain_path, const std::string& imu_path);

/// Reads the sensor.yaml files of an EuRoC/ASL folder (mav0/cam*, mav0/imu0). The vehicle frame is
/// then the body frame.
Result<Rig> readEurocRig(const std::string& sequence_path);

/// rig.yaml of a sequence folder if there, else its sensor.yaml files.
Result<Rig> readSequenceRig(const std::string& sequence_path);

}  // namespace parkade
