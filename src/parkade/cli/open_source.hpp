// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "parkade/camera/rig.hpp"
#include "parkade/core/result.hpp"
#include "parkade/core/time.hpp"
#include "parkade/types/sensor_source.hpp"

namespace parkade::cli {

/// What a command may ask of its input.
struct SourceRequest {
  std::string spec;     ///< a sequence folder, or sim:GARAGE/ROUTE
  std::string rig;      ///< file in place of the sequence's own, or folder of a run; empty: its own
  std::string cameras;  ///< cam0,cam1; empty: all
  double start_s = 0.0;
  double duration_s = 0.0;  ///< 0: to the end
  bool tolerate_stamps = false;
  double join_tolerance_ms = -1.0;  ///< between images of one instant; -1: as is usual
  bool gray = true;
  bool gray_beside = false;  ///< gray as well where colour is read, as key points want it
  int decode_threads = 1;
};

/// An input with its calibration.
struct OpenedSource {
  Rig rig;                              ///< without time offsets: the source's stamps have them
  std::vector<TimeNs> time_offsets_ns;  ///< what was added to each camera's recorded stamps
  std::unique_ptr<SensorSource> source;
};

/// Opens a sequence folder or the simulator: from here on nobody can tell which.
Result<OpenedSource> openSource(const SourceRequest& request);

/// What is wrong with the text of --cameras; empty where nothing is.
std::string checkCameraNames(const std::string& text);

}  // namespace parkade::cli
