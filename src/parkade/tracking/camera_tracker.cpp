// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/tracking/camera_tracker.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "parkade/core/check.hpp"
#include "parkade/core/log.hpp"
#include "parkade/core/median.hpp"
#include "parkade/tracking/overlap.hpp"

namespace parkade {
namespace {

constexpr double kBorderPx = 2.0;           // features nearer to the border are let go
constexpr double kRenewalSigmaPx = 0.15;    // what each new patch adds to the uncertainty
constexpr int kBackwardLevels = 1;          // the start is known: no need for the whole pyramid
constexpr std::size_t kNeighbours = 3;      // known points that lend their depth to a new feature
constexpr double kPredictionErrorPx = 4.0;  // a worse prediction gets a second try with the median

bool isFinite(const cv::Point2f& p) {
  return std::isfinite(p.x) && std::isfinite(p.y);
}

cv::Point2f toPoint(const Eigen::Vector2d& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y())};
}

// How far a warp is from keeping size and shape: the larger of its stretches and their inverses.
double stretchOf(const Eigen::Matrix2d& warp) {
  const double square = warp.squaredNorm();
  const double area = std::abs(warp.determinant());
  const double root = std::sqrt(std::max(square * square - 4.0 * area * area, 0.0));
  const double large = std::sqrt(0.5 * (square + root));
  const double small = std::sqrt(std::max(0.5 * (square - root), 1e-12));
  return std::max(large, 1.0 / small);
}

}  // namespace

// A view on its way into the new picture.
struct CameraTracker::Flow {
  FeatureView view;
  Eigen::Vector2d predicted = Eigen::Vector2d::Zero();
  cv::Point2f found;
  bool alive = true;
  bool follows_prediction = true;  // a point or ray was predicted, not just the old place
  TrackLoss why = TrackLoss::kFlow;

  void drop(TrackLoss reason) {
    if (!alive) return;
    alive = false;
    why = reason;
  }
};

CameraTracker::CameraTracker(const RigCamera& camera, const TrackingOptions& options, int index)
    : camera_(camera),
      options_(options),
      index_(index),
      detector_(options.detection, camera.camera.width(), camera.camera.height()),
      contrast_(options.contrast),
      static_mask_(validityMask(camera.camera)) {}

