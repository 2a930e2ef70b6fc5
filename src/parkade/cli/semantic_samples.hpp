// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "parkade/bev/stitcher.hpp"
#include "parkade/core/options.hpp"
#include "parkade/core/random.hpp"
#include "parkade/sim/drive/simulation.hpp"
#include "parkade/sim/render/renderer.hpp"
#include "parkade/types/samples.hpp"

namespace parkade::cli {

/// How samples for training and scores are drawn from a simulated drive.
struct SampleOptions {
  int frames = 10;
  double attitude_error_deg = 0.07;
  double height_error_cm = 0.3;
  double relief_error_cm = 0.5;
  double turn_deg = 0.0;
  double shift_m = 0.0;
  bool masks = true;
  bool coarse_light = false;
  bool stitched = true;
  std::string first_zone = "A";

  void visit(OptionVisitor& v) {
    v.field("frames", frames, "count", "Frame sets per drive, evenly along the way.", 1, 100000);
    v.field("attitude_error_deg", attitude_error_deg, "deg",
            "Standard deviation of the pitch and of the roll that the stitcher is told.", 0.0,
            10.0);
    v.field("height_error_cm", height_error_cm, "cm",
            "Standard deviation of the height that the stitcher is told.", 0.0, 100.0);
    v.field("relief_error_cm", relief_error_cm, "cm",
            "Standard deviation of the floor's heights, every 2 m, that the stitcher is told.", 0.0,
            100.0);
    v.field("turn_deg", turn_deg, "deg",
            "Standard deviation of a turn away from the drive's heading.", 0.0, 180.0);
    v.field("shift_m", shift_m, "m", "Standard deviation of a step away from the drive.", 0.0,
            10.0);
    v.field("masks", masks, "Whether the stitcher knows where the own body is in sight.");
    v.field("coarse_light", coarse_light, "Bake the light coarsely: faster, for training.");
    v.field("stitched", stitched, "Whether the stitched picture and its labels are made.");
    v.field("first_zone", first_zone, "Letter of the garages' first row of zones.");
  }
};

/// One frame set with its truth. Truth serves scores and training only.
struct SemanticSample {
  FrameSet frames;
  double t = 0.0;  ///< s since the drive began
  SE3 T_world_vehicle;
  GroundAttitude attitude;       ///< that the picture was stitched with
  GroundRelief relief;           ///< and with it the floor over its plane
  GroundAttitude true_attitude;  ///< of the floor around the car
  BevImage bev;                  ///< stitched by the program, own car and unseen places black;
                                 ///< empty where none is wanted
  cv::Mat bev_labels;            ///< CV_8UC1: what each of its pixels shows; kUnknown: not valid
};

/// Draws samples of one drive. The same options and seeds give the same samples.
class SemanticSampler {
 public:
  static Result<std::unique_ptr<SemanticSampler>> make(const sim::SimSpec& spec,
                                                       const SampleOptions& options,
                                                       const BevOptions& bev);

  [[nodiscard]] int count() const { return options_.frames; }
  [[nodiscard]] const sim::Simulation& simulation() const { return *simulation_; }
  [[nodiscard]] const BevStitcher& stitcher() const { return *stitcher_; }
  [[nodiscard]] const sim::Scene& scene() const { return *scene_; }

  /// The index-th sample, 0 <= index < count(). In order, since the stitcher's gains follow.
  [[nodiscard]] SemanticSample draw(int index);

  /// CV_8UC1, SemanticClass of every pixel of a camera's picture; kUnknown on the own car.
  [[nodiscard]] cv::Mat cameraLabels(const SemanticSample& sample, int camera) const;

  /// CV_8UC1: 0 where the own car hides the world from a camera.
  [[nodiscard]] const cv::Mat& bodyMask(int camera) const {
    return body_masks_[static_cast<std::size_t>(camera)];
  }

 private:
  SemanticSampler() = default;
  [[nodiscard]] cv::Mat drawBodyMask(int camera) const;
  [[nodiscard]] double timeOf(int index, Random& random) const;
  [[nodiscard]] GroundAttitude trueAttitude(const SE3& T_world_vehicle) const;
  /// Of the floor over the plane of an attitude.
  [[nodiscard]] GroundRelief trueRelief(const SE3& T_world_vehicle,
                                        const GroundAttitude& attitude) const;
  [[nodiscard]] cv::Mat labelPicture(const SemanticSample& sample, const sim::Moment& moment) const;

  SampleOptions options_;
  std::shared_ptr<const sim::Simulation> simulation_;
  std::shared_ptr<const sim::Scene> scene_;
  std::unique_ptr<sim::Renderer> renderer_;
  std::unique_ptr<BevStitcher> stitcher_;
  std::vector<cv::Mat> body_masks_;
  std::vector<double> way_;  ///< m driven at each frame time
};

}  // namespace parkade::cli
