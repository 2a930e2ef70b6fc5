// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/localization/loop_closure.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "parkade/core/units.hpp"

namespace parkade {
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
  const PlaceScorer coarse(frame, submap, loop.coarse_radius_m, kCoarse);
  std::vector<PlaceCandidate> candidates;
  for (int k = -turns; k <= turns; ++k) {
    for (int j = -steps; j <= steps; ++j) {
      for (int i = -steps; i <= steps; ++i) {
        PlaceCandidate c;
        c.T_map_vehicle = SE2(expected.angle() + k * loop.step_deg * kDegree,
                              expected.translation() + loop.step_m * Eigen::Vector2d(i, j));
        c.score = coarse.at(c.T_map_vehicle);
        candidates.push_back(c);
      }
    }
  }
  PlaceRules rules;
  rules.refined = loop.refined;
  rules.spacing_m = 1.1 * loop.step_m;
  rules.ambiguity = loop.ambiguity;
  rules.least_fit = loop.least_fit;
  return decidePlace(frame, submap, std::move(candidates), rules, registration, viewpoints);
}

}  // namespace parkade
