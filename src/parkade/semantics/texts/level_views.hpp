// SPDX-FileCopyrightText: 2026 The Parkade authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

#include "parkade/camera/camera.hpp"
#include "parkade/geometry/se3.hpp"
#include "parkade/types/level_view.hpp"

namespace parkade {

/// The labels of a camera's picture as a panorama, in steps of a degree and of 0.03 of slope, from
/// 27 degrees below the horizon to 39 above; each takes the label that lies where it projects to.
///
/// labels: CV_8UC1 (SemanticClass), of any size; the picture that the camera gave, shrunk. mask:
/// CV_8UC1 of the camera's picture, 0 where the own car is; may be empty. T_level_cam: from the
/// camera to the levelled vehicle frame.
LevelView levelView(const cv::Mat& labels, const cv::Mat& mask, const Camera& camera,
                    const SE3& T_level_cam);

}  // namespace parkade
