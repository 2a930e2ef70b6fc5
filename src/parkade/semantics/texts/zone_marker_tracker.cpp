// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/texts/zone_marker_tracker.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "parkade/core/check.hpp"
#include "parkade/core/nearest_first.hpp"

namespace parkade {
namespace {

constexpr double kMarkerGate = 16.27;  // 99.9 % of chi-square, 3 degrees

using Jacobian = Eigen::Matrix<double, 3, 4>;

/// What a view says of a marker at a place, in units of its sigmas: equation (5).
struct Residual {
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
  Jacobian d_value_d_state = Jacobian::Zero();
  bool valid = false;
};

Residual residualOf(const ZoneMarkerView& view, const Eigen::Vector4d& state, double place_sigma) {
  Residual result;
  const Eigen::Vector3d d = state.head<3>() - view.eye;
  const double range = d.norm();
  const double ground = d.head<2>().norm();
  constexpr double kLeast = 0.3;  // m
  if (ground < kLeast || d.dot(view.ray) <= 0.0) return result;
  result.valid = true;
  const Eigen::Vector3d u = d / range;
  Eigen::Matrix<double, 2, 3> across;  // axes across the ray
  across.row(0) = view.ray.cross(Eigen::Vector3d::UnitZ()).normalized();
  across.row(1) = across.row(0).transpose().cross(view.ray);
  const double sigma = std::hypot(view.sigma, place_sigma / range);
  const Eigen::Matrix3d d_u_d_p = (Eigen::Matrix3d::Identity() - u * u.transpose()) / range;
  result.value.head<2>() = across * u / sigma;
  result.d_value_d_state.topLeftCorner<2, 3>() = across * d_u_d_p / sigma;
  // The apparent height; how the pillar stands changes it by some per cent.
  constexpr double kShape = 0.06;
  const double ratio = state[3] / ground;
  const double height_sigma = std::hypot(view.height_sigma, kShape * view.height_ratio);
  result.value[2] = (ratio - view.height_ratio) / height_sigma;
  result.d_value_d_state(2, 3) = 1.0 / ground / height_sigma;
  result.d_value_d_state.block<1, 2>(2, 0) =
      -ratio / (ground * ground) * d.head<2>().transpose() / height_sigma;
  return result;
}

struct Solution {
  Eigen::Vector4d state = Eigen::Vector4d::Zero();
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Identity();
};

// Gauss-Newton with Huber's weights over views [begin, end); the height has a prior.
template <class Iterator>
Solution solve(Iterator begin, Iterator end, Eigen::Vector4d state,
               const ZoneMarkerTrackerOptions& options) {
  constexpr double kHuber = 2.0;
  constexpr int kIterations = 12;
  const double prior = 1.0 / (options.height_sigma_m * options.height_sigma_m);
  Eigen::Matrix4d H;
  double cost = 0.0;
  int count = 0;
  for (int i = 0; i < kIterations; ++i) {
    H.setZero();
    Eigen::Vector4d b = Eigen::Vector4d::Zero();
    H(3, 3) = prior;
    b[3] = prior * (state[3] - options.height_m);
    cost = 0.0;
    count = 0;
    for (Iterator it = begin; it != end; ++it) {
      const Residual r = residualOf(*it, state, options.place_sigma_m);
      if (!r.valid) continue;
      const double norm = r.value.norm();
      const double weight = norm > kHuber ? kHuber / norm : 1.0;
      H += weight * r.d_value_d_state.transpose() * r.d_value_d_state;
      b += weight * r.d_value_d_state.transpose() * r.value;
      cost += weight * norm * norm;
      ++count;
    }
    const Eigen::Matrix4d damped = H + 1e-6 * Eigen::Matrix4d::Identity();
    Eigen::Vector4d step = -damped.ldlt().solve(b);
    constexpr double kLongest = 3.0;  // m
    if (step.norm() > kLongest) step *= kLongest / step.norm();
    state += step;
    state[3] = std::max(state[3], 0.05);
    if (step.norm() < 1e-6) break;
  }
  Solution solution;
  solution.state = state;
  // Where views disagree more than their sigmas say, the place is known less well.
  const double excess = count > 2 ? std::max(1.0, cost / (3.0 * count - 4.0)) : 1.0;
  solution.covariance =
      excess * (H + 1e-6 * Eigen::Matrix4d::Identity()).ldlt().solve(Eigen::Matrix4d::Identity());
  return solution;
}

ZoneMarker markerOf(std::uint64_t id, const Solution& solution, const TextReading& best,
                    std::size_t views) {
  ZoneMarker marker;
  marker.id = id;
  marker.position = solution.state.head<3>();
  marker.covariance = solution.covariance.topLeftCorner<3, 3>();
  marker.text = best.text;
  marker.confidence = best.probability;
  marker.views = static_cast<int>(views);
  return marker;
}

}  // namespace

// Pillars are alike but for their texts.
bool ZoneMarkerTracker::contradicts(const Track& track, const ZoneMarkerView& view) {
  return std::any_of(view.readings.begin(), view.readings.end(),
                     [&](const auto& readings) { return track.text.contradicts(readings); });
}

double ZoneMarkerTracker::misfit(const Track& track, const ZoneMarkerView& view) const {
  const Residual r = residualOf(view, track.state, options_.place_sigma_m);
  if (!r.valid) return kMarkerGate;
  const Eigen::Matrix3d S = Eigen::Matrix3d::Identity() +
                            r.d_value_d_state * track.covariance * r.d_value_d_state.transpose();
  return r.value.dot(S.llt().solve(r.value));
}

void ZoneMarkerTracker::extend(Track& track, const ZoneMarkerView& view, TimeNs t_ns) const {
  track.views.push_back(view);
  ++track.seen;
  // As many as it takes to be told, however few are to be kept.
  if (track.views.size() >
      static_cast<std::size_t>(std::max(options_.max_views, options_.told_views))) {
    track.views.pop_front();
    if (track.told > 0) --track.told;
  }
  for (const auto& readings : view.readings) track.text.add(readings);
  const Solution solution = solve(track.views.begin(), track.views.end(), track.state, options_);
  track.state = solution.state;
  track.covariance = solution.covariance;
  track.seen_ns = t_ns;
}

void ZoneMarkerTracker::start(const ZoneMarkerView& view, TimeNs t_ns) {
  Track track;
  track.id = next_id_++;
  const double ground = options_.height_m / std::max(1e-3, view.height_ratio);
  track.state << view.eye + view.ray * (ground / std::max(0.1, view.ray.head<2>().norm())),
      options_.height_m;
  extend(track, view, t_ns);
  tracks_.push_back(std::move(track));
}

void ZoneMarkerTracker::add(const std::vector<ZoneMarkerView>& views, TimeNs t_ns) {
  PARKADE_CHECK(t_ns >= last_ns_, "a view of {} ns after one of {} ns", t_ns, last_ns_);
  last_ns_ = t_ns;
  std::vector<TrackPair> pairs;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    for (std::size_t j = 0; j < views.size(); ++j) {
      const double value = misfit(tracks_[i], views[j]);
      if (value >= kMarkerGate || contradicts(tracks_[i], views[j])) continue;
      pairs.push_back({value, i, j});
    }
  }
  const auto matches = matchNearestFirst(std::move(pairs), tracks_.size(), views.size());
  for (std::size_t j = 0; j < views.size(); ++j) {
    if (matches[j]) extend(tracks_[*matches[j]], views[j], t_ns);
  }
  for (std::size_t j = 0; j < views.size(); ++j) {
    if (!matches[j] && views[j].whole && views[j].height_ratio > 0.0) start(views[j], t_ns);
  }
  std::erase_if(tracks_, [&](const Track& track) {
    if (toSeconds(t_ns - track.seen_ns) <= options_.forget_s) return false;
    constexpr double kSure = 0.95;
    const TextReading text = track.text.best();
    if (track.told > 0 && text.probability > kSure) format_.add(text.text);
    return true;
  });
}