void CameraTracker::setMask(const cv::Mat& mask) {
  PARKADE_CHECK(mask.type() == CV_8UC1 && mask.size() == static_mask_.size(),
                "mask of {} x {}, type {}", mask.cols, mask.rows, mask.type());
  static_mask_ = validityMask(camera_.camera) & (mask != 0);
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
    predict(prior, flows);
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

void CameraTracker::predict(const MotionPrior& prior, std::vector<Flow>& flows) const {
  for (Flow& flow : flows) flow.predicted = flow.view.pixel;
  if (!motion_valid_) {
    for (Flow& flow : flows) flow.follows_prediction = false;
    return;
  }
  const SE3 T_cam_vehicle = camera_.T_vehicle_cam.inverse();
  const SE3 T_current_last =  // camera frames
      T_cam_vehicle * T_last_current_.inverse() * camera_.T_vehicle_cam;
  const SE3 T_cam_previous = T_cam_vehicle * prior.T_previous_current.inverse();
  struct Known {
    Eigen::Vector2d pixel;
    double inverse_depth;  // along the ray of the last picture
  };
  std::vector<Known> known;
  std::vector<std::uint8_t> has_point(flows.size(), 0);
  for (std::size_t i = 0; i < flows.size() && prior.translation_valid && translation_valid_; ++i) {
    const auto point = prior.p_previous.find(flows[i].view.id);
    if (point == prior.p_previous.end()) continue;
    const Eigen::Vector3d p_cam = T_cam_previous * point->second;
    Eigen::Vector2d pixel;
    if (!camera_.camera.project(p_cam, pixel)) continue;
    flows[i].predicted = pixel;
    has_point[i] = 1;
    const double depth = (T_current_last.inverse() * p_cam).norm();
    if (depth > 1e-3) known.push_back({flows[i].view.pixel, 1.0 / depth});
  }
  for (std::size_t i = 0; i < flows.size(); ++i) {
    if (has_point[i] != 0) continue;
    // Features of unknown depth are taken to be as far as their neighbours.
    double inverse_depth = 0.0;
    if (known.size() >= kNeighbours) {
      const auto distance = [&](const Known& k) {
        return (k.pixel - flows[i].view.pixel).squaredNorm();
      };
      std::array<std::size_t, kNeighbours> nearest{};
      std::array<double, kNeighbours> square;
      square.fill(1e12);
      for (std::size_t k = 0; k < known.size(); ++k) {
        double d = distance(known[k]);
        std::size_t id = k;
        for (std::size_t n = 0; n < kNeighbours; ++n) {
          if (d < square[n]) {
            std::swap(d, square[n]);
            std::swap(id, nearest[n]);
          }
        }
      }
      for (const std::size_t k : nearest) inverse_depth += known[k].inverse_depth / kNeighbours;
    }
    Eigen::Vector2d pixel;
    const Eigen::Vector3d p_cam = T_current_last.rotation() * flows[i].view.ray +
                                  inverse_depth * T_current_last.translation();
    if (camera_.camera.project(p_cam, pixel)) flows[i].predicted = pixel;
  }
}

void CameraTracker::flowForward(std::vector<Flow>& flows) const {
  std::vector<cv::Point2f> from(flows.size());
  std::vector<cv::Point2f> to(flows.size());
  for (std::size_t i = 0; i < flows.size(); ++i) {
    from[i] = toPoint(flows[i].view.pixel);
    to[i] = toPoint(flows[i].predicted);
  }
  std::vector<std::uint8_t> status;
  const FlowOptions& o = options_.flow;
  cv::calcOpticalFlowPyrLK(
      last_pyramid_, pyramid_, from, to, status, cv::noArray(), cv::Size(o.window_px, o.window_px),
      o.levels,
      cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, o.iterations, o.epsilon_px),
      cv::OPTFLOW_USE_INITIAL_FLOW, 1e-5);
  for (std::size_t i = 0; i < flows.size(); ++i) {
    flows[i].found = to[i];
    if (status[i] == 0 || !isFinite(to[i]) ||
        !camera_.camera.inImage({to[i].x, to[i].y}, kBorderPx)) {
      flows[i].drop(TrackLoss::kFlow);
    }
  }
}

void CameraTracker::flowBackward(std::vector<Flow>& flows) const {
  std::vector<std::size_t> index;
  std::vector<cv::Point2f> from;
  std::vector<cv::Point2f> to;
  for (std::size_t i = 0; i < flows.size(); ++i) {
    if (!flows[i].alive) continue;
    index.push_back(i);
    from.push_back(flows[i].found);
    to.push_back(toPoint(flows[i].view.pixel));
  }
  if (index.empty()) return;
  std::vector<std::uint8_t> status;
  const FlowOptions& o = options_.flow;
  cv::calcOpticalFlowPyrLK(
      pyramid_, last_pyramid_, from, to, status, cv::noArray(), cv::Size(o.window_px, o.window_px),
      std::min(o.levels, kBackwardLevels),
      cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, o.iterations, o.epsilon_px),
      cv::OPTFLOW_USE_INITIAL_FLOW, 1e-5);
  for (std::size_t k = 0; k < index.size(); ++k) {
    Flow& flow = flows[index[k]];
    const Eigen::Vector2d back(to[k].x, to[k].y);
    if (status[k] == 0 || !((back - flow.view.pixel).norm() < o.max_backward_px)) {
      flow.drop(TrackLoss::kBackward);
    }
  }
}

