// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "parkade/geometry/so3.hpp"
#include "parkade/io/check.hpp"
#include "parkade/io/stream_statistics.hpp"
#include "parkade/types/samples.hpp"

namespace parkade {

struct WheelReport {
  StreamStatistics stream;
  double max_speed_mps = 0.0;  ///< mean of the rear wheels, magnitude
  double distance_m = 0.0;     ///< sum of the speeds' magnitude
  bool has_steering = false;
};

/// Largest speed and way of samples in the order of time, into the report.
void describeWheels(const std::vector<WheelSample>& samples, WheelReport& report);

/// Whether the speeds are metres a second and forwards positive: their changes over half a second
/// against what the accelerometer felt along the vehicle's x. Nothing where the car hardly
/// accelerates, or both have nothing to do with each other. Samples in the order of time.
std::optional<Check> checkWheelUnit(const std::vector<WheelSample>& wheels,
                                    const std::vector<ImuSample>& imu, const SO3& R_vehicle_imu);

}  // namespace parkade
