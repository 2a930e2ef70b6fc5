// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <opencv2/core/mat.hpp>
#include <string>

#include "parkade/camera/rig.hpp"
#include "parkade/core/result.hpp"
#include "parkade/pipeline/mapping_run.hpp"

namespace parkade::cli {

/// The files that ReportPictures writes below a run's folder.
inline constexpr const char* kReportPictures[] = {
    "pictures/tracks.jpg",    "pictures/stitched.jpg",     "pictures/features.jpg",
    "pictures/local_map.png", "pictures/local_moving.png", "pictures/pictures.json"};

/// Keeps some pictures of a run for its report, from the first frame set after its middle: what the
/// front end follows, the cameras stitched on the ground, the features on that picture, the map
/// around the car; and the moving layer around the car when most moved. pictures.json says where
/// and when.
class ReportPictures : public PipelineObserver {
 public:
  /// begin_ns and end_ns: of the source, as far as known. semantics: the method labels pictures;
  /// the one on the ground is made here where it does not.
  ReportPictures(Rig rig, TimeNs begin_ns, TimeNs end_ns, bool semantics);
  void onTracks(const TracksEvent& event) override;
  void onFeatures(const FeaturesEvent& event) override;
  void onMap(const MapEvent& event) override;
  /// Writes the pictures below a run's folder, after the run.
  [[nodiscard]] Status write(const std::string& folder) const;

 private:
  void stitch(const FrameSet& frames);

  Rig rig_;
  TimeNs middle_ns_;
  bool semantics_;
  TrackSet previous_;
  // Each from one thread of the run.
  cv::Mat tracks_;
  cv::Mat stitched_;
  cv::Mat features_;
  nlohmann::ordered_json features_json_;
  cv::Mat local_map_;
  nlohmann::ordered_json local_json_;
  cv::Mat moving_;
  nlohmann::ordered_json moving_json_;
  int most_moving_ = 0;
};

}  // namespace parkade::cli
