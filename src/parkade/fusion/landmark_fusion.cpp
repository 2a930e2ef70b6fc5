// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#include "parkade/fusion/landmark_fusion.hpp"

#include <Eigen/LU>
#include <limits>

#include "parkade/fusion/pose_filter.hpp"

namespace parkade {
namespace {

struct Nearest {
  int index = -1;
  double first = std::numeric_limits<double>::infinity();
  double second = std::numeric_limits<double>::infinity();

  void offer(int candidate, double distance) {
    if (distance < first) {
      second = first;
      first = distance;
      index = candidate;
    } else if (distance < second) {
      second = distance;
    }
  }
};

}  // namespace

std::vector<LandmarkMatch> matchLandmarks(const std::vector<PlacedPoint>& semantic,
                                          const std::vector<PlacedPoint>& key_points,
                                          const LandmarkFusionOptions& options) {
  std::vector<Nearest> of_semantic(semantic.size());
  std::vector<Nearest> of_key_point(key_points.size());
  for (std::size_t i = 0; i < semantic.size(); ++i) {
    for (std::size_t j = 0; j < key_points.size(); ++j) {
      const Eigen::Vector3d from = key_points[j].p - semantic[i].p;
      if (from.norm() > options.max_distance_m) continue;
      const Eigen::Matrix3d S = semantic[i].covariance + key_points[j].covariance;
      const double distance = from.dot(S.inverse() * from);
      of_semantic[i].offer(static_cast<int>(j), distance);
      of_key_point[j].offer(static_cast<int>(i), distance);
    }
  }
  const double gate = chiSquareQuantile(3, options.gate_probability);
  std::vector<LandmarkMatch> matches;
  for (std::size_t i = 0; i < semantic.size(); ++i) {
    const Nearest& near = of_semantic[i];
    if (near.index < 0 || near.first > gate) continue;
    const Nearest& back = of_key_point[static_cast<std::size_t>(near.index)];
    if (back.index != static_cast<int>(i)) continue;
    const double ratio2 = options.ratio * options.ratio;
    if (near.first > ratio2 * near.second || back.first > ratio2 * back.second) continue;
    matches.push_back({static_cast<int>(i), near.index, near.first});
  }
  return matches;
}

PlacedPoint fuseLandmark(const PlacedPoint& semantic, const PlacedPoint& key_point) {
  const Eigen::Matrix3d S = semantic.covariance + key_point.covariance;
  const Eigen::Matrix3d K = semantic.covariance * S.inverse();
  PlacedPoint fused;
  fused.p = semantic.p + K * (key_point.p - semantic.p);
  const Eigen::Matrix3d A = Eigen::Matrix3d::Identity() - K;
  fused.covariance =
      A * semantic.covariance * A.transpose() + K * key_point.covariance * K.transpose();
  return fused;
}

}  // namespace parkade
