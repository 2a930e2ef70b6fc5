// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/localization/place_decision.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "parkade/geometry/alignment.hpp"

namespace parkade {
namespace {

// Of the frame's texts that stand where the submap has one on a landmark of that class, those that
// differ.
struct Comparison {
  int compared = 0;
  int wrong = 0;
  [[nodiscard]] bool contradicts(const PlaceRules& rules) const {
    return wrong > rules.wrong_texts * compared;
  }
};
struct Texts {
  Comparison names;    // of zone markers and guide signs
  Comparison repeats;  // of arrows and limits: they say the same all over a garage
  [[nodiscard]] bool contradict(const PlaceRules& rules) const {
    const Comparison all{names.compared + repeats.compared, names.wrong + repeats.wrong};
    return names.contradicts(rules) || all.contradicts(rules);
  }
  [[nodiscard]] bool suffice(const PlaceRules& rules) const {
    return rules.enough_texts > 0 && names.compared - names.wrong >= rules.enough_texts;
  }
  [[nodiscard]] std::string reason() const {
    const int compared = names.compared + repeats.compared;
    if (compared == 1) return "a marker there has another text";
    return fmt::format("{} of {} markers there have another text", names.wrong + repeats.wrong,
                       compared);
  }
};
Texts compareTexts(const SemanticFrame& frame, const Submap& submap, const SE2& T) {
  Texts texts;
  for (const ObjectObservation& object : frame.objects) {
    const SemanticClass c = object.semantic_class;
    if (object.text.empty() || !isPointLandmark(c)) continue;
    const Eigen::Vector2d q = T * object.position.head<2>();
    constexpr double kThere = 0.5;  // m
    if (submap.nearestPoint(q, c, "", kThere) == nullptr) continue;
    const PointFeature* same = submap.nearestPoint(q, c, object.text, kThere);
    if (same != nullptr && same->text.empty()) continue;  // nobody has read that one
    const bool is_name = c == SemanticClass::kZoneMarker || c == SemanticClass::kGuideSign;
    Comparison& kind = is_name ? texts.names : texts.repeats;
    ++kind.compared;
    kind.wrong += same == nullptr ? 1 : 0;
  }
  return texts;
}

// The frame's landmarks, and those of the submap that they fall on at a pose.
struct Landmarks {
  Points3d seen;  // in the plane
  Points3d mapped;
  [[nodiscard]] bool enough() const {
    constexpr std::size_t kFewest = 3;
    return seen.size() >= kFewest;
  }
};
Landmarks landmarksAt(const SemanticFrame& frame, const Submap& submap, const SE2& T) {
  constexpr double kRadius = 1.0;  // m
  Landmarks landmarks;
  for (const ObjectObservation& object : frame.objects) {
    if (!isPointLandmark(object.semantic_class)) continue;
    const Eigen::Vector2d p = object.position.head<2>();
    const PointFeature* match =
        submap.nearestPoint(T * p, object.semantic_class, object.text, kRadius);
    if (match == nullptr) continue;
    landmarks.seen.emplace_back(p.x(), p.y(), 0.0);
    landmarks.mapped.emplace_back(match->p.x(), match->p.y(), 0.0);
  }
  return landmarks;
}

// The pose by landmarks alone.
SE2 layOnLandmarks(const SemanticFrame& frame, const Submap& submap, SE2 T) {
  constexpr int kRounds = 3;
  for (int round = 0; round < kRounds; ++round) {
    const Landmarks landmarks = landmarksAt(frame, submap, T);
    if (!landmarks.enough()) return T;
    T = SE2::fromSE3(alignYaw(landmarks.seen, landmarks.mapped).T_target_source);
  }
  return T;
}

}  // namespace

double PlaceScorer::at(const SE2& T) const {
  const Eigen::Matrix2d R = T.rotationMatrix();
  double fits = 0.0;
  double all = 0.0;
  for (std::size_t i = 0; i < frame_.line_points.size(); i += stride_) {
    const LinePoint& point = frame_.line_points[i];
    const Eigen::Vector2d q = T * point.p_level;
    if (!inside(q)) continue;
    all += 1.0;
    const LineFeature* match =
        submap_.lines().nearest(q, R * point.normal, point.semantic_class, 2.0 * radius_);
    if (match != nullptr && std::abs(match->normal.dot(q - match->p)) < radius_) fits += 1.0;
  }
  const double lines = all;
  const double weight = 0.12 * std::max(10.0, lines);
  for (const ObjectObservation& object : frame_.objects) {
    if (!isPointLandmark(object.semantic_class)) continue;
    const Eigen::Vector2d q = T * object.position.head<2>();
    if (!inside(q)) continue;
    all += weight;
    if (submap_.nearestPoint(q, object.semantic_class, object.text, 0.5) != nullptr) {
      fits += weight;
    }
  }
  // The share that fits, and little where little lies inside.
  const double seen = static_cast<double>(frame_.line_points.size()) / static_cast<double>(stride_);
  constexpr double kEnough = 0.4;
  if (all <= 0.0 || seen <= 0.0) return 0.0;
  return fits / all * std::min(1.0, lines / (kEnough * seen));
}

bool PlaceScorer::inside(const Eigen::Vector2d& q) const {
  constexpr double kMargin = 0.2;
  return (q - submap_.low()).minCoeff() > -kMargin && (submap_.high() - q).minCoeff() > -kMargin;
}

bool textsContradict(const SemanticFrame& frame, const Submap& submap, const SE2& T_map_vehicle,
                     const PlaceRules& rules) {
  return compareTexts(frame, submap, T_map_vehicle).contradict(rules);
}

bool textsSuffice(const SemanticFrame& frame, const Submap& submap, const SE2& T_map_vehicle,
                  const PlaceRules& rules) {
  return compareTexts(frame, submap, T_map_vehicle).suffice(rules);
}

bool samePlace(const SE2& a, const SE2& b, double distance, double angle) {
  return (a.translation() - b.translation()).norm() < distance &&
         std::abs(wrapAngle(a.angle() - b.angle())) < angle;
}

void sortByScore(std::vector<PlaceCandidate>& candidates) {
  std::stable_sort(
      candidates.begin(), candidates.end(),
      [](const PlaceCandidate& a, const PlaceCandidate& b) { return a.score > b.score; });
}

LoopResult decidePlace(const SemanticFrame& frame, const Submap& submap,
                       std::vector<PlaceCandidate> candidates, const PlaceRules& rules,
                       const RegistrationOptions& registration,
                       const std::vector<Eigen::Vector3d>& viewpoints) {
  LoopResult result;
  sortByScore(candidates);
  // Refine the best of each place, and compare what they end as.
  const PlaceScorer fine(frame, submap, 0.08, 1);
  std::vector<SE2> tried;
  std::vector<PlaceCandidate> ends;
  for (const PlaceCandidate& c : candidates) {
    if (static_cast<int>(tried.size()) >= rules.refined) break;
    const bool near = std::any_of(tried.begin(), tried.end(), [&](const SE2& other) {
      return samePlace(c.T_map_vehicle, other, rules.spacing_m, rules.spacing_rad);
    });
    if (near) continue;
    tried.push_back(c.T_map_vehicle);
    const SE2 start =
        rules.landmarks_first ? layOnLandmarks(frame, submap, c.T_map_vehicle) : c.T_map_vehicle;
    const Registration fit = registerFrame(frame, submap, start, registration, viewpoints);
    if (fit.line_matches < registration.min_matches / 2) continue;
    if (rules.texts_exclude && textsContradict(frame, submap, fit.T_map_vehicle, rules)) {
      continue;
    }
    const double score = fine.at(fit.T_map_vehicle);
    ends.push_back({fit.T_map_vehicle, score});
    if (fit.accepted && score > result.score) {
      result.score = score;
      result.registration = fit;
    }
  }
  if (result.score <= 0.0) {
    result.reason = "nothing fits";
    return result;
  }
  for (const PlaceCandidate& end : ends) {
    if (samePlace(end.T_map_vehicle, result.registration.T_map_vehicle, 0.4)) continue;
    result.second = std::max(result.second, end.score);
  }
  const Texts texts = compareTexts(frame, submap, result.registration.T_map_vehicle);
  if (texts.contradict(rules)) {
    result.reason = texts.reason();
  } else if (result.score < (texts.suffice(rules) ? rules.least_fit_by_texts : rules.least_fit)) {
    result.reason = fmt::format("{:.0f} % fit", 100.0 * result.score);
  } else if (result.second > rules.ambiguity * result.score) {
    result.reason = fmt::format("ambiguous: {:.0f} % fit, and {:.0f} % at another place",
                                100.0 * result.score, 100.0 * result.second);
  } else if (result.registration.observable < 3) {
    result.reason = "a direction is not observable";
  }
  result.accepted = result.reason.empty();
  return result;
}

}  // namespace parkade
