// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
// How a camera's features are followed from one picture into the next.
#include "parkade/tracking/camera_tracker_flow.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/video/tracking.hpp>

#include "parkade/core/median.hpp"
#include "parkade/tracking/row_motion.hpp"

namespace parkade {
namespace {

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

// What is predicted of a feature whose depth is known.
struct KnownDepth {
  Eigen::Vector2d pixel;  // in the last picture
  double inverse_depth;   // 1/m, along its ray there
};

// The mean of the nearest known features; 0 (far away) where there are too few.
double inverseDepthNear(const std::vector<KnownDepth>& known, const Eigen::Vector2d& pixel) {
  if (known.size() < kNeighbours) return 0.0;
  std::array<std::size_t, kNeighbours> nearest{};
  std::array<double, kNeighbours> square;
  square.fill(1e12);
  for (std::size_t k = 0; k < known.size(); ++k) {
    double d = (known[k].pixel - pixel).squaredNorm();
    std::size_t id = k;
    for (std::size_t n = 0; n < kNeighbours; ++n) {
      if (d < square[n]) {
        std::swap(d, square[n]);
        std::swap(id, nearest[n]);
      }
    }
  }
  double sum = 0.0;
  for (const std::size_t k : nearest) sum += known[k].inverse_depth / kNeighbours;
  return sum;
}

}  // namespace

void CameraTracker::predict(const MotionPrior& prior, TimeNs t_ns, std::vector<Flow>& flows) const {
  for (Flow& flow : flows) flow.predicted = flow.view.pixel;
  if (!motion_valid_) {
    for (Flow& flow : flows) flow.follows_prediction = false;
    return;
  }
  const SE3 T_cam_vehicle = camera_.T_vehicle_cam.inverse();
  const SE3 T_current_last =  // camera frames
      T_cam_vehicle * T_last_current_.inverse() * camera_.T_vehicle_cam;
  const SE3 T_cam_previous = T_cam_vehicle * prior.T_previous_current.inverse();
  const RowMotion rows(prior, t_ns);
  std::vector<KnownDepth> known;
  std::vector<std::uint8_t> has_point(flows.size(), 0);
  for (std::size_t i = 0; i < flows.size() && prior.translation_valid && translation_valid_; ++i) {
    const auto point = prior.p_previous.find(flows[i].view.id);
    if (point == prior.p_previous.end()) continue;
    const Eigen::Vector3d p_cam = T_cam_previous * point->second;
    Eigen::Vector2d pixel;
    if (!camera_.camera.project(p_cam, pixel)) continue;
    if (camera_.readout_time > 0.0) {  // where it is when its row is read
      const SE3 T_now_row = rows.vehicleAt(camera_.rowTime(pixel.y()));
      const SE3 T_cam_previous_then =
          T_cam_vehicle * (prior.T_previous_current * T_now_row).inverse();
      if (!camera_.camera.project(T_cam_previous_then * point->second, pixel)) continue;
    }
    flows[i].predicted = pixel;
    has_point[i] = 1;
    const double depth = (T_current_last.inverse() * p_cam).norm();
    if (depth > 1e-3) known.push_back({flows[i].view.pixel, 1.0 / depth});
  }
  for (std::size_t i = 0; i < flows.size(); ++i) {
    if (has_point[i] != 0) continue;
    // Features of unknown depth are taken to be as far as their neighbours.
    const double inverse_depth = inverseDepthNear(known, flows[i].view.pixel);
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
        !camera_.camera.inImage({to[i].x, to[i].y}, kTrackBorderPx)) {
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
    if (!camera_.camera.inImage(view.pixel, kTrackBorderPx) ||
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

}  // namespace parkade