void CameraTracker::retry(std::vector<Flow>& flows) const {
  // What failed gets a second try from where its companions went: the depth guess may be wrong.
  std::vector<double> error_x;
  std::vector<double> error_y;
  for (const Flow& flow : flows) {
    if (!flow.alive) continue;
    error_x.push_back(flow.found.x - flow.predicted.x());
    error_y.push_back(flow.found.y - flow.predicted.y());
  }
  if (error_x.size() < 8 || error_x.size() == flows.size()) return;
  const Eigen::Vector2d error(median(error_x), median(error_y));
  if (error.norm() < kPredictionErrorPx) return;
  std::vector<Flow> again;
  std::vector<std::size_t> index;
  for (std::size_t i = 0; i < flows.size(); ++i) {
    if (flows[i].alive) continue;
    again.push_back(flows[i]);
    again.back().alive = true;
    again.back().predicted += error;
    index.push_back(i);
  }
  flowForward(again);
  flowBackward(again);
  for (std::size_t k = 0; k < index.size(); ++k) {
    if (again[k].alive) flows[index[k]] = again[k];
  }
}

void CameraTracker::align(std::vector<Flow>& flows) {
  const cv::Mat& image = pyramid_[0];
  const FlowOptions& o = options_.flow;
  for (Flow& flow : flows) {
    if (!flow.alive) continue;
    FeatureView& view = flow.view;
    const Eigen::Vector2d flowed(flow.found.x, flow.found.y);
    if (masked(flowed)) {
      flow.drop(TrackLoss::kMask);
      continue;
    }
    view.pixel = flowed;
    if (!o.refine) {
      view.sigma_px = o.sigma_floor_px;
      continue;
    }
    const PatchAlignment found = view.patch->align(image, flowed, view.warp, o.affine_sigma);
    const bool aligned = found.converged && found.correlation > o.min_correlation &&
                         (found.pixel - flowed).norm() < o.max_refine_px;
    if (aligned) {
      view.pixel = found.pixel;
      view.warp = found.warp;
    }
    if (!aligned || stretchOf(found.warp) > o.max_scale) {
      // The first picture no longer explains this one, but the flow from the last frame does: take
      // a new patch and say so in the uncertainty. A feature that needs one again at once is lost.
      view.patch = aligned || view.patch_age > 2 ? Patch::sample(image, view.pixel) : nullptr;
      if (view.patch == nullptr) {
        flow.drop(TrackLoss::kPatch);
        continue;
      }
      view.patch_age = 0;
      view.warp.setIdentity();
      ++view.renewals;
      ++renewed;
    }
    const double variance = o.sigma_floor_px * o.sigma_floor_px +
                            (aligned ? found.sigma_px * found.sigma_px : 0.0) +
                            view.renewals * kRenewalSigmaPx * kRenewalSigmaPx;
    view.sigma_px = std::sqrt(variance);
  }
}

void CameraTracker::judge(std::vector<Flow>& flows, std::uint64_t seed) {
  std::vector<std::size_t> index;
  std::vector<Eigen::Vector3d> before;
  std::vector<Eigen::Vector3d> after;
  for (std::size_t i = 0; i < flows.size(); ++i) {
    FeatureView& view = flows[i].view;
    if (!flows[i].alive) continue;
    const Eigen::Vector3d ray_before = view.ray;
    if (!camera_.camera.inImage(view.pixel, kBorderPx) ||
        !camera_.camera.unproject(view.pixel, view.ray)) {
      flows[i].drop(TrackLoss::kFlow);
      continue;
    }
    index.push_back(i);
    before.push_back(ray_before);
    after.push_back(view.ray);
  }
  CameraMotion motion;
  const SE3 T_current_last =
      camera_.T_vehicle_cam.inverse() * T_last_current_.inverse() * camera_.T_vehicle_cam;
  motion.rotation_valid = motion_valid_;
  motion.translation_valid = motion_valid_ && translation_valid_;
  motion.R_current_previous = T_current_last.rotation();
  motion.t_current_previous = T_current_last.translation();
  const MotionConsensus consensus =
      findConsensus(before, after, motion, camera_.camera.focalLength(), options_.outliers, seed);
  motion_rms_px = consensus.rms_px;
  for (std::size_t k = 0; k < index.size(); ++k) {
    if (consensus.inlier[k] == 0) flows[index[k]].drop(TrackLoss::kMotion);
  }
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
  if (masked(view.pixel) || !camera_.camera.inImage(view.pixel, kBorderPx) ||
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
