// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/tracking/camera_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "parkade/core/check.hpp"
#include "parkade/core/log.hpp"
#include "parkade/tracking/camera_tracker_flow.hpp"
#include "parkade/tracking/overlap.hpp"

namespace parkade {

CameraTracker::CameraTracker(const RigCamera& camera, const TrackingOptions& options, int index)
    : camera_(camera),
      options_(options),
      index_(index),
      detector_(options.detection, camera.camera.width(), camera.camera.height()),
      contrast_(options.contrast),
      static_mask_(validityMask(camera.camera)) {}

void CameraTracker::setReadoutTime(double seconds) {
  if (camera_.readout_time > 0.0) camera_.readout_time = seconds;
}

void CameraTracker::setMask(const cv::Mat& mask) {
  PARKADE_CHECK(mask.type() == CV_8UC1 && mask.size() == static_mask_.size(),
                "mask of {} x {}, type {}", mask.cols, mask.rows, mask.type());
  // A patch must not show what is hidden: the own body stands still, and drags it along.
  constexpr int kMargin = Patch::kRadius + 1;  // px
  const cv::Mat disc =
      cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * kMargin + 1, 2 * kMargin + 1});
  cv::Mat clear;
  cv::erode(mask != 0, clear, disc);
  static_mask_ = validityMask(camera_.camera) & clear;
}

void CameraTracker::setDynamicMask(const cv::Mat& mask) {
  PARKADE_CHECK(mask.type() == CV_8UC1 && mask.size() == static_mask_.size(),
                "mask of {} x {}, type {}", mask.cols, mask.rows, mask.type());
  dynamic_mask_ = mask.clone();
  has_dynamic_mask_ = true;
}

bool CameraTracker::masked(const Eigen::Vector2d& pixel) const {
  const int x = std::clamp(static_cast<int>(std::lround(pixel.x())), 0, mask_.cols - 1);
  const int y = std::clamp(static_cast<int>(std::lround(pixel.y())), 0, mask_.rows - 1);
  return mask_.at<std::uint8_t>(y, x) == 0;
}

void CameraTracker::accumulate(const MotionPrior& prior) {
  motion_valid_ = motion_valid_ && prior.valid;
  translation_valid_ = translation_valid_ && prior.valid && prior.translation_valid;
  if (motion_valid_) T_last_current_ = T_last_current_ * prior.T_previous_current;
}

void CameraTracker::track(const cv::Mat& image, TimeNs t_ns, const MotionPrior& prior,
                          std::uint64_t seed) {
  lost.clear();
  renewed = 0;
  motion_rms_px = 0.0;
  accumulate(prior);
  mask_ = has_dynamic_mask_ ? cv::Mat(static_mask_ & (dynamic_mask_ != 0)) : static_mask_;
  has_dynamic_mask_ = false;

  const bool right_size =
      image.cols == camera_.camera.width() && image.rows == camera_.camera.height();
  cv::Mat grey;
  ok_ = !image.empty() && right_size && contrast_.apply(image, grey);
  if (!image.empty() && !right_size) {
    logWarning("{}: image of {} x {} px, the rig says {} x {}; left out", camera_.name, image.cols,
               image.rows, camera_.camera.width(), camera_.camera.height());
  }
  const bool gap_too_long = toSeconds(t_ns - last_t_ns_) > options_.flow.max_gap_s;
  if (!ok_ || gap_too_long) {
    if (gap_too_long) {
      for (const FeatureView& view : views_) {
        lost.push_back({index_, view.id, view.pixel, TrackLoss::kFlow});
      }
      views_.clear();
    }
    if (!ok_) return;
  }

  std::swap(pyramid_, last_pyramid_);
  cv::buildOpticalFlowPyramid(
      grey, pyramid_, cv::Size(options_.flow.window_px, options_.flow.window_px),
      options_.flow.levels, true, cv::BORDER_REFLECT_101, cv::BORDER_CONSTANT, false);
  if (!views_.empty()) {
    std::vector<Flow> flows(views_.size());
    for (std::size_t i = 0; i < views_.size(); ++i) flows[i].view = views_[i];
    predict(prior, t_ns, flows);
    flowForward(flows);
    flowBackward(flows);
    retry(flows);
    align(flows);
    judge(flows, seed);
    commit(flows);
  }
  last_t_ns_ = t_ns;
  T_last_current_ = SE3();
  motion_valid_ = true;
  translation_valid_ = true;
}

