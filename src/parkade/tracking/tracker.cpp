// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/tracking/tracker.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "parkade/core/check.hpp"
#include "parkade/core/random.hpp"
#include "parkade/tracking/camera_tracker.hpp"
#include "parkade/tracking/epipolar_search.hpp"
#include "parkade/tracking/overlap.hpp"
#include "parkade/tracking/row_motion.hpp"

namespace parkade {

const char* toString(TrackLoss loss) {
  switch (loss) {
    case TrackLoss::kFlow:
      return "flow";
    case TrackLoss::kBackward:
      return "backward";
    case TrackLoss::kPatch:
      return "patch";
    case TrackLoss::kMotion:
      return "motion";
    case TrackLoss::kEpipolar:
      return "epipolar";
    case TrackLoss::kMask:
      return "mask";
  }
  return "?";
}

class Tracker::Impl {
 public:
  Impl(const Rig& rig, const TrackingOptions& options);
  TrackSet track(const FrameSet& frames, const MotionPrior& prior);

  std::vector<CameraTracker> cameras;
  ParallelFor parallel;
  TrackingReport report;

 private:
  // A camera pair that overlaps: features of `from` are looked for in `to`.
  struct Pair {
    int from;
    int to;
    SE3 T_to_from;
  };
  // A search, and what came of it.
  struct Search {
    const Pair* pair;
    std::uint64_t id;
    std::optional<CrossMatch> match;
  };

  void forEach(int count, const std::function<void(int)>& body) const;
  void checkShared(const RowMotion& motion);
  void match(bool only_new, const MotionPrior& prior, const RowMotion& motion);
  [[nodiscard]] RowPair rowsOf(const Pair& pair, const Eigen::Vector2d& pixel_from,
                               const RowMotion& motion) const {
    return {camera(pair.from).camera(), camera(pair.to).camera(), pair.T_to_from, pixel_from.y(),
            motion};
  }
  [[nodiscard]] std::vector<Search> planSearches(bool only_new, const MotionPrior& prior) const;
  void commit(const std::vector<Search>& searches);
  void detect();
  CameraTracker& camera(int index) { return cameras[static_cast<std::size_t>(index)]; }
  const CameraTracker& camera(int index) const { return cameras[static_cast<std::size_t>(index)]; }

  TrackingOptions options_;
  std::vector<Pair> pairs_;
  std::uint64_t next_id_ = 1;
  std::uint64_t first_new_id_ = 1;  // features of this frame set start here
  std::uint64_t frame_ = 0;
};

Tracker::Impl::Impl(const Rig& rig, const TrackingOptions& options) : options_(options) {
  PARKADE_CHECK(!rig.cameras.empty(), "rig '{}' has no cameras", rig.name);
  for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
    cameras.emplace_back(rig.cameras[c], options, static_cast<int>(c));
  }
  if (!options.matching.enabled) return;
  const std::vector<std::vector<double>> overlap = computeOverlap(rig);
  for (std::size_t a = 0; a < rig.cameras.size(); ++a) {
    for (std::size_t b = 0; b < rig.cameras.size(); ++b) {
      if (a == b || overlap[a][b] < options.matching.min_overlap) continue;
      pairs_.push_back({static_cast<int>(a), static_cast<int>(b),
                        rig.cameras[b].T_vehicle_cam.inverse() * rig.cameras[a].T_vehicle_cam});
    }
  }
}

void Tracker::Impl::forEach(int count, const std::function<void(int)>& body) const {
  if (parallel && count > 1) {
    parallel(count, body);
  } else {
    for (int i = 0; i < count; ++i) body(i);
  }
}

