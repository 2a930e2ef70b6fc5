// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/localization/loop_closure.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "parkade/core/units.hpp"

namespace parkade {
namespace {

// How much of a frame fits a submap at a pose: line points in metres' worth, and point landmarks,
// each of which is as telling as several metres of line. Landmarks in the submap's area that are
// not where they should be speak against the pose.
class Scorer {
 public:
  Scorer(const SemanticFrame& frame, const Submap& submap, double radius, std::size_t stride)
      : frame_(frame), submap_(submap), radius_(radius), stride_(stride) {}

  [[nodiscard]] double at(const SE2& T) const {
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
    const double seen =
        static_cast<double>(frame_.line_points.size()) / static_cast<double>(stride_);
    constexpr double kEnough = 0.4;
    if (all <= 0.0 || seen <= 0.0) return 0.0;
    return fits / all * std::min(1.0, lines / (kEnough * seen));
  }

 private:
  [[nodiscard]] bool inside(const Eigen::Vector2d& q) const {
    constexpr double kMargin = 0.2;
    return (q - submap_.low()).minCoeff() > -kMargin && (submap_.high() - q).minCoeff() > -kMargin;
  }
  const SemanticFrame& frame_;
  const Submap& submap_;
  double radius_;
  std::size_t stride_;
};

struct Candidate {
  SE2 pose;
  double score = 0.0;
};

bool samePlace(const SE2& a, const SE2& b, double distance) {
  constexpr double kAngle = 0.06;
  return (a.translation() - b.translation()).norm() < distance &&
         std::abs(wrapAngle(a.angle() - b.angle())) < kAngle;
}

// A marker of the frame stands where the submap has one of its class with another text.
bool contradicted(const SemanticFrame& frame, const Submap& submap, const SE2& T) {
  return std::any_of(
      frame.objects.begin(), frame.objects.end(), [&](const ObjectObservation& object) {
        if (object.text.empty() || !isPointLandmark(object.semantic_class)) return false;
        const Eigen::Vector2d q = T * object.position.head<2>();
        constexpr double kThere = 0.5;
        return submap.nearestPoint(q, object.semantic_class, object.text, kThere) == nullptr &&
               submap.nearestPoint(q, object.semantic_class, "", kThere) != nullptr;
      });
}

}  // namespace

LoopResult searchInSubmap(const SemanticFrame& frame, const Submap& submap, const SE2& expected,
                          double sigma_m, double sigma_rad, const LoopOptions& loop,
                          const RegistrationOptions& registration,
                          const std::vector<Eigen::Vector3d>& viewpoints) {
  LoopResult result;
  const double reach = 3.0 * sigma_m;
  if (reach > loop.max_search_m) {
    result.reason = fmt::format("the pose is uncertain by {:.1f} m", sigma_m);
    return result;
  }
  if (frame.line_points.empty()) {
    result.reason = "no lines are seen";
    return result;
  }
  const int steps = static_cast<int>(std::ceil(reach / loop.step_m));
  const int turns = std::min(
      5, static_cast<int>(std::ceil(std::max(0.0, 3.0 * sigma_rad - 0.5 * loop.step_deg * kDegree) /
                                    (loop.step_deg * kDegree))));
  constexpr std::size_t kCoarse = 4;
  const Scorer coarse(frame, submap, loop.coarse_radius_m, kCoarse);
  std::vector<Candidate> candidates;
  for (int k = -turns; k <= turns; ++k) {
    for (int j = -steps; j <= steps; ++j) {
      for (int i = -steps; i <= steps; ++i) {
        Candidate c;
        c.pose = SE2(expected.angle() + k * loop.step_deg * kDegree,
                     expected.translation() + loop.step_m * Eigen::Vector2d(i, j));
        c.score = coarse.at(c.pose);
        candidates.push_back(c);
      }
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.score > b.score; });
  // Refine the best of each place, and compare what they end as.
  const Scorer fine(frame, submap, 0.08, 1);
  std::vector<SE2> tried;
  std::vector<Candidate> ends;
  for (const Candidate& c : candidates) {
    if (static_cast<int>(tried.size()) >= loop.refined) break;
    const bool near = std::any_of(tried.begin(), tried.end(), [&](const SE2& other) {
      return samePlace(c.pose, other, 1.1 * loop.step_m);
    });
    if (near) continue;
    tried.push_back(c.pose);
    const Registration fit = registerFrame(frame, submap, c.pose, registration, viewpoints);
    if (fit.line_matches < registration.min_matches / 2) continue;
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
  for (const Candidate& end : ends) {
    if (samePlace(end.pose, result.registration.T_map_vehicle, 0.4)) continue;
    result.second = std::max(result.second, end.score);
  }
  constexpr double kLeast = 0.5;
  if (contradicted(frame, submap, result.registration.T_map_vehicle)) {
    result.reason = "a marker there has another text";
  } else if (result.score < kLeast) {
    result.reason = fmt::format("{:.0f} % fit", 100.0 * result.score);
  } else if (result.second > loop.ambiguity * result.score) {
    result.reason = fmt::format("ambiguous: {:.0f} % fit, and {:.0f} % at another place",
                                100.0 * result.score, 100.0 * result.second);
  } else if (result.registration.observable < 3) {
    result.reason = "a direction is not observable";
  }
  result.accepted = result.reason.empty();
  return result;
}

}  // namespace parkade
