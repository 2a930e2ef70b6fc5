// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>

#include "parkade/core/median.hpp"
#include "parkade/core/units.hpp"
#include "parkade/vio/estimator_impl.hpp"

namespace parkade {
namespace {

// Longer readings are not summed up again at every frame: the frame between goes into the prior.
constexpr double kMaxSummed = 1.0;  // s

}  // namespace

const WindowFrame* VioEstimator::Impl::keyframeBefore(std::size_t index) const {
  while (index > 0 && !window_.frames[index - 1].keyframe) --index;
  return index > 0 ? &window_.frames[index - 1] : nullptr;
}

std::vector<const WindowFrame*> VioEstimator::Impl::keyframesBefore(std::size_t index) const {
  std::vector<const WindowFrame*> keyframes(window_.cameras.size(), nullptr);
  for (std::size_t c = 0; c < keyframes.size(); ++c) {
    const std::uint64_t camera = std::uint64_t{1} << (c & 63);
    if ((window_.frames[index].cameras & camera) == 0) continue;
    for (std::size_t k = index; k > 0 && keyframes[c] == nullptr; --k) {
      const WindowFrame& before = window_.frames[k - 1];
      if (before.keyframe && (before.cameras & camera) != 0) keyframes[c] = &before;
    }
  }
  return keyframes;
}

VioEstimator::Impl::Overlap VioEstimator::Impl::overlapOf(
    std::size_t index, const std::vector<const WindowFrame*>& keyframes) const {
  const WindowFrame& frame = window_.frames[index];
  const WindowFrame& next = window_.frames[index + 1];
  // A camera that gives every frame set is missed where it gives none, one that takes turns is not.
  const std::uint64_t expected =
      next.cameras == 0 ? ~std::uint64_t{0} : next.cameras | frame.steady_cameras;
  std::vector<SO3> turns(keyframes.size());
  for (std::size_t c = 0; c < keyframes.size(); ++c) {
    if (keyframes[c] == nullptr) continue;
    turns[c] = keyframes[c]->state.R_odom_imu.inverse() * frame.state.R_odom_imu;
  }
  Overlap overlap;
  for (const auto& [id, feature] : window_.features) {
    const WindowObservation* here = nullptr;
    const WindowObservation* there = nullptr;
    bool continued = false;
    for (const WindowObservation& o : feature.observations) {
      if (o.frame_id == next.id) continued = true;
      if (o.frame_id == frame.id && here == nullptr) here = &o;
    }
    if (here == nullptr) continue;
    const auto camera = static_cast<std::size_t>(here->camera);
    ++overlap.seen;
    if (continued || ((expected >> (camera & 63)) & 1U) != 0) ++overlap.expected;
    if (continued) ++overlap.continued;
    if (keyframes[camera] == nullptr) continue;
    for (const WindowObservation& o : feature.observations) {
      if (o.frame_id == keyframes[camera]->id && o.camera == here->camera) there = &o;
    }
    if (there == nullptr) continue;
    ++overlap.shared;
    const SO3& R_imu_cam = window_.cameras[camera].T_imu_cam.rotation();
    const Eigen::Vector3d ray = turns[camera] * (R_imu_cam * here->ray);
    overlap.parallax.push_back(std::acos(std::clamp(ray.dot(R_imu_cam * there->ray), -1.0, 1.0)));
  }
  return overlap;
}

// Whether the frame adds to what the keyframes before it see; decided when it leaves the recent
// frames, with the frame after it known.
bool VioEstimator::Impl::wantsKeyframe(std::size_t index) const {
  const WindowFrame& frame = window_.frames[index];
  const WindowFrame* last = keyframeBefore(index);
  if (last == nullptr) return true;
  if (frame.still_since >= 0 && frame.still_since != frame.id) return false;

  const std::vector<const WindowFrame*> keyframes = keyframesBefore(index);
  Overlap overlap = overlapOf(index, keyframes);
  if (overlap.seen == 0) return false;
  // The last good frame before darkness keeps what it saw.
  if (overlap.continued < 0.4 * overlap.expected) return true;
  if (overlap.shared == 0 || overlap.shared < options_.keyframe.min_overlap * overlap.seen) {
    return true;
  }
  if (median(std::move(overlap.parallax)) > options_.keyframe.parallax_deg * kDegree) return true;
  const WindowFrame* newest = nullptr;
  for (const WindowFrame* keyframe : keyframes) {
    if (keyframe == nullptr) continue;
    if (newest == nullptr || newest->id < keyframe->id) newest = keyframe;
  }
  const WindowFrame& keyframe = newest != nullptr ? *newest : *last;
  if ((frame.state.p_odom - keyframe.state.p_odom).norm() > options_.keyframe.distance_m) {
    return true;
  }
  if (angleBetween(frame.state.R_odom_imu, keyframe.state.R_odom_imu) >
      options_.keyframe.rotation_deg * kDegree) {
    return true;
  }
  return toSeconds(frame.t_ns - keyframe.t_ns) > options_.keyframe.max_interval_s;
}

void VioEstimator::Impl::removeFrame(std::size_t index) {
  WindowFrame& frame = window_.frames[index];
  const WindowFrame& before = window_.frames[index - 1];
  const WindowFrame& after = window_.frames[index + 1];
  const std::vector<int>& prior_ids = window_.prior.frame_ids;
  const bool in_prior = std::find(prior_ids.begin(), prior_ids.end(), frame.id) != prior_ids.end();
  const bool too_long = toSeconds(after.t_ns - before.t_ns) > kMaxSummed;
  if (in_prior || !frame.imu || !after.imu || too_long) {
    FrameConditional conditional =
        marginaliseFrame(window_, frame.id, {}, solveOptions(1).loss, solveOptions(1).still);
    history_.addMarginalised(std::move(conditional), window_);
    return;
  }
  // Relative to a frame that stays: one that waits for the end of a rest may be dropped later.
  const WindowFrame* lasting = keyframeBefore(index);
  history_.addDropped(frame, lasting != nullptr ? *lasting : window_.frames.front());
  const Preintegration sum =
      readings_.sumBetween(before.t_ns, after.t_ns, inertial_noise_.noise(), before.bias, gap_ns_);
  dropFrame(window_, frame.id, sum);
  window_.frames[index].imu_noise_factor = inertial_noise_.factor();
}

void VioEstimator::Impl::marginaliseOldestKeyframe() {
  const int id = window_.frames.front().id;
  const std::size_t recent =
      std::min(window_.frames.size() - 1, static_cast<std::size_t>(options_.window.recent_frames));
  const int first_recent = window_.frames[window_.frames.size() - recent].id;
  // Landmarks that no recent frame sees any more go into the prior with all they know; the others
  // stay and only lose their oldest view.
  std::vector<WindowFeature*> gone;
  for (auto& [feature_id, feature] : window_.features) {
    if (!feature.selected || !feature.has_point || feature.observations.size() < 2) continue;
    if (feature.observations.front().frame_id != id || feature.last_seen_id >= first_recent) {
      continue;
    }
    gone.push_back(&feature);
  }
  FrameConditional conditional =
      marginaliseFrame(window_, id, gone, solveOptions(1).loss, solveOptions(1).still);
  history_.addMarginalised(std::move(conditional), window_);
}

void VioEstimator::Impl::trimWindow() {
  const auto recent = static_cast<std::size_t>(options_.window.recent_frames);
  const TimeNs now = window_.frames.back().t_ns;
  // Rest is told by a whole stretch: until one has passed, a frame's rest may yet be taken back.
  const TimeNs doubtful = fromSeconds(options_.standstill.window_s);
  std::size_t held = 0;
  for (std::size_t index = 0; index + recent < window_.frames.size();) {
    WindowFrame& frame = window_.frames[index];
    const bool waits = !frame.keyframe && frame.still_since >= 0 && now - frame.t_ns <= doubtful;
    if (waits) ++held;
    if (!frame.keyframe && !waits) {
      if (!wantsKeyframe(index)) {
        removeFrame(index);
        continue;
      }
      frame.keyframe = true;
    }
    ++index;
  }
  while (window_.frames.size() >
         static_cast<std::size_t>(options_.window.keyframes) + recent + held) {
    marginaliseOldestKeyframe();
  }
}

}  // namespace parkade