TrackSet Tracker::Impl::track(const FrameSet& frames, const MotionPrior& prior) {
  const std::vector<cv::Mat>& pictures = frames.gray.empty() ? frames.images : frames.gray;
  PARKADE_CHECK(pictures.size() == cameras.size(), "{} images for {} cameras", pictures.size(),
                cameras.size());
  report = {};
  first_new_id_ = next_id_;
  const int count = static_cast<int>(cameras.size());
  for (std::size_t c = 0; c < std::min(cameras.size(), prior.readout_times.size()); ++c) {
    cameras[c].setReadoutTime(prior.readout_times[c]);
  }
  // 1. Every camera for itself.
  forEach(count, [&](int c) {
    camera(c).track(pictures[static_cast<std::size_t>(c)], frames.t_ns, prior,
                    hash64(frame_, static_cast<std::uint64_t>(c)));
  });
  // 2. Between cameras: old features first, so that they fill cells that need no new corner then.
  const RowMotion motion(prior, frames.t_ns);
  checkShared(motion);
  match(false, prior, motion);
  detect();
  match(true, prior, motion);
  // 3. What goes to the estimator.
  TrackSet tracks;
  tracks.t_ns = frames.t_ns;
  for (int c = 0; c < count; ++c) {
    const CameraTracker& tracker = camera(c);
    tracks.camera_ok.push_back(tracker.ok() ? 1 : 0);
    report.motion_rms_px.push_back(tracker.motion_rms_px);
    report.renewed += tracker.renewed;
    report.lost.insert(report.lost.end(), tracker.lost.begin(), tracker.lost.end());
    if (!tracker.ok()) continue;
    for (const FeatureView& view : tracker.views()) {
      tracks.observations.push_back({view.id, c, view.pixel, view.age, view.sigma_px});
    }
  }
  ++frame_;
  return tracks;
}

void Tracker::Impl::checkShared(const RowMotion& motion) {
  for (const Pair& pair : pairs_) {
    if (!camera(pair.from).ok() || !camera(pair.to).ok()) continue;
    // Most pairs stand both ways round: once is enough.
    const auto mirrored = [&](const Pair& other) {
      return other.from == pair.to && other.to == pair.from;
    };
    if (pair.from > pair.to && std::any_of(pairs_.begin(), pairs_.end(), mirrored)) continue;
    const double focal = camera(pair.to).camera().camera.focalLength();
    std::vector<std::pair<std::uint64_t, Eigen::Vector2d>> wrong;
    for (const FeatureView& view : camera(pair.to).views()) {
      const FeatureView* other = camera(pair.from).find(view.id);
      if (other == nullptr) continue;
      const SE3 T_to_from = rowsOf(pair, other->pixel, motion).at(view.pixel.y());
      const EpipolarCheck check = checkEpipolar(other->ray, view.ray, T_to_from, focal);
      if (check.distance_px > 1.5 * options_.matching.max_epipolar_px) {
        wrong.emplace_back(view.id, view.pixel);
      }
    }
    for (const auto& [id, pixel] : wrong) {
      // Which of the two crept away is unknown; the one followed for longer is trusted.
      const bool keep_from = camera(pair.from).find(id)->age >= camera(pair.to).find(id)->age;
      const int loser = keep_from ? pair.to : pair.from;
      report.lost.push_back({loser, id, camera(loser).find(id)->pixel, TrackLoss::kEpipolar});
      camera(loser).remove(id);
    }
  }
}

std::vector<Tracker::Impl::Search> Tracker::Impl::planSearches(bool only_new,
                                                               const MotionPrior& prior) const {
  std::vector<Search> searches;
  const auto period = static_cast<std::uint64_t>(options_.matching.retry_frames);
  for (const Pair& pair : pairs_) {
    if (!camera(pair.from).ok() || !camera(pair.to).ok()) continue;
    for (const FeatureView& view : camera(pair.from).views()) {
      const bool is_new = view.id >= first_new_id_;
      if (is_new != only_new) continue;
      if (!is_new && (frame_ + view.id) % period != 0) continue;
      // A feature that several tries did not find waits until its depth is known: the search along
      // the whole curve costs most where there is nothing to be found.
      constexpr int kBlindTries = 3;
      if (view.age > kBlindTries * options_.matching.retry_frames &&
          !(prior.translation_valid && prior.p_previous.contains(view.id))) {
        continue;
      }
      if (camera(pair.to).find(view.id) != nullptr) continue;
      searches.push_back({&pair, view.id, std::nullopt});
    }
  }
  return searches;
}

