// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "parkade/camera/rig.hpp"
#include "parkade/core/result.hpp"
#include "parkade/vio/estimator.hpp"

namespace parkade::cli {

/// A rig's file: the path itself, or rig.yaml in the folder of the run that learned it. Fails on a
/// folder that holds none.
Result<std::string> rigFileOf(const std::string& path);

/// The rig with its cameras where a drive has found them, how sure it is, their clocks and, of
/// rolling shutters that are refined, their readout times. told:
/// with the time offsets of its file; learned: one a camera (checked).
Rig learnedRig(const Rig& told, const std::vector<CameraCalibrationEstimate>& learned);

/// One entry of metrics.json's "calibration" (docs/formats.md): where the camera was told to sit
/// and where it was found, how far that is along and about the vehicle's axes, and how sure.
nlohmann::json calibrationJson(const RigCamera& told, const CameraCalibrationEstimate& learned);

}  // namespace parkade::cli
