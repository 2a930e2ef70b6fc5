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
#include "parkade/io/stamps.hpp"

namespace parkade {

/// kWarn: readable, but look at it. kFail: a run would refuse the sequence.
enum class CheckMark { kPass, kWarn, kFail };

struct SequenceCheck {
  CheckMark mark = CheckMark::kPass;
  std::string name;
  std::string detail;
};

/// Timing of one sensor. Steps are taken between rows in the order of time (after repair, where the
/// stamps need it).
struct StreamStatistics {
  std::size_t count = 0;
  TimeNs start_ns = 0;
  TimeNs end_ns = 0;
  double rate_hz = 0.0;         ///< 1 / median step
  double jitter_ms = 0.0;       ///< standard deviation of the steps that are no gaps
  std::size_t gaps = 0;         ///< steps above 1.5 median steps
  double largest_gap_ms = 0.0;  ///< largest step; 0 where there is no gap
  StampReport stamps;
};

struct CameraReport {
  std::string name;
  std::string model;
  int width = 0;
  int height = 0;
  StreamStatistics stream;     ///< stamps on the IMU's clock
  std::size_t missing = 0;     ///< listed files that are absent
  std::size_t unreadable = 0;  ///< with decode_images: of those present
};

struct ImuReport {
  StreamStatistics stream;
  Eigen::Vector3d gyro_mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyro_std = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_mean = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_std = Eigen::Vector3d::Zero();
  /// The quietest second (least spread of the accelerometer).
  TimeNs quiet_start_ns = 0;
  Eigen::Vector3d quiet_gyro = Eigen::Vector3d::Zero();           ///< mean, imu frame, rad/s
  Eigen::Vector3d quiet_accel_vehicle = Eigen::Vector3d::Zero();  ///< mean, vehicle frame, m/s^2
  double quiet_accel_std = 0.0;                                   ///< m/s^2
  double gravity = 0.0;                                           ///< norm of that mean, m/s^2
};

struct WheelReport {
  StreamStatistics stream;
  double max_speed_mps = 0.0;  ///< mean of the rear wheels, magnitude
  double distance_m = 0.0;     ///< sum of the speeds' magnitude
  bool has_steering = false;
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
  std::vector<SequenceCheck> checks;

  [[nodiscard]] bool failed() const;
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

/// Timing of stamps in the order of a file.
StreamStatistics streamStatistics(const std::vector<TimeNs>& t_ns);

}  // namespace parkade
