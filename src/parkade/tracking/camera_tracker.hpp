// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <unordered_map>
#include <vector>

#include "parkade/camera/rig.hpp"
#include "parkade/core/time.hpp"
#include "parkade/tracking/contrast.hpp"
#include "parkade/tracking/detector.hpp"
#include "parkade/tracking/epipolar_search.hpp"
#include "parkade/tracking/outliers.hpp"
#include "parkade/tracking/patch.hpp"
#include "parkade/tracking/tracker.hpp"

namespace parkade {

/// A feature as one camera sees it.
struct FeatureView {
  std::uint64_t id = 0;
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  Eigen::Vector3d ray = Eigen::Vector3d::UnitZ();      ///< unit, camera frame
  Eigen::Matrix2d warp = Eigen::Matrix2d::Identity();  ///< patch offsets to image offsets
  std::shared_ptr<const Patch> patch;                  ///< may stem from another camera
  int age = 1;
  int patch_age = 1;  ///< frames that the patch has served
  int renewals = 0;   ///< patches taken since the first
  double sigma_px = 1.0;
};

/// One camera's part of the tracker: its pictures and its features. Used by one thread at a time.
class CameraTracker {
 public:
  CameraTracker(const RigCamera& camera, const TrackingOptions& options, int index);

  /// Follows the features into a new picture (empty: none came).
  void track(const cv::Mat& image, TimeNs t_ns, const MotionPrior& prior, std::uint64_t seed);

  /// Corners in cells that hold no feature; nothing where the camera is not ok.
  [[nodiscard]] std::vector<Corner> detect();

  /// Takes a new feature; false where it has no patch or ray there.
  bool add(std::uint64_t id, const Eigen::Vector2d& pixel);
  /// Takes a feature of another camera that was found here.
  bool addMatch(std::uint64_t id, const PatchAlignment& found,
                const std::shared_ptr<const Patch>& patch);
  void remove(std::uint64_t id);

  [[nodiscard]] bool ok() const { return ok_; }
  [[nodiscard]] const std::vector<FeatureView>& views() const { return views_; }  ///< by id
  [[nodiscard]] const FeatureView* find(std::uint64_t id) const;
  [[nodiscard]] const FeatureView* nearest(const Eigen::Vector2d& pixel, double reach_px) const;
  [[nodiscard]] SearchImage searchImage() const;
  [[nodiscard]] const RigCamera& camera() const { return camera_; }

  /// A rolling shutter takes longer or less long than the rig said; of no use to others.
  void setReadoutTime(double seconds);
  void setMask(const cv::Mat& mask);
  void setDynamicMask(const cv::Mat& mask);

  std::vector<TrackingReport::Lost> lost;  ///< of the last track()
  double motion_rms_px = 0.0;
  int renewed = 0;

 private:
  struct Flow;
  void accumulate(const MotionPrior& prior);
  void predict(const MotionPrior& prior, TimeNs t_ns, std::vector<Flow>& flows) const;
  void flowForward(std::vector<Flow>& flows) const;
  void flowBackward(std::vector<Flow>& flows) const;
  void retry(std::vector<Flow>& flows) const;
  void align(std::vector<Flow>& flows);
  void judge(std::vector<Flow>& flows, std::uint64_t seed);
  void commit(const std::vector<Flow>& flows);
  [[nodiscard]] bool masked(const Eigen::Vector2d& pixel) const;

  RigCamera camera_;
  TrackingOptions options_;
  int index_;
  GridDetector detector_;
  std::vector<TimeNs> barren_;  // cells of the detector, since when
  ContrastNormaliser contrast_;
  cv::Mat static_mask_;   // validity and body
  cv::Mat dynamic_mask_;  // of this frame set, or empty
  cv::Mat mask_;          // both, of this frame set
  bool has_dynamic_mask_ = false;
  bool ok_ = false;
  TimeNs last_t_ns_ = 0;  // of the picture that the views belong to
  SE3 T_last_current_;    // vehicle's motion since then
  bool motion_valid_ = false;
  bool translation_valid_ = false;
  std::vector<cv::Mat> pyramid_;  // image and derivatives, level by level
  std::vector<cv::Mat> last_pyramid_;
  std::vector<FeatureView> views_;
};

}  // namespace parkade
