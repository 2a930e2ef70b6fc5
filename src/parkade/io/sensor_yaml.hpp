// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "parkade/camera/rig.hpp"

namespace parkade {

// The sensor.yaml files of an EuRoC/ASL folder as text. T_BS is T_vehicle_sensor.

/// rate_hz: written where the camera does not state its own.
std::string cameraSensorYaml(const RigCamera& camera, double rate_hz);
std::string imuSensorYaml(const ImuCalibration& imu);
std::string wheelSensorYaml();
std::string groundTruthSensorYaml();

}  // namespace parkade
