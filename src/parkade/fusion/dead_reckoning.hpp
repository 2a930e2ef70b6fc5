// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>

#include "parkade/core/options.hpp"
#include "parkade/types/pose_estimate.hpp"
#include "parkade/types/samples.hpp"

namespace parkade {

struct DeadReckoningOptions {
  double start_s = 0.5;
  double scale_sigma = 0.005;
  double side_sigma = 0.003;
  double gyro_density_deg = 0.014;
  double bias_floor_deg_s = 0.005;
  double bias_unknown_deg_s = 0.3;
  double still_mps = 0.005;
  double attitude_s = 4.0;
  double max_silence_s = 0.2;

  void visit(OptionVisitor& v) {
    v.field("start_s", start_s, "s", "A car that stands this long at the start tells its biases.",
            0.0, 60.0);
    v.field("scale_sigma", scale_sigma, "ratio", "Error of the wheels' radius, 1 sigma.", 1e-5,
            0.2);
    v.field("side_sigma", side_sigma, "m/sqrt(m)", "Slip and noise, a random walk.", 1e-5, 1.0);
    v.field("gyro_density_deg", gyro_density_deg, "deg/s/sqrt(Hz)", "White noise of the gyroscope.",
            1e-5, 10.0);
    v.field("bias_floor_deg_s", bias_floor_deg_s, "deg/s",
            "The gyroscope's bias is not known better than this.", 1e-5, 10.0);
    v.field("bias_unknown_deg_s", bias_unknown_deg_s, "deg/s",
            "Its error where the car never stood, 1 sigma.", 1e-4, 10.0);
    v.field("still_mps", still_mps, "m/s", "Wheels slower than this stand.", 0.0, 0.5);
    v.field("attitude_s", attitude_s, "s",
            "Time over which the accelerometer mends pitch and roll.", 0.1, 100.0);
    v.field("max_silence_s", max_silence_s, "s",
            "Where the wheels or the inertial unit are silent for longer, the car is lost: their "
            "last readings go on, and are believed ever less.",
            0.01, 10.0);
  }
};

/// Where the car is by its rear wheels' mean speed and its gyroscope alone: no camera. The floor is
/// taken for flat (z = 0); while the car stands, the gyroscope's bias is learned. Frame odom: the
/// first pose over the ground. docs/avp-slam.md.
class DeadReckoning {
 public:
  DeadReckoning(const SE3& T_vehicle_imu, const DeadReckoningOptions& options);

  /// In the order of time each.
  void addImu(const ImuSample& sample);
  void addWheel(const WheelSample& sample);

  /// The pose at an instant not before the last one asked for, by the readings up to it (and the
  /// first ones after it, where they are there). kInitialising until wheels and IMU have been
  /// heard; kLost while one of them is silent.
  PoseEstimate poseAt(TimeNs t_ns);

 private:
  struct Speed {
    TimeNs t_ns = 0;
    double mps = 0.0;
  };
  void start();
  void advance(const ImuSample& sample, TimeNs until);
  void levelUp(const Eigen::Vector3d& rate, const Eigen::Vector3d& accel, double speed, double dt);
  [[nodiscard]] Eigen::Vector3d drivingNoise(double step, TimeNs until, double dt) const;
  [[nodiscard]] Eigen::Matrix3d silenceNoise(TimeNs last_imu, TimeNs until, double dt) const;
  void tellPose(PoseEstimate& e) const;
  [[nodiscard]] double speedAt(TimeNs t_ns) const;
  void stand(const Eigen::Vector3d& gyro, const Eigen::Vector3d& accel, double dt);

  SE3 T_vehicle_imu_;
  DeadReckoningOptions options_;
  std::deque<ImuSample> imu_;
  std::deque<Speed> speeds_;
  bool started_ = false;
  TimeNs t_ns_ = 0;
  TimeNs bias_t_ns_ = 0;  // when the car stood last
  TimeNs origin_t_ns_ = 0;
  double still_s_ = 0.0;  // of this stand
  double bias_seconds_ = 0.0;
  Eigen::Vector3d bias_ = Eigen::Vector3d::Zero();  // vehicle frame, rad/s
  Eigen::Vector3d up_ = Eigen::Vector3d::UnitZ();   // vehicle frame
  double yaw_ = 0.0;
  Eigen::Vector2d position_ = Eigen::Vector2d::Zero();
  double way_ = 0.0;
  double last_speed_ = 0.0;
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();  // x, y, yaw; right perturbation
};

}  // namespace parkade
