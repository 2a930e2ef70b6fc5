// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "parkade/camera/camera.hpp"
#include "parkade/camera/rig.hpp"
#include "parkade/core/yaml.hpp"

namespace parkade {

// What the readers of rig.yaml, Kalibr and EuRoC files share. They throw YamlError.

/// camera_model, intrinsics, distortion_model, coefficients (under the key given) and resolution,
/// in Kalibr's words: pinhole with radtan (4, 5 or 8 numbers), equidistant or none; omni with
/// radtan or none; and ocam with polynomial, which Kalibr does not know.
Camera readCamera(const YamlNode& node, const char* coefficients_key);
/// The same as lines of YAML, each indented.
std::string writeCamera(const Camera& camera, const std::string& indent);

/// A 4x4 rigid motion, refused where its upper left block is no rotation (|R R' - I| > 1e-5).
SE3 readTransform(const YamlNode& node);
std::string writeTransform(const char* key, const SE3& transform, const std::string& indent);

/// The four noise figures under Kalibr's names, each > 0.
void readImuNoise(const YamlNode& node, ImuCalibration& imu);

/// A finite number > 0.
double readPositive(const YamlNode& node);

}  // namespace parkade
