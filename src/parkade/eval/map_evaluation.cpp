// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/eval/map_evaluation.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "parkade/eval/association.hpp"
#include "parkade/eval/map_evaluation_parts.hpp"

namespace parkade {

double distanceToWay(const Eigen::Vector2d& p, const Way& way) {
  double best = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector2d& q : way) best = std::min(best, (p - q).squaredNorm());
  return std::sqrt(best);
}

Result<SE3> placeByFirstPose(TimeNs t_ns, const SE3& T_map_vehicle, const Trajectory& driven) {
  AssociationOptions options;
  options.interpolate = true;
  const Result<Association> pairs = associate({{t_ns, T_map_vehicle}}, driven, options);
  if (!pairs) {
    return Error{fmt::format("no reference where the map begins: {}", pairs.error().message)};
  }
  const SE3& there = pairs->reference.front().T_world_body;
  const SE3& here = pairs->estimate.front().T_world_body;
  SE3 T = (SE2::fromSE3(there) * SE2::fromSE3(here).inverse()).toSE3();
  T.translation().z() = there.translation().z() - here.translation().z();
  return T;
}

Result<MapEvaluation> evaluateMap(const ParkingMap& map, const SE2& T_truth_map,
                                  const MapTruth& truth, const MapEvaluationOptions& options) {
  MapEvaluation result;
  result.options = options;
  result.T_truth_map = T_truth_map;
  Way way;
  constexpr double kSpacing = 0.1;
  for (const auto& pose : truth.driven) {
    const Eigen::Vector2d p = pose.T_world_body.translation().head<2>();
    if (way.empty() || (p - way.back()).norm() >= kSpacing) way.push_back(p);
  }
  scoreSlots(map, truth, way, result);
  scoreObjects(map, truth, way, result);
  result.loops = scoreLoops(map, truth.driven);
  for (Eigen::Vector2d& p : way) p = T_truth_map.inverse() * p;
  for (const GridLayer layer : kGridLayers) {
    if (layer == GridLayer::kDynamic) continue;
    const Result<LayerScore> score =
        scoreLayer(map.grid, layer, T_truth_map, truth, way, options.passed_within_m);
    if (!score) return score.error();
    result.layers[layer] = *score;
  }
  return result;
}

}  // namespace parkade