void CameraTracker::commit(const std::vector<Flow>& flows) {
  // Two features that ran into each other are one: the older stays.
  std::vector<FeatureView> kept;
  kept.reserve(flows.size());
  for (const Flow& flow : flows) {
    if (!flow.alive) {
      const Eigen::Vector2d place(flow.found.x, flow.found.y);
      lost.push_back({index_, flow.view.id, place.allFinite() ? place : flow.predicted, flow.why});
      continue;
    }
    const double reach = 0.5 * options_.detection.min_distance_px;
    const bool crowded = std::any_of(kept.begin(), kept.end(), [&](const FeatureView& other) {
      return (other.pixel - flow.view.pixel).squaredNorm() < reach * reach;
    });
    if (crowded) {
      lost.push_back({index_, flow.view.id, flow.view.pixel, TrackLoss::kPatch});
      continue;
    }
    kept.push_back(flow.view);
    ++kept.back().age;
    ++kept.back().patch_age;
  }
  views_ = std::move(kept);
}

std::vector<Corner> CameraTracker::detect() {
  if (!ok_) return {};
  std::vector<Eigen::Vector2d> taken;
  taken.reserve(views_.size());
  for (const FeatureView& view : views_) taken.push_back(view.pixel);
  // What a passing thing hides may hold corners in the next picture.
  const bool partly_hidden = mask_.data != static_mask_.data;
  return detector_.detect(pyramid_[0], mask_, taken, last_t_ns_,
                          partly_hidden ? nullptr : &barren_);
}

bool CameraTracker::add(std::uint64_t id, const Eigen::Vector2d& pixel) {
  FeatureView view;
  view.id = id;
  view.pixel = pixel;
  view.patch = Patch::sample(pyramid_[0], pixel);
  view.sigma_px = options_.flow.sigma_floor_px;
  if (view.patch == nullptr || !camera_.camera.unproject(pixel, view.ray)) return false;
  PARKADE_CHECK(views_.empty() || views_.back().id < id, "ids must grow: {} after {}", id,
                views_.back().id);
  views_.push_back(std::move(view));
  return true;
}

bool CameraTracker::addMatch(std::uint64_t id, const PatchAlignment& found,
                             const std::shared_ptr<const Patch>& patch) {
  FeatureView view;
  view.id = id;
  view.pixel = found.pixel;
  view.warp = found.warp;
  view.patch = patch;
  view.sigma_px = std::hypot(options_.flow.sigma_floor_px, found.sigma_px);
  if (masked(view.pixel) || !camera_.camera.inImage(view.pixel, kTrackBorderPx) ||
      !camera_.camera.unproject(view.pixel, view.ray)) {
    return false;
  }
  const auto place =
      std::lower_bound(views_.begin(), views_.end(), id,
                       [](const FeatureView& v, std::uint64_t i) { return v.id < i; });
  views_.insert(place, std::move(view));
  return true;
}

const FeatureView* CameraTracker::find(std::uint64_t id) const {
  const auto place =
      std::lower_bound(views_.begin(), views_.end(), id,
                       [](const FeatureView& v, std::uint64_t i) { return v.id < i; });
  return place != views_.end() && place->id == id ? &*place : nullptr;
}

void CameraTracker::remove(std::uint64_t id) {
  std::erase_if(views_, [id](const FeatureView& v) { return v.id == id; });
}

const FeatureView* CameraTracker::nearest(const Eigen::Vector2d& pixel, double reach_px) const {
  const FeatureView* best = nullptr;
  double square = reach_px * reach_px;
  for (const FeatureView& view : views_) {
    const double d = (view.pixel - pixel).squaredNorm();
    if (d < square) {
      square = d;
      best = &view;
    }
  }
  return best;
}

SearchImage CameraTracker::searchImage() const {
  PARKADE_CHECK(ok_, "{} has no picture", camera_.name);
  cv::Mat coarse;
  if (pyramid_.size() >= 4) {
    coarse = pyramid_[2];
  } else {
    cv::pyrDown(pyramid_[0], coarse);
  }
  return {&camera_.camera, pyramid_[0], coarse};
}

}  // namespace parkade
