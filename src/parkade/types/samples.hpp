// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <opencv2/core/mat.hpp>
#include <string>
#include <variant>
#include <vector>

#include "parkade/core/time.hpp"

namespace parkade {

/// One reading of the inertial unit, in the imu frame.
struct ImuSample {
  TimeNs t_ns = 0;
  Eigen::Vector3d gyro = Eigen::Vector3d::Zero();   ///< angular rate, rad/s
  Eigen::Vector3d accel = Eigen::Vector3d::Zero();  ///< specific force, m/s^2 (+9.81 up at rest)
};

/// One reading of the rear wheels and the steering; NaN where the car does not report it.
struct WheelSample {
  TimeNs t_ns = 0;
  double rear_left_mps = std::numeric_limits<double>::quiet_NaN();   ///< signed ground speed, m/s
  double rear_right_mps = std::numeric_limits<double>::quiet_NaN();  ///< signed ground speed, m/s
  double steering_rad = std::numeric_limits<double>::quiet_NaN();    ///< road wheel angle, left > 0
};

/// The images of one instant, one place per camera of the rig, in the rig's order. A camera that
/// has no picture for this instant has an empty image.
struct FrameSet {
  TimeNs t_ns = 0;                 ///< the instant: mean stamp of the images joined here
  std::vector<cv::Mat> images;     ///< CV_8UC1 or CV_8UC3 (BGR)
  std::vector<cv::Mat> gray;       ///< CV_8UC1, beside colour where the source read it; or none
  std::vector<TimeNs> image_t_ns;  ///< each image's own stamp on the IMU's clock (0: empty)
  int index = 0;                   ///< counts frame sets from 0
};

/// What a source delivers, in the order of time.
using SensorEvent = std::variant<ImuSample, WheelSample, FrameSet>;

inline TimeNs timeOf(const SensorEvent& event) {
  return std::visit([](const auto& sample) { return sample.t_ns; }, event);
}

}  // namespace parkade
