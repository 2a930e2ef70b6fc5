// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "parkade/imu/imu_types.hpp"
#include "parkade/imu/reading_buffer.hpp"
#include "parkade/types/motion_prior.hpp"
#include "parkade/types/samples.hpp"

namespace parkade {

/// A copy of an estimator's newest state that can be carried to another thread. It knows the IMU
/// readings up to the moment of the copy; later ones are added here.
class MotionPredictor {
 public:
  MotionPredictor() = default;

  void addImu(const ImuSample& sample);

  /// Motion of the vehicle from one instant to a later one, both at or after the copied state's;
  /// features are given in the vehicle frame at previous_t_ns. Not valid before start-up, nor more
  /// than 5 s ahead.
  [[nodiscard]] MotionPrior predict(TimeNs previous_t_ns, TimeNs t_ns) const;

  [[nodiscard]] bool valid() const { return valid_; }
  [[nodiscard]] TimeNs stateTime() const { return t_ns_; }

 private:
  friend class VioEstimator;
  bool valid_ = false;
  bool rotation_only_ = false;  ///< before start-up only the gyroscope is trusted
  TimeNs t_ns_ = 0;
  NavState state_;
  ImuBias bias_;
  Eigen::Vector3d gravity_ = Eigen::Vector3d::Zero();
  SE3 T_vehicle_imu_;
  ReadingBuffer readings_;
  std::vector<std::pair<std::uint64_t, Eigen::Vector3d>> points_odom_;
  std::vector<double> readout_times_;
};

}  // namespace parkade
