// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/semantics/standing/raised_points.hpp"

namespace parkade {

std::vector<RaisedPoint> raisedPoints(const std::vector<Landmark>& landmarks,
                                      const SE3& T_level_odom, const GroundRelief& relief,
                                      const RaisedPointOptions& options) {
  std::vector<RaisedPoint> raised;
  for (const Landmark& landmark : landmarks) {
    if (landmark.num_observations < options.min_observations) continue;
    Eigen::Vector3d p = T_level_odom * landmark.p_odom;
    p.z() -= relief.at(p.head<2>());
    if (p.z() < options.min_height_m || p.head<2>().norm() > options.range_m) continue;
    if (landmark.covariance.trace() > options.max_sigma_m * options.max_sigma_m) continue;
    raised.push_back({landmark.id, p});
  }
  return raised;
}

}  // namespace parkade
