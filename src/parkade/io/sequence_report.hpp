// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "parkade/core/progress.hpp"
#include "parkade/core/result.hpp"
#include "parkade/io/check.hpp"
#include "parkade/io/imu_report.hpp"
#include "parkade/io/stream_statistics.hpp"
#include "parkade/io/wheel_report.hpp"

namespace parkade {

struct CameraReport {
  std::string name;
  std::string model;
  int width = 0;
  int height = 0;
  StreamStatistics stream;     ///< stamps on the IMU's clock
  std::size_t missing = 0;     ///< listed files that are absent
  std::size_t unreadable = 0;  ///< with decode_images: of those present
};

struct ReferenceReport {
  std::string path;
  std::size_t count = 0;
  double duration_s = 0.0;
  double length_m = 0.0;
};

struct SequenceReport {
  std::string path;
  double duration_s = 0.0;
  TimeNs start_ns = 0;
  TimeNs end_ns = 0;
  std::vector<CameraReport> cameras;
  std::size_t frame_sets = 0;
  std::size_t complete_frame_sets = 0;  ///< those with an image of every camera
  double frame_rate_hz = 0.0;
  std::optional<ImuReport> imu;
  std::optional<WheelReport> wheel;
  std::optional<ReferenceReport> reference;
  std::vector<Check> checks;

  [[nodiscard]] bool failed() const { return anyFailed(checks); }
};

struct SequenceReportOptions {
  bool decode_images = false;  ///< decode all of them, not only the first of each camera
  int threads = 1;
  ProgressCallback progress;
};

/// Reads all there is of a sequence folder and judges it. What cannot be read becomes a failed
/// check; only a path that is no sequence is an Error.
Result<SequenceReport> describeSequence(const std::string& path,
                                        const SequenceReportOptions& options = {});

/// For a reader at a terminal, and the same for programs.
std::string sequenceText(const SequenceReport& report);
nlohmann::json sequenceJson(const SequenceReport& report);

}  // namespace parkade
