// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace parkade {

/// A place with its uncertainty, in a frame that both of two lists share.
struct PlacedPoint {
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< m^2, positive
};

struct LandmarkFusionOptions {
  double max_distance_m = 0.15;
  double gate_probability = 0.95;
  double ratio = 0.7;
};

struct LandmarkMatch {
  int semantic = 0;
  int key_point = 0;
  double distance = 0.0;  ///< squared Mahalanobis distance
};

/// Semantic landmarks and key points that are the same thing: each other's nearest by Mahalanobis
/// distance, inside the gate, and clearly nearer than the second (a corner with two key points
/// beside it matches neither).
std::vector<LandmarkMatch> matchLandmarks(const std::vector<PlacedPoint>& semantic,
                                          const std::vector<PlacedPoint>& key_points,
                                          const LandmarkFusionOptions& options);

/// Equation (4) of the paper on one matched pair: mu <- mu + K (Z - h(mu)), where mu is the
/// semantic landmark, Z the key point's position, h the identity. Covariance in Joseph's form.
PlacedPoint fuseLandmark(const PlacedPoint& semantic, const PlacedPoint& key_point);

}  // namespace parkade