void Tracker::Impl::match(bool only_new, const MotionPrior& prior, const RowMotion& motion) {
  if (pairs_.empty()) return;
  std::vector<Search> searches = planSearches(only_new, prior);
  std::vector<std::optional<SearchImage>> images(cameras.size());
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    if (cameras[c].ok()) images[c] = cameras[c].searchImage();
  }
  constexpr int kBlock = 8;  // searches per piece of work
  const int blocks = (static_cast<int>(searches.size()) + kBlock - 1) / kBlock;
  forEach(blocks, [&](int block) {
    const std::size_t end = std::min(searches.size(), static_cast<std::size_t>(block + 1) * kBlock);
    for (std::size_t i = static_cast<std::size_t>(block) * kBlock; i < end; ++i) {
      Search& search = searches[i];
      const FeatureView& view = *camera(search.pair->from).find(search.id);
      double depth = 0.0;
      if (const auto point = prior.p_previous.find(search.id);
          prior.translation_valid && point != prior.p_previous.end()) {
        const SE3 T_cam_previous = camera(search.pair->from).camera().T_vehicle_cam.inverse() *
                                   prior.T_previous_current.inverse();
        depth = (T_cam_previous * point->second).norm();
      }
      search.match = searchEpipolar(*images[static_cast<std::size_t>(search.pair->from)],
                                    *images[static_cast<std::size_t>(search.pair->to)],
                                    rowsOf(*search.pair, view.pixel, motion), view.pixel, view.warp,
                                    *view.patch, depth, options_.matching);
    }
  });
  commit(searches);
}

void Tracker::Impl::commit(const std::vector<Search>& searches) {
  constexpr double kSamePx = 3.0;     // two features nearer than this are one corner
  constexpr double kMostShare = 1.3;  // of the features aimed at, with those matched from others
  const auto most = static_cast<std::size_t>(kMostShare * options_.detection.features);
  for (const Search& search : searches) {
    if (!search.match) continue;
    const FeatureView* view = camera(search.pair->from).find(search.id);
    CameraTracker& target = camera(search.pair->to);
    if (target.views().size() >= most) continue;
    // An earlier match may have taken the feature's place or given it a view there.
    if (view == nullptr || target.find(search.id) != nullptr) continue;
    const double reach = std::max(kSamePx, 0.5 * options_.detection.min_distance_px);
    if (const FeatureView* there = target.nearest(search.match->alignment.pixel, reach)) {
      // The same corner was found in both cameras on its own: the younger name yields, but only
      // while no estimator has seen it.
      if (there->id < first_new_id_ || there->id < search.id) continue;
      const std::uint64_t other = there->id;
      for (CameraTracker& each : cameras) each.remove(other);
    }
    const std::shared_ptr<const Patch> patch = view->patch;
    if (!target.addMatch(search.id, search.match->alignment, patch)) continue;
    report.matched.push_back(
        {search.id, search.pair->from, search.pair->to, search.match->inverse_depth});
  }
}

void Tracker::Impl::detect() {
  // Features wander, so that some cells hold several: fill the empty ones with the best corners
  // only as far as the number aimed at.
  const auto roomOf = [&](int c) {
    return static_cast<std::size_t>(
        std::max(0, options_.detection.features - static_cast<int>(camera(c).views().size())));
  };
  std::vector<std::vector<Corner>> corners(cameras.size());
  forEach(static_cast<int>(cameras.size()), [&](int c) {
    if (roomOf(c) > 0) corners[static_cast<std::size_t>(c)] = camera(c).detect();
  });
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    const std::size_t room = roomOf(static_cast<int>(c));
    std::stable_sort(corners[c].begin(), corners[c].end(),
                     [](const Corner& x, const Corner& y) { return x.gradient > y.gradient; });
    if (corners[c].size() > room) corners[c].resize(room);
    for (const Corner& corner : corners[c]) {
      if (!cameras[c].add(next_id_, corner.pixel)) continue;
      ++next_id_;
      ++report.detected;
    }
  }
}

Tracker::Tracker(const Rig& rig, const TrackingOptions& options)
    : impl_(std::make_unique<Impl>(rig, options)) {}
Tracker::~Tracker() = default;
Tracker::Tracker(Tracker&&) noexcept = default;
Tracker& Tracker::operator=(Tracker&&) noexcept = default;

TrackSet Tracker::track(const FrameSet& frames, const MotionPrior& prior) {
  return impl_->track(frames, prior);
}

void Tracker::setMask(int camera, const cv::Mat& mask) {
  impl_->cameras.at(static_cast<std::size_t>(camera)).setMask(mask);
}

void Tracker::setDynamicMask(int camera, const cv::Mat& mask) {
  impl_->cameras.at(static_cast<std::size_t>(camera)).setDynamicMask(mask);
}

void Tracker::setParallel(ParallelFor parallel) {
  impl_->parallel = std::move(parallel);
}

const TrackingReport& Tracker::report() const {
  return impl_->report;
}

}  // namespace parkade