bool ZoneMarkerTracker::needsNoReading(const ZoneMarkerView& view) const {
  constexpr double kSure = 0.99;
  constexpr double kSupport = 12.0;  // about three sure readings
  constexpr std::size_t kEach = 3;
  const Track* only = nullptr;
  for (const Track& track : tracks_) {
    if (misfit(track, view) >= kMarkerGate) continue;
    if (only != nullptr) return false;
    only = &track;
  }
  if (only == nullptr || only->seen % kEach == 0) return false;
  const TextReading text = only->text.best();
  return text.probability > kSure && only->text.support(text.text) > kSupport;
}

std::vector<ZoneMarker> ZoneMarkerTracker::takeTold() {
  std::vector<ZoneMarker> told;
  for (Track& track : tracks_) {
    const std::size_t fresh = track.views.size() - track.told;
    if (fresh < static_cast<std::size_t>(options_.told_views)) continue;
    if (track.text.best().probability < options_.told_confidence) continue;
    const auto begin = track.views.begin() + static_cast<std::ptrdiff_t>(track.told);
    const Solution solution = solve(begin, track.views.end(), track.state, options_);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> spread(
        solution.covariance.topLeftCorner<2, 2>(), Eigen::EigenvaluesOnly);
    if (std::sqrt(spread.eigenvalues()[1]) > options_.told_sigma_m) continue;
    told.push_back(markerOf(track.id, solution, track.text.best(format_), fresh));
    track.told = track.views.size();
  }
  return told;
}

std::vector<ZoneMarker> ZoneMarkerTracker::followed() const {
  std::vector<ZoneMarker> all;
  for (const Track& track : tracks_) {
    all.push_back(markerOf(track.id, {track.state, track.covariance}, track.text.best(format_),
                           track.views.size()));
  }
  return all;
}

}  // namespace parkade
