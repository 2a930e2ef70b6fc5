// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "parkade/core/result.hpp"
#include "parkade/pipeline/mapping_run.hpp"
#include "parkade/types/pose_covariance.hpp"

namespace parkade::cli {

/// Gathers one row of health.csv per frame set, and the covariances of the poses.
class HealthLog : public PipelineObserver {
 public:
  HealthLog();
  void onPose(const PoseEvent& event) override;
  [[nodiscard]] const std::string& text() const { return text_; }
  [[nodiscard]] const PoseCovariances& covariances() const { return covariances_; }
  [[nodiscard]] int frames(Health health) const { return frames_[static_cast<int>(health)]; }
  /// Seconds from the first frame set to the first pose; nothing where there is none.
  [[nodiscard]] std::optional<double> startUpSeconds() const;
  /// Mean over the poses: how many times larger the inertial unit's errors are than told.
  [[nodiscard]] double imuNoiseFactor() const;

 private:
  std::string text_;
  PoseCovariances covariances_;
  int frames_[4] = {};
  TimeNs first_t_ns_ = 0;
  std::optional<TimeNs> first_pose_t_ns_;
  double imu_noise_factors_ = 0.0;  // sum over the poses
};

/// Draws every frame set's tracks into a folder, as NNNNNN.jpg, in place of those of an earlier
/// run. status() says from the start on whether that works.
class DebugImages : public PipelineObserver {
 public:
  DebugImages(std::string folder, Rig rig);
  void onTracks(const TracksEvent& event) override;
  [[nodiscard]] const Status& status() const { return status_; }

 private:
  std::string folder_;
  Rig rig_;
  TrackSet previous_;
  Status status_;
};

/// What the files tell besides the run itself.
struct RunDescription {
  std::string source;
  std::string cameras;
  Rig rig;  ///< as told, with the time offsets of its file
  std::string method;
  std::string config;  ///< effective configuration, YAML
  int threads = 1;
};

/// The text of config.yaml.
std::string configText(const RunDescription& description);

/// Name and text of files.
using RunTexts = std::vector<std::pair<std::string, std::string>>;

/// health.csv, timing.json and metrics.json.
RunTexts runTexts(const RunDescription& description, const MappingRun& run,
                  const HealthLog& health);

/// Writes trajectory*.tum, covariance.csv and the texts, each whole or not at all.
Status writeRunFiles(const std::string& folder, const RunTexts& texts, const MappingRun& run,
                     const HealthLog& health, bool with_final);

/// Writes rig.yaml, the rig as learned, where the run refined its cameras and has a pose. Not that
/// of a drive simulated on the fly, whose masks lie in no file.
Status writeLearnedRig(const std::string& folder, const RunDescription& description,
                       const MappingRun& run);

/// Writes map.db and the exports map/, where the run made a map.
Status writeMap(const std::string& folder, const std::string& name, const MappingRun& run);

/// The table of stage timings, as printed at the end.
std::string timingTable(const RunSummary& summary);

/// Largest memory that this process held so far, MB.
double peakMemoryMb();

}  // namespace parkade::cli
