// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "parkade/camera/rig.hpp"
#include "parkade/core/result.hpp"
#include "parkade/eval/evaluation.hpp"
#include "parkade/pipeline/mapping_run.hpp"

namespace parkade::cli {

/// Keeps two pictures of the middle of a run for its report: FOLDER/pictures/tracks.jpg (what the
/// front end follows) and stitched.jpg (all cameras on the ground).
class ReportPictures : public PipelineObserver {
 public:
  /// begin_ns and end_ns: of the source, as far as known.
  ReportPictures(std::string folder, Rig rig, TimeNs begin_ns, TimeNs end_ns);
  void onTracks(const TracksEvent& event) override;
  [[nodiscard]] const Status& status() const { return status_; }

 private:
  void draw(const TracksEvent& event);

  std::string folder_;
  Rig rig_;
  TimeNs middle_ns_;
  TrackSet previous_;
  bool drawn_ = false;
  Status status_;
};

/// What is known from outside about where the car was.
struct ReportTruth {
  Evaluation evaluation;  ///< of the run's trajectory
  Trajectory reference;
};

/// Writes a page about a run from the files of its folder: way, map, slots, health, timing,
/// pictures; with a truth also errors. What the run did not write is left out. Fails where
/// the folder holds no trajectory or the page cannot be written.
Status writeRunReport(const std::string& run_folder, const std::string& page_path,
                      const std::optional<ReportTruth>& truth = {});

}  // namespace parkade::cli
