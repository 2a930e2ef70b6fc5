// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/vio/feature_manager.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "parkade/core/median.hpp"
#include "parkade/vio/reprojection.hpp"
#include "parkade/vio/window_solver.hpp"

namespace parkade {
namespace {

constexpr int kMaxFailures = 3;
constexpr double kLandmarkSigmaPx = 0.7;     // what the landmark's own uncertainty adds, about
constexpr double kGateSquared = 25.0;        // of one feature: 5 sigma
constexpr double kGatePx = 4.0;              // and at least this
constexpr double kCameraGateSquared = 12.0;  // of a camera's median feature: far outside chance
constexpr double kCameraGatePx = 2.0;
constexpr int kMinCameraFeatures = 6;
constexpr std::size_t kMinContradicting = 2;  // cameras, that a prediction may be wrong by
constexpr std::size_t kLeastInSight = 8;      // landmarks, as a part of the budget: an eighth
constexpr TimeNs kUnseenForLong = kNsPerSecond;
constexpr double kNoisePrior = 4.0;  // views' coordinates that the common noise counts for
constexpr double kLeastNoiseFactor = 0.7;
constexpr double kMostNoiseFactor = 10.0;
constexpr double kMinFreedom = 3.0;  // of a landmark that tells the common noise
constexpr std::size_t kMinTellers = 20;
constexpr int kCellColumns = 4;
constexpr int kCellRows = 3;

int cellOf(const VioCamera& camera, const WindowObservation& o) {
  const int column = std::clamp(
      static_cast<int>(o.pixel.x() * kCellColumns / camera.camera.width()), 0, kCellColumns - 1);
  const int row = std::clamp(static_cast<int>(o.pixel.y() * kCellRows / camera.camera.height()), 0,
                             kCellRows - 1);
  return (o.camera * kCellRows + row) * kCellColumns + column;
}

struct Innovation {
  std::uint64_t id;
  int camera;
  double squared;  // over its covariance
  double px;
};

// How far the newest frame's views of placed features lie from where its state predicts them.
std::vector<Innovation> innovationsOf(const Window& window,
                                      const Eigen::Matrix<double, 6, 6>& spread) {
  std::vector<Innovation> innovations;
  const WindowFrame& newest = window.frames.back();
  const PoseMatrices target(newest.state);
  for (const auto& [id, feature] : window.features) {
    if (!feature.has_point || feature.last_seen_id != newest.id) continue;
    const WindowFrame* anchor_frame = window.find(feature.anchor_frame_id);
    if (anchor_frame == nullptr || anchor_frame->id == newest.id) continue;
    const PoseMatrices anchor(anchor_frame->state);
    for (const WindowObservation& o : feature.observations) {
      if (o.frame_id != newest.id) continue;
      Eigen::Vector2d pixel;
      ReprojectionJacobians j;
      Innovation innovation{id, o.camera, 1e6, 1e3};
      const VioCamera& camera = window.cameras[static_cast<std::size_t>(o.camera)];
      if (reproject(window.cameras[static_cast<std::size_t>(feature.anchor_camera)], camera,
                    cameraPlace(camera, newest, o), anchor, target, anchor, target,
                    feature.direction, feature.inverse_distance, pixel, &j)) {
        const Eigen::Vector2d error = pixel - observedPixel(window, o);
        const double noise = o.sigma_px * o.sigma_px + kLandmarkSigmaPx * kLandmarkSigmaPx;
        const Eigen::Matrix2d S = j.d_px_d_target * spread * j.d_px_d_target.transpose() +
                                  noise * Eigen::Matrix2d::Identity();
        innovation.squared = error.dot(S.ldlt().solve(error));
        innovation.px = error.norm();
      }
      innovations.push_back(innovation);
    }
  }
  return innovations;
}

struct JudgedCameras {
  std::size_t count = 0;  // with enough features to judge by
  std::vector<int> bad;   // most of whose features miss
};

JudgedCameras judgeCameras(const std::vector<Innovation>& innovations, std::size_t cameras) {
  std::vector<std::vector<double>> squared(cameras);
  std::vector<std::vector<double>> px(cameras);
  for (const Innovation& innovation : innovations) {
    squared[static_cast<std::size_t>(innovation.camera)].push_back(innovation.squared);
    px[static_cast<std::size_t>(innovation.camera)].push_back(innovation.px);
  }
  JudgedCameras judged;
  for (std::size_t c = 0; c < cameras; ++c) {
    if (static_cast<int>(squared[c].size()) < kMinCameraFeatures) continue;
    ++judged.count;
    if (median(squared[c]) > kCameraGateSquared && median(px[c]) > kCameraGatePx) {
      judged.bad.push_back(static_cast<int>(c));
    }
  }
  return judged;
}

// Landmarks out of sight hold their places until their keyframes leave, which takes long after
// darkness. Where next to none is in sight, those unseen for longest give theirs away.
void makeRoom(const Window& window, std::size_t budget, std::size_t candidates,
              std::vector<WindowFeature*>& chosen) {
  const WindowFrame& newest = window.frames.back();
  const auto in_sight = static_cast<std::size_t>(std::count_if(
      chosen.begin(), chosen.end(),
      [&](const WindowFeature* feature) { return feature->last_seen_id == newest.id; }));
  const std::size_t room = budget - std::min(budget, chosen.size());
  if (in_sight + room >= budget / kLeastInSight) return;
  const std::size_t wanted = std::min(candidates, budget / 2 - in_sight);
  if (wanted <= room) return;
  std::vector<std::pair<TimeNs, WindowFeature*>> unseen;
  for (WindowFeature* feature : chosen) {
    const WindowFrame* last = window.find(feature->observations.back().frame_id);
    const TimeNs seen = last != nullptr ? last->t_ns : 0;
    if (newest.t_ns - seen > kUnseenForLong) unseen.emplace_back(seen, feature);
  }
  std::stable_sort(unseen.begin(), unseen.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  unseen.resize(std::min(unseen.size(), wanted - room));
  for (const auto& [seen, feature] : unseen) feature->selected = false;
  std::erase_if(chosen, [](const WindowFeature* feature) { return !feature->selected; });
}

// What a landmark's views miss it by.
struct Missed {
  WindowFeature* feature;
  double squares;  // whitened
  double freedom;  // coordinates of its views, less its own
};

// Some tracks are worse than others in all their views: an edge that slides, a shadow's border. The
// variance of each landmark's views is that of the middle one's, joined with what its own tell.
void setNoiseFactors(const std::vector<Missed>& missed) {
  std::vector<double> variances;
  for (const Missed& m : missed) {
    if (m.freedom >= kMinFreedom) variances.push_back(m.squares / m.freedom);
  }
  if (variances.size() < kMinTellers) return;
  const double common = median(std::move(variances));
  if (!(common > 0.0)) return;
  for (const Missed& m : missed) {
    const double variance = (kNoisePrior + m.squares / common) / (kNoisePrior + m.freedom);
    m.feature->noise_factor = std::clamp(std::sqrt(variance), kLeastNoiseFactor, kMostNoiseFactor);
  }
}

}  // namespace

Observations FeatureManager::observationsOf(const std::vector<VioCamera>& cameras,
                                            const TrackSet& tracks, int frame_id) {
  Observations result;
  result.reserve(tracks.observations.size());
  for (const TrackObservation& track : tracks.observations) {
    if (track.camera < 0 || track.camera >= static_cast<int>(cameras.size())) continue;
    const auto camera = static_cast<std::size_t>(track.camera);
    if (camera < tracks.camera_ok.size() && tracks.camera_ok[camera] == 0) continue;
    WindowObservation o;
    o.frame_id = frame_id;
    o.camera = track.camera;
    o.pixel = track.pixel;
    o.sigma_px = std::max(track.sigma_px, 0.01);
    if (cameras[camera].readout_time != 0.0) {
      o.row_share = rowTimeOf(1.0, track.pixel.y(), cameras[camera].camera.height());
    }
    if (!track.pixel.allFinite() || !cameras[camera].camera.unproject(track.pixel, o.ray)) continue;
    result.emplace_back(track.id, o);
  }
  return result;
}

void FeatureManager::add(Window& window, const Observations& observations) {
  std::set<std::uint64_t> still_banned;
  for (const auto& [id, observation] : observations) {
    if (banned_.count(id) != 0) {
      still_banned.insert(id);
      continue;
    }
    WindowFeature& feature = window.features[id];
    feature.id = id;
    feature.observations.push_back(observation);
    feature.last_seen_id = observation.frame_id;
  }
  banned_ = std::move(still_banned);
}

GateResult FeatureManager::gateNewest(Window& window, const Eigen::Matrix<double, 6, 6>& spread,
                                      bool is_sure) {
  const std::vector<Innovation> innovations = innovationsOf(window, spread);
  const JudgedCameras judged = judgeCameras(innovations, window.cameras.size());
  GateResult result;
  result.checked = static_cast<int>(innovations.size());
  // The world does not move all around the car at once.
  const std::size_t bad = judged.bad.size();
  contradicted_ = !is_sure && bad >= kMinContradicting && 2 * bad > judged.count;
  result.contradicted = contradicted_;
  if (contradicted_) return result;
  result.cameras = judged.bad;

  const int newest = window.frames.back().id;
  const auto isBad = [&](int camera) {
    return std::find(judged.bad.begin(), judged.bad.end(), camera) != judged.bad.end();
  };
  const auto erase = [&](WindowFeature& feature, int camera) {
    std::erase_if(feature.observations, [&](const WindowObservation& o) {
      return o.frame_id == newest && o.camera == camera;
    });
  };
  for (const Innovation& innovation : innovations) {
    const bool fits = innovation.squared < kGateSquared || innovation.px < kGatePx;
    if (fits && !isBad(innovation.camera)) continue;
    ++result.rejected;
    WindowFeature& feature = window.features.at(innovation.id);
    erase(feature, innovation.camera);
    ++feature.failures;
  }
  if (!result.cameras.empty()) {
    // New features of such a camera would be placed by a motion that is not the car's.
    for (auto& [id, feature] : window.features) {
      for (const int camera : result.cameras) erase(feature, camera);
    }
  }
  for (auto it = window.features.begin(); it != window.features.end();) {
    WindowFeature& feature = it->second;
    if (feature.failures >= kMaxFailures || feature.observations.empty()) {
      if (feature.failures >= kMaxFailures) banned_.insert(feature.id);
      it = window.features.erase(it);
    } else {
      ++it;
    }
  }
  return result;
}

void FeatureManager::triangulateNew(Window& window) {
  TriangulationLimits limits;
  const int newest = window.frames.back().id;
  for (auto it = window.features.begin(); it != window.features.end();) {
    WindowFeature& feature = it->second;
    if (!feature.has_point && feature.last_seen_id == newest && feature.observations.size() >= 2) {
      (void)triangulate(window, feature, limits);
      if (feature.failures >= kMaxFailures) {
        banned_.insert(feature.id);
        it = window.features.erase(it);
        continue;
      }
    }
    ++it;
  }
}

std::vector<WindowFeature*> FeatureManager::select(Window& window) {
  std::vector<WindowFeature*> chosen;
  std::vector<WindowFeature*> candidates;
  std::vector<int> cells(window.cameras.size() * kCellColumns * kCellRows, 0);
  const auto cell = [&](const WindowFeature& feature) -> int& {
    const WindowObservation& o = feature.observations.back();
    return cells[static_cast<std::size_t>(
        cellOf(window.cameras[static_cast<std::size_t>(o.camera)], o))];
  };
  const int newest = window.frames.back().id;
  for (auto& [id, feature] : window.features) {
    if (!feature.has_point || feature.observations.size() < 2) {
      feature.selected = false;
    } else if (feature.selected) {
      chosen.push_back(&feature);
      if (feature.last_seen_id == newest) ++cell(feature);
    } else if (feature.last_seen_id == newest) {
      candidates.push_back(&feature);
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const WindowFeature* a, const WindowFeature* b) {
                     return a->observations.size() > b->observations.size();
                   });
  const auto budget = static_cast<std::size_t>(options_.window.max_landmarks);
  makeRoom(window, budget, candidates.size(), chosen);
  for (int level = 1; chosen.size() < budget && !candidates.empty(); ++level) {
    std::vector<WindowFeature*> later;
    for (WindowFeature* feature : candidates) {
      int& filled = cell(*feature);
      if (chosen.size() >= budget || filled >= level) {
        later.push_back(feature);
        continue;
      }
      ++filled;
      feature->selected = true;
      chosen.push_back(feature);
    }
    candidates = std::move(later);
  }
  return chosen;
}

int FeatureManager::rejectOutliers(Window& window, const std::vector<WindowFeature*>& features) {
  int rejected = 0;
  std::vector<Missed> missed;
  for (WindowFeature* feature : features) {
    const std::size_t before = feature->observations.size();
    bool anchor_lost = false;
    double squares = 0.0;
    std::erase_if(feature->observations, [&](const WindowObservation& o) {
      const double error = whitenedError(window, *feature, o);
      if (error < options_.window.outlier_sigma) {
        squares += error * error;
        return false;
      }
      if (o.frame_id == feature->anchor_frame_id && o.camera == feature->anchor_camera) {
        anchor_lost = true;
      }
      return true;
    });
    const std::size_t removed = before - feature->observations.size();
    const double freedom = 2.0 * static_cast<double>(feature->observations.size()) - 3.0;
    if (freedom > 0.0) missed.push_back({feature, squares, freedom});
    if (removed == 0) continue;
    rejected += static_cast<int>(removed);
    if (!contradicted_) ++feature->failures;
    if (feature->observations.size() < 2 || feature->failures >= kMaxFailures) {
      feature->has_point = false;
      feature->selected = false;
      feature->observations.clear();
    } else if (anchor_lost && !moveAnchor(window, *feature, feature->observations.front())) {
      feature->has_point = false;
      feature->selected = false;
    }
  }
  setNoiseFactors(missed);
  for (auto it = window.features.begin(); it != window.features.end();) {
    if (it->second.observations.empty()) {
      if (it->second.failures >= kMaxFailures) banned_.insert(it->first);
      it = window.features.erase(it);
    } else {
      ++it;
    }
  }
  return rejected;
}

void FeatureManager::forgive(Window& window) {
  for (auto& [id, feature] : window.features) feature.failures = 0;
  banned_.clear();
}

}  // namespace parkade
