// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>

#include "parkade/camera/rig.hpp"
#include "parkade/tracking/options.hpp"
#include "parkade/tracking/patch.hpp"
#include "parkade/tracking/row_motion.hpp"

namespace parkade {

/// A feature found again in another camera.
struct CrossMatch {
  PatchAlignment alignment;    ///< in the other camera's image
  double inverse_depth = 0.0;  ///< 1/m along the first camera's ray, 0: far away
  double epipolar_px = 0.0;    ///< distance from the epipolar plane, other camera's scale
};

/// One camera's picture, as the search needs it.
struct SearchImage {
  const Camera* camera = nullptr;
  cv::Mat fine;    ///< CV_8UC1
  cv::Mat coarse;  ///< half the size of fine
};

/// Finds a feature of camera a in camera b of the same instant: walks along the epipolar curve of
/// the known extrinsics from the nearest depth to infinity, warps the patch as each depth asks for
/// (so that cameras with very different directions still match), takes the best correlated place
/// if no other comes near, aligns the feature's patch there and checks the result against the
/// extrinsics: epipolar distance and positive depth. Nothing found: empty.
///
/// known_depth: m along the ray from a, where the estimator knows it; 0 else.
std::optional<CrossMatch> searchEpipolar(const SearchImage& a, const SearchImage& b,
                                         const RowPair& pair, const Eigen::Vector2d& pixel_a,
                                         const Eigen::Matrix2d& warp_a, const Patch& patch,
                                         double known_depth, const MatchingOptions& options);

/// Distance in pixels (image centre's scale) of b's ray from the epipolar plane of a's ray; also
/// the inverse depths along both rays (negative: behind the camera).
struct EpipolarCheck {
  double distance_px = 0.0;
  double inverse_depth_a = 0.0;
  double inverse_depth_b = 0.0;
};
EpipolarCheck checkEpipolar(const Eigen::Vector3d& ray_a, const Eigen::Vector3d& ray_b,
                            const SE3& T_b_a, double focal_px);

}  // namespace parkade
